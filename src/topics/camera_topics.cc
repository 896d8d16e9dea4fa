// Topics of cameras: pictures, intrinsics, depth, ids, temperatures, events.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "gloam/view.h"
#include "ros/message_types.h"
#include "ros/messages/event_camera_msgs.h"
#include "ros/messages/foxglove_msgs.h"
#include "ros/messages/sensor_msgs.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "topics/topic_video.h"
#include "world/streams.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr int kJpegQuality = 90;

template <class T>
Bytes view_of(const std::vector<T>& values) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
  return Bytes::view({bytes, values.size() * sizeof(T)});
}

sensor_msgs::Image image_of(const TopicInfo& topic, const CameraFrame& frame, const char* encoding,
                            size_t pixel_bytes) {
  sensor_msgs::Image image;
  image.header = ros_header(frame.time, topic.frame_id);
  image.width = static_cast<uint32_t>(frame.intrinsics.width);
  image.height = static_cast<uint32_t>(frame.intrinsics.height);
  image.encoding = encoding;
  image.step = static_cast<uint32_t>(image.width * pixel_bytes);
  return image;
}

Status encode_rgb(const TopicInfo& topic, const CameraFrame& frame, MessageBytes* out) {
  sensor_msgs::Image image = image_of(topic, frame, "rgb8", 3);
  image.data = view_of(frame.rgb);
  encode(image, out);
  return {};
}

Status encode_rgb_jpeg(const TopicInfo& topic, const CameraFrame& frame, MessageBytes* out) {
  sensor_msgs::CompressedImage image;
  image.header = ros_header(frame.time, topic.frame_id);
  image.format = "jpeg";
  GLOAM_TRY(const std::vector<uint8_t> jpeg,
            encode_jpeg(frame.intrinsics.width, frame.intrinsics.height, frame.rgb, kJpegQuality));
  image.data = view_of(jpeg);
  encode(image, out);
  return {};
}

// `baseline`: of the right eye of a stereo pair, its distance from the left one [m]; else 0.
// Pictures of a pair are rectified as they are: the eyes are alike, parallel and without
// distortion.
FrameEncoder info_encoder(double baseline) {
  return [baseline](const TopicInfo& topic, const CameraFrame& frame, MessageBytes* out) {
    const CameraInfo from = camera_info(frame.camera, frame.intrinsics);
    sensor_msgs::CameraInfo info;
    info.header = ros_header(frame.time, topic.frame_id);
    info.width = static_cast<uint32_t>(from.width);
    info.height = static_cast<uint32_t>(from.height);
    info.distortion_model = from.distortion_model;
    info.d = from.d;
    info.k = from.k;
    info.r = from.r;
    info.p = from.p;
    if (baseline > 0) info.p[3] = -info.p[0] * baseline;
    encode(info, out);
    return Status();
  };
}

const CameraOptions* find_camera(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.cameras, name, &CameraOptions::name);
  return found != scene.cameras.end() ? &*found : nullptr;
}

/// Distance of a right eye from its left one [m]; 0 of all other cameras.
double stereo_baseline(const CompiledWorld& world, const std::string& camera) {
  for (const StereoOptions& rig : world.written.stereo) {
    if (camera != rig.name + "/right") continue;
    const CameraOptions* left = find_camera(world.scene, rig.name + "/left");
    const CameraOptions* right = find_camera(world.scene, camera);
    if (left == nullptr || right == nullptr) return 0;
    const Vec3 &a = left->position, &b = right->position;
    return std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
  }
  return 0;
}

// REP 118: metres as 32FC1 with +inf where nothing is hit.
Status encode_depth(const TopicInfo& topic, const std::vector<float>& depth,
                    const CameraFrame& frame, MessageBytes* out) {
  sensor_msgs::Image image = image_of(topic, frame, "32FC1", 4);
  image.data = view_of(depth);
  encode(image, out);
  return {};
}

Status encode_depth_mm(const TopicInfo& topic, const std::vector<float>& depth,
                       const CameraFrame& frame, MessageBytes* out) {
  std::vector<uint16_t> mm(depth.size());
  std::transform(depth.begin(), depth.end(), mm.begin(), [](float z) {
    const double whole = std::round(1000.0 * static_cast<double>(z));
    return whole >= 1 && whole <= 65535 ? static_cast<uint16_t>(whole) : uint16_t{0};
  });
  sensor_msgs::Image image = image_of(topic, frame, "16UC1", 2);
  image.data = view_of(mm);
  encode(image, out);
  return {};
}

Status encode_ids(const TopicInfo& topic, const std::vector<uint32_t>& ids,
                  const CameraFrame& frame, MessageBytes* out) {
  std::vector<uint16_t> small(ids.size());
  std::transform(ids.begin(), ids.end(), small.begin(),
                 [](uint32_t id) { return static_cast<uint16_t>(std::min(id, 65535u)); });
  sensor_msgs::Image image = image_of(topic, frame, "mono16", 2);
  image.data = view_of(small);
  encode(image, out);
  return {};
}

// Hundredths of a kelvin, as thermal cameras' drivers have it.
Status encode_thermal(const TopicInfo& topic, const CameraFrame& frame, MessageBytes* out) {
  std::vector<uint16_t> hundredths(frame.thermal.size());
  std::transform(frame.thermal.begin(), frame.thermal.end(), hundredths.begin(), [](float kelvin) {
    return static_cast<uint16_t>(std::clamp(std::round(100.0f * kelvin), 0.0f, 65535.0f));
  });
  sensor_msgs::Image image = image_of(topic, frame, "mono16", 2);
  image.data = view_of(hundredths);
  encode(image, out);
  return {};
}

// Encoding "mono" of event_camera_msgs: eight bytes an event, little endian: 32 bits of nanoseconds
// since time_base, 16 of x, 15 of y, the last bit the polarity.
Status encode_events(const TopicInfo& topic, const CameraFrame& frame, MessageBytes* out) {
  event_camera_msgs::EventPacket packet;
  packet.header = ros_header(frame.time, topic.frame_id);
  packet.width = static_cast<uint32_t>(frame.intrinsics.width);
  packet.height = static_cast<uint32_t>(frame.intrinsics.height);
  packet.seq = static_cast<uint64_t>(frame.index);
  packet.encoding = "mono";
  const double base = frame.events.empty() ? frame.time : frame.events.front().time;
  packet.time_base = static_cast<uint64_t>(std::llround(base * 1e9));
  std::vector<uint64_t> events;
  events.reserve(frame.events.size());
  for (const Event& event : frame.events) {
    const auto since = static_cast<uint64_t>(std::llround(event.time * 1e9)) - packet.time_base;
    events.push_back((since & 0xffffffffu) | uint64_t{event.x} << 32 | uint64_t{event.y} << 48 |
                     uint64_t{event.brighter} << 63);
  }
  packet.events = view_of(events);
  encode(packet, out);
  return {};
}

/// A kind of messages that cameras can send.
struct CameraTopicKind {
  const char* suffix;   ///< of the topic's name
  const char* channel;  ///< of CameraRequest::outputs that it needs
  std::string (*type)();
  bool is_logged;
  bool is_large;  ///< as in TopicInfo
  TopicCode code;
  TopicQos qos = kSensorQos;
};

const std::vector<CameraTopicKind>& camera_topic_kinds() {
  using Frame = const CameraFrame&;
  using Info = const TopicInfo&;
  const auto image = type_name<sensor_msgs::Image>;
  static const std::vector<CameraTopicKind> kinds = {
      {"image_raw", "rgb", image, false, true, encode_rgb},
      {"image_raw/compressed", "rgb", type_name<sensor_msgs::CompressedImage>, true, false,
       encode_rgb_jpeg},
      // A picture that is lost on the way spoils those after it: reliable.
      {"image_raw/h264", "rgb", type_name<foxglove_msgs::CompressedVideo>, false, false,
       FrameEncoderMaker(h264_encoder), TopicQos{}},
      {"camera_info", "rgb", type_name<sensor_msgs::CameraInfo>, true, false, info_encoder(0)},
      {"depth/image_rect_raw", "depth", image, false, true,
       [](Info t, Frame f, MessageBytes* out) { return encode_depth(t, f.depth, f, out); }},
      {"depth/image_rect_mm", "depth", image, false, true,
       [](Info t, Frame f, MessageBytes* out) { return encode_depth_mm(t, f.depth, f, out); }},
      {"depth/camera_info", "depth", type_name<sensor_msgs::CameraInfo>, false, false,
       info_encoder(0)},
      {"sensor_depth/image_rect_raw", "sensor_depth", image, false, true,
       [](Info t, Frame f, MessageBytes* out) { return encode_depth(t, f.sensor_depth, f, out); }},
      {"sensor_depth/image_rect_mm", "sensor_depth", image, true, true,
       [](Info t, Frame f, MessageBytes* out) {
         return encode_depth_mm(t, f.sensor_depth, f, out);
       }},
      {"segmentation/instance", "segmentation", image, false, true,
       [](Info t, Frame f, MessageBytes* out) { return encode_ids(t, f.instance, f, out); }},
      {"segmentation/semantic", "segmentation", image, false, true,
       [](Info t, Frame f, MessageBytes* out) { return encode_ids(t, f.semantic, f, out); }},
      {"thermal/image_raw", "thermal", image, true, true, encode_thermal},
      {"events", "events", type_name<event_camera_msgs::EventPacket>, true, true, encode_events},
  };
  return kinds;
}

}  // namespace

void add_camera_topics(const TopicWorld& world, TopicTable* table) {
  for (const StreamInfo& stream : list_streams(*world)) {
    if (stream.kind != StreamKind::kCamera) continue;
    const double baseline = stereo_baseline(*world, stream.name);
    for (const CameraTopicKind& kind : camera_topic_kinds()) {
      if (std::ranges::find(stream.outputs, kind.channel) == stream.outputs.end()) continue;
      Topic& topic = table->emplace_back();
      topic.info = {.name = "/" + topic_token(stream.name) + "/" + kind.suffix,
                    .type = kind.type(),
                    .frame_id = stream.frame_id,
                    .rate = stream.rate,
                    .qos = kind.qos,
                    .is_logged = kind.is_logged,
                    .source = {TopicSource::Kind::kCamera, stream.name},
                    .is_large = kind.is_large};
      topic.streams = {stream.name};
      topic.channel = kind.channel;
      topic.code = kind.code;
      if (topic.info.type == type_name<sensor_msgs::CameraInfo>() && baseline > 0)
        topic.code = info_encoder(baseline);
    }
  }
}

}  // namespace gloam
