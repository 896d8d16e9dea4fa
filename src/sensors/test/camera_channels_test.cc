// The table of outputs, and subsets of its channels.

#include "sensors/camera/camera_channels.h"

#include <gtest/gtest.h>

#include <set>

namespace gloam {
namespace {

TEST(CameraChannels, EveryFileIsOfAChannelAndHasAPlaceOfItsOwn) {
  std::set<std::string_view> channels, folders, suffixes;
  for (const CameraFile& file : kCameraFiles) {
    SCOPED_TRACE(file.output);
    EXPECT_NE(find_camera_channel(file.channel), nullptr);
    channels.insert(file.channel);
    if (!file.is_of_each_frame()) continue;
    EXPECT_TRUE(folders.insert(file.folder).second);
    EXPECT_TRUE(suffixes.insert(file.suffix).second);
    EXPECT_EQ(file.format == FileFormat::kExr, !file.exr_names.empty());
    EXPECT_EQ(file.extension(), file.format == FileFormat::kExr    ? "exr"
                                : file.format == FileFormat::kJson ? "json"
                                                                   : "png");
  }
  for (const CameraChannel& channel : kCameraChannels)
    EXPECT_TRUE(channels.contains(channel.name)) << channel.name << " is never written";
  EXPECT_EQ(std::set(kRecordOutputs.begin(), kRecordOutputs.end()).size(), kRecordOutputs.size());
}

TEST(CameraChannels, AnUnknownNameIsRefusedWithTheNearest) {
  const auto channels = CameraChannels::parse({"rgb", "scene_flw"});
  ASSERT_FALSE(channels.ok());
  EXPECT_NE(channels.error().to_string().find("scene_flow"), std::string::npos);
  EXPECT_EQ(find_camera_channel("depth_png"), nullptr) << "an output is no channel";
}

TEST(CameraChannels, AreWhatTheRequestNames) {
  const CameraChannels channels = *CameraChannels::parse({"depth", "segmentation", "depth"});
  EXPECT_TRUE(channels.has("depth"));
  EXPECT_FALSE(channels.has("rgb"));
  EXPECT_FALSE(channels.light());
  EXPECT_TRUE(channels.needs(ChannelSource::kSurface));
  EXPECT_FALSE(channels.needs(ChannelSource::kDetails));
  EXPECT_EQ(channels.pixel_bytes(), 16u);
}

TEST(CameraChannels, OfModelsNeedTheirTable) {
  const CameraChannels channels = *CameraChannels::parse({"rgb", "thermal"});
  CameraSensing sensing;
  ASSERT_NE(channels.without_model(sensing), nullptr);
  EXPECT_EQ(channels.without_model(sensing)->name, "thermal");
  EXPECT_EQ(channels.without_model(sensing)->model, "thermal");
  sensing.thermal.emplace();
  EXPECT_EQ(channels.without_model(sensing), nullptr);
}

}  // namespace
}  // namespace gloam
