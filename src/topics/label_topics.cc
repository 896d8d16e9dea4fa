// Topics of cameras' tables of labels: names of the ids in segmentation/instance and …/semantic.

#include <algorithm>
#include <map>

#include "ros/messages/vision_msgs.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/streams.h"

namespace gloam {
namespace {

using Id = uint32_t LabelRow::*;
using Name = std::string LabelRow::*;

constexpr uint32_t kMostId = 65535;  // of a mono16 picture

// 0 is where nothing is hit.
LatchedEncoder label_info(Id id, Name name) {
  return [id, name](const TopicInfo& topic, const LatchedInputs& at, MessageBytes* out) -> Status {
    GLOAM_TRY(const std::vector<LabelRow> rows, at.labels());
    std::map<uint32_t, std::string> names = {{0, "nothing"}};
    for (const LabelRow& row : rows) names.try_emplace(std::min(row.*id, kMostId), row.*name);
    vision_msgs::LabelInfo info;
    info.header = ros_header(at.time, topic.frame_id);
    for (const auto& [number, text] : names)
      info.class_map.push_back({static_cast<uint16_t>(number), text});
    encode(info, out);
    return {};
  };
}

}  // namespace

void add_label_topics(const TopicWorld& world, TopicTable* table) {
  for (const StreamInfo& stream : list_streams(*world)) {
    if (stream.kind != StreamKind::kCamera ||
        std::ranges::count(stream.outputs, "segmentation") == 0)
      continue;
    const auto add = [&](const char* picture, LatchedEncoder encode) {
      table->push_back(
          {{.name = "/" + topic_token(stream.name) + "/segmentation/" + picture + "/label_info",
            .type = type_name<vision_msgs::LabelInfo>(),
            .frame_id = stream.frame_id,
            .qos = kLatchedQos,
            .is_logged = false,
            .source = {TopicSource::Kind::kCamera, stream.name},
            .is_large = true},
           {},
           {},
           std::move(encode)});
    };
    add("instance", label_info(&LabelRow::instance, &LabelRow::instance_name));
    add("semantic", label_info(&LabelRow::semantic, &LabelRow::semantic_name));
  }
}

}  // namespace gloam
