// Topics of LiDARs: clouds of points with the fields of the drivers of Velodyne and Ouster.

#include <cstring>

#include "ros/messages/sensor_msgs.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/streams.h"
#include "world/world.h"

namespace gloam {
namespace {

/// One point as it lies in PointCloud2::data.
struct PackedPoint {
  float x, y, z, intensity;  // [m], [m], [m], 0 … 255
  float time;                // since the stamp [s]
  uint16_t ring;             // from below
  uint16_t unused;
};
static_assert(sizeof(PackedPoint) == 24);

Status encode_scan(const TopicInfo& topic, const LidarScan& scan, MessageBytes* out) {
  using Field = sensor_msgs::PointField;
  static const std::vector<Field> kFields = {
      {"x", 0, Field::FLOAT32, 1},     {"y", 4, Field::FLOAT32, 1},
      {"z", 8, Field::FLOAT32, 1},     {"intensity", 12, Field::FLOAT32, 1},
      {"time", 16, Field::FLOAT32, 1}, {"ring", 20, Field::UINT16, 1},
  };
  std::vector<PackedPoint> points(scan.size());
  for (size_t i = 0; i < points.size(); ++i)
    points[i] = {scan.x[i], scan.y[i], scan.z[i], scan.intensity[i], scan.time[i], scan.ring[i], 0};
  sensor_msgs::PointCloud2 cloud;
  cloud.header = ros_header(scan.start, topic.frame_id);
  cloud.height = 1;
  cloud.width = static_cast<uint32_t>(points.size());
  cloud.fields = kFields;
  cloud.point_step = sizeof(PackedPoint);
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.is_dense = true;
  cloud.data = Bytes::view(
      {reinterpret_cast<const uint8_t*>(points.data()), points.size() * sizeof(PackedPoint)});
  encode(cloud, out);
  return {};
}

}  // namespace

void add_lidar_topics(const TopicWorld& world, TopicTable* table) {
  for (const StreamInfo& stream : World(world).streams()) {
    if (stream.kind != StreamKind::kLidar) continue;
    Topic& topic = table->emplace_back();
    topic.info = {.name = "/" + topic_token(stream.name) + "/points",
                  .type = type_name<sensor_msgs::PointCloud2>(),
                  .frame_id = stream.frame_id,
                  .rate = stream.rate,
                  .qos = kSensorQos,
                  .source = {TopicSource::Kind::kLidar, stream.name},
                  .is_large = true};
    topic.streams = {stream.name};
    topic.code = ScanEncoder(encode_scan);
  }
}

}  // namespace gloam
