// Stills and the files of one frame.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/files.h"
#include "geometry/image/image_exr.h"
#include "geometry/image/image_file.h"
#include "gloam/run.h"
#include "scenes.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kChannels = {"rgb",    "radiance", "depth", "segmentation",
                                            "normal", "albedo",   "motion"};

CameraRequest small(const std::string& camera) {
  CameraRequest request{.camera = camera, .width = 32, .height = 24, .outputs = kChannels};
  request.render = {.tier = RenderTier::kPath, .spp = 2, .denoise = false};
  return request;
}

TEST(Stills, ArePicturesOfTheInstantAskedFor) {
  const TempFolder folder;
  const World world = flight(folder);
  for (const double time : {0.0, 0.5, 1.0}) {
    const auto frames = render_stills(world, time, {small("a/rider"), small("a/fixed")}, {});
    ASSERT_TRUE(frames.ok()) << frames.error().to_string();
    ASSERT_EQ(frames->size(), 2u);
    EXPECT_NEAR((*frames)[0].time, time, 1e-9);
    EXPECT_NEAR((*frames)[0].X_WC.p.x, time, 1e-5);
    EXPECT_NEAR((*frames)[1].X_WC.p.x, 0, 1e-6);
  }
}

TEST(Stills, MotionCountsFromThePictureBefore) {
  const TempFolder folder;
  const World world = flight(folder);
  CameraRequest request = small("a/fixed");
  request.outputs = {"motion", "scene_flow", "segmentation"};
  request.rate = {10, 1};
  for (const double time : {0.0, 0.04, 0.2}) {
    const auto frames = render_stills(world, time, {request}, {});
    ASSERT_TRUE(frames.ok()) << frames.error().to_string();
    const CameraFrame& frame = frames->front();
    float farthest = 0, most_pixels = 0;
    for (size_t i = 0; i < frame.part.size(); ++i) {
      farthest = std::max(farthest, frame.scene_flow[3 * i]);
      most_pixels = std::max(most_pixels, frame.motion[2 * i]);
    }
    EXPECT_NEAR(farthest, std::min(time, 0.1), 1e-5) << "the ball flies at 1 m/s";
    EXPECT_EQ(most_pixels > 0.1f, time > 0);
  }
}

TEST(Stills, OfTwoTimesHaveNoiseOfTheirOwn) {
  const TempFolder folder;
  folder.write("ball.xml", R"(<mujoco><worldbody><light pos="0 -1 3"/>
    <geom type="plane" size="3 3 0.1"/><geom type="sphere" pos="1 0 0.5" size="0.5"/></worldbody></mujoco>)");
  const World world = compile_text(folder, "ball.toml", R"(
[environment]
file = "ball.xml"
[[camera]]
name = "still"
position = [0, 0, 1.5]
look_at = [1, 0, 0.5]
[camera.imager]
mosaic = "none"
[camera.imager.exposure]
f_number = 4
shutter = 0.01
iso = 1600
[camera.imager.pixel]
shot_noise = true
read_noise = 3
)");
  const auto pictures = [&](double time, bool denoise, const std::string& output) {
    CameraRequest request = small("still");
    request.outputs = {output};
    request.render.denoise = denoise;
    const auto frames = render_stills(world, time, {request}, {});
    EXPECT_TRUE(frames.ok()) << frames.error().to_string();
    return frames.ok() ? frames->front() : CameraFrame{};
  };
  for (const bool denoise : {false, true}) {
    const CameraFrame first = pictures(0, denoise, "radiance");
    EXPECT_EQ(first.radiance, pictures(0, denoise, "radiance").radiance);
    EXPECT_NE(first.radiance, pictures(0.1, denoise, "radiance").radiance) << denoise;
    EXPECT_NE(pictures(0.102, denoise, "radiance").radiance,
              pictures(0.1, denoise, "radiance").radiance);
    EXPECT_EQ(first.index, 0);
  }
  EXPECT_NE(pictures(0, true, "rgb").rgb, pictures(0.1, true, "rgb").rgb) << "the imager's";
}

TEST(Stills, SayWhatIsWrong) {
  const TempFolder folder;
  const World world = flight(folder);
  for (const double time : {-1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    const auto frames = render_stills(world, time, {small("a/rider")}, {});
    ASSERT_FALSE(frames.ok()) << time;
    EXPECT_EQ(frames.error().kind, ErrorKind::kUsage) << time;
  }
  const auto unknown = render_stills(world, 0, {small("a/ridr")}, {});
  ASSERT_FALSE(unknown.ok());
  EXPECT_NE(unknown.error().to_string().find("a/rider"), std::string::npos);
  const auto stopped =
      render_stills(world, 0, {small("a/rider")}, [](const Progress&) { return false; });
  ASSERT_FALSE(stopped.ok());
  EXPECT_EQ(stopped.error().kind, ErrorKind::kInterrupted);
}

TEST(Stills, EveryChannelIsWrittenAndReadsBack) {
  const TempFolder folder;
  const auto frames = render_stills(flight(folder), 0, {small("a/fixed")}, {});
  ASSERT_TRUE(frames.ok()) << frames.error().to_string();
  const CameraFrame& frame = frames->front();
  const fs::path out = folder.path() / "new" / "pictures";
  const auto written = write_frame(frame, out, "fixed");
  ASSERT_TRUE(written.ok()) << written.error().to_string();
  EXPECT_EQ(written->size(), 10u);
  EXPECT_EQ(read_image(out / "fixed.png")->texels, frame.rgb);
  const auto png16 = [&](const std::string& name) {
    return decode_png16(read_file(out / name).value(), name).value().texels;
  };
  EXPECT_THAT(png16("fixed_instance.png"), testing::ElementsAreArray(frame.instance));
  EXPECT_THAT(png16("fixed_semantic.png"), testing::ElementsAreArray(frame.semantic));
  EXPECT_THAT(png16("fixed_part.png"), testing::ElementsAreArray(frame.part));
  const auto millimetres = png16("fixed_depth.png");
  for (size_t i = 0; i < millimetres.size(); ++i) {
    const float d = frame.depth[i];
    EXPECT_EQ(millimetres[i], std::isinf(d) ? 0 : std::lround(d * 1000));
  }
  const auto exr = [&](const std::string& name) {
    return decode_exr(read_file(out / name).value(), name).value();
  };
  EXPECT_EQ(*exr("fixed_depth.exr").find("Z"), frame.depth);
  for (size_t i = 0; i < frame.depth.size(); ++i) {
    EXPECT_EQ((*exr("fixed.exr").find("G"))[i], frame.radiance[3 * i + 1]);
    EXPECT_EQ((*exr("fixed_normal.exr").find("Y"))[i], frame.normal[3 * i + 1]);
    if (i > 40) break;
  }
}

TEST(Stills, PartsAndObjectsBeyond16BitsAreToldApart) {
  const TempFolder folder;
  folder.write("tiles.xml", R"(
<mujoco model="tiles">
  <worldbody>
    <camera name="fixed" pos="127.5 128 150" xyaxes="1 0 0 0 1 0" fovy="85"/>
    <replicate count="256" offset="1 0 0">
      <replicate count="257" offset="0 1 0">
        <geom type="box" size="0.5 0.5 0.1" contype="0" conaffinity="0"/>
      </replicate>
    </replicate>
  </worldbody>
</mujoco>)");
  const World world = compile_file(folder.path() / "tiles.xml");
  CameraRequest request = small("fixed");
  request.width = request.height = 256;
  request.outputs = {"segmentation"};
  const auto frames = render_stills(world, 0, {request}, {});
  ASSERT_TRUE(frames.ok()) << frames.error().to_string();
  const CameraFrame& frame = frames->front();
  const auto written = write_frame(frame, folder.path(), "fixed");
  ASSERT_TRUE(written.ok()) << written.error().to_string();
  const auto ids = [&](const char* name) {
    const auto picture = read_image(folder.path() / name);
    EXPECT_TRUE(picture.ok() && picture->channels == 3) << name;
    std::vector<uint32_t> values;
    for (size_t i = 0; i < frame.part.size(); ++i) {
      const uint8_t* p = &picture->texels[3 * i];
      values.push_back(p[0] + 256u * p[1] + 65536u * p[2]);
    }
    return values;
  };
  EXPECT_EQ(ids("fixed_part.png"), frame.part);
  EXPECT_GT(*std::max_element(frame.part.begin(), frame.part.end()), 65535u);
  EXPECT_EQ(ids("fixed_instance.png"), frame.instance);
  EXPECT_EQ(frame.instance, frame.part) << "each tile is an object of one part";
  EXPECT_EQ(ids("fixed_semantic.png"), frame.semantic);
}

TEST(Stills, AFolderThatCannotBeMadeIsNamed) {
  const TempFolder folder;
  const auto frames = render_stills(flight(folder), 0, {small("a/fixed")}, {});
  ASSERT_TRUE(frames.ok());
  folder.write("file", "in the way");
  const auto written = write_frame(frames->front(), folder.path() / "file" / "out", "fixed");
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().kind, ErrorKind::kIo);
  EXPECT_NE(written.error().to_string().find("file"), std::string::npos);
}

}  // namespace
}  // namespace gloam
