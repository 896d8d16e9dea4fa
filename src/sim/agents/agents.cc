#include "sim/agents/agents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/log.h"
#include "scene/files/mujoco_guard.h"
#include "sim/agents/brain.h"
#include "sim/loop/step_halves.h"
#include "sim/state/initial_state.h"

namespace gloam {
namespace {

constexpr Rational kMotionRate = {50, 1};  // rate of gait and bodies [Hz]
constexpr int kPlaceTries = 200;
constexpr double kMostShift = 3;  // longest shift of an agent that begins in something [m]
constexpr double kMinAgentDistance =
    0.9;  // distance at which agents of a crowd begin from each other [m]
constexpr double kMinRobotDistance = 1.5;

}  // namespace

Agents::Agents(std::shared_ptr<const CompiledWorld> world, uint64_t seed)
    : world_(std::move(world)), seed_(seed) {}

Result<std::unique_ptr<Effect>> Agents::make(const EffectParts& parts) {
  if (parts.world->agents.empty()) return std::unique_ptr<Effect>();
  std::unique_ptr<Agents> agents(new Agents(parts.world, parts.seed));
  const mjModel* model = &parts.model;
  mjData* data = &parts.data;
  GLOAM_TRY_STATUS(guarded([&] { place_at_initial_state(*parts.world, *model, data); }));
  GLOAM_TRY_STATUS(agents->prepare(parts.timestep, *model, *data));
  return std::unique_ptr<Effect>(std::move(agents));
}

Status Agents::prepare(Rational timestep, const mjModel& m, const mjData& data) {
  const NavigationOptions& o = world_->scene.navigation;
  Result<StepSchedule> decisions = StepSchedule::make(o.rate, {0, 1}, timestep);
  if (!decisions.ok()) {
    Error error = std::move(decisions).error();
    if (error.loc.line == 0) error.loc = o.loc;
    return error;
  }
  decisions_ = *decisions;
  motions_ = StepSchedule::at_most(kMotionRate, timestep);
  timestep_ = timestep.value();
  decision_time_ = 1 / o.rate.value();
  GLOAM_TRY(nav_, NavWorld::create(*world_, m, data));
  doors_ = std::make_unique<AgentDoors>(*world_, m, data);
  agents_.reserve(world_->agents.size());
  for (const AgentDescription& d : world_->agents) {
    agents_.emplace_back(d);
    splines_.push_back(d.behavior == AgentBehavior::kSpline ? AgentSpline(d.route, d.loop)
                                                            : AgentSpline());
    if (d.behavior == AgentBehavior::kSpline && d.kind != AgentKind::kPerson)
      splines_.back().plan_speeds(d.vehicle);
  }
  map_geoms(m);
  GLOAM_TRY_STATUS(read_trees());
  nav_->reset(m, data);
  return place(true);
}

void Agents::map_geoms(const mjModel& m) {
  contacts_ = std::make_unique<BodyContacts>(*world_, m);
  softens_ = contacts_->any() && has_halves(m);
  agent_of_geom_.assign(static_cast<size_t>(m.ngeom), -1);
  is_robot_geom_.assign(static_cast<size_t>(m.ngeom), false);
  for (size_t row = 0; row < agents_.size(); ++row) {
    const AgentDescription& d = *agents_[row].description;
    for (int part = 0; part < d.parts(); ++part) {
      const int body = d.body[static_cast<size_t>(part)];
      for (int g = m.body_geomadr[body]; g < m.body_geomadr[body] + m.body_geomnum[body]; ++g)
        agent_of_geom_[static_cast<size_t>(g)] = static_cast<int>(row);
    }
  }
  for (const RobotInstance& robot : world_->robots)
    for (int g = 0; robot.root_body > 0 && g < static_cast<int>(m.ngeom); ++g)
      if (m.body_rootid[m.geom_bodyid[g]] == robot.root_body)
        is_robot_geom_[static_cast<size_t>(g)] = true;
}

Status Agents::read_trees() {
  for (AgentBody& agent : agents_) {
    if (agent.description->behavior != AgentBehavior::kTree) continue;
    Result<std::shared_ptr<const BehaviorTree>> tree =
        read_behavior_tree_file(agent.description->tree);
    if (!tree.ok()) {
      Error error = std::move(tree).error();
      if (error.loc.line == 0) error.loc = agent.description->loc;
      return error;
    }
    for (const TreeNode& node : (*tree)->nodes) {
      const auto is_named = [&](const auto& things) {
        return std::any_of(things.begin(), things.end(),
                           [&](const auto& thing) { return thing.name == node.target; });
      };
      if (!node.target.empty() && !is_named(world_->robots) && !is_named(world_->agents))
        return Error{
            ErrorKind::kInput,
            fmt::format("the behaviour tree refers to '{}', which is neither a robot nor an agent",
                        node.target),
            node.loc, "omit 'target' to select the nearest robot"};
    }
    agent.tree = std::make_unique<TreeState>(*tree);
  }
  return {};
}

void Agents::stand(size_t row, const NavPoint& at, double heading) {
  AgentBody& agent = agents_[row];
  agent.motion = {};
  agent.intent = {};
  agent.vehicle = {};
  agent.force = {};
  agent.force_steps = 0;
  agent.robot_touches = false;
  agent.path.reset(at);
  if (agent.tree != nullptr) agent.tree->reset();
  AgentMotion& m = agent.motion;
  m.p = at.p;
  m.p.z = nav_->ground_below(at.p, 0.5, 0.8);
  m.heading = heading;
  m.seen_at = m.p;
  class Ground final : public GroundHeight {
   public:
    explicit Ground(const NavWorld& world) : world_(world) {}
    double at(Vec3d p) const override { return world_.ground_below(p, 0.4, 0.4); }

   private:
    const NavWorld& world_;
  };
  agent.walker.reset(agent.walk_input(0), Ground(*nav_));
  agent.find_pose(0);
  agent.before = agent.after;
}

// A place on the largest part of the mesh, away from those who have one.
bool Agents::draw_place(size_t row, NavPoint* at) const {
  const RandomStream stream = agents_[row].stream(seed_, "agent.place");
  const auto is_free = [&](Vec3d p, double apart) {
    for (size_t i = 0; i < row; ++i)
      if (norm(agents_[i].motion.p - p) < apart) return false;
    for (const NavObstacle& o : nav_->obstacles())
      if (o.is_robot && norm(flat(o.p - p)) < kMinRobotDistance + o.radius) return false;
    return true;
  };
  for (uint64_t i = 0; i < kPlaceTries; ++i) {
    *at = nav_->random_place(row, {}, stream.uniform(i, 0), stream.uniform(i, 1),
                             stream.uniform(i, 2));
    // The later half of the tries accepts half the distance, for crowded places.
    if (at->ref != 0 &&
        is_free(at->p, i < kPlaceTries / 2 ? kMinAgentDistance : kMinAgentDistance / 2))
      return true;
  }
  return false;
}

Status Agents::place(bool tell) {
  for (size_t row = 0; row < agents_.size(); ++row) {
    const AgentDescription& d = *agents_[row].description;
    NavPoint at;
    double heading = d.heading;
    if (!d.is_placed) {
      if (!draw_place(row, &at)) {
        return Error{ErrorKind::kInput,
                     fmt::format("there is no room for '{}': {:.3g} m² of walkable area, and {} "
                                 "agents placed before it",
                                 d.name, nav_->mesh_of(row).area(), row),
                     d.loc, "reduce the size of the crowd"};
      }
      heading = 2 * M_PI * agents_[row].stream(seed_, "agent.heading").uniform(0, 0);
    } else if (d.behavior == AgentBehavior::kSpline) {
      Vec3d direction;
      at.p = splines_[row].at(0, &direction);
      heading = std::atan2(direction.y, direction.x);
    } else {
      const Vec3d p = to_vec3d(d.position);
      at = nav_->mesh_of(row).nearest(p, 0.3, 1);
      if (at.ref == 0) at = nav_->mesh_of(row).nearest(p, kMostShift, 1);
      if (at.ref == 0) {
        return Error{ErrorKind::kInput,
                     fmt::format("agent '{}' starts at ({:g}, {:g}, {:g}), where there is no room "
                                 "for it, nor within {:g} m",
                                 d.name, p.x, p.y, p.z, kMostShift),
                     d.loc, "change its position, or adjust [navigation]"};
      }
      if (tell && flat_norm(at.p - p) > 0.05)
        log_warning(
            "{}:{}: agent '{}' starts at ({:g}, {:g}, {:g}), where there is no room for it; it is "
            "placed at ({:.2f}, {:.2f}, {:.2f}) instead",
            d.loc.file, d.loc.line, d.name, p.x, p.y, p.z, at.p.x, at.p.y, at.p.z);
    }
    stand(row, at, heading);
  }
  return {};
}

void Agents::begin(const mjModel& m, const mjData& data) {
  nav_->reset(m, data);
  doors_->reset();
  const Status placed = place(false);  // as at first, when there was room
  static_cast<void>(placed);
  decision_ = motion_ = 0;
  last_motion_step_ = next_motion_step_ = 0;
  planted_.assign(agents_.size(), {true, true});
}

void Agents::reset(const EffectContext& at) {
  at.events.footfalls.reserve(2 * agents_.size());
  begin(at.model, at.data);
}

void Agents::take_over(const EffectContext& at, Effect* other) {
  const int64_t step = at.step;
  const auto* before = static_cast<const Agents*>(other);
  reset(at);
  decision_ = decisions_.first_at_or_after(step + 1);
  motion_ = motions_.first_at_or_after(step + 1);
  last_motion_step_ = step;
  next_motion_step_ = motions_.step_of(motion_);
  if (before == nullptr) return;
  for (size_t row = 0; row < agents_.size(); ++row) {
    AgentBody& agent = agents_[row];
    const auto same = [&](const AgentBody& other) {
      return other.description->name == agent.description->name &&
             other.description->kind == agent.description->kind &&
             other.description->seed == agent.description->seed &&
             other.description->person.height == agent.description->person.height;
    };
    const auto found = std::find_if(before->agents_.begin(), before->agents_.end(), same);
    if (found == before->agents_.end()) continue;
    agent.motion = found->motion;
    agent.walker = found->walker;
    agent.vehicle = found->vehicle;
    // The goal and the path may no longer exist: both are searched again.
    agent.motion.has_goal = 0;
    agent.path.reset(nav_->mesh_of(row).nearest(agent.motion.p, 1.5, 1));
    agent.after = found->after;
    const double length =
        static_cast<double>(before->next_motion_step_ - before->last_motion_step_);
    const double t =
        length > 0 ? static_cast<double>(step - before->last_motion_step_) / length : 1;
    for (size_t part = 0; part < kPersonParts; ++part)
      agent.before[part] = between(found->before[part], found->after[part], t);
    for (size_t part = static_cast<size_t>(agent.description->parts()); part < kPersonParts; ++part)
      agent.before[part] = agent.after[part];
  }
}

void Agents::apply_loads(const EffectContext& at) {
  if (at.is_halved) contacts_->soften(at.model, &at.data);
}

void Agents::read_contacts(const mjModel& m, const mjData& data) {
  for (AgentBody& agent : agents_) ++agent.force_steps;
  for (int i = 0; i < static_cast<int>(data.ncon); ++i) {
    const mjContact& contact = data.contact[i];
    for (int side = 0; side < 2; ++side) {
      const int geom = contact.geom[side];
      const int row = geom >= 0 ? agent_of_geom_[static_cast<size_t>(geom)] : -1;
      if (row < 0) continue;
      mjtNum wrench[6], force[3];
      mj_contactForce(&m, &data, i, wrench);
      mju_mulMatTVec3(force, contact.frame, wrench);
      // On the second geom as it is, on the first the other way round.
      const double sign = side == 1 ? 1 : -1;
      AgentBody& agent = agents_[static_cast<size_t>(row)];
      agent.force += Vec3d{force[0], force[1], force[2]} * sign;
      const int other = contact.geom[1 - side];
      agent.robot_touches |= other >= 0 && is_robot_geom_[static_cast<size_t>(other)];
    }
  }
}

void Agents::decide(int64_t step, const mjModel& m, const mjData& data) {
  const bool changed = nav_->follow(m, data, step == 0 ? 0 : decision_time_);
  const double time = time_of(step);
  const AgentSurroundings around{*world_, *nav_, agents_, splines_, seed_, time, decision_time_};
  for (size_t row = 0; row < agents_.size(); ++row) {
    AgentBody& agent = agents_[row];
    if (changed && !agent.path.is_valid(nav_->mesh_of(row))) {
      agent.path.reset(nav_->mesh_of(row).nearest(agent.motion.p, 1.5, 1));
      agent.motion.has_goal = 0;
    }
    if (changed && agent.motion.is_whole == 0) agent.motion.has_goal = 0;  // it may be free now
    decide_intent(around, row, &agent);
  }
  doors_->decide(data, agents_, nav_->obstacles(), decision_time_);
  for (size_t row = 0; row < agents_.size(); ++row) agents_[row].motion.wanted = steer(row, data);
}

void Agents::move(int64_t step) {
  last_motion_step_ = step;
  next_motion_step_ = motions_.step_of(++motion_);
  const double dt = time_of(next_motion_step_ - step), time = time_of(next_motion_step_);
  for (size_t row = 0; row < agents_.size(); ++row) {
    AgentBody& agent = agents_[row];
    agent.before = agent.after;
    move_body(dt, time, nav_->mesh_of(row), *nav_, &agent);
    agent.find_pose(time);
  }
}

void Agents::advance(const EffectContext& at) {
  if (at.step > 0) read_contacts(at.model, at.data);
  if (at.step == decisions_.step_of(decision_)) {
    decide(at.step, at.model, at.data);
    for (const AgentBody& agent : agents_) at.hash = agent.hash(at.hash);
    at.hash = doors_->hash(nav_->hash(at.hash));
    ++decision_;
  }
  if (at.step == motions_.step_of(motion_)) move(at.step);
  write_state(at.step, &at.data);
  if (at.step > 0) find_footfalls(at.data, &at.events.footfalls);
}

void Agents::find_footfalls(const mjData& data, std::vector<Footfall>* footfalls) {
  for (size_t row = 0; row < agents_.size(); ++row) {
    const AgentBody& agent = agents_[row];
    const AgentDescription& d = *agent.description;
    if (d.kind != AgentKind::kPerson) continue;
    for (int foot = 0; foot < 2; ++foot) {
      bool& was = planted_[row][static_cast<size_t>(foot)];
      const bool is = agent.walker.is_planted(foot);
      if (is && !was) {
        const double* p = data.mocap_pos + 3 * d.mocap[foot == 0 ? kFootL : kFootR];
        footfalls->push_back({static_cast<int>(row),
                              {p[0], p[1], p[2]},
                              d.person.mass,
                              std::hypot(agent.motion.velocity.x, agent.motion.velocity.y)});
      }
      was = is;
    }
  }
}

void Agents::write_state(int64_t step, mjData* data) const {
  const double length = static_cast<double>(next_motion_step_ - last_motion_step_);
  const double t = length > 0 ? static_cast<double>(step - last_motion_step_) / length : 1;
  for (const AgentBody& agent : agents_) {
    const int parts = agent.description->parts();
    for (int part = 0; part < parts; ++part) {
      const auto i = static_cast<size_t>(part);
      const PartPose pose = between(agent.before[i], agent.after[i], t);
      const int mocap = agent.description->mocap[i];
      mjtNum *p = data->mocap_pos + 3 * mocap, *q = data->mocap_quat + 4 * mocap;
      p[0] = pose.p.x, p[1] = pose.p.y, p[2] = pose.p.z;
      q[0] = pose.q.w, q[1] = pose.q.x, q[2] = pose.q.y, q[3] = pose.q.z;
    }
  }
  doors_->drive(data);
}

}  // namespace gloam
