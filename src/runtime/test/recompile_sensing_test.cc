// A recompile under open streams of what remembers: automatic exposures, event cameras, LiDARs,
// sensors.

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <thread>

#include "runtime/live/live_simulation.h"
#include "scenes.h"

namespace gloam {
namespace {

const char* const kMeteredEye = R"(
[[camera]]
name = "eye"
position = [0, -2, 0]
look_at = [0, 0, 0]
width = 16
height = 12
)";

/// A wall 5 m before the cameras, lit by a lamp twice as bright from 0.1 s and thrice that from
/// 0.8 s; a site at x = `place` [m] with a sensor of where it is. 2 ms steps.
Scene room(const TempFolder& folder, double lamp, double place, const std::string& more) {
  ::setenv("GLOAM_CACHE", (folder.path() / "cache").c_str(), 1);
  folder.write("room.xml", fmt::format(R"(<mujoco><visual><headlight active="0"/></visual>
<worldbody><geom type="box" size="5 .1 5" pos="0 3.1 0"/><site name="s" pos="{} 0 0"/></worldbody>
<sensor><framepos name="where" objtype="site" objname="s"/></sensor></mujoco>)",
                                       place));
  auto scene = load_scene(folder.write("scene.toml", fmt::format(R"(
[environment]
file = "room.xml"
[[light]]
name = "lamp"
type = "point"
position = [1.5, -1, 0.5]
intensity = {}
[light.schedule]
keys = [ {{ time = 0, level = 0.5 }}, {{ time = 0.101, level = 0.5 }}, {{ time = 0.109, level = 1 }},
         {{ time = 0.801, level = 1 }}, {{ time = 0.809, level = 3 }} ]
{}{})",
                                                                 lamp, kMeteredEye, more)));
  EXPECT_TRUE(scene.ok()) << scene.error().to_string();
  return *scene;
}

const char* const kAutomatic = "rate = 25\nimager.auto_exposure = { time_constant = 0.1 }\n";
const char* const kOthers = R"(
[[camera]]
name = "dvs"
position = [0, -2, 0]
look_at = [0, 0, 0]
events = { threshold = 0.3 }
[[sensor]]
match = "where"
rate = 50
[[lidar]]
name = "scanner"
preset = "Mid-40"
orientation = [0.7071067811865476, 0, 0, 0.7071067811865476]
position = [0, -2, 0]
points = 100
)";

CameraRequest small(const std::string& camera, Rational rate, const std::string& output) {
  CameraRequest request{.camera = camera, .rate = rate, .width = 16, .height = 12};
  request.outputs = {output};
  request.render = {.tier = RenderTier::kDirect, .spp = 1, .denoise = false};
  request.required = true;
  return request;
}

/// Items that a stream delivers, to be read once it is closed.
template <class Item>
class CollectedUnlocked {
 public:
  auto take() {
    return [this](Item item) {
      const std::lock_guard lock(mutex_);
      items_.push_back(std::move(item));
    };
  }
  const std::vector<Item>& all() const { return items_; }

 private:
  std::mutex mutex_;
  std::vector<Item> items_;
};
using CollectedFrames = CollectedUnlocked<std::shared_ptr<const CameraFrame>>;

// 4 stops more light in the new World: the exposure approaches them from where it was, a metering
// later; an event
// camera begins anew, so that the change of Worlds is no change of light to it; samples and scans
// keep their numbers.
TEST(RecompileSensing, ExposureGoesOnAndEventsBeginAnew) {
  const TempFolder folder;
  auto simulation =
      simulate(*World::compile(room(folder, 2e4, 1, std::string(kAutomatic) + kOthers)));
  CollectedFrames eye_frames, dvs_frames;
  CollectedUnlocked<SensorMessage> messages;
  CollectedUnlocked<std::shared_ptr<const LidarScan>> scans;
  auto eye = simulation->open_camera(small("eye", {25, 1}, "rgb"), eye_frames.take());
  auto dvs = simulation->open_camera(small("dvs", {50, 1}, "events"), dvs_frames.take());
  auto where = simulation->open_sensor({"where", true}, messages.take());
  auto lidar = simulation->open_lidar({"scanner", true}, scans.take());
  ASSERT_TRUE(eye.ok() && dvs.ok() && where.ok() && lidar.ok());
  ASSERT_TRUE(simulation->run_until(255).ok());
  const Status status =
      simulation->recompile(room(folder, 3.2e5, 2, std::string(kAutomatic) + kOthers));
  ASSERT_TRUE(status.ok()) << status.error().to_string();
  ASSERT_TRUE(simulation->run_until(450).ok());
  for (const Status& s :
       {(*eye)->status(), (*dvs)->status(), (*where)->status(), (*lidar)->status()})
    EXPECT_TRUE(s.ok()) << s.error().to_string();
  eye->reset(), dvs->reset(), where->reset(), lidar->reset();

  ASSERT_EQ(eye_frames.all().size(), 23u) << "0 … 440";
  const double before = eye_frames.all()[12]->ev100;  // at 0.48 s, at rest
  for (size_t k = 13; k <= 20; ++k) {
    const double share = 1 - std::exp(-0.04 / 0.1 * static_cast<double>(k - 13));
    EXPECT_NEAR(eye_frames.all()[k]->ev100 - before, 4 * share, 0.15) << "frame " << k;
  }
  ASSERT_EQ(dvs_frames.all().size(), 46u) << "0 … 450";
  constexpr double kPixels = 16 * 12;
  for (const auto& frame : dvs_frames.all()) {
    // log 2 / 0.3 = 2.3 after 0.1 s, log 3 / 0.3 = 3.7 after 0.8 s: found by the next frames.
    const double each = frame->index == 6 ? 2 : frame->index == 41 ? 3 : 0;
    EXPECT_NEAR(static_cast<double>(frame->events.size()), each * kPixels, 0.25 * kPixels * each)
        << "frame " << frame->index;
  }
  ASSERT_EQ(messages.all().size(), 45u) << "0 … 440: that of step 450 comes with the next";
  for (size_t i = 0; i < messages.all().size(); ++i) {
    const SensorMessage& message = messages.all()[i];
    EXPECT_EQ(message.index, static_cast<int64_t>(i));
    EXPECT_EQ(message.values.at(0), message.step <= 255 ? 1 : 2) << "at step " << message.step;
  }
  std::vector<int64_t> indices;
  for (const auto& scan : scans.all()) indices.push_back(scan->index);
  EXPECT_EQ(indices, (std::vector<int64_t>{0, 1, 2, 3, 4, 6, 7, 8}))
      << "scans of 0.1 s: the one that had begun at the recompile is not made";
}

// The exposure is what the camera of the new World says: its automatic with other numbers, none,
// one again, one at another rate.
TEST(RecompileSensing, ExposureIsThatOfTheNewCamera) {
  const TempFolder folder;
  const auto automatic = [&](int rate, int compensation) {
    return room(folder, 2e4, 1,
                fmt::format("rate = {}\nimager.auto_exposure = {{ time_constant = 0.001, "
                            "compensation = {} }}\n",
                            rate, compensation));
  };
  const Scene fixed =
      room(folder, 2e4, 1, "imager.exposure = { f_number = 4, shutter = 0.01, iso = 100 }\n");
  auto simulation = simulate(*World::compile(automatic(25, 0)));
  CollectedFrames frames;
  auto eye = simulation->open_camera(small("eye", {25, 1}, "rgb"), frames.take());
  ASSERT_TRUE(eye.ok());
  int64_t step = 245;  // five steps after every second frame
  for (const Scene& next : {automatic(25, 2), fixed, automatic(25, 2), automatic(50, 0)}) {
    ASSERT_TRUE(simulation->run_until(step).ok());
    ASSERT_TRUE(simulation->recompile(next).ok());
    step += 40;
  }
  ASSERT_TRUE(simulation->run_until(step).ok());
  ASSERT_TRUE((*eye)->status().ok());
  eye->reset();
  ASSERT_EQ(frames.all().size(), 21u) << "0 … 400";
  const double metered = frames.all()[12]->ev100;
  const double expected[] = {metered - 2, std::log2(4 * 4 / 0.01), metered - 2, metered};
  EXPECT_NEAR(frames.all()[13]->ev100, metered, 0.1) << "by the metering before the recompile";
  for (size_t k = 14; k <= 20; ++k)
    EXPECT_NEAR(frames.all()[k]->ev100, expected[(k - 13) / 2], 0.1) << "frame " << k;
}

// Worlds with and without an automatic exposure while physics runs free: nobody waits for a meter
// that has ended, nor for the first instant of one that has just begun.
TEST(RecompileSensing, ManyWhileItRuns) {
  const TempFolder folder;
  const std::string metered = "imager.auto_exposure = {}\nrate = ";
  const World worlds[] = {*World::compile(room(folder, 2e4, 1, metered + "25\n" + kOthers)),
                          *World::compile(room(folder, 2e4, 1, kOthers)),
                          *World::compile(room(folder, 2e4, 1, metered + "4\n" + kOthers))};
  auto simulation = simulate(worlds[0]);
  std::atomic<int64_t> frames{0};
  const auto count = [&](auto) { ++frames; };
  auto eye = simulation->open_camera(small("eye", {250, 1}, "rgb"), count);
  auto dvs = simulation->open_camera(small("dvs", {50, 1}, "events"), [](auto) {});
  auto where = simulation->open_sensor({"where", true}, [](auto) {});
  auto lidar = simulation->open_lidar({"scanner", true}, [](auto) {});
  ASSERT_TRUE(eye.ok() && dvs.ok() && where.ok() && lidar.ok());
  simulation->resume();
  for (int i = 1; i <= 12; ++i) {
    const Status status = simulation->recompile(worlds[i % 3]);
    ASSERT_TRUE(status.ok()) << status.error().to_string();
    const int64_t seen = frames;
    for (int wait = 0; frames < seen + 5 && wait < 10000; ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_GE(frames, seen + 5) << "recompile " << i;
  }
  simulation->pause();
  for (const Status& s :
       {(*eye)->status(), (*dvs)->status(), (*where)->status(), (*lidar)->status()})
    EXPECT_TRUE(s.ok()) << s.error().to_string();
}

// Two sensors in one stream, of which one is not in the next World.
TEST(RecompileSensing, ASensorThatIsGoneIsToldOfAndTheOthersGoOn) {
  const TempFolder folder;
  const auto with = [&folder](const char* name, const std::string& sensors) {
    return compile_text(folder, name,
                        "<mujoco><worldbody><body name=\"b\"><joint name=\"j\"/><geom "
                        "size=\".1\"/></body></worldbody><sensor>" +
                            sensors + "</sensor></mujoco>");
  };
  const std::string angle = "<jointpos name=\"angle\" joint=\"j\"/>";
  const World both = with("both.xml", angle + "<jointvel name=\"rate\" joint=\"j\"/>");
  const World one = with("one.xml", angle), none = with("none.xml", "");
  auto simulation = *LiveSimulation::create(both, {.pace = Pace::kLockstep});
  std::mutex mutex;
  std::vector<std::string> lost;
  std::map<std::string, std::vector<int64_t>> steps;
  LiveSensorsRequest request{.sensors = {"angle", "rate"}, .required = true};
  request.on_lost = [&](const Error& why) {
    const std::lock_guard lock(mutex);
    lost.push_back(why.to_string());
  };
  request.on_end = [&](const Error& why) {
    const std::lock_guard lock(mutex);
    lost.push_back("the end: " + why.to_string());
  };
  auto stream = *simulation->open_live_sensors(request, [&](const SensorMessage& message) {
    const std::lock_guard lock(mutex);
    steps[message.sensor].push_back(message.step);
  });
  ASSERT_TRUE(simulation->step(20).ok());
  ASSERT_TRUE(simulation->recompile(one).ok());
  ASSERT_TRUE(simulation->step(20).ok());
  ASSERT_TRUE(simulation->recompile(none).ok());
  ASSERT_TRUE(simulation->step(20).ok());
  simulation->simulator().stop();
  stream->drain();
  ASSERT_EQ(lost.size(), 3u);
  EXPECT_NE(lost[0].find("'rate'"), std::string::npos) << lost[0];
  EXPECT_NE(lost[1].find("'angle'"), std::string::npos) << lost[1];
  EXPECT_EQ(lost[2], "the end: " + lost[1]);
  EXPECT_EQ(steps["rate"].back(), 19) << "the last that its World has computed";
  EXPECT_EQ(steps["angle"].back(), 39);
  EXPECT_EQ(steps["angle"].size(), 40u) << "none twice, none left out";
  EXPECT_FALSE(stream->status().ok());
}

}  // namespace
}  // namespace gloam
