// One list of names of outputs: channels, and files made of them.

#include <gmock/gmock.h>

#include "gloam/output_names.h"
#include "sensors/camera/camera_channels.h"

namespace gloam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(OutputNames, AChannelStandsForItsFilesInARecording) {
  EXPECT_THAT(recorded_outputs({"rgb", "depth", "depth_exr", "video", "lidar"}),
              ElementsAre("png", "depth_png", "depth_exr", "video", "lidar"));
  EXPECT_THAT(recorded_outputs({"segmentation", "events", "nothing"}),
              ElementsAre("segmentation", "events", "nothing"));
  // Every channel is recorded, and only by names that a recorder knows.
  for (const CameraChannel& channel : kCameraChannels) {
    const auto outputs = recorded_outputs({std::string(channel.name)});
    EXPECT_FALSE(outputs.empty()) << channel.name;
    for (const std::string& output : outputs)
      EXPECT_NE(std::ranges::find(kRecordOutputs, output), kRecordOutputs.end()) << output;
  }
}

TEST(OutputNames, AFileStandsForItsChannelInACamera) {
  const auto channels = CameraChannels::parse({"png", "depth_png", "normal_exr", "thermal"});
  ASSERT_TRUE(channels.ok()) << channels.error().to_string();
  for (const char* channel : {"rgb", "depth", "normal", "thermal"})
    EXPECT_NE(find_output_channel(channel), nullptr);
  EXPECT_TRUE(channels->has("rgb"));
  EXPECT_TRUE(channels->has("depth"));
  EXPECT_TRUE(channels->has("normal"));
  EXPECT_FALSE(channels->has("albedo"));
  EXPECT_EQ(find_output_channel("lidar"), nullptr);
}

TEST(OutputNames, AnErrorNamesTheNearestOfAll) {
  const auto wrong = CameraChannels::parse({"depth_pgn"});
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().to_string(), HasSubstr("depth_png"));
}

}  // namespace
}  // namespace gloam
