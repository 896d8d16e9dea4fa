#include "sim/loop/restepper.h"

#include <utility>

#include "scene/files/mujoco_guard.h"
#include "sim/loop/next_world.h"

namespace gloam {

Result<std::unique_ptr<Restepper>> Restepper::create(RunRecord record, RobotMakers makers,
                                                     DataMaker make_data) {
  std::unique_ptr<Restepper> made(
      new Restepper(std::move(record), std::move(makers), std::move(make_data)));
  const RunRecord& run = made->record_;
  GLOAM_TRY(const auto world, run.chapters.front().compiled());
  const Rational timestep =
      exact_rational(run.timestep.value_or(double{world->model->opt.timestep}));
  GLOAM_TRY(NextWorld first, make_next_world(world, run.seed, run.timestep, {}, made->make_data_));
  std::vector<LoggedCommand> replay;
  for (const Command& command : run.commands) replay.push_back({0, command});
  made->loop_ = std::make_unique<SimLoop>(std::move(first.stepper), timestep, made->queue_,
                                          std::move(first.scene_commands), std::move(replay),
                                          made->makers_.controller);
  GLOAM_TRY(auto robots, make_controllers(world, made->makers_));
  for (RobotController& c : robots) GLOAM_TRY_STATUS(made->loop_->add_robot(std::move(c)));
  if (!run.inputs.empty()) made->repeat_inputs();
  return made;
}

// Inputs of step hooks come where the hooks wrote them.
void Restepper::repeat_inputs() {
  loop_->set_step_hook([this](const mjModel* model, mjData* data) {
    const int64_t step = loop_->stepper().step_count();
    const std::vector<StepInput>& inputs = record_.inputs;
    for (; next_input_ < inputs.size() && inputs[next_input_].step <= step; ++next_input_)
      if (inputs[next_input_].step == step) apply_input(*model, inputs[next_input_], &state_, data);
  });
}

Status Restepper::begin_chapter(const RunRecord::Chapter& chapter) {
  const std::shared_ptr<const CompiledWorld> before = loop_->stepper().shared_world();
  GLOAM_TRY(const auto world, chapter.compiled());
  GLOAM_TRY(auto robots, make_controllers(world, makers_));
  GLOAM_TRY(NextWorld next,
            make_next_world(world, record_.seed, record_.timestep, std::move(robots), make_data_));
  const Correspondence same(*before, *world);
  return loop_->exchange(next, same);
}

Status Restepper::run_until(int64_t step) {
  MujocoWarningCapture warnings;  // the first run has told them
  while (loop_->stepper().step_count() < step) {
    GLOAM_TRY_STATUS(begin_chapters());
    if (!loop_->advance()) return loop_->stepper().error();
  }
  return {};
}

bool Restepper::has_chapter_here() const {
  return next_chapter_ < record_.chapters.size() &&
         record_.chapters[next_chapter_].from == loop_->stepper().step_count();
}

Status Restepper::begin_chapters() {
  while (has_chapter_here()) GLOAM_TRY_STATUS(begin_chapter(record_.chapters[next_chapter_++]));
  return {};
}

}  // namespace gloam
