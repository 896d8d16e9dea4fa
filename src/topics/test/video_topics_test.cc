// Videos as topics: what others' decoder makes of them is what the camera saw.

#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "base/files.h"
#include "ros/messages/foxglove_msgs.h"
#include "ros/messages/sensor_msgs.h"
#include "scene/test/temp_folder.h"
#include "topics/ros_values.h"
#include "topics/test/topic_inbox.h"
#include "topics/topic_table.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;
using foxglove_msgs::CompressedVideo;

constexpr const char* kFallingBox = R"(<mujoco><option timestep="0.002"/>
<worldbody><geom type="plane" size="5 5 .1" rgba=".5 .6 .4 1"/><light pos="0 0 3"/>
<body name="box" pos="0 0 2"><freejoint/><geom type="box" size=".3 .2 .2" rgba=".8 .2 .1 1"/></body>
</worldbody></mujoco>)";

constexpr const char* kVideoScene = R"(
[[robot]]
name = "box"
file = "box.xml"
[[camera]]
name = "wall"
position = [-2.5, 0, 1]
look_at = [0, 0, 0.6]
rate = 10
width = 160
height = 120
[render]
tier = "direct"
spp = 4
)";

class VideoTopics : public testing::Test {
 protected:
  VideoTopics() { folder_.write("box.xml", kFallingBox); }
  World world_of(std::string scene) { return *World::compile(*parse_scene(scene, folder_.path())); }
  static std::string output_of(const std::string& command) {
    std::string out;
    FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
    if (pipe == nullptr) return out;
    char buffer[65536];
    for (size_t n; (n = fread(buffer, 1, sizeof(buffer), pipe)) > 0;) out.append(buffer, n);
    pclose(pipe);
    return out;
  }
  /// Pictures (width x height x 3) that ffmpeg reads in the messages from `first` on.
  std::vector<std::string> decoded(const std::vector<CompressedVideo>& messages, size_t first,
                                   size_t picture_bytes) {
    std::vector<uint8_t> stream;
    for (size_t i = first; i < messages.size(); ++i) {
      const auto bytes = messages[i].data.span();
      stream.insert(stream.end(), bytes.begin(), bytes.end());
    }
    const fs::path path = folder_.path() / "stream.h264";
    EXPECT_TRUE(write_file_atomic(path, stream).ok());
    const std::string all =
        output_of("ffmpeg -v error -xerror -f h264 -i " + path.string() +
                  " -sws_flags accurate_rnd+full_chroma_int -fps_mode passthrough -f rawvideo "
                  "-pix_fmt rgb24 -");
    EXPECT_EQ(all.size() % picture_bytes, 0u);
    std::vector<std::string> pictures;
    for (size_t at = 0; at + picture_bytes <= all.size(); at += picture_bytes)
      pictures.push_back(all.substr(at, picture_bytes));
    return pictures;
  }
  static double psnr(std::span<const uint8_t> a, const std::string& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      const double d = a[i] - static_cast<double>(static_cast<uint8_t>(b[i]));
      sum += d * d;
    }
    return 10 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / std::max(sum, 1e-9));
  }
  static bool has_ffmpeg() { return !output_of("ffmpeg -version").empty(); }

  TempFolder folder_;
};

/// Types of the NAL units of an Annex B stream.
std::vector<int> nal_types(std::span<const uint8_t> bytes) {
  std::vector<int> types;
  for (size_t i = 0; i + 4 < bytes.size(); ++i)
    if (bytes[i] == 0 && bytes[i + 1] == 0 && bytes[i + 2] == 0 && bytes[i + 3] == 1)
      types.push_back(bytes[i + 4] & 0x1f);
  return types;
}

constexpr int kSlice = 1, kKeySlice = 5, kSps = 7, kPps = 8;

TEST_F(VideoTopics, OthersDecodeWhatTheCameraSaw) {
  TopicInbox inbox;
  record_topics(world_of(kVideoScene), {"/wall/image_raw", "/wall/image_raw/h264"}, 1250, &inbox);
  const auto raw = inbox.all<sensor_msgs::Image>("/wall/image_raw");
  const auto video = inbox.all<CompressedVideo>("/wall/image_raw/h264");
  ASSERT_EQ(raw.size(), 26u);
  ASSERT_EQ(video.size(), raw.size());
  for (size_t i = 0; i < video.size(); ++i) {
    EXPECT_EQ(video[i].format, "h264");
    EXPECT_EQ(video[i].timestamp, raw[i].header.stamp);
    EXPECT_EQ(video[i].frame_id, raw[i].header.frame_id);
    // One access unit each; a key picture at every second, with its parameter sets.
    const std::vector<int> expected =
        i % 10 == 0 ? std::vector{kSps, kPps, kKeySlice} : std::vector{kSlice};
    EXPECT_EQ(nal_types(video[i].data.span()), expected) << i;
  }
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  const auto pictures = decoded(video, 0, raw[0].data.size());
  ASSERT_EQ(pictures.size(), raw.size());
  for (size_t i = 0; i < raw.size(); ++i) EXPECT_GT(psnr(raw[i].data.span(), pictures[i]), 33) << i;
  // The box has fallen: an exchange of pictures would show.
  EXPECT_LT(psnr(raw[0].data.span(), pictures[25]), 25);
  // A reader that comes late begins with a key picture.
  const auto late = decoded(video, 20, raw[0].data.size());
  ASSERT_EQ(late.size(), 6u);
  EXPECT_EQ(late.back(), pictures.back());
}

TEST_F(VideoTopics, EqualRunsHaveEqualBytesAndEverySubscriptionBeginsAnew) {
  const World world = world_of(kVideoScene);
  const std::string name = "/wall/image_raw/h264";
  TopicInbox one, two, late;
  record_topics(world, {name}, 300, &one);
  record_topics(world, {name, "/wall/image_raw"}, 300, &two);
  EXPECT_EQ(one.messages[name], two.messages[name]);
  auto simulation = *Simulation::create(world, {.pace = Pace::kLockstep});
  TopicInbox first;
  auto stream = *simulation->open_topics({.topics = {name}, .required = true}, first.callback());
  ASSERT_TRUE(simulation->step(175).ok());
  auto second = *simulation->open_topics({.topics = {name}, .required = true}, late.callback());
  ASSERT_TRUE(simulation->step(126).ok());
  second.reset();
  stream.reset();
  EXPECT_EQ(first.messages[name], one.messages[name]);
  const auto video = late.all<CompressedVideo>(name);
  ASSERT_EQ(video.size(), 3u);  // 0.4, 0.5 and 0.6 s
  EXPECT_EQ(nal_types(video[0].data.span()).front(), kSps);
  EXPECT_EQ(nal_types(video[1].data.span()), std::vector<int>{kSlice});
}

TEST_F(VideoTopics, ResetsBeginWithAKeyPicture) {
  auto simulation = *Simulation::create(world_of(kVideoScene), {.pace = Pace::kLockstep});
  TopicInbox inbox;
  auto stream = *simulation->open_topics({.topics = {"/wall/image_raw/h264"}, .required = true},
                                         inbox.callback());
  ASSERT_TRUE(simulation->step(151).ok());
  ASSERT_TRUE(simulation->post({.what = ResetSim{}}).ok());
  ASSERT_TRUE(simulation->step(60).ok());
  stream.reset();
  const auto video = inbox.all<CompressedVideo>("/wall/image_raw/h264");
  ASSERT_EQ(video.size(), 6u);
  for (size_t i = 0; i < video.size(); ++i)
    EXPECT_EQ(nal_types(video[i].data.span()).size(), i % 4 == 0 ? 3u : 1u) << i;
}

TEST_F(VideoTopics, AreReliableAndInNoLogThatDoesNotAskForThem) {
  const World world = world_of(kVideoScene);
  const auto topics = *list_topics(world);
  const auto found = std::ranges::find(topics, "/wall/image_raw/h264", &TopicInfo::name);
  ASSERT_NE(found, topics.end());
  EXPECT_EQ(found->type, "foxglove_msgs/msg/CompressedVideo");
  EXPECT_FALSE(found->is_logged);
  EXPECT_TRUE(found->qos.is_reliable);
}

// Sizes that H.264 cannot hold are said once, and other topics go on.
TEST_F(VideoTopics, TinyPicturesAreRefused) {
  std::string scene = kVideoScene;
  scene.replace(scene.find("width = 160"), 11, "width = 12");
  auto simulation = *Simulation::create(world_of(scene), {.pace = Pace::kLockstep});
  TopicInbox inbox;
  auto stream = *simulation->open_topics({.topics = {"/wall/image_raw*"}, .required = true},
                                         inbox.callback());
  ASSERT_TRUE(simulation->step(101).ok());
  for (int i = 0; i < 1000 && stream->status().ok(); ++i)  // pictures come on their own thread
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const Status status = stream->status();
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().to_string(), testing::HasSubstr("16"));
  stream.reset();
  EXPECT_GE(inbox.messages["/wall/image_raw"].size(), 2u);
  EXPECT_TRUE(inbox.messages["/wall/image_raw/h264"].empty());
}

// An odd size is extended by a repeated line.
TEST_F(VideoTopics, OddSizesAreExtended) {
  std::string scene = kVideoScene;
  scene.replace(scene.find("width = 160"), 11, "width = 161");
  TopicInbox inbox;
  record_topics(world_of(scene), {"/wall/image_raw/h264"}, 100, &inbox);
  if (!has_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
  const auto video = inbox.all<CompressedVideo>("/wall/image_raw/h264");
  EXPECT_EQ(decoded(video, 0, 162 * 120 * 3).size(), 3u);
}

}  // namespace
}  // namespace gloam
