// gloam/scene/robot_model.h: settings for models from elsewhere.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>

#include "base/files.h"
#include "control/guess/guess_text.h"
#include "gloam/scene.h"
#include "gloam/world.h"
#include "scene/files/model_path.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

/// A World with this robot alone.
Result<World> compile_alone(const RobotOptions& robot, const FileAccess& access) {
  Scene scene;
  scene.access = access;
  scene.robots.push_back(robot);
  return World::compile(scene);
}

/// "home" or "stand" among the keyframes, else the first that has a name.
std::string choose_keyframe(const CompiledWorld& world) {
  std::string chosen;
  for (const char* wanted : {"home", "stand", ""})
    for (int key = 0; key < static_cast<int>(world.model->nkey) && chosen.empty(); ++key) {
      const std::string name = own_name(world, mjOBJ_KEY, key);
      if (name.find(wanted) != std::string::npos) chosen = name;
    }
  return chosen;
}

/// The highest rate of at most the default that divides the model's step rate.
Rational choose_rate(double timestep) {
  const Rational usual = ControllerOptions().rate;
  Rational step;
  if (!exact_rational(timestep, &step)) return usual;
  // 1 / rate is a whole number of steps: the least that is not faster than usual.
  const int64_t per_second = usual.num * step.num;
  const int64_t steps = std::max<int64_t>(1, (step.den + per_second - 1) / per_second);
  const int64_t shared = std::gcd(step.den, step.num * steps);
  return {step.den / shared, step.num * steps / shared};
}

/// A name for the robot: letters, digits, '_' and '-' of its file's name.
std::string choose_name(const fs::path& file) {
  std::string name = file.stem().string();
  std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; });
  return name.empty() ? "robot" : name;
}

/// URDF fixes every root; an MJCF without a free joint is fixed on purpose.
bool may_float(const RobotOptions& robot) { return lower_extension(robot.file) == ".urdf"; }

struct Reading {
  World world;
  RobotTree tree;
  RobotShape shape;
};

Result<Reading> read_robot(const RobotOptions& robot, const FileAccess& access) {
  GLOAM_TRY(World world, compile_alone(robot, access));
  RobotTree tree = robot_tree(*world.compiled());
  RobotShape shape = find_shape(*world.compiled(), tree, may_float(robot));
  return Reading{std::move(world), std::move(tree), std::move(shape)};
}

bool walks_or_drives(BodyPlan plan) {
  return plan == BodyPlan::kQuadruped || plan == BodyPlan::kHumanoid ||
         plan == BodyPlan::kDiffDrive;
}

std::vector<std::string> comments_of(const fs::path& file, const RobotOptions& robot,
                                     const Reading& reading) {
  std::vector<std::string> lines = {
      fmt::format("{}, from the shape of its tree{}:", file.filename().string(),
                  robot.keyframe.empty() ? "" : " at keyframe '" + robot.keyframe + "'")};
  for (const std::string& reason : reading.shape.reasons) lines.push_back("  " + reason);
  if (robot.base == "free")
    lines.emplace_back("  URDF fixes the root, but the robot stands on its own: base = \"free\"");
  const CompiledWorld& world = *reading.world.compiled();
  std::string fingers;
  for (const int joint : reading.shape.gripper)
    fingers += " " + own_name(world, mjOBJ_JOINT, joint);
  if (!fingers.empty()) lines.push_back("  joints of the gripper:" + fingers);
  return lines;
}

}  // namespace

Result<RobotGuess> guess_robot(const fs::path& file, const FileAccess& access) {
  RobotOptions robot;
  robot.name = choose_name(file);
  robot.file = file;
  GLOAM_TRY(Reading reading, read_robot(robot, access));
  robot.keyframe = choose_keyframe(*reading.world.compiled());
  if (!robot.keyframe.empty()) {
    GLOAM_TRY(reading, read_robot(robot, access));
  }
  if (!reading.tree.is_floating && walks_or_drives(reading.shape.plan)) {
    robot.base = "free";
    if (Result<Reading> floating = read_robot(robot, access); floating.ok()) {
      reading = std::move(*floating);
    } else {
      robot.base = "model";
      reading.shape.reasons.push_back("its base stays fixed: " + floating.error().message);
    }
  }
  const CompiledWorld& world = *reading.world.compiled();
  const GuessedController controller = guess_controller(world, reading.tree, reading.shape);
  robot.controller.rate = choose_rate(world.model->opt.timestep);
  return RobotGuess{name_of(reading.shape.plan),
                    guess_text(robot, comments_of(file, robot, reading), controller)};
}

}  // namespace gloam
