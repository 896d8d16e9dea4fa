#pragma once
// The table of topics of a World.

#include <memory>

#include "topics/topic.h"

namespace gloam {

using TopicTable = std::vector<Topic>;

/// Topics by the default rules, with names of their own (topic_names.h), changed as the scene's
/// [[topic]]s say, without those that are off. Errors: a [[topic]] that fits none; two topics of
/// one name because of a [[topic]].
Result<TopicTable> make_topic_table(const std::shared_ptr<const CompiledWorld>& world);

/// Rows of a table whose names fit a name or pattern; * stands for any text. Error: none does.
Result<std::vector<const Topic*>> find_topics(const TopicTable& table, const std::string& pattern);

// The kinds, in the order of the table.
using TopicWorld = std::shared_ptr<const CompiledWorld>;
void add_world_topics(const TopicWorld& world, TopicTable* table);
void add_object_topics(const TopicWorld& world, TopicTable* table);
void add_metric_topics(const TopicWorld& world, TopicTable* table);
void add_air_topics(const TopicWorld& world, TopicTable* table);
void add_diagnostic_topics(const TopicWorld& world, TopicTable* table);
void add_robot_topics(const TopicWorld& world, TopicTable* table);
void add_actuator_topics(const TopicWorld& world, TopicTable* table);
void add_sensor_topics(const TopicWorld& world, TopicTable* table);
void add_camera_topics(const TopicWorld& world, TopicTable* table);
void add_label_topics(const TopicWorld& world, TopicTable* table);
void add_lidar_topics(const TopicWorld& world, TopicTable* table);
void add_input_topics(const TopicWorld& world, TopicTable* table);
void add_object_scene_topics(const TopicWorld& world, TopicTable* table);

}  // namespace gloam
