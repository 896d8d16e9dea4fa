// Checkpoints: whoever goes on from one has the bits of the run it was taken of, by a copy and by
// stepping again.

#include "gloam/world.h"
#include "scene/test/temp_folder.h"
#include "sim/state/state_layout.h"
#include "test_world.h"

namespace gloam {
namespace {

/// RandomController that can be copied.
class CopiedController final : public Controller {
 public:
  void reset(const mjModel*, const mjData*) override { sum_ = 0; }
  void control(const ControlInputs& in) override {
    for (int i = 0; i < in.model->nu; ++i) {
      sum_ += 0.01 * random_control(in.step, i) + 1e-3 * in.data->qpos[0];
      in.data->ctrl[i] = sum_;
    }
  }
  std::unique_ptr<Controller> clone() const override {
    return std::make_unique<CopiedController>(*this);
  }

 private:
  double sum_ = 0;
};

constexpr Rational kControlRate = {250, 1};

/// The rich model, whose robot has a controller of the test's.
std::shared_ptr<CompiledWorld> controlled_world() {
  auto world = world_from_mjcf(kRichModel);
  world->robots[0].options.controller = {.type = "of the test", .rate = kControlRate};
  return world;
}

template <class C>
Result<std::unique_ptr<Controller>> make_one(const std::shared_ptr<const CompiledWorld>&, int,
                                             const ControllerOptions&) {
  return std::unique_ptr<Controller>(std::make_unique<C>());
}

template <class C>
std::unique_ptr<Simulator> driven(std::shared_ptr<const CompiledWorld> world) {
  SimulatorOptions options = lockstep();
  options.makers.controller = make_one<C>;
  auto sim = make_simulator(std::move(world), std::move(options));
  EXPECT_TRUE(sim->add_controller(0, std::make_unique<C>(), kControlRate).ok());
  sim->start();
  return sim;
}

Body body(const CompiledWorld& world, const std::string& name) {
  return {mj_name2id(world.model.get(), mjOBJ_BODY, name.c_str()), world.serial};
}

/// Pushes, drags, live fields: the marks that Commands leave.
void disturb(Simulator& sim, int64_t step, const std::string& prefix = "") {
  const CompiledWorld& world = *sim.world();
  ASSERT_TRUE(sim.post({step, SetWrench{body(world, prefix + "ball"), {0.1, 0, 1}, {}}}).ok());
  ASSERT_TRUE(
      sim.post({step, DragBody{body(world, prefix + "base"), {0, 0, .05}, {.2, 0, 1}}}).ok());
  ASSERT_TRUE(sim.post({step + 20, SetLiveField{LiveFieldId::kGravity, 0, {1, 0, -8}}}).ok());
  ASSERT_TRUE(sim.post({step + 30, SetLiveField{LiveFieldId::kBodyMass, 1, {1.5}}}).ok());
}

template <class C>
void expect_the_same_tail(bool copied) {
  const auto world = controlled_world();
  auto sim = driven<C>(world);
  ASSERT_TRUE(sim->step(40).ok());
  disturb(*sim, 60);
  ASSERT_TRUE(sim->step(100).ok());
  const auto checkpoint = *sim->checkpoint();
  EXPECT_EQ(checkpoint->copy != nullptr, copied);
  const uint64_t there = sim->latest().hash();
  disturb(*sim, 150);
  ASSERT_TRUE(sim->step(100).ok());
  const uint64_t end = sim->latest().hash();
  const std::vector<double> sensors = sim->latest().data().sensordata;

  const auto go_on = [&](Simulator& other) {
    ASSERT_TRUE(other.restore(*checkpoint).ok());
    EXPECT_EQ(other.latest().step(), 140);
    EXPECT_EQ(other.latest().hash(), there);
    disturb(other, 150);
    ASSERT_TRUE(other.step(100).ok());
    EXPECT_EQ(other.latest().hash(), end);
    EXPECT_EQ(other.latest().data().sensordata, sensors);
  };
  go_on(*sim);
  go_on(*sim);  // as often as one likes
  auto fresh = driven<C>(world);
  go_on(*fresh);
  // Then another way: another end.
  ASSERT_TRUE(fresh->restore(*checkpoint).ok());
  ASSERT_TRUE(fresh->step(100).ok());
  EXPECT_NE(fresh->latest().hash(), end);
}

TEST(Checkpoint, CopyGoesOnWithTheSameBits) { expect_the_same_tail<CopiedController>(true); }
TEST(Checkpoint, SteppedAgainGoesOnWithTheSameBits) {
  expect_the_same_tail<RandomController>(false);
}

TEST(Checkpoint, OfACheckpointsBranchIsWholeToo) {
  const auto world = controlled_world();
  auto sim = driven<RandomController>(world);
  disturb(*sim, 10);
  ASSERT_TRUE(sim->step(50).ok());
  const auto first = *sim->checkpoint();
  ASSERT_TRUE(sim->restore(*first).ok());
  disturb(*sim, 60);
  ASSERT_TRUE(sim->step(50).ok());
  const auto second = *sim->checkpoint();
  const uint64_t hash = sim->latest().hash();
  auto fresh = driven<RandomController>(world);
  ASSERT_TRUE(fresh->restore(*second).ok());
  EXPECT_EQ(fresh->latest().hash(), hash);
}

std::shared_ptr<const CompiledWorld> world_of_file(const std::filesystem::path& model) {
  return World::compile(load_scene(model).value()).value().compiled();
}

// The run keeps the source of the World that it has left, and the checkpoint compiles it again.
TEST(Checkpoint, LeadsThroughARecompile) {
  const TempFolder folder;
  folder.write("rich.xml", kRichModel);
  const auto file = folder.write("scene.toml", R"([[robot]]
name = "rich"
file = "rich.xml"
[robot.controller]
type = "joint_position"
rate = 250)");
  const auto world = world_of_file(file), other = world_of_file(file);
  auto sim = driven<RandomController>(world);
  disturb(*sim, 10, "rich/");
  ASSERT_TRUE(sim->step(50).ok());
  ASSERT_TRUE(sim->recompile(other, *make_controllers(other, {make_one<RandomController>})).ok());
  disturb(*sim, 60, "rich/");
  ASSERT_TRUE(sim->step(50).ok());
  const auto checkpoint = *sim->checkpoint();
  const uint64_t hash = sim->latest().hash();
  ASSERT_EQ(checkpoint->record.chapters.size(), 2u);
  auto fresh = driven<RandomController>(world);
  ASSERT_TRUE(fresh->restore(*checkpoint).ok());
  EXPECT_EQ(fresh->latest().hash(), hash);
  EXPECT_EQ(fresh->world(), other);
}

TEST(Checkpoint, ForgetsWhatWasBeforeAReset) {
  auto sim = driven<RandomController>(controlled_world());
  disturb(*sim, 10);
  ASSERT_TRUE(sim->step(50).ok());
  ASSERT_TRUE(sim->reset().ok());
  ASSERT_TRUE(sim->step(5).ok());
  EXPECT_TRUE((*sim->checkpoint())->record.commands.empty());
}

TEST(Checkpoint, StepHookThatIsNotRepeatedIsToldOf) {
  auto sim = driven<RandomController>(controlled_world());
  ASSERT_TRUE(sim->set_step_hook([](const mjModel*, mjData* d) { d->qvel[0] += 1e-3; }).ok());
  ASSERT_TRUE(sim->step(50).ok());
  const auto checkpoint = *sim->checkpoint();
  const uint64_t before = sim->latest().hash();
  const Status restored = sim->restore(*checkpoint);
  ASSERT_FALSE(restored.ok());
  EXPECT_NE(restored.error().to_string().find("state hash"), std::string::npos);
  EXPECT_EQ(sim->latest().hash(), before);
}

TEST(Checkpoint, RefusesAnotherTimestepAndAFailedSimulation) {
  auto sim = driven<RandomController>(controlled_world());
  ASSERT_TRUE(sim->step(5).ok());
  const auto checkpoint = *sim->checkpoint();
  auto slower = make_simulator(controlled_world(), {.timestep = 0.01, .pace = Pace::kLockstep});
  slower->start();
  EXPECT_FALSE(slower->restore(*checkpoint).ok());
  ASSERT_TRUE(
      sim->set_step_hook([](const mjModel*, mjData* d) { d->qvel[0] = std::nan(""); }).ok());
  EXPECT_FALSE(sim->step(2).ok());
  EXPECT_FALSE(sim->checkpoint().ok());
  // Going back heals it, as a reset does.
  ASSERT_TRUE(sim->set_step_hook({}).ok());
  ASSERT_TRUE(sim->restore(*checkpoint).ok());
  EXPECT_TRUE(sim->step(5).ok());
}

TEST(Checkpoint, StreamsGoOnInANewRun) {
  auto sim = driven<CopiedController>(controlled_world());
  auto queue = *sim->subscribe({.rate = {50, 1}, .required = true, .capacity = 64});
  ASSERT_TRUE(sim->step(40).ok());
  const auto checkpoint = *sim->checkpoint();
  ASSERT_TRUE(sim->step(20).ok());
  ASSERT_TRUE(sim->restore(*checkpoint).ok());
  ASSERT_TRUE(sim->step(20).ok());
  std::vector<std::pair<int64_t, int64_t>> seen;  // run, step
  while (const Snapshot s = queue->try_next()) seen.push_back({s.data().run, s.step()});
  const std::vector<std::pair<int64_t, int64_t>> wanted = {
      {0, 0}, {0, 10}, {0, 20}, {0, 30}, {0, 40}, {0, 50}, {0, 60}, {1, 40}, {1, 50}, {1, 60}};
  EXPECT_EQ(seen, wanted);
}

}  // namespace
}  // namespace gloam
