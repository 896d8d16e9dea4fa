// Effects around a robot: the same whatever watches them, however fast, with any number of threads.

#include "base/parallel.h"
#include "scenes.h"

namespace gloam {
namespace {

/// ball.xml with a keyframe "go" of `state`.
void write_ball(const TempFolder& folder, const std::string& state) {
  folder.write("ball.xml", R"(<mujoco><worldbody><body><freejoint/>
    <geom type="sphere" size=".15" mass="1"/></body></worldbody>
    <keyframe><key name="go" )" +
                               state + "/></keyframe></mujoco>");
}

World burning_room(const TempFolder& folder) {
  folder.write("room.xml", R"(<mujoco><option timestep="0.005"/><worldbody>
    <geom type="plane" size="3 3 .1"/>
    <geom type="box" size=".1 1.5 1" pos="1.5 0 1"/>
    <geom type="box" size="1.5 .1 1" pos="0 1.5 1"/>
    <light pos="0 0 3"/></worldbody></mujoco>)");
  write_ball(folder, R"(qpos="-.8 0 .3 1 0 0 0" qvel=".3 .1 0 0 0 0")");
  return compile_text(folder, "room.toml", R"(
[environment]
file = "room.xml"
[[robot]]
name = "ball"
file = "ball.xml"
keyframe = "go"
[[gas]]
name = "air"
position = [0, 0, 1]
size = [2.8, 2.8, 2]
voxel = 0.1
rate = 10
closed = ["-z"]
[[fire]]
name = "bin"
position = [0.6, 0.6, 0.1]
size = [0.4, 0.4, 0.2]
power = 30e3
growth = "instant"
[[camera]]
name = "eye"
position = [-1.2, -1.2, 1]
look_at = [0.5, 0.5, 0.5]
)");
}

/// A fire, dusty ground, sand, a pool, gusts and rain; balls roll and float, one person walks in
/// the robot's way.
World garden(const TempFolder& folder) {
  folder.write("garden.xml", R"(<mujoco><option timestep="0.005"/><worldbody>
    <geom type="box" size="4 2 .1" pos="0 0 -.2"/>
    <geom type="box" size="4 .1 .4" pos="0 2.1 -.4"/>
    <geom type="box" size="1 1 .1" pos="0 3.2 -.9"/>
    <geom type="box" size="2 2 .1" pos="-2 0 -.1"/>
    <body pos="0 3.2 .1"><freejoint/><geom type="sphere" size=".15" density="400"/></body>
    <light pos="0 0 3"/></worldbody></mujoco>)");
  write_ball(folder, R"(qpos="0 0 .06 1 0 0 0" qvel="1.2 .05 0 0 8 0")");
  return compile_text(folder, "garden.toml", R"(
[environment]
file = "garden.xml"
[[robot]]
name = "ball"
file = "ball.xml"
keyframe = "go"
[weather]
rain = 10
wind = 4
gusts = 0.2
[[gas]]
name = "air"
position = [-1, 0, 1]
size = [2, 2, 2]
voxel = 0.2
closed = ["-z"]
[[fire]]
name = "bin"
position = [-0.5, 0.6, 0.2]
size = [0.4, 0.4, 0.2]
power = 30e3
growth = "instant"
[[gas]]
name = "yard"
position = [-3, 0, 0.5]
size = [1.6, 2, 1]
voxel = 0.2
medium = "dust"
closed = ["-z"]
[[dust]]
name = "earth"
[[soil]]
name = "sand"
position = [2, 0, 0]
size = [3, 3]
depth = 0.1
[[water]]
name = "pool"
position = [0, 3.2, -0.1]
size = [2, 2]
depth = 0.7
wave_height = 0.03
wave_period = 0.9
[[agent]]
name = "walker"
kind = "person"
position = [-3.2, 0.2, 0]
behavior = "wander"
yields = true
[[camera]]
name = "eye"
position = [-3, -1.8, 1.4]
look_at = [0.5, 0.5, 0]
)");
}

uint64_t hash_at(const World& world, double time, const SimulationOptions& options, bool filmed) {
  const auto simulation = simulate(world, options);
  std::unique_ptr<CameraStream> stream;
  if (filmed) {
    CameraRequest request;
    request.camera = "eye";
    request.rate = {2, 1};
    request.width = 32, request.height = 24;
    request.render.spp = 2;
    auto opened = simulation->open_camera(request, [](auto) {});
    EXPECT_TRUE(opened.ok()) << opened.error().to_string();
    stream = std::move(*opened);
  }
  EXPECT_TRUE(simulation->run_until(int64_t(time * 200 + 0.5)).ok());
  return simulation->latest().hash();
}

void check(World (*make)(const TempFolder&), double time, std::initializer_list<double> speeds) {
  const TempFolder folder;
  const World world = make(folder);
  const uint64_t reference = hash_at(world, time, {}, false);
  const int threads_before = thread_count();
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    EXPECT_EQ(hash_at(world, time, {}, false), reference) << threads << " threads";
  }
  set_thread_count(threads_before);
  EXPECT_EQ(hash_at(world, time, {}, true), reference) << "with a camera";
  for (const double speed : speeds) {
    EXPECT_EQ(hash_at(world, time, {.pace = Pace::kRealTime, .speed = speed}, false), reference)
        << speed << " times real time";
  }
}

TEST(EffectsHash, OfASecondOfFireIsTheSame) { check(burning_room, 1, {1, 10}); }
TEST(EffectsHash, OfASecondOfAllEffectsIsTheSame) { check(garden, 1, {1, 10}); }
// Each is twelve minutes, most of which are waited for.
TEST(EffectsHashOfMinutes, DISABLED_SweepAMinuteOfFireIsTheSame) {
  check(burning_room, 60, {1, 0.1});
}
TEST(EffectsHashOfMinutes, DISABLED_SweepAMinuteOfAllEffectsIsTheSame) {
  check(garden, 60, {1, 0.1});
}

}  // namespace
}  // namespace gloam
