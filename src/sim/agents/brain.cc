#include "sim/agents/brain.h"

#include <fmt/format.h>

#include <limits>

#include "base/log.h"

namespace gloam {
namespace {

constexpr double kArrivalDistance = 0.3;              // from the end of a way [m]
constexpr double kLeastWander = 4;                    // [m]
constexpr double kStuckTime = 6, kMinProgress = 0.4;  // [s], [m]
constexpr double kTouchMemory = 1;                    // time that a touch is remembered for [s]
constexpr int kMaxWanderTries = 12;

bool has_arrived(const AgentBody& agent) {
  if (agent.motion.has_goal == 0) return false;
  const Vec3d to = flat(agent.path.end() - agent.motion.p);
  // Vehicles cannot turn to a point inside their turning circle: it counts as passed once it lies
  // behind.
  const double radius =
      agent.description->kind == AgentKind::kPerson ? 0 : agent.description->vehicle.turning_radius;
  return norm(to) < kArrivalDistance ||
         (norm(to) < radius && dot(to, heading_vector(agent.motion.heading)) < 0);
}

class Brain final : public TreeHost {
 public:
  Brain(const AgentSurroundings& around, size_t row, AgentBody* agent)
      : around_(around), row_(row), agent_(*agent), motion_(agent->motion) {}

  void decide() {
    agent_.intent = {};
    const AgentDescription& d = *agent_.description;
    if (around_.time < d.start) return;
    switch (d.behavior) {
      case AgentBehavior::kStand:
        break;
      case AgentBehavior::kWander:
        wander_on();
        break;
      case AgentBehavior::kRoute:
        follow_route();
        break;
      case AgentBehavior::kSpline:
        follow_spline();
        break;
      case AgentBehavior::kTree:
        static_cast<void>(agent_.tree->tick(this));
        break;
    }
    note_progress();
  }

  // TreeHost.
  double time() const override { return around_.time; }
  void stand() override { agent_.intent.mode = AgentIntent::Mode::kStand; }

  NodeStatus go_to(Vec3d goal, double speed, bool is_new) override {
    if (is_new) motion_.has_goal = 0;
    if (!is_new && has_arrived(agent_)) {
      stand();
      return motion_.is_whole != 0 ? NodeStatus::kSuccess : NodeStatus::kFailure;
    }
    go(goal, speed);
    return NodeStatus::kRunning;
  }

  NodeStatus wander(double speed, bool is_new) override {
    if (is_new && !draw_goal()) {
      stand();
      return NodeStatus::kFailure;
    }
    if (!is_new && has_arrived(agent_)) return NodeStatus::kSuccess;
    go(motion_.goal, speed);
    return NodeStatus::kRunning;
  }

  NodeStatus follow(const std::string& target, double distance, double speed) override {
    Vec3d p;
    if (!find_target(target, &p)) return NodeStatus::kFailure;
    if (flat_norm(p - motion_.p) <= distance) {
      stand();
      turn_to(p);
    } else {
      // A new way at every metre of the target's.
      if (motion_.has_goal == 0 || flat_norm(p - motion_.goal) > 1)
        motion_.goal = p, motion_.has_goal = 0;
      go(motion_.goal, speed);
    }
    return NodeStatus::kRunning;
  }

  NodeStatus face(const std::string& target) override {
    Vec3d p;
    if (!find_target(target, &p)) return NodeStatus::kFailure;
    stand();
    turn_to(p);
    return std::abs(wrapped(agent_.intent.facing - motion_.heading)) < 0.15 ? NodeStatus::kSuccess
                                                                            : NodeStatus::kRunning;
  }

  double robot_distance() const override {
    double nearest = std::numeric_limits<double>::infinity();
    for (const NavObstacle& obstacle : around_.nav.obstacles())
      if (obstacle.is_robot) nearest = std::min(nearest, flat_norm(obstacle.p - motion_.p));
    return nearest;
  }
  double agent_distance() const override {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < around_.agents.size(); ++i)
      if (i != row_) nearest = std::min(nearest, flat_norm(around_.agents[i].motion.p - motion_.p));
    return nearest;
  }
  double distance_to(Vec3d p) const override { return flat_norm(p - motion_.p); }
  bool was_touched() const override { return around_.time - motion_.touched < kTouchMemory; }

 private:
  void go(Vec3d goal, double speed) {
    const double usual = agent_.description->speed;
    agent_.intent.mode = AgentIntent::Mode::kGo;
    agent_.intent.goal = goal;
    agent_.intent.speed = speed > 0 ? std::min(speed, std::max(usual, 2.5)) : usual;
  }

  void turn_to(Vec3d p) {
    agent_.intent.faces = true;
    agent_.intent.facing = std::atan2(p.y - motion_.p.y, p.x - motion_.p.x);
  }

  // "" = the nearest robot.
  bool find_target(const std::string& name, Vec3d* p) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < around_.world.robots.size(); ++i) {
      const int row = around_.nav.obstacle_of_robot(i);
      if (row < 0 || (!name.empty() && around_.world.robots[i].name != name)) continue;
      const Vec3d at = around_.nav.obstacles()[static_cast<size_t>(row)].p;
      if (flat_norm(at - motion_.p) < nearest) nearest = flat_norm(at - motion_.p), *p = at;
    }
    for (size_t i = 0; i < around_.agents.size() && !name.empty(); ++i) {
      if (i == row_ || around_.agents[i].description->name != name) continue;
      *p = around_.agents[i].motion.p;
      return true;
    }
    return std::isfinite(nearest);
  }

  double draw(const char* what, uint32_t index) const {
    return agent_.stream(around_.seed, what).uniform(static_cast<uint64_t>(motion_.draws), index);
  }

  // A place that a way leads to, not right here.
  bool draw_goal() {
    for (int i = 0; i < kMaxWanderTries; ++i) {
      ++motion_.draws;
      const NavPoint to = around_.nav.random_place(row_, agent_.path.at(), draw("agent.goal", 0),
                                                   draw("agent.goal", 1), draw("agent.goal", 2));
      if (to.ref == 0) continue;
      if (flat_norm(to.p - motion_.p) < kLeastWander && i + 2 < kMaxWanderTries) continue;
      motion_.goal = to.p;
      motion_.has_goal = 0;
      return true;
    }
    return false;
  }

  bool is_stuck() const { return around_.time - motion_.progress > kStuckTime; }

  void wander_on() {
    if (around_.time < motion_.pause_end) return;
    const bool arrived = has_arrived(agent_);
    if (arrived && motion_.pause_end < motion_.progress) {
      // Looks around where it has come to.
      ++motion_.draws;
      motion_.pause_end = around_.time + 0.5 + 4 * draw("agent.pause", 0);
      motion_.progress = motion_.pause_end;
      return;
    }
    if ((motion_.has_goal == 0 || arrived || is_stuck()) && !draw_goal()) return;
    if (is_stuck()) motion_.progress = around_.time;
    go(motion_.goal, 0);
  }

  void follow_route() {
    const AgentDescription& d = *agent_.description;
    const auto count = static_cast<int64_t>(d.route.size());
    if (motion_.waypoint >= count || around_.time < motion_.pause_end) return;
    // An agent without a path to its station waits, and after a while goes on if there are others.
    if (has_arrived(agent_) && (motion_.is_whole != 0 || (count > 1 && is_stuck()))) {
      motion_.progress = around_.time;
      const double pause = d.route[static_cast<size_t>(motion_.waypoint)].pause;
      motion_.has_goal = 0;
      if (++motion_.waypoint == count && d.loop) motion_.waypoint = 0;
      motion_.pause_end = around_.time + pause;
      if (pause > 0 || motion_.waypoint >= count) return;
    }
    go(to_vec3d(d.route[static_cast<size_t>(motion_.waypoint)].position), 0);
  }

  // The curve is followed where it leads, through whatever is there.
  void follow_spline() {
    const AgentSpline& spline = around_.splines[row_];
    Vec3d direction;
    const double speed = std::min(agent_.description->speed, spline.speed_at(motion_.way));
    const Vec3d lag = flat(spline.at(motion_.way, &direction) - motion_.p);
    // It waits for a body that was held up; one that is ahead of it need not wait.
    const double behind = norm(lag - flat(direction) * std::min(dot(lag, flat(direction)), 0.0));
    motion_.way += norm(motion_.wanted) > 0 || motion_.way == 0
                       ? speed * around_.dt * std::clamp(1.5 - behind, 0.0, 1.0)
                       : 0;
    if (!spline.loop && motion_.way >= spline.length()) return;
    const Vec3d to = spline.at(motion_.way, &direction);
    agent_.intent.mode = AgentIntent::Mode::kSpline;
    agent_.intent.speed = speed;
    // People hurry after the point where they should be; vehicles keep to their speed.
    const double most = agent_.description->kind == AgentKind::kPerson ? 1.4 * speed : speed;
    agent_.intent.velocity = shortened(flat(direction) * speed + flat(to - motion_.p) * 1.5, most);
  }

  void note_progress() {
    if (flat_norm(motion_.p - motion_.seen_at) < kMinProgress &&
        agent_.intent.mode != AgentIntent::Mode::kStand)
      return;
    motion_.seen_at = motion_.p;
    motion_.progress = std::max(motion_.progress, around_.time);
  }

  const AgentSurroundings& around_;
  const size_t row_;
  AgentBody& agent_;
  AgentMotion& motion_;
};

}  // namespace

void decide_intent(const AgentSurroundings& around, size_t row, AgentBody* agent) {
  Brain(around, row, agent).decide();
}

bool find_way(const NavMesh& mesh, Vec3d goal, AgentBody* agent) {
  AgentMotion& m = agent->motion;
  if (agent->path.at().ref == 0 || !agent->path.is_valid(mesh)) {
    const NavPoint here = mesh.nearest(m.p, 1.5, 1);
    if (here.ref == 0) return false;
    agent->path.reset(here);
    m.has_goal = 0;
  }
  if (m.has_goal != 0 && m.goal == goal) return true;
  NavPoint to = mesh.nearest(goal, 0.3, 1.5);
  const bool is_on_mesh = to.ref != 0 && flat_norm(to.p - goal) < 0.15;
  if (to.ref == 0) to = mesh.nearest(goal);
  if (to.ref == 0) to = agent->path.at();
  m.is_whole = agent->path.find(mesh, to) && is_on_mesh ? 1 : 0;
  m.goal = goal;
  m.has_goal = 1;
  if (m.is_whole == 0 && !(agent->warned_goal == goal)) {
    agent->warned_goal = goal;
    const Vec3d end = agent->path.end();
    const SourceLoc& loc = agent->description->loc;
    log_warning(
        "{}:{}: '{}' cannot reach ({:.2f}, {:.2f}, {:.2f}): {}; it goes to ({:.2f}, {:.2f}, "
        "{:.2f}), the nearest reachable point",
        loc.file, loc.line, agent->description->name, goal.x, goal.y, goal.z,
        is_on_mesh ? "no path leads there" : "there is no room to stand", end.x, end.y, end.z);
  }
  return true;
}

}  // namespace gloam
