#include "runtime/log/topic_reader.h"

#include <fmt/format.h>

#include "base/text.h"

namespace gloam {

Status refuse_empty_log(const McapReader& log) {
  if (log.statistics().messages > 0 || !log.pieces().empty()) return {};
  return Error{ErrorKind::kInput, "the log is empty: it contains no messages", {log.name(), 0, 0}};
}

Result<TopicReader> TopicReader::find(const McapReader& log, const std::string& name) {
  GLOAM_TRY_STATUS(refuse_empty_log(log));
  std::vector<std::string> names;
  for (const auto& [id, channel] : log.channels()) {
    names.push_back(channel.topic);
    if (channel.topic != name) continue;
    const auto schema = log.schemas().find(channel.schema);
    if (channel.encoding != "cdr" || schema == log.schemas().end() ||
        schema->second.encoding != "ros2msg")
      return Error{
          ErrorKind::kUnsupported,
          fmt::format("topic '{}' has the encoding '{}' (expected CDR with a ros2msg definition)",
                      name, channel.encoding)};
    const std::vector<uint8_t>& data = schema->second.data;
    const std::string_view text(reinterpret_cast<const char*>(data.data()), data.size());
    GLOAM_TRY(MessageSchema parsed, MessageSchema::parse(text, schema->second.name));
    return TopicReader{name, std::move(parsed)};
  }
  return Error{ErrorKind::kInput,
               fmt::format("{} has no topic '{}'", log.name(), name),
               {},
               suggest_name(name, names)};
}

Status TopicReader::for_each(const McapReader& log,
                             const std::function<Status(const DynamicMessage&)>& f) const {
  McapMessages messages = log.messages({.topics = {name}});
  for (;;) {
    GLOAM_TRY(const McapMessage* message, messages.next());
    if (message == nullptr) return {};
    GLOAM_TRY(const DynamicMessage read, DynamicMessage::open(schema, message->data));
    GLOAM_TRY_STATUS(f(read));
  }
}

}  // namespace gloam
