// Steering of agents: along the path, around others.

#include <limits>
#include <span>

#include "sim/agents/agents.h"
#include "sim/agents/brain.h"

namespace gloam {
namespace {

constexpr double kNeighbourRange = 6;    // [m]
constexpr double kPersonalSpace = 0.05;  // beyond radii [m]
constexpr double kHorizon = 0.7;         // within which a collision makes it stop [s]
constexpr double kFrontGap = 0.6;        // gap that a vehicle leaves in front [m]
constexpr double kSideGap = 0.15;        // and to its sides [m]

struct Nearby {
  Vec3d p, velocity, wanted;
  double radius, away;
};

// Circles that cover an agent: f(centre, radius), for a vehicle from its rear to its front.
template <class F>
void for_circles(const AgentBody& agent, const F& f) {
  const AgentDescription& d = *agent.description;
  if (d.kind == AgentKind::kPerson) return f(agent.motion.p, d.radius);
  const double half = static_cast<double>(d.vehicle.width) / 2;
  const double from = half - length_behind(d.vehicle), to = length_ahead(d.vehicle) - half;
  const int gaps = std::max(1, static_cast<int>(std::ceil((to - from) / (1.5 * half))));
  const Vec3d ahead = heading_vector(agent.motion.heading);
  for (int k = 0; k <= gaps; ++k)
    f(agent.motion.p + ahead * (from + (to - from) * k / gaps), half + 0.1);
}

// At which a vehicle may go so that it takes the next corners of its way as slowly as its circle is
// tight.
double corner_speed(const AgentBody& agent, std::span<const Vec3d> corners) {
  const VehicleSize& size = agent.description->vehicle;
  const double radius = std::max(size.turning_radius, 0.5);
  double fastest = std::numeric_limits<double>::infinity(), way = 0;
  Vec3d from = agent.motion.p;
  for (size_t i = 0; i + 1 < corners.size(); ++i) {
    const Vec3d to = flat(corners[i] - from), on = flat(corners[i + 1] - corners[i]);
    const Vec3d ahead = unit_or(to, {1, 0, 0});
    const double turn = std::acos(std::clamp(dot(ahead, unit_or(on, ahead)), -1.0, 1.0));
    const double slow = bend_speed(std::min(turn, 1.0) / radius);
    way += norm(to);
    fastest = std::min(fastest, std::sqrt(slow * slow + 2 * planned_slowing(size) * way));
    from = corners[i];
  }
  return fastest;
}

}  // namespace

// The velocity that it would have if it were alone, then the velocity that it takes.
Vec3d Agents::steer(size_t row, const mjData& data) {
  AgentBody& agent = agents_[row];
  AgentMotion& m = agent.motion;
  const AgentIntent& intent = agent.intent;
  const NavMesh& mesh = nav_->mesh_of(row);
  m.is_facing = intent.faces ? 1 : 0;
  m.facing = intent.facing;
  const AgentDescription& d = *agent.description;
  const bool drives = d.kind != AgentKind::kPerson;
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
    // Slows down so that it can stop where the way ends, with 0.9 m/s².
    const double speed = std::min(intent.speed, std::sqrt(2 * 0.9 * std::max(left - 0.1, 0.0)));
    wanted = unit_or(to, heading_vector(m.heading)) * speed;
    if (left < 0.12) return {};
    if (drives) wanted = shortened(wanted, corner_speed(agent, {corners, size_t(count)}));
  }
  if (!d.yields) return wanted;
  if (doors_->is_blocked(data, m)) return {};
  // An agent that is touched stops for a second.
  if (time_of(decisions_.step_of(decision_)) - m.touched < 1) return {};
  if (intent.mode != AgentIntent::Mode::kSpline) avoid(row, &wanted);
  if (drives) return shortened(wanted, free_speed(row));
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
    if (other.away > kNeighbourRange || std::abs(other.p.z - m.p.z) > 1.5) return;
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
    for_circles(agents_[i], [&](Vec3d p, double size) {
      add({p, o.velocity, o.wanted, size + kPersonalSpace, 0});
    });
  }
  for (const NavObstacle& o : nav_->obstacles())
    if (!o.is_in_mesh) add({o.p, flat(o.velocity), flat(o.velocity), o.radius + kPersonalSpace, 0});
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
    if (std::abs(q.z - p.z) > 1.5 || norm(to) > kNeighbourRange) return false;
    const Vec3d relative = wanted - velocity;
    if (dot(to, wanted) <= 0 || dot(to, relative) <= 0) return false;
    const double size = radius + agent.description->radius - 0.08;
    const double t = std::min(dot(to, relative) / dot(relative, relative), kHorizon);
    return norm(to - relative * t) < size && norm(to - relative * t) < norm(to);
  };
  for (size_t i = 0; i < agents_.size(); ++i) {
    const AgentBody& other = agents_[i];
    bool is_hit = false;
    for_circles(other, [&](Vec3d q, double size) {
      is_hit |= i != row && collides(q, other.motion.velocity, size);
    });
    if (is_hit) return false;
  }
  for (const NavObstacle& o : nav_->obstacles())
    if ((!o.is_in_mesh || o.is_robot) && collides(o.p, flat(o.velocity), o.radius)) return false;
  return true;
}

// At which a vehicle can still stop before what is, or in a second will be, in the lane that its
// wheels are set to.
double Agents::free_speed(size_t row) const {
  const AgentBody& agent = agents_[row];
  const AgentMotion& m = agent.motion;
  const VehicleSize& size = agent.description->vehicle;
  const Vec3d ahead = heading_vector(m.heading), left{-ahead.y, ahead.x, 0};
  const double lane = static_cast<double>(size.width) / 2 + kSideGap;
  double free = std::numeric_limits<double>::infinity();
  const auto look = [&](Vec3d q, Vec3d velocity, double radius) {
    for (const double later : {0.0, 0.5, 1.0}) {
      const Vec3d to = flat(q + velocity * later - m.p);
      const double x = dot(to, ahead), y = dot(to, left) - 0.5 * agent.vehicle.curvature * x * x;
      if (std::abs(q.z - m.p.z) > 1.5 || x < 0 || std::abs(y) > lane + radius) continue;
      free = std::min(free, x - radius - length_ahead(size));
    }
  };
  for (size_t i = 0; i < agents_.size(); ++i)
    if (i != row)
      for_circles(agents_[i],
                  [&](Vec3d q, double radius) { look(q, agents_[i].motion.velocity, radius); });
  for (const NavObstacle& o : nav_->obstacles())
    if (!o.is_in_mesh || o.is_robot) look(o.p, flat(o.velocity), o.radius);
  return std::sqrt(2 * planned_slowing(size) * std::max(free - kFrontGap, 0.0));
}

}  // namespace gloam
