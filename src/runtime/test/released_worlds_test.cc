// Worlds of 100 MB that a simulation has left are freed, whatever has read them; a checkpoint that
// went through them compiles them again.

#include <gmock/gmock.h>

#include "base/cache_writer.h"
#include "base/files.h"
#include "scenes.h"
#include "world/world.h"

namespace gloam {
namespace {

class LeftWorlds : public testing::Test {
 protected:
  LeftWorlds() : world_(flight(folder_)) {}

  World other(int i) {
    Scene scene = world_.compiled()->written;
    EXPECT_TRUE(set_option(scene, "sim.duration", std::to_string(i + 1)).ok());
    return *World::compile(scene);
  }

  TempFolder folder_;
  World world_;
};

TEST_F(LeftWorlds, AreFreedUnderOpenStreams) {
  const auto simulation = simulate(world_, {.pace = Pace::kLockstep});
  CameraRequest request{.camera = "a/fixed", .rate = {500, 1}, .width = 8, .height = 6};
  request.outputs = {"depth"};
  request.required = true;
  auto camera = simulation->open_camera(request, [](auto) {});
  ASSERT_TRUE(camera.ok());
  TopicRequest topics{.topics = {"/tf", "/clock"}, .required = true};
  auto feed = simulation->open_topics(topics, [](const auto&) {});
  ASSERT_TRUE(feed.ok()) << feed.error().to_string();
  std::vector<std::weak_ptr<const CompiledWorld>> left;
  world_ = {};
  for (int i = 0; i < 5; ++i) {
    left.push_back(simulation->world().compiled());
    World next = [&] {
      Scene scene = simulation->world().compiled()->written;
      EXPECT_TRUE(set_option(scene, "sim.duration", std::to_string(i + 1)).ok());
      return *World::compile(scene);
    }();
    ASSERT_TRUE(simulation->recompile(next).ok());
    static_cast<void>(simulation->body_pose(*simulation->world().find_body("a/ball")));
    static_cast<void>(simulation->topics());
    ASSERT_TRUE(simulation->step(20).ok());
    (*camera)->flush();
    (*feed)->flush();
  }
  finish_cache_writes();  // of Worlds whose compilation took long
  // The feed keeps the table of topics, and with it the World, in which it was opened.
  for (size_t i = 1; i < left.size(); ++i) EXPECT_TRUE(left[i].expired()) << "World " << i;
}

TEST_F(LeftWorlds, ACheckpointStepsThroughThemAgain) {
  const auto first = simulate(world_, {.pace = Pace::kLockstep});
  ASSERT_TRUE(first->step(10).ok());
  ASSERT_TRUE(first->recompile(other(1)).ok());
  ASSERT_TRUE(first->step(10).ok());
  ASSERT_TRUE(first->recompile(other(2)).ok());
  ASSERT_TRUE(first->step(10).ok());
  const Checkpoint checkpoint = *first->checkpoint();
  const auto second = simulate(other(9), {.pace = Pace::kLockstep});
  const Status restored = second->restore(checkpoint);  // another World: it is stepped again
  ASSERT_TRUE(restored.ok()) << restored.error().to_string();
  EXPECT_EQ(second->stats().hash, first->stats().hash);
}

TEST_F(LeftWorlds, ACheckpointWhoseFilesHaveChangedSaysSo) {
  const auto first = simulate(world_, {.pace = Pace::kLockstep});
  ASSERT_TRUE(first->step(10).ok());
  ASSERT_TRUE(first->recompile(other(1)).ok());
  ASSERT_TRUE(first->step(10).ok());
  const Checkpoint checkpoint = *first->checkpoint();
  const auto second = simulate(other(9), {.pace = Pace::kLockstep});
  folder_.write(
      "flight.xml",
      "<mujoco><worldbody><body name=\"ball\"><freejoint name=\"ball\"/><geom size=\".2\" "
      "mass=\"1\"/></body></worldbody><keyframe><key name=\"go\" qpos=\"0 0 0 1 0 0 "
      "0\"/></keyframe></mujoco>");
  const Status restored = second->restore(checkpoint);
  ASSERT_FALSE(restored.ok());
  EXPECT_THAT(restored.error().to_string(), testing::HasSubstr("files have changed"));
}

}  // namespace
}  // namespace gloam
