// Cameras with models, from scene file to frame: what is off changes nothing, what is on is there.

#include <gtest/gtest.h>

#include "base/srgb.h"
#include "render/film/tone_map.h"
#include "render/test/scene_builder.h"
#include "scene/test/temp_folder.h"
#include "sensors/camera/camera_sensor.h"
#include "sensors/depth/stereo_depth.h"
#include "sensors/test/statistics.h"
#include "sim/loop/simulator.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {
namespace {

// Three tiles 2 m before the cameras: matt, black and chrome.
const char* const kTiles = R"(
<mujoco>
  <asset>
    <material name="matt" rgba="0.8 0.8 0.8 1" roughness="1"/>
    <material name="black" rgba="0.02 0.02 0.02 1" roughness="1"/>
    <material name="chrome" rgba="0.9 0.9 0.9 1" metallic="1" roughness="0.02"/>
  </asset>
  <worldbody>
    <light pos="0 -1 3" dir="0 0.5 -1"/>
    <geom name="matt" type="box" size="0.5 0.1 2" pos="-1 2.1 0" material="matt"/>
    <geom name="black" type="box" size="0.5 0.1 2" pos="0 2.1 0" material="black"/>
    <geom name="chrome" type="box" size="0.5 0.1 2" pos="1 2.1 0" material="chrome"/>
  </worldbody>
</mujoco>)";

class CameraModelsTest : public ::testing::Test {
 protected:
  void load(const std::string& toml) {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    folder_.write("tiles.xml", kTiles);
    const auto scene = load_scene(folder_.write(
        "scene.toml",
        "[environment]\nfile = \"tiles.xml\"\n[render]\nspp = 2\ndenoise = false\n" + toml));
    ASSERT_TRUE(scene.ok()) << scene.error().to_string();
    auto world = World::compile(*scene);
    ASSERT_TRUE(world.ok()) << world.error().to_string();
    world_ = std::move(*world);
    auto description = describe_for_rendering(*world_.compiled());
    ASSERT_TRUE(description.ok()) << description.error().to_string();
    description_ = std::move(*description);
    renderer_ = std::move(make_cpu_renderer(description_)).value();
    auto solver = std::move(PoseSolver::create(world_.compiled())).value();
    auto simulator =
        std::move(Simulator::create(world_.compiled(), {.pace = Pace::kLockstep})).value();
    ASSERT_TRUE(solver->solve(simulator->latest(), poses_).ok());
  }

  Result<std::unique_ptr<CameraSensor>> make(const std::string& camera,
                                             std::vector<std::string> outputs) {
    CameraRequest request{.camera = camera};
    request.outputs = std::move(outputs);
    request.render = world_.compiled()->scene.render;
    return CameraSensor::create(description_, request, 1);
  }
  std::shared_ptr<const CameraFrame> capture(const std::string& camera,
                                             std::vector<std::string> outputs, int64_t index = 0) {
    auto sensor = make(camera, std::move(outputs));
    if (!sensor.ok()) {
      ADD_FAILURE() << sensor.error().to_string();
      abort();
    }
    return (*sensor)->capture(*renderer_, turns_, poses_, poses_, index);
  }

  TempFolder folder_;
  World world_;
  RenderDescription description_;
  std::unique_ptr<Renderer> renderer_;
  PoseFrame poses_;
  RenderTurns turns_;
};

std::string camera(const std::string& name, const std::string& more = "") {
  return "[[camera]]\nname = \"" + name +
         "\"\nlook_at = [0, 2, 0]\nfovy = 70\nwidth = 120\nheight = 90\n" + more;
}

// Matt patches under an even sky whose light is at the top of the scale: a patch of reflectance x
// sends back x of it.
TEST(DefaultCamera, ShowsAChartOfGreysAsSrgbDoes) {
  constexpr float kEv100 = 8;
  constexpr int kSide = 16;
  for (const float grey : {0.02f, 0.03f, 0.09f, 0.18f, 0.36f, 0.5f, 0.59f, 0.75f, 0.9f}) {
    SceneBuilder b;
    const float top = max_luminance(kEv100);
    b.description.sky.environment = {"even", 4, 2, std::vector<Vec3f>(4 * 2, {top, top, top})};
    b.description.ev100 = kEv100;
    b.add(ShapeType::kBox, {2, 2, 0.1f}, {}, b.add_diffuse({grey, grey, grey}));
    const Affine3f X_WC = look_at({0, 0, 3}, {0, 0, 0});
    CameraDescription eye;
    eye.name = "eye";
    eye.intrinsics = SceneBuilder::camera(X_WC, kSide, kSide, 40).intrinsics;
    eye.X_WC = X_WC;
    b.description.cameras.push_back(eye);
    CameraRequest request{.camera = "eye", .width = kSide, .height = kSide};
    request.outputs = {"rgb"};
    request.render.spp = 64;
    auto sensor = CameraSensor::create(b.description, request, 1);
    ASSERT_TRUE(sensor.ok()) << sensor.error().to_string();
    const auto renderer = b.make();
    RenderTurns turns;
    const auto frame = (*sensor)->capture(*renderer, turns, b.frame, b.frame, 0);
    for (size_t c = 0; c < 3; ++c) {
      double mean = 0;
      for (size_t i = c; i < frame->rgb.size(); i += 3) mean += frame->rgb[i];
      EXPECT_NEAR(mean / (kSide * kSide), 255 * static_cast<double>(srgb_encode(grey)), 2) << grey;
    }
  }
}

TEST_F(CameraModelsTest, WithoutAnImagerThePictureIsTheLightsOwnBitByBit) {
  load(camera("plain") + camera("timed", "timing = { latency = 0.1, drop = 0.5 }\n") +
       camera("truth", "imager = { pixel = { shot_noise = true, bits = 8 } }\n"));
  const auto frame = capture("plain", {"rgb", "radiance", "depth"});
  std::vector<Vec3f> light(frame->radiance.size() / 3);
  std::copy(frame->radiance.begin(), frame->radiance.end(), &light[0].x);
  std::vector<uint8_t> rgb;
  tone_map(light, 120, 90, {.ev100 = description_.ev100}, &rgb);
  EXPECT_EQ(frame->rgb, rgb);
  EXPECT_EQ(frame->ev100, static_cast<double>(description_.ev100));
  EXPECT_TRUE(frame->raw.empty() && frame->sensor_depth.empty() && frame->events.empty() &&
              frame->thermal.empty());
  EXPECT_EQ(frame->delivery, frame->time);
  EXPECT_NEAR(capture("timed", {"rgb"})->delivery, frame->time + 0.1, 1e-12);
  // A noisy imager leaves the truth alone.
  const auto noisy = capture("truth", {"rgb", "radiance", "depth", "raw"});
  EXPECT_EQ(noisy->depth, frame->depth);
  EXPECT_EQ(noisy->raw.size(), size_t{3 * 120 * 90});
  EXPECT_NE(noisy->rgb, frame->rgb);
}

TEST_F(CameraModelsTest, TheImagersExposureCounts) {
  load(camera("a", "imager = { exposure = { f_number = 4, shutter = 0.01, iso = 100 } }\n") +
       camera("b", "imager = { exposure = { f_number = 4, shutter = 0.02, iso = 100 } }\n"));
  const auto a = capture("a", {"rgb"}), b = capture("b", {"rgb"});
  EXPECT_NEAR(a->ev100 - b->ev100, 1, 1e-9);
  double bright_a = 0, bright_b = 0;
  for (size_t i = 0; i < a->rgb.size(); ++i) {
    bright_a += a->rgb[i];
    bright_b += b->rgb[i];
  }
  EXPECT_GT(bright_b, 1.1 * bright_a);
}

TEST_F(CameraModelsTest, DarkAndShinyThingsSendTheProjectorsLightAway) {
  load(camera("depth", "stereo_depth = { baseline = 0.05, half_signal = 0.02 }\n"));
  const auto frame = capture("depth", {"sensor_depth", "depth", "segmentation"});
  const auto kept = [&](const char* geom) {
    const auto part = static_cast<uint32_t>(world_.find_geom(geom)->id) + 1;
    double all = 0, good = 0;
    for (size_t i = 0; i < frame->part.size(); ++i) {
      if (frame->part[i] != part) continue;
      all += 1;
      if (frame->sensor_depth[i] <= 0) continue;
      good += 1;
      EXPECT_NEAR(frame->sensor_depth[i], frame->depth[i], 1e-4f);
    }
    EXPECT_GT(all, 500);
    return good / all;
  };
  EXPECT_GT(kept("matt"), 0.9) << "a signal of about 0.8 * 0.9 / 4";
  EXPECT_LT(kept("black"), 0.2);
  EXPECT_LT(kept("chrome"), 0.05);
}

// Light that does not change makes no events, however few paths a pixel has.
TEST_F(CameraModelsTest, AStillSceneMakesNoEventsButTheirNoise) {
  load(camera("quiet", "events = { threshold = 0.1 }\n") + camera("plain") +
       camera("noisy", "events = { threshold = 0.1, noise_rate = 5 }\n"));
  const auto frames = [&](const char* name, RenderTier tier, const char* output) {
    CameraRequest request{.camera = name};
    request.outputs = {output};
    request.render = {.tier = tier, .spp = 2, .denoise = false};
    auto sensor = std::move(CameraSensor::create(description_, request, 1)).value();
    std::vector<std::shared_ptr<const CameraFrame>> out;
    PoseFrame now = poses_;
    for (int k = 0; k < 5; ++k) {
      now.time = 0.02 * k;
      out.push_back(sensor->capture(*renderer_, turns_, now, poses_, k));
    }
    return out;
  };
  const auto plain = frames("plain", RenderTier::kPath, "radiance");
  size_t changed = 0;
  for (size_t i = 0; i < plain[0]->radiance.size(); ++i)
    changed += std::abs(std::log((plain[0]->radiance[i] + 1) / (plain[1]->radiance[i] + 1))) > 0.1f;
  EXPECT_GT(changed, 500u) << "the scene must have noise for this test to mean something";
  for (const RenderTier tier : {RenderTier::kPath, RenderTier::kDirect}) {
    for (const auto& frame : frames("quiet", tier, "events"))
      EXPECT_EQ(frame->events.size(), 0u) << to_string(tier) << ", frame " << frame->index;
    size_t noise = 0;
    for (const auto& frame : frames("noisy", tier, "events")) noise += frame->events.size();
    const double mean = 5 * 0.08 * 120 * 90;
    expect_within(static_cast<double>(noise), mean, std::sqrt(mean), to_string(tier));
  }
}

TEST_F(CameraModelsTest, RigsAreTheirCameras) {
  load(
      "[[stereo]]\nname = \"eyes\"\nbaseline = 0.2\nwidth = 120\nheight = 90\nlook_at = [0, 2, 0]\n"
      "[[rgbd]]\nname = \"head\"\nwidth = 120\nheight = 90\nlook_at = [0, 2, 0]\n"
      "color_offset = 0.1\nimager = { mosaic = \"rggb\" }\n");
  const auto left = capture("eyes/left", {"depth"}), right = capture("eyes/right", {"depth"});
  EXPECT_NEAR(right->X_WC.p.x - left->X_WC.p.x, 0.2, 1e-6);
  EXPECT_NEAR(right->X_WC.p.y, left->X_WC.p.y, 1e-6);
  EXPECT_NEAR(capture("head/color", {"raw"})->X_WC.p.x, 0.1, 1e-6);
  EXPECT_EQ(capture("head/depth", {"sensor_depth"})->sensor_depth.size(), size_t{120 * 90});
  EXPECT_EQ(world_.compiled()->scene.cameras.size(), 4u);
  EXPECT_TRUE(World::compile(world_.compiled()->scene).ok()) << "a compiled scene compiles again";
}

TEST_F(CameraModelsTest, AnOutputWithoutItsModelIsAnError) {
  load(camera("plain"));
  for (const char* output : {"raw", "sensor_depth", "events", "thermal"}) {
    const auto sensor = make("plain", {output});
    ASSERT_FALSE(sensor.ok()) << output;
    EXPECT_NE(sensor.error().to_string().find(output), std::string::npos);
  }
  load(camera("wide",
              "lens = { model = \"equidistant\", fx = 40 }\n"
              "stereo_depth = { baseline = 0.05 }\n"));
  const auto wide = make("wide", {"sensor_depth"});
  ASSERT_FALSE(wide.ok()) << "a fisheye's pictures are not matched along rows";
  EXPECT_NE(wide.error().to_string().find("plumb_bob"), std::string::npos);
  const auto scene = load_scene(
      folder_.write("twice.toml", "[environment]\nfile = \"tiles.xml\"\n" + camera("eyes/left") +
                                      "[[stereo]]\nname = \"eyes\"\n"));
  ASSERT_TRUE(scene.ok());
  const auto world = World::compile(*scene);
  ASSERT_FALSE(world.ok());
  EXPECT_NE(world.error().to_string().find("eyes/left"), std::string::npos);
}

// Effects are fields that change, unlike volumes: these cameras take them from the same instant.
TEST_F(CameraModelsTest, ThermalAndStereoCamerasSeeTheFireAndItsSmoke) {
  load(camera("eye", "thermal = {}\nstereo_depth = { preset = \"d435\" }\n") +
       "[[gas]]\nname = \"air\"\nposition = [0, 1, 0]\nsize = [1.6, 1.6, 2]\nvoxel = 0.1\n"
       "closed = [\"-z\"]\n"
       "[[fire]]\nname = \"pan\"\nposition = [0, 1, -0.7]\nsize = [0.4, 0.4, 0.2]\n"
       "power = 60e3\ngrowth = \"instant\"\n");
  const auto hottest = [](const CameraFrame& f) {
    return *std::max_element(f.thermal.begin(), f.thermal.end());
  };
  const auto seen = [](const CameraFrame& f) {
    return std::count_if(f.sensor_depth.begin(), f.sensor_depth.end(),
                         [](float z) { return z > 0; });
  };
  const std::vector<std::string> outputs = {"thermal", "sensor_depth"};
  const auto before = capture("eye", outputs);
  EXPECT_LT(hottest(*before), 300);
  auto simulator =
      std::move(Simulator::create(world_.compiled(), {.pace = Pace::kLockstep})).value();
  simulator->start();
  ASSERT_TRUE(simulator->step(1500).ok());  // 3 s
  auto solver = std::move(PoseSolver::create(world_.compiled())).value();
  ASSERT_TRUE(solver->solve(simulator->latest(), poses_).ok());
  const auto burning = capture("eye", outputs);
  EXPECT_GT(hottest(*burning), 600) << "flames";
  EXPECT_LT(seen(*burning), 0.96 * static_cast<double>(seen(*before))) << "behind its smoke";
}

}  // namespace
}  // namespace gloam
