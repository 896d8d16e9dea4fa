// Streams of MuJoCo's sensors and the timing of cameras in a running simulation.

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "gloam/run.h"
#include "scenes.h"

namespace gloam {
namespace {

/// A ball that falls freely with an accelerometer on it and a slide that moves at 1 m/s.
const char* const kLab = R"(
<mujoco model="lab">
  <option timestep="0.002"/>
  <worldbody>
    <geom name="wall" type="box" size="5 0.1 5" pos="0 3.1 0" rgba="0.7 0.6 0.5 1"/>
    <camera name="eye" pos="0 1 0" xyaxes="1 0 0 0 0 1"/>
    <body name="ball" pos="0 0 1"><freejoint/><site name="imu"/>
      <geom type="sphere" size="0.1" mass="1"/></body>
    <body name="cart"><joint name="rail" type="slide" axis="1 0 0"/>
      <geom type="box" size="0.1 0.1 0.1" mass="1"/></body>
  </worldbody>
  <sensor>
    <framelinvel name="velocity" objtype="site" objname="imu"/>
    <jointpos name="encoder" joint="rail"/>
    <gyro site="imu"/>
  </sensor>
  <keyframe><key name="go" qpos="0 0 1 1 0 0 0 0" qvel="0 0 0 0 0 0 1"/></keyframe>
</mujoco>)";

World lab(const TempFolder& folder, const std::string& more) {
  folder.write("lab.xml", kLab);
  folder.write("nothing.xml", "<mujoco><visual><headlight active=\"0\"/></visual></mujoco>");
  return compile_text(folder, "scene.toml",
                      "[environment]\nfile = \"nothing.xml\"\n[[robot]]\nname = \"a\"\nfile = "
                      "\"lab.xml\"\nkeyframe = \"go\"\n" +
                          more);
}

std::vector<SensorMessage> stream(const World& world, const std::string& sensor, int64_t steps,
                                  int64_t open_at = 0, uint64_t seed = 1) {
  auto simulation = simulate(world, {.seed = seed});
  EXPECT_TRUE(open_at == 0 || simulation->run_until(open_at).ok());
  std::mutex mutex;
  std::vector<SensorMessage> messages;
  auto opened = simulation->open_sensor({sensor, true}, [&](const SensorMessage& message) {
    const std::lock_guard lock(mutex);
    messages.push_back(message);
  });
  EXPECT_TRUE(opened.ok());
  EXPECT_TRUE(simulation->run_until(steps).ok());
  opened->reset();
  return messages;
}

// v = -g t at the stamp, that of the sample's step. It is computed in the step that follows, and
// comes with the Snapshot after that.
TEST(LiveSensors, WithoutAModelValuesAreMujocosAtTheTimeOfTheirState) {
  const TempFolder folder;
  const World world = lab(folder, "");
  const auto messages = stream(world, "a/velocity", 100);
  ASSERT_EQ(messages.size(), 100u) << "one at every step that is done";
  for (const SensorMessage& m : messages) {
    EXPECT_EQ(m.index, m.step);
    EXPECT_NEAR(m.time, 0.002 * static_cast<double>(m.step), 1e-12);
    EXPECT_NEAR(m.values.at(2), -9.81 * m.time, 1e-9);
    EXPECT_NEAR(m.delivery, 0.002 * static_cast<double>(m.step + 1), 1e-12);
  }
  EXPECT_EQ(stream(world, "sensor_2", 3).size(), 3u) << "one without a name";
}

TEST(LiveSensors, AModelAddsRateErrorsLatencyAndDrops) {
  const TempFolder folder;
  const World world = lab(folder, R"(
[[sensor]]
match = "a/*"
rate = 50
[[sensor]]
match = "a/enc*"
rate = 100
noise = 0.01
resolution = 0.001
timing = { latency = 0.05, latency_jitter = 0.001, drop = 0.2, phase = "1/1000" }
)");
  EXPECT_EQ(stream(world, "a/velocity", 500).size(), 50u) << "the first table's";
  const auto messages = stream(world, "a/encoder", 5000);
  EXPECT_NEAR(static_cast<double>(messages.size()), 800, 3 * std::sqrt(1000 * 0.16));
  double square = 0;
  for (const SensorMessage& m : messages) {
    EXPECT_EQ(m.step, 5 * m.index + 1) << "1 ms later, at the next step";
    EXPECT_NEAR(m.delivery - m.time, 0.05, 0.004 + 1e-9);
    EXPECT_NEAR(std::remainder(m.values[0], 0.001), 0, 1e-9);
    square += std::pow(m.values[0] - m.time, 2) / static_cast<double>(messages.size());
  }
  EXPECT_NEAR(square, 1e-4, 3 * 1e-4 * std::sqrt(2.0 / 800));
}

// The state of noise, drift and drops is the schedule's, not the listener's.
TEST(LiveSensors, ALateListenerHearsWhatAnEarlyOneHears) {
  const TempFolder folder;
  const World world = lab(folder, R"(
[[sensor]]
match = "a/encoder"
rate = 100
noise = 0.01
random_walk = 0.02
bias_instability = 0.03
timing = { jitter = 0.0005, drop = 0.3 }
)");
  std::map<int64_t, SensorMessage> early;
  for (const SensorMessage& m : stream(world, "a/encoder", 1000)) early[m.index] = m;
  const auto late = stream(world, "a/encoder", 1000, 500);
  EXPECT_GT(late.size(), 50u);
  for (const SensorMessage& m : late) {
    ASSERT_TRUE(early.contains(m.index)) << m.index;
    EXPECT_EQ(m.values, early[m.index].values);
    EXPECT_EQ(m.step, early[m.index].step);
    EXPECT_EQ(m.delivery, early[m.index].delivery);
  }
  EXPECT_NE(stream(world, "a/encoder", 1000, 0, 2).at(5).values, early.begin()->second.values);
}

TEST(LiveSensors, AListenerDoesNotChangePhysics) {
  const TempFolder folder;
  const World world = lab(folder, "[[sensor]]\nmatch = \"*\"\nnoise = 0.5\n");
  const auto hash = [&](bool listen) {
    auto simulation = simulate(world);
    std::unique_ptr<SensorStream> opened;
    if (listen) opened = std::move(*simulation->open_sensor({"a/velocity", false}, [](auto&) {}));
    EXPECT_TRUE(simulation->run_until(200).ok());
    return simulation->stats().hash;
  };
  EXPECT_EQ(hash(true), hash(false));
}

TEST(LiveSensors, WhatItCannotDoIsAnErrorWithItsPlace) {
  const TempFolder folder;
  folder.write("lab.xml", kLab);
  const auto message = [&](const std::string& more) {
    const auto scene = load_scene(
        folder.write("bad.toml", "[[robot]]\nname = \"a\"\nfile = \"lab.xml\"\n" + more));
    if (!scene.ok()) return scene.error().to_string();
    const auto world = World::compile(*scene);
    if (!world.ok()) return world.error().to_string();
    auto simulation = simulate(*world);
    const auto opened = simulation->open_sensor({"a/encoder", false}, [](auto&) {});
    return opened.ok() ? std::string() : opened.error().to_string();
  };
  const std::string nothing = message("[[sensor]]\nmatch = \"a/encodr\"\n");
  EXPECT_NE(nothing.find("bad.toml:4"), std::string::npos) << nothing;
  EXPECT_NE(nothing.find("a/encoder"), std::string::npos) << nothing;
  const std::string fast = message("[[sensor]]\nmatch = \"*\"\nrate = 600\n");
  EXPECT_NE(fast.find("600"), std::string::npos) << fast;
  EXPECT_NE(fast.find("bad.toml:4"), std::string::npos) << fast;
  const std::string shaky =
      message("[[sensor]]\nmatch = \"*\"\nrate = 100\ntiming = { jitter = 0.009 }\n");
  EXPECT_NE(shaky.find("at most"), std::string::npos) << shaky;
  EXPECT_NE(message("[[sensor]]\nmatch = \"*\"\npreset = \"adis\"\n").find("adis16470_gyro"),
            std::string::npos);
  auto simulation = simulate(lab(folder, ""));
  const auto opened = simulation->open_sensor({"a/encodr", false}, [](auto&) {});
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().to_string().find("a/encoder"), std::string::npos);
}

CameraRequest eye() {
  CameraRequest request{.camera = "a/eye", .rate = {50, 1}, .width = 16, .height = 12};
  request.outputs = {"depth"};
  request.required = true;
  return request;
}

std::vector<CameraFrame> frames_of(const World& world, const CameraRequest& request, int64_t steps,
                                   int64_t open_at = 0) {
  auto simulation = simulate(world);
  EXPECT_TRUE(open_at == 0 || simulation->run_until(open_at).ok());
  std::vector<CameraFrame> frames;
  auto camera = simulation->open_camera(
      request, [&](std::shared_ptr<const CameraFrame> frame) { frames.push_back(*frame); });
  if (!camera.ok()) {
    ADD_FAILURE() << camera.error().to_string();
    return {};
  }
  EXPECT_TRUE(simulation->run_until(steps).ok());
  camera->reset();
  return frames;
}

TEST(CameraTiming, FramesHaveTheirPhaseJitterLatencyAndDrops) {
  const TempFolder folder;
  const World plain = lab(folder, "[[camera]]\nname = \"a/eye\"\n");
  const World world = lab(folder, R"(
[[camera]]
name = "a/eye"
[camera.timing]
phase = 0.01
jitter = 0.002
latency = 0.03
drop = 0.25
)");
  const auto all = frames_of(plain, eye(), 1000), some = frames_of(world, eye(), 1000);
  ASSERT_EQ(all.size(), 101u);
  EXPECT_NEAR(static_cast<double>(some.size()), 75, 14);
  std::map<int64_t, int64_t> steps;
  double moved = 0;
  for (const CameraFrame& f : some) {
    EXPECT_NEAR(f.delivery, f.time + 0.03, 1e-12);
    const double planned = 0.01 + 0.02 * static_cast<double>(f.index);
    EXPECT_NEAR(f.time, planned, 0.008 + 0.002);
    moved += std::abs(f.time - planned) > 0.002 ? 1 : 0;
    steps[f.index] = f.step;
  }
  EXPECT_GT(moved, 5);
  for (const CameraFrame& f : all) EXPECT_EQ(f.delivery, f.time);
  for (const CameraFrame& f : frames_of(world, eye(), 1000, 450))
    EXPECT_EQ(steps.at(f.index), f.step) << "whether or not anyone looked before";
}

// A lamp of a hundredfold light goes on after half a second.
TEST(CameraTiming, AutoExposureGoesOnWhileNobodyLooks) {
  const TempFolder folder;
  const World world = lab(folder, R"(
[[camera]]
name = "a/eye"
rate = 25
width = 64
height = 48
[camera.imager.auto_exposure]
time_constant = 0.2
[[light]]
name = "lamp"
type = "point"
position = [1.5, 1, 0.5]
intensity = 20000
[light.schedule]
keys = [ { time = 0, level = 0.01 }, { time = 0.5, level = 0.01 }, { time = 0.501, level = 1 } ]
)");
  CameraRequest request = eye();
  request.rate = {25, 1};
  request.outputs = {"rgb"};
  request.render = {.tier = RenderTier::kDirect, .spp = 1, .denoise = false};
  const auto all = frames_of(world, request, 750);
  ASSERT_EQ(all.size(), 38u);
  std::map<int64_t, double> ev;
  for (const CameraFrame& f : all) ev[f.index] = f.ev100;
  EXPECT_NEAR(ev[12], ev[5], 0.1) << "steady before the lamp";
  EXPECT_NEAR(ev[13], ev[12], 0.1) << "exposed by what was metered before the lamp";
  const double rise = std::log2(100.0);
  for (int k = 14; k <= 37; ++k) {
    // The first metering after the lamp is that of frame 13 at 0.52 s, for frame 14.
    const double share = 1 - std::exp(-0.04 * (k - 13) / 0.2);
    EXPECT_NEAR(ev[k] - ev[12], rise * share, 0.1) << k;
  }
  for (const CameraFrame& f : frames_of(world, request, 750, 400)) {
    EXPECT_EQ(f.ev100, ev.at(f.index)) << "opened late: frame " << f.index;
  }
}

const char* const kDvs = R"(
[[camera]]
name = "a/eye"
[camera.events]
threshold = 0.3
[camera.thermal]
[camera.imager]
mosaic = "gbrg"
pixel = { bits = 10 }
[[temperature]]
temperature = 330
emissivity = 1
[[light]]
name = "lamp"
type = "point"
position = [1.5, 1, 0.5]
intensity = 2000
[light.schedule]
keys = [ { time = 0, level = 0.2 }, { time = 0.101, level = 0.2 }, { time = 0.109, level = 1 } ]
)";

TEST(CameraOutputs, EventsTemperaturesAndNumbersComeThroughTheStream) {
  const TempFolder folder;
  const World world = lab(folder, kDvs);
  CameraRequest request = eye();
  request.outputs = {"events", "thermal", "raw"};
  request.render = {.tier = RenderTier::kDirect, .spp = 1, .denoise = false};
  const auto frames = frames_of(world, request, 100);
  ASSERT_EQ(frames.size(), 11u);
  for (const CameraFrame& f : frames) {
    // Between frames 5 and 6, at 0.1 and 0.12 s, light grows fivefold: log 5 / 0.3 = 5.4 events.
    if (f.index == 6) {
      EXPECT_NEAR(static_cast<double>(f.events.size()), 5.0 * 16 * 12, 50);
      for (const Event& e : f.events) EXPECT_TRUE(e.brighter && e.time > 0.1 && e.time <= 0.12);
    } else {
      EXPECT_TRUE(f.events.empty()) << f.index;
    }
    EXPECT_NEAR(f.thermal.at(100), 330, 0.01);
    EXPECT_EQ(f.raw.size(), size_t{16 * 12});
  }
  const World odd = lab(folder,
                        "[[camera]]\nname = \"a/eye\"\nthermal = {}\n"
                        "[[temperature]]\nbody = \"a/bal\"\n");
  request.outputs = {"thermal"};
  auto simulation = simulate(odd);
  const auto opened = simulation->open_camera(request, [](auto) {});
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().to_string().find("a/bal"), std::string::npos);
  EXPECT_NE(opened.error().to_string().find("scene.toml:"), std::string::npos);
}

TEST(RecordedSensors, AreTablesOfTheirSamples) {
  const TempFolder folder;
  const World world = lab(folder, R"(
[[sensor]]
match = "a/encoder"
rate = 100
noise = 0.01
[record]
outputs = ["sensors", "events", "raw_png", "thermal_png", "sensor_depth_png"]
[render]
tier = "direct"
)" + std::string(kDvs));
  RunRequest request;
  request.out = folder.path() / "run";
  request.duration = 0.5;
  request.width = 16;
  request.height = 12;
  const auto report = run_and_record(world, request, {});
  ASSERT_TRUE(report.ok()) << report.error().to_string();
  ASSERT_TRUE(report->status.ok()) << report->status.error().to_string();
  std::ifstream file(request.out / "sensors" / "a_encoder.csv");
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(line, "sample,step,time_s,delivery_s,value_0");
  int rows = 0;
  while (std::getline(file, line)) ++rows;
  EXPECT_EQ(rows, 50);
  EXPECT_TRUE(std::filesystem::exists(request.out / "sensors" / "a_velocity.csv"));
  const auto camera = request.out / "a_eye";
  EXPECT_TRUE(std::filesystem::exists(camera / "raw" / "000003.png"));
  EXPECT_TRUE(std::filesystem::exists(camera / "thermal" / "000003.png"));
  EXPECT_FALSE(std::filesystem::exists(camera / "sensor_depth")) << "it has no such model";
  std::ifstream events(camera / "events.csv");
  ASSERT_TRUE(std::getline(events, line));
  EXPECT_EQ(line, "time_s,x_px,y_px,brighter");
  EXPECT_TRUE(std::getline(events, line)) << "the lamp's";
}

}  // namespace
}  // namespace gloam
