// Images of World::snapshot: of the same state as a simulation, and of effects that have not begun.

#include "gloam/render.h"
#include "gloam/snapshot.h"
#include "instant/pose_frame.h"
#include "scenes.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {
namespace {

CameraRequest request_of(const std::string& camera) {
  CameraRequest request;
  request.camera = camera;
  request.width = 32, request.height = 24;
  request.outputs = {"radiance", "depth", "motion"};
  request.render.spp = 2;
  request.render.denoise = false;
  return request;
}

std::span<const double> qpos_of(const Snapshot& snapshot, int nq) {
  return snapshot.state().subspan(1, static_cast<size_t>(nq));  // after the time
}

TEST(Configuration, HasTheImageOfASimulationInThisState) {
  const TempFolder folder;
  const World world = flight(folder);
  const auto simulation = simulate(world);
  ASSERT_TRUE(simulation->step(100).ok());
  const Snapshot now = simulation->latest();
  const Result<Snapshot> same = world.snapshot(qpos_of(now, world.info().nq), now.time());
  ASSERT_TRUE(same.ok()) << same.error().to_string();
  auto renderer = SceneRenderer::create(world), other = SceneRenderer::create(world);
  ASSERT_TRUE(renderer.ok() && other.ok());
  const auto expected = renderer->render({&now, 1}, request_of("a/rider"));
  const auto frame = other->render({&*same, 1}, request_of("a/rider"));
  ASSERT_TRUE(expected.ok() && frame.ok());
  EXPECT_EQ((*frame)->depth, (*expected)->depth);
  EXPECT_EQ((*frame)->radiance, (*expected)->radiance);
}

TEST(Configuration, HasNoMotionFromAnother) {
  const TempFolder folder;
  const World world = flight(folder);
  const std::vector<double> here = {0, 0, 0, 1, 0, 0, 0}, there = {0.5, 0, 0, 1, 0, 0, 0};
  auto renderer = SceneRenderer::create(world);
  ASSERT_TRUE(renderer.ok());
  for (const auto& qpos : {here, there}) {
    const Snapshot snapshot = *world.snapshot(qpos);
    const auto frame = renderer->render({&snapshot, 1}, request_of("a/fixed"));
    ASSERT_TRUE(frame.ok()) << frame.error().to_string();
    for (const float flow : (*frame)->motion) ASSERT_EQ(flow, 0);
  }
}

TEST(Configuration, EffectsHaveNotBegun) {
  const TempFolder folder;
  folder.write("yard.xml", R"(<mujoco><option timestep="0.005"/><worldbody>
    <geom type="plane" size="9 9 .1"/><light pos="0 0 3"/>
    <body name="ball" pos="0 0 .5"><freejoint/><geom size=".1"/></body></worldbody></mujoco>)");
  const World world = compile_text(folder, "yard.toml", R"(
[environment]
file = "yard.xml"
[weather]
wind = 4
[[gas]]
name = "air"
position = [0, 0, 1]
size = [2, 2, 2]
voxel = 0.2
[[smoke]]
name = "pot"
position = [0, 0, 0.3]
size = [0.4, 0.4, 0.2]
rate = 0.01
[[soil]]
name = "sand"
position = [2, 0, 0]
size = [1, 1]
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
behavior = "stand"
[[camera]]
name = "eye"
position = [-3, -1.8, 1.4]
look_at = [0.5, 0.5, 0]
)");
  const std::vector<double> qpos = {0, 0, 1, 1, 0, 0, 0};
  const Result<Snapshot> made = world.snapshot(qpos, 1.0);
  ASSERT_TRUE(made.ok()) << made.error().to_string();
  Instant instant;
  ASSERT_TRUE(instant.solve(*made).ok());
  const auto solver = PoseSolver::create(world.compiled());
  PoseFrame frame;
  ASSERT_TRUE(solver.ok() && (*solver)->solve(*made, frame).ok());
  ASSERT_EQ(frame.fields.size(), 1u);
  EXPECT_EQ(frame.fields[0].density, nullptr) << "the air is clear";
  EXPECT_FALSE(frame.vertices.empty()) << "the pool has its waves";
  auto renderer = SceneRenderer::create(world);
  ASSERT_TRUE(renderer.ok());
  const auto image = renderer->render({&*made, 1}, request_of("eye"));
  ASSERT_TRUE(image.ok()) << image.error().to_string();
}

}  // namespace
}  // namespace gloam
