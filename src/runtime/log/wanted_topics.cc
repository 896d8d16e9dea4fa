#include "runtime/log/wanted_topics.h"

#include <algorithm>

namespace gloam {

Result<std::vector<const Topic*>> wanted_topics(const TopicTable& table,
                                                const std::vector<std::string>& patterns) {
  std::vector<const Topic*> wanted;
  for (const Topic& topic : table)
    if (patterns.empty() && topic.info.is_logged) wanted.push_back(&topic);
  for (const std::string& pattern : patterns) {
    GLOAM_TRY(const auto found, find_topics(table, pattern));
    for (const Topic* topic : found)
      if (std::ranges::count(wanted, topic) == 0) wanted.push_back(topic);
  }
  return wanted;
}

Result<bool> logs_pictures(const World& world, const LogRequest& request) {
  GLOAM_TRY(const TopicTable table, make_topic_table(world.compiled()));
  GLOAM_TRY(const auto topics, wanted_topics(table, request.topics));
  return std::ranges::any_of(topics, [](const Topic* topic) { return !topic->channel.empty(); });
}

}  // namespace gloam
