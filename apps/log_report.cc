#include "log_report.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "gloam/log.h"
#include "gloam/topics.h"
#include "json_text.h"
#include "print.h"

namespace gloam::cli {

bool is_log(const std::string& file) {
  if (std::filesystem::path(file).extension() == ".mcap") return true;
  constexpr std::string_view kMagic("\x89MCAP0\r\n");
  char head[8] = {};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head, sizeof(head));
  return std::string_view(head, static_cast<size_t>(stream.gcount())) == kMagic;
}

int report_log(const std::string& file, const Globals& globals) {
  const auto log = describe_log(file);
  if (!log.ok()) return fail(log.error());
  if (globals.json) {
    nlohmann::ordered_json json = {{"profile", log->profile},
                                   {"library", log->library},
                                   {"bytes", log->bytes},
                                   {"messages", log->messages},
                                   {"chunks", log->chunks},
                                   {"start_s", log->start},
                                   {"duration_s", log->duration},
                                   {"compression", log->compression},
                                   {"can_be_stepped_again", log->has_run},
                                   {"scene", log->scene},
                                   {"damage", log->damage}};
    auto& topics = json["topics"] = nlohmann::ordered_json::array();
    for (const LoggedTopic& topic : log->topics)
      topics.push_back({{"name", topic.name},
                        {"type", topic.type},
                        {"messages", topic.messages},
                        {"rate_hz", topic.rate}});
    put_json(json);
    return log->damage.empty() ? 0 : 3;
  }
  say("{:.2f} MiB, {} messages in {} chunks, {:.2f} : 1; {:.3f} s; profile '{}', by '{}'\n",
      static_cast<double>(log->bytes) / (1 << 20), log->messages, log->chunks, log->compression,
      log->duration, log->profile, log->library);
  if (log->has_run)
    say("run of scene '{}'; to verify it: `gloam replay {} --verify`\n", log->scene, file);
  if (log->messages == 0) say("the log is empty: it contains no messages\n");
  if (!log->damage.empty())
    say("damaged: {}; to repair the log: `gloam recover {}`\n", log->damage, file);
  say("\n  {:<40} {:<36} {:>9} {:>9}\n", "topic", "type", "messages", "rate");
  for (const LoggedTopic& topic : log->topics)
    if (topic.messages > 0)
      say("  {:<40} {:<36} {:>9} {:>9}\n", topic.name, topic.type, topic.messages,
          topic.rate > 0 ? fmt::format("{:.1f} Hz", topic.rate) : "");
  return log->damage.empty() ? 0 : 3;
}

int report_topics(const World& world, const Globals& globals) {
  const auto topics = list_topics(world);
  if (!topics.ok()) return fail(topics.error());
  if (globals.json) {
    auto json = nlohmann::ordered_json::array();
    for (const TopicInfo& topic : *topics)
      json.push_back({{"name", topic.name},
                      {"type", topic.type},
                      {"frame_id", topic.frame_id},
                      {"rate_hz", {topic.rate.num, topic.rate.den}},
                      {"reliable", topic.qos.is_reliable},
                      {"latched", topic.qos.is_latched},
                      {"depth", topic.qos.depth},
                      {"input", topic.is_input},
                      {"logged", topic.is_logged},
                      {"source", to_string(topic.source)}});
    put_json(json);
    return 0;
  }
  say("  {:<6} {:<36} {:<34} {:<10} {}\n", "", "topic", "type", "rate", "source");
  for (const TopicInfo& topic : *topics) {
    const std::string rate = topic.is_input         ? "-"
                             : topic.qos.is_latched ? "latched"
                             : topic.rate.num == 0  ? "every step"
                                                    : fmt::format("{:g} Hz", topic.rate.value());
    say("  {:<6} {:<36} {:<34} {:<10} {}{}\n", topic.is_input ? "input" : "output", topic.name,
        topic.type, rate, to_string(topic.source),
        topic.is_logged || topic.is_input ? "" : " (not in logs)");
  }
  return 0;
}

}  // namespace gloam::cli
