// Nobody looks, nothing is drawn: counts of what is made for readers of numbers alone.

#include "runtime/log/log_recorder.h"
#include "runtime/log/wanted_topics.h"
#include "scenes.h"
#include "topics/topic_table.h"

namespace gloam {
namespace {

const char* const kMuchToSee = R"(
[environment]
file = "place.xml"
[[water]]
name = "pool"
position = [0, 0, -0.2]
size = [3, 3]
depth = 1
wave_height = 0.05
wave_period = 1
[[agent]]
name = "bather"
behavior = "stand"
position = [3, 3, 0]
[[camera]]
name = "eye"
position = [4, 0, 2]
look_at = [0, 0, 0]
imager = { auto_exposure = {} }
)";

World much_to_see(const TempFolder& folder) {
  folder.write("place.xml", R"(<mujoco><worldbody><geom type="plane" size="9 9 .1"/>
    <body name="raft"><freejoint/><geom type="box" size=".3 .3 .1" density="500"/>
    <site name="s"/></body></worldbody><sensor><accelerometer name="imu" site="s"/></sensor>
    </mujoco>)");
  return compile_text(folder, "scene.toml", kMuchToSee);
}

TEST(Unseen, NoTopicOfAnInstantMeshesSurfacesOrSkins) {
  const TempFolder folder;
  const World world = much_to_see(folder);
  const auto simulation = simulate(world);
  ASSERT_TRUE(simulation->step(10).ok());
  const auto table = make_topic_table(world.compiled());
  ASSERT_TRUE(table.ok()) << table.error().to_string();
  auto solver = *PoseSolver::create(world.compiled());
  const Snapshot now = simulation->latest();
  int encoded = 0, bytes = 0;
  for (const Topic& topic : *table) {
    const auto* make = std::get_if<InstantEncoderMaker>(&topic.code);
    const auto* ready = std::get_if<InstantEncoder>(&topic.code);
    if (make == nullptr && ready == nullptr) continue;
    TopicInstant instant(now, *solver);
    MessageBytes message;
    const InstantEncoder encode = make != nullptr ? (*make)() : *ready;
    ASSERT_TRUE(encode(topic.info, instant, &message).ok()) << topic.info.name;
    ++encoded, bytes += static_cast<int>(message.size());
  }
  EXPECT_GT(encoded, 3);
  EXPECT_GT(bytes, 500);
  EXPECT_EQ(solver->meshed(), 0);
}

TEST(Unseen, AskingForTheWhereaboutsOfABodyMeshesNothing) {
  const TempFolder folder;
  const World world = much_to_see(folder);
  auto solver = *PoseSolver::create(world.compiled());
  const auto simulation = simulate(world);
  PoseFrame frame;
  ASSERT_TRUE(solver->solve(simulation->latest(), frame).ok());
  EXPECT_GT(frame.vertices.size(), 10000u) << "what a picture takes";
  ASSERT_TRUE(solver->solve_bodies(simulation->latest(), frame).ok());
  EXPECT_TRUE(frame.vertices.empty());
}

// Automatic exposure renders small pictures, which a log of numbers does not need.
TEST(Unseen, ALogOfNumbersMetersNoCamera) {
  const TempFolder folder;
  const World world = much_to_see(folder);
  const auto logs = [&](std::vector<std::string> topics) {
    LogRequest request;
    request.topics = std::move(topics);
    const auto pictures = logs_pictures(world, request);
    EXPECT_TRUE(pictures.ok()) << pictures.error().to_string();
    return pictures.ok() && *pictures;
  };
  EXPECT_FALSE(logs({"/tf", "/imu"}));
  EXPECT_TRUE(logs({"/tf", "/eye/*"}));
  EXPECT_TRUE(logs({})) << "the usual log has videos";
}

}  // namespace
}  // namespace gloam
