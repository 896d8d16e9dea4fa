#include "topics/topic_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "topics/ros_values.h"

namespace gloam {
namespace {

/// Names that no element's topic may have, with the type of the topic that has it.
const std::map<std::string, std::string>& reserved_names() {
  static const std::map<std::string, std::string> names = {
      {"/clock", "rosgraph_msgs/msg/Clock"},
      {"/tf", "tf2_msgs/msg/TFMessage"},
      {"/tf_static", "tf2_msgs/msg/TFMessage"},
      {"/metrics", "gloam_msgs/msg/Metrics"},
      {"/contacts", "gloam_msgs/msg/Contacts"},
      {"/objects", "visualization_msgs/msg/MarkerArray"},
      {"/agents", "visualization_msgs/msg/MarkerArray"},
      {"/scene", "foxglove_msgs/msg/SceneUpdate"},
      {"/weather", "gloam_msgs/msg/Weather"},
      {"/diagnostics", "diagnostic_msgs/msg/DiagnosticArray"},
      {"/diagnostics/performance", "diagnostic_msgs/msg/DiagnosticArray"},
      {"/reset", "std_msgs/msg/Empty"},
      {"/rosout", ""},
      {"/parameter_events", ""},
      {"/gloam/world", ""},
      {"/gloam/commands", ""},
      {"/gloam/states", ""},
      {"/gloam/inputs", ""},
  };
  return names;
}

bool is_own(const TopicInfo& info) {
  const auto found = reserved_names().find(info.name);
  return found != reserved_names().end() && found->second == info.type;
}

/// Topics of one element, in the order of the table.
struct ElementTopics {
  TopicSource source;
  std::vector<Topic*> topics;

  /// "/front" of camera "front"; of topics that do not lie below their element's name the whole
  /// name of the first.
  std::string space() const {
    const std::string below = "/" + topic_token(source.name);
    const bool is_below = std::ranges::all_of(topics, [&below](const Topic* topic) {
      return topic->info.name == below || topic->info.name.starts_with(below + "/");
    });
    return is_below ? below : topics.front()->info.name;
  }
};

std::vector<ElementTopics> topics_by_element(TopicTable* table) {
  std::vector<ElementTopics> elements;
  std::map<TopicSource, size_t> places;
  for (Topic& topic : *table) {
    if (is_own(topic.info)) continue;
    const auto [place, is_new] = places.emplace(topic.info.source, elements.size());
    if (is_new) elements.push_back({topic.info.source, {}});
    elements[place->second].topics.push_back(&topic);
  }
  return elements;
}

class Namer {
 public:
  Namer(TopicTable* table, std::vector<Error>* notes) : notes_(notes) {
    for (const auto& [name, type] : reserved_names()) taken_.insert(name);
    for (const Topic& topic : *table) wanted_.insert(topic.info.name);
  }

  void name(const ElementTopics& element) {
    const std::string space = element.space();
    std::string next = space;
    for (int number = 2; !fits(element, space, next, number > 2); ++number)
      next = fmt::format("{}{}{}", space, space.ends_with('_') ? "" : "_", number);
    if (next != space)
      notes_->push_back({ErrorKind::kInput,
                         fmt::format("topics of {} are named '{}', not '{}': {}",
                                     to_string(element.source), next, space, "that name is in use"),
                         {},
                         "use a [[topic]] with `rename` to choose other names"});
    for (Topic* topic : element.topics) {
      topic->info.name = renamed(topic->info.name, space, next);
      taken_.insert(topic->info.name);
    }
  }

 private:
  static std::string renamed(const std::string& name, const std::string& space,
                             const std::string& next) {
    return name.starts_with(space) ? next + name.substr(space.size()) : name;
  }

  // A name that is made up must not be one that another element has of its own.
  bool fits(const ElementTopics& element, const std::string& space, const std::string& next,
            bool is_made_up) const {
    std::set<std::string> own;
    return std::ranges::all_of(element.topics, [&](const Topic* topic) {
      const std::string name = renamed(topic->info.name, space, next);
      return !taken_.contains(name) && own.insert(name).second &&
             !(is_made_up && wanted_.contains(name));
    });
  }

  std::vector<Error>* notes_;
  std::set<std::string> taken_, wanted_;
};

}  // namespace

void make_names_unique(TopicTable* table, std::vector<Error>* notes) {
  Namer namer(table, notes);
  for (const ElementTopics& element : topics_by_element(table)) namer.name(element);
}

}  // namespace gloam
