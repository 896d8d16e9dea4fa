// gloam::describe_log and recover_log.

#include "gloam/log.h"
#include "mcap/mcap_describe.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_recover.h"
#include "runtime/log/logged_text.h"
#include "runtime/log/run_text.h"

namespace gloam {

Result<LogInfo> describe_log(const std::filesystem::path& file) {
  GLOAM_TRY(const McapReader reader, McapReader::open(file));
  const McapInfo from = describe(reader);
  LogInfo info;
  info.profile = from.profile;
  info.library = from.library;
  info.bytes = static_cast<int64_t>(from.bytes);
  info.messages = static_cast<int64_t>(from.messages);
  info.chunks = static_cast<int64_t>(from.chunks);
  info.start = 1e-9 * static_cast<double>(from.start_time);
  info.duration = from.duration;
  info.compression = from.compression_ratio;
  info.damage = from.damage;
  for (const McapTopicInfo& topic : from.topics)
    info.topics.push_back(
        {topic.topic, topic.type, static_cast<int64_t>(topic.messages), topic.rate});
  McapMessages worlds = reader.messages({.topics = {kWorldTopic}});
  if (const auto first = worlds.next(); first.ok() && *first != nullptr) {
    const auto json = logged_text(reader, **first);
    const auto text = json.ok() ? parse_run_text(*json) : Result<RunText>(json.error());
    info.has_run = text.ok();
    if (text.ok()) info.scene = text->name;
  }
  return info;
}

Result<LogRecovery> recover_log(const std::filesystem::path& file,
                                const std::filesystem::path& to) {
  GLOAM_TRY(const McapRecovery from, recover_log_file(file, to));
  return LogRecovery{from.whole, static_cast<int64_t>(from.messages),
                     static_cast<int64_t>(from.messages_lost),
                     static_cast<int64_t>(from.bytes_lost), from.damage};
}

}  // namespace gloam
