#include "runtime/recording/state_table.h"

#include <fmt/format.h>

#include <string_view>

#include "world/model_names.h"

namespace gloam {
namespace {

std::string name_or_number(const mjModel& m, mjtObj type, const char* kind, int id) {
  const std::string name = name_of(m, type, id);
  return name.empty() ? fmt::format("{} {}", kind, id) : name;
}

std::vector<std::string_view> joint_columns(int type) {
  switch (type) {
    case mjJNT_HINGE:
      return {"q_rad", "v_radps"};
    case mjJNT_SLIDE:
      return {"q_m", "v_mps"};
    case mjJNT_BALL:
      return {"qw", "qx", "qy", "qz", "wx_radps", "wy_radps", "wz_radps"};
    default:
      return {"x_m",    "y_m",    "z_m",    "qw",       "qx",       "qy",      "qz",
              "vx_mps", "vy_mps", "vz_mps", "wx_radps", "wy_radps", "wz_radps"};
  }
}

}  // namespace

StateTable::StateTable(const CompiledWorld& world, uint64_t serial) : serial_(serial) {
  columns_.emplace_back("time_s");
  add_joints(*world.model);
  add_controls(*world.model);
  add_bodies(world);
}

void StateTable::add_joints(const mjModel& m) {
  for (int j = 0; j < static_cast<int>(m.njnt); ++j) {
    joints_.push_back({j, serial_});
    const std::string name = name_or_number(m, mjOBJ_JOINT, "joint", j);
    for (const std::string_view column : joint_columns(m.jnt_type[j]))
      columns_.push_back(fmt::format("{}.{}", name, column));
  }
}

void StateTable::add_controls(const mjModel& m) {
  controls_ = static_cast<size_t>(m.nu);
  std::vector<std::string> names(controls_);
  for (int a = 0; a < static_cast<int>(m.nactuator); ++a) {
    const std::string name = name_or_number(m, mjOBJ_ACTUATOR, "actuator", a);
    const int count = m.actuator_ctrlnum[a];
    for (int i = 0; i < count; ++i)
      names[static_cast<size_t>(m.actuator_ctrladr[a] + i)] =
          count == 1 ? name + ".control" : fmt::format("{}.control_{}", name, i);
  }
  columns_.insert(columns_.end(), names.begin(), names.end());
}

void StateTable::add_bodies(const CompiledWorld& world) {
  const mjModel& m = *world.model;
  const bool bare = !world.scene.bare_model.empty();
  for (int b = 1; b < static_cast<int>(m.nbody); ++b) {
    const std::string name = name_of(m, mjOBJ_BODY, b);
    bool of_robot = bare;
    for (const RobotInstance& robot : world.robots) {
      const bool below = robot.root_body > 0 && m.body_rootid[b] == m.body_rootid[robot.root_body];
      if (below || (!robot.prefix.empty() && name.starts_with(robot.prefix))) of_robot = true;
    }
    if (!of_robot) continue;
    bodies_.push_back(b);
    const std::string label = name_or_number(m, mjOBJ_BODY, "body", b);
    for (const char* column : {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"})
      columns_.push_back(fmt::format("{}.body.{}", label, column));
  }
}

Result<std::vector<double>> StateTable::row(const Snapshot& snapshot) {
  std::vector<double> row = {snapshot.time()};
  for (const Joint& joint : joints_) {
    const JointState state = snapshot[joint];
    row.insert(row.end(), state.qpos.begin(), state.qpos.end());
    row.insert(row.end(), state.qvel.begin(), state.qvel.end());
  }
  GLOAM_TRY_STATUS(instant_.solve(snapshot));
  GLOAM_TRY(const std::vector<double> controls, instant_.value("ctrl"));
  row.insert(row.end(), controls.begin(), controls.end());
  for (const int body : bodies_) {
    GLOAM_TRY(const BodyState state, instant_.body({body, serial_}));
    const Pose& X = state.X_WB;
    row.insert(row.end(), {X.p.x, X.p.y, X.p.z, X.q.w, X.q.x, X.q.y, X.q.z});
  }
  return row;
}

}  // namespace gloam
