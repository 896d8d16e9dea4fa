// A recompile under open streams, as users of gloam::Simulation see it.

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

#include "scenes.h"

namespace gloam {
namespace {

/// The flight (scenes.h) in an environment of `geoms`.
Scene flight_past(const TempFolder& folder, const std::string& geoms,
                  const std::string& more = "") {
  ::setenv("GLOAM_CACHE", (folder.path() / "cache").c_str(), 1);
  folder.write("flight.xml", kFlight);
  folder.write("room.xml", "<mujoco><worldbody>" + geoms + "</worldbody></mujoco>");
  auto scene = load_scene(folder.write(
      "scene.toml",
      "[environment]\nfile = \"room.xml\"\n[[robot]]\nname = \"a\"\nfile = \"flight.xml\"\n"
      "keyframe = \"go\"\n" +
          more));
  EXPECT_TRUE(scene.ok()) << scene.error().to_string();
  return *scene;
}

World compiled(const Scene& scene) {
  auto world = World::compile(scene);
  EXPECT_TRUE(world.ok()) << world.error().to_string();
  return *world;
}

// Two metres ahead of camera a/fixed, beside the way of the ball.
const char* const kScreen =
    "<geom name=\"screen\" type=\"box\" size=\"3 .05 3\" pos=\"0 -.5 0\" rgba=\"1 0 0 1\"/>";
const char* const kLidar = R"(
[[lidar]]
name = "scanner"
preset = "Mid-40"
orientation = [0.7071067811865476, 0, 0, 0.7071067811865476]
position = [0, -2, 0]
points = 100
)";

template <class Item>
class Collected {
 public:
  void add(Item item) {
    const std::lock_guard lock(mutex_);
    items_.push_back(std::move(item));
  }
  std::vector<Item> all() {
    const std::lock_guard lock(mutex_);
    return items_;
  }

 private:
  std::mutex mutex_;
  std::vector<Item> items_;
};
using Frames = Collected<std::shared_ptr<const CameraFrame>>;

CameraRequest small(const std::string& camera, std::vector<std::string> outputs) {
  CameraRequest request{.camera = camera, .rate = {50, 1}, .width = 16, .height = 12};
  request.outputs = std::move(outputs);
  request.render.spp = 1;
  request.required = true;
  return request;
}

std::unique_ptr<CameraStream> open(Simulation& simulation, const CameraRequest& request,
                                   Frames& frames) {
  auto stream = simulation.open_camera(request, [&](auto frame) { frames.add(std::move(frame)); });
  EXPECT_TRUE(stream.ok()) << stream.error().to_string();
  return std::move(*stream);
}

TEST(Recompile, StreamsGoOnInTheNewWorld) {
  const TempFolder folder;
  auto simulation = simulate(compiled(flight_past(folder, "", kLidar)));
  Frames frames;
  Collected<std::shared_ptr<const LidarScan>> scans;
  auto camera = open(*simulation, small("a/fixed", {"depth"}), frames);
  auto lidar =
      simulation->open_lidar({"scanner", true}, [&](auto scan) { scans.add(std::move(scan)); });
  ASSERT_TRUE(lidar.ok()) << lidar.error().to_string();
  ASSERT_TRUE(simulation->run_until(105).ok());
  const Status status = simulation->recompile(flight_past(folder, kScreen, kLidar));
  ASSERT_TRUE(status.ok()) << status.error().to_string();
  ASSERT_TRUE(simulation->run_until(304).ok());
  const Pose X_WB = *simulation->body_pose(*simulation->world().find_body("a/ball"));
  EXPECT_NEAR(X_WB.p.x, 304 * 0.002, 1e-9) << "the ball flew on";
  camera.reset();
  lidar->reset();
  std::vector<int64_t> indices;
  for (const auto& frame : frames.all()) {
    indices.push_back(frame->index);
    const float corner = frame->depth[0];  // beside the ball
    EXPECT_NEAR(corner, frame->step <= 105 ? 5.0 : 1.45, 1e-3) << "step " << frame->step;
  }
  std::vector<int64_t> expected(31);
  for (size_t i = 0; i < expected.size(); ++i) expected[i] = static_cast<int64_t>(i);
  EXPECT_EQ(indices, expected) << "no frame is missing";
  // Scans of 0.1 s: the one that had begun at the recompile is not made.
  ASSERT_GE(scans.all().size(), 3u);
  for (const auto& scan : scans.all()) {
    EXPECT_NE(scan->index, 2);
    const float farthest = *std::max_element(scan->range.begin(), scan->range.end());
    EXPECT_EQ(farthest < 3, scan->index > 2) << "the wall, or the screen before it";
  }
}

TEST(Recompile, AStreamWhoseCameraIsGoneEndsAndSaysSo) {
  const TempFolder folder;
  const char* const kCamera = "<camera name=\"extra\" pos=\"0 -2 0\" xyaxes=\"1 0 0 0 0 1\"/>";
  auto simulation = simulate(compiled(flight_past(folder, kCamera)));
  Frames extra_frames, fixed_frames;
  auto extra = open(*simulation, small("extra", {"depth"}), extra_frames);
  auto fixed = open(*simulation, small("a/fixed", {"depth"}), fixed_frames);
  ASSERT_TRUE(simulation->run_until(100).ok());
  ASSERT_TRUE(simulation->recompile(flight_past(folder, "")).ok());
  ASSERT_TRUE(simulation->run_until(200).ok()) << "nobody waits for what has ended";
  fixed.reset();
  EXPECT_EQ(fixed_frames.all().size(), 21u);
  ASSERT_FALSE(extra->status().ok());
  EXPECT_NE(extra->status().error().to_string().find("extra"), std::string::npos);
  EXPECT_LE(extra_frames.all().size(), 11u);
}

TEST(Recompile, ASceneThatDoesNotCompileLeavesTheOldOneRunning) {
  const TempFolder folder;
  auto simulation = simulate(compiled(flight_past(folder, "")));
  Frames frames;
  auto camera = open(*simulation, small("a/fixed", {"depth"}), frames);
  ASSERT_TRUE(simulation->run_until(50).ok());
  const uint64_t hash = simulation->latest().hash();
  const Status broken = simulation->recompile(flight_past(folder, "<geom type=\"box\"/>"));
  ASSERT_FALSE(broken.ok());
  EXPECT_NE(broken.error().to_string().find("size"), std::string::npos);
  const Status slower = simulation->recompile(flight_past(folder, "", "[sim]\ntimestep = 0.004\n"));
  ASSERT_FALSE(slower.ok());
  EXPECT_NE(slower.error().to_string().find("timestep"), std::string::npos);
  EXPECT_EQ(simulation->latest().hash(), hash);
  ASSERT_TRUE(simulation->run_until(100).ok());
  camera.reset();
  EXPECT_EQ(frames.all().size(), 11u);
  EXPECT_TRUE(simulation->world().find_body("a/ball").ok());
}

// The same recompile at the same step: the same hashes and the same pictures.
TEST(Recompile, PicturesAreTheSameEveryTime) {
  const TempFolder folder;
  const World first = compiled(flight_past(folder, "")),
              second = compiled(flight_past(folder, kScreen));
  const auto run = [&] {
    auto simulation = simulate(first);
    Frames frames;
    auto camera = open(*simulation, small("a/fixed", {"rgb"}), frames);
    EXPECT_TRUE(simulation->run_until(60).ok());
    EXPECT_TRUE(simulation->recompile(second).ok());
    EXPECT_TRUE(simulation->run_until(120).ok());
    camera.reset();
    std::vector<std::vector<uint8_t>> pictures;
    for (const auto& frame : frames.all())
      pictures.emplace_back(frame->rgb.begin(), frame->rgb.end());
    return std::pair(simulation->latest().hash(), pictures);
  };
  const auto once = run();
  EXPECT_EQ(once.second.size(), 13u);
  EXPECT_NE(once.second[5], once.second[7]);
  EXPECT_EQ(run(), once);
}

// Twenty recompiles while physics runs free and cameras, a LiDAR and readers are at work.
TEST(Recompile, ManyUnderOpenStreams) {
  const TempFolder folder;
  const World worlds[] = {compiled(flight_past(folder, "", kLidar)),
                          compiled(flight_past(folder, kScreen, kLidar)),
                          compiled(flight_past(folder,
                                               "<body name=\"box\" pos=\"0 0 9\"><freejoint/><geom "
                                               "size=\".1\"/></body>",
                                               kLidar))};
  auto simulation = simulate(worlds[0]);
  std::atomic<int64_t> frames{0};
  std::vector<std::unique_ptr<CameraStream>> cameras;
  for (const char* name : {"a/fixed", "a/rider", "free"}) {
    CameraRequest request = small(name, {"rgb", "depth", "segmentation"});
    request.required = std::string(name) == "a/fixed";
    auto stream = simulation->open_camera(request, [&](auto) { ++frames; });
    ASSERT_TRUE(stream.ok());
    cameras.push_back(std::move(*stream));
  }
  auto lidar = simulation->open_lidar({"scanner", false}, [](auto) {});
  ASSERT_TRUE(lidar.ok());
  simulation->resume();
  std::atomic<bool> done{false};
  std::thread client([&] {
    while (!done) {
      const auto ball = simulation->world().find_body("a/ball");
      static_cast<void>(simulation->post({.what = AddVelocity{*ball, {0.001, 0, 0}}}));
      static_cast<void>(simulation->body_pose(*ball));
      cameras[2]->refresh();
      cameras[2]->set_pose(cameras[2]->pose());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  for (int i = 1; i <= 20; ++i) {
    const Status status = simulation->recompile(worlds[i % 3]);
    ASSERT_TRUE(status.ok()) << status.error().to_string();
    const int64_t seen = frames;
    for (int wait = 0; frames == seen && wait < 10000; ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_GT(frames, seen) << "recompile " << i;
  }
  done = true;
  client.join();
  simulation->pause();
  for (const auto& camera : cameras) EXPECT_TRUE(camera->status().ok());
  EXPECT_TRUE((*lidar)->status().ok());
  EXPECT_TRUE(simulation->status().ok());
}

}  // namespace
}  // namespace gloam
