// How an agent gets where it means to go: along its way, around others, not into them.

#include "sim/agents/agents.h"
#include "sim/agents/brain.h"

namespace gloam {
namespace {

constexpr double kLook = 6;         // [m]
constexpr double kPersonal = 0.05;  // beyond radii [m]
constexpr double kHorizon = 0.7;    // within which a collision makes it stop [s]

struct Nearby {
  Vec3d p, velocity, wanted;
  double radius, away;
};

}  // namespace

// The velocity that it would have if it were alone, then that which it takes.
Vec3d Agents::steer(size_t row, const mjData& data) {
  AgentBody& agent = agents_[row];
  AgentMotion& m = agent.motion;
  const AgentIntent& intent = agent.intent;
  const NavMesh& mesh = nav_->mesh_of(row);
  m.is_facing = intent.faces ? 1 : 0;
  m.facing = intent.facing;
  Vec3d wanted;
  if (intent.mode == AgentIntent::Mode::kStand) return {};
  if (intent.mode == AgentIntent::Mode::kSpline) {
    wanted = intent.velocity;
  } else {
    if (!find_way(mesh, intent.goal, &agent)) return {};
    Vec3d corners[3];
    const int count = agent.path.corners(mesh, corners, 3);
    if (count == 0) return {};
    const Vec3d to = flat(corners[0] - m.p);
    const double left = flat_norm(agent.path.end() - m.p);
    // Slows down so that it can stop where the way ends, 0.9 m/s² (twice what is left under a
    // root).
    const double speed = std::min(intent.speed, std::sqrt(2 * 0.9 * std::max(left - 0.1, 0.0)));
    wanted = unit_or(to, heading_vector(m.heading)) * speed;
    if (left < 0.12) return {};
  }
  const AgentDescription& d = *agent.description;
  if (!d.yields) return wanted;
  if (doors_->is_blocked(data, m)) return {};
  // Whoever is touched stops for a second.
  if (time_of(decisions_.step_of(decision_)) - m.touched < 1) return {};
  if (intent.mode != AgentIntent::Mode::kSpline) avoid(row, &wanted);
  return has_room(row, wanted) ? wanted : Vec3d{};
}

void Agents::avoid(size_t row, Vec3d* wanted) {
  AgentBody& agent = agents_[row];
  const AgentMotion& m = agent.motion;
  const double radius = agent.description->radius;
  // The nearest ones, in order of distance; what is behind counts as further away.
  Nearby near[NavAvoidance::kMostCircles];
  int count = 0;
  const auto add = [&](Nearby other) {
    const Vec3d to = flat(other.p - m.p);
    other.away = norm(to) - other.radius;
    if (other.away > kLook || std::abs(other.p.z - m.p.z) > 1.5) return;
    if (dot(to, *wanted) < 0) other.away += 2;
    const bool is_full = count == NavAvoidance::kMostCircles;
    if (is_full && near[count - 1].away <= other.away) return;
    int at = is_full ? count - 1 : count++;
    for (; at > 0 && near[at - 1].away > other.away; --at) near[at] = near[at - 1];
    near[at] = other;
  };
  for (size_t i = 0; i < agents_.size(); ++i) {
    if (i == row) continue;
    const AgentMotion& o = agents_[i].motion;
    add({o.p, o.velocity, o.wanted, agents_[i].description->radius + kPersonal, 0});
  }
  for (const NavObstacle& o : nav_->obstacles())
    if (!o.is_in_mesh) add({o.p, flat(o.velocity), flat(o.velocity), o.radius + kPersonal, 0});
  if (count == 0) return;
  avoidance_.clear();
  for (int i = 0; i < count; ++i)
    avoidance_.add_circle(near[i].p, near[i].radius, near[i].velocity, near[i].wanted);
  const NavPoint here = agent.path.at();
  if (here.ref != 0) avoidance_.add_walls(nav_->mesh_of(row), here, 2.5);
  *wanted = avoidance_.choose(m.p, radius, std::max(norm(*wanted), 0.3), m.velocity, *wanted);
}

// Would it run into someone within the horizon? To part from one that is too near is always right.
bool Agents::has_room(size_t row, Vec3d wanted) const {
  const AgentBody& agent = agents_[row];
  const Vec3d p = agent.motion.p;
  const auto collides = [&](Vec3d q, Vec3d velocity, double radius) {
    const Vec3d to = flat(q - p);
    if (std::abs(q.z - p.z) > 1.5 || norm(to) > kLook) return false;
    const Vec3d relative = wanted - velocity;
    if (dot(to, wanted) <= 0 || dot(to, relative) <= 0) return false;
    const double size = radius + agent.description->radius - 0.08;
    const double t = std::min(dot(to, relative) / dot(relative, relative), kHorizon);
    return norm(to - relative * t) < size && norm(to - relative * t) < norm(to);
  };
  for (size_t i = 0; i < agents_.size(); ++i) {
    const AgentBody& other = agents_[i];
    if (i != row && collides(other.motion.p, other.motion.velocity, other.description->radius))
      return false;
  }
  for (const NavObstacle& o : nav_->obstacles())
    if ((!o.is_in_mesh || o.is_robot) && collides(o.p, flat(o.velocity), o.radius)) return false;
  return true;
}

}  // namespace gloam
