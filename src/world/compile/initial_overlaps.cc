#include "world/compile/initial_overlaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scene/files/mujoco_guard.h"
#include "world/model_memory.h"
#include "world/model_names.h"

namespace gloam {
namespace {

constexpr double kMaxPenetration = 0.01, kMaxDepthBelowFloor = 0.05;  // [m]

class Overlaps {
 public:
  explicit Overlaps(const CompiledWorld& world) : world_(world), m_(*world.model) {}

  std::vector<Error> find() {
    const DataPtr data = make_data(m_);
    mjData* d = data.get();
    const MujocoWarningCapture warnings;  // a warning that there are many contacts
    const bool is_done = try_mujoco([&] {
      world_.initial_key >= 0 ? mj_resetDataKeyframe(&m_, d, world_.initial_key)
                              : mj_resetData(&m_, d);
      mj_kinematics(&m_, d);
      mj_comPos(&m_, d);
      mj_flex(&m_, d);
      mj_collision(&m_, d);
    });
    if (!is_done) return {};
    for (int i = 0; i < static_cast<int>(d->ncon); ++i) add(d->contact[i]);
    for (const auto& [thing, deepest] : deepest_) tell(thing, deepest);
    find_sunken(*d);
    return std::move(out_);
  }

 private:
  struct Deepest {
    double depth = 0;
    std::string in;
  };

  /// -1 = of none.
  int robot_of(int body) const {
    for (int b = body; b > 0; b = m_.body_parentid[b]) {
      const std::string name = name_of(m_, mjOBJ_BODY, b);
      for (size_t i = 0; i < world_.robots.size(); ++i)
        if (b == world_.robots[i].root_body || name.starts_with(world_.robots[i].prefix))
          return static_cast<int>(i);
    }
    return -1;
  }

  bool is_agent(int body) const {
    for (const AgentDescription& agent : world_.agents)
      for (int part = 0; part < agent.parts(); ++part)
        if (agent.body[static_cast<size_t>(part)] == body) return true;
    return false;
  }

  std::string what_is(int geom) const {
    const int body = m_.geom_bodyid[geom];
    std::string name = body > 0 ? name_of(m_, mjOBJ_BODY, body) : "";
    if (name.empty()) name = name_of(m_, mjOBJ_GEOM, geom);
    return name.empty() ? "the environment" : fmt::format("'{}'", name);
  }

  void add(const mjContact& contact) {
    if (!(contact.dist < -kMaxPenetration) || contact.geom[0] < 0 || contact.geom[1] < 0) return;
    int geoms[2] = {contact.geom[0], contact.geom[1]};
    for (const int geom : geoms)  // agents are put where there is room (sim/agents)
      if (is_agent(m_.geom_bodyid[geom])) return;
    const auto moves = [&](int geom) { return m_.body_weldid[m_.geom_bodyid[geom]] != 0; };
    int robots[2] = {robot_of(m_.geom_bodyid[geoms[0]]), robot_of(m_.geom_bodyid[geoms[1]])};
    if (robots[0] >= 0 && robots[0] == robots[1]) return;
    // The first is the one to be moved: a robot, otherwise the moving body.
    if ((robots[0] < 0 && robots[1] >= 0) || (robots[0] < 0 && robots[1] < 0 && !moves(geoms[0]))) {
      std::swap(geoms[0], geoms[1]);
      std::swap(robots[0], robots[1]);
    }
    if (robots[0] < 0 && !moves(geoms[0])) return;
    const int root = m_.body_rootid[m_.geom_bodyid[geoms[0]]];
    if (robots[0] < 0 && robots[1] < 0 && root == m_.body_rootid[m_.geom_bodyid[geoms[1]]] &&
        root > 0)
      return;  // parts of one thing
    Deepest& deepest = deepest_[{robots[0], robots[0] < 0 ? root : 0}];
    if (-contact.dist > deepest.depth) deepest = {-contact.dist, what_is(geoms[1])};
  }

  void tell(const std::pair<int, int>& thing, const Deepest& deepest) {
    std::string title;
    SourceLoc loc;
    if (thing.first >= 0) {
      const RobotInstance& robot = world_.robots[static_cast<size_t>(thing.first)];
      title = fmt::format("robot '{}'", robot.name), loc = robot.options.loc;
    } else {
      const std::string name = name_of(m_, mjOBJ_BODY, thing.second);
      title = name.empty() ? "a body without a name" : fmt::format("'{}'", name);
      const auto look_in = [&](const auto& options, const char* kind) {
        for (const auto& o : options)
          if (o.name == name) title = fmt::format("{} '{}'", kind, name), loc = o.loc;
      };
      look_in(world_.scene.objects, "object"), look_in(world_.scene.props, "prop");
    }
    out_.push_back({ErrorKind::kInput,
                    fmt::format("{} starts {:.2g} m deep in {}", title, deepest.depth, deepest.in),
                    loc, "change its position"});
  }

  void find_sunken(const mjData& d) {
    if (world_.regions.empty()) return;
    double lowest = INFINITY;
    for (const Region& region : world_.regions) lowest = std::min(lowest, region.low.z);
    for (const RobotInstance& robot : world_.robots) {
      if (robot.root_body <= 0) continue;
      const double z = d.xpos[3 * robot.root_body + 2];
      if (z < lowest - kMaxDepthBelowFloor)
        out_.push_back({ErrorKind::kInput,
                        fmt::format("robot '{}' starts {:.2g} m below the lowest floor", robot.name,
                                    lowest - z),
                        robot.options.loc, "change its position"});
    }
  }

  const CompiledWorld& world_;
  const mjModel& m_;
  std::map<std::pair<int, int>, Deepest> deepest_;  // by robot, else by root body
  std::vector<Error> out_;
};

}  // namespace

std::vector<Error> find_initial_overlaps(const CompiledWorld& world) {
  if (!world.scene.bare_model.empty()) return {};
  return Overlaps(world).find();
}

}  // namespace gloam
