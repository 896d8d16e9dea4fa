#include "sim/agents/agent.h"

#include <limits>

#include "base/hash.h"

namespace gloam {
namespace {

// Comfortable ones: people start with 0.7 to 1.2 m/s² and turn at up to 120 degrees a second
// (Kouchaki et al. 2022).
constexpr double kAcceleration = 1.2, kBraking = 2.2;  // [m/s²]
constexpr double kTurnRate = 2.1;                      // [rad/s]
constexpr double kPushTime = 0.35;                     // in which a push is walked off [s]
constexpr double kMostPush = 1.8;                      // [m/s]

class WalkGround final : public GroundHeight {
 public:
  WalkGround(const NavWorld& world, double height) : world_(world), height_(height) {}
  double at(Vec3d p) const override {
    p.z = height_;
    return world_.ground_below(p, 0.45, 0.6);
  }

 private:
  const NavWorld& world_;
  double height_;  // height of the body's place [m]
};

void move_person(double dt, AgentBody* agent) {
  AgentMotion& m = agent->motion;
  const Vec3d before = m.velocity;
  const Vec3d change = m.wanted - m.velocity;
  const bool brakes = norm(m.wanted) < norm(m.velocity);
  m.velocity += shortened(change, (brakes ? kBraking : kAcceleration) * dt);
  if (norm(m.wanted) < 1e-9 && norm(m.velocity) < 0.02) m.velocity = {};
  m.acceleration = (m.velocity - before) * (1 / dt);
  // Faces where it goes; while it stands, where it is asked to.
  double target = m.heading;
  if (norm(m.wanted) > 0.15 && norm(m.velocity) > 0.05)
    target = std::atan2(m.velocity.y, m.velocity.x);
  else if (m.is_facing != 0)
    target = m.facing;
  const double rate = std::clamp(5 * wrapped(target - m.heading), -kTurnRate, kTurnRate);
  m.yaw_rate += std::clamp(rate - m.yaw_rate, -9 * dt, 9 * dt);
  m.heading = wrapped(m.heading + m.yaw_rate * dt);
  // Nobody walks sideways as fast as ahead: a body that still has to turn slows down.
  const double off = std::abs(wrapped(target - m.heading));
  if (off > 0.6) m.velocity = m.velocity * std::max(1 - 3 * dt * (off - 0.6), 0.0);
}

}  // namespace

AgentBody::AgentBody(const AgentDescription& d)
    : description(&d), walker(d.person, d.seed), before{}, after{} {}

WalkInput AgentBody::walk_input(double time) const {
  return {motion.p,
          motion.velocity + motion.push,
          motion.acceleration,
          motion.heading,
          motion.yaw_rate,
          motion.push,
          time};
}

void AgentBody::find_pose(double time) {
  if (description->kind == AgentKind::kPerson) {
    after = walker.pose(walk_input(time));
    return;
  }
  const auto pose = vehicle_pose(description->vehicle, motion.p, motion.heading, vehicle);
  std::copy(pose.begin(), pose.end(), after.begin());
}

uint64_t AgentBody::hash(uint64_t seed) const {
  seed = hash_bytes(&motion, sizeof(motion), seed);
  seed = walker.hash(seed);
  seed = hash_bytes(&vehicle, sizeof(vehicle), seed);
  const Vec3d end = path.end();
  seed = hash_bytes(&end, sizeof(end), seed);
  return tree != nullptr ? tree->hash(seed) : seed;
}

void move_body(double dt, double time, const NavMesh& mesh, const NavWorld& world,
               AgentBody* agent) {
  AgentMotion& m = agent->motion;
  const AgentDescription& d = *agent->description;
  const double mass = d.kind == AgentKind::kPerson ? d.person.mass : d.vehicle.mass;
  if (d.yields && agent->force_steps > 0) {
    const Vec3d force = flat(agent->force) * (1.0 / agent->force_steps);
    m.push = shortened(m.push + force * (dt / mass), kMostPush);
    if (agent->robot_touches && norm(force) > 10) m.touched = time;
  }
  agent->force = {};
  agent->force_steps = 0;
  agent->robot_touches = false;
  m.push = m.push * std::exp(-dt / kPushTime);
  if (norm(m.push) < 1e-3) m.push = {};

  const bool drives = d.kind != AgentKind::kPerson;
  if (drives)
    drive(d.vehicle, dt, m.wanted, &m.velocity, &m.heading, &m.yaw_rate, &agent->vehicle);
  else
    move_person(dt, agent);
  const Vec3d by = (m.velocity + m.push) * dt;
  Vec3d to = m.p + by;
  if (norm(by) > 0 && agent->intent.mode != AgentIntent::Mode::kSpline &&
      agent->path.at().ref != 0) {
    const Vec3d on = agent->path.move(mesh, to);
    // An agent whose ground was taken out of the mesh leaves it at walking pace, not in one jump.
    to = m.p + shortened(flat(on - m.p), std::max(norm(by), 0.8 * dt));
    to.z = on.z;
  }
  const double z = world.ground_below({to.x, to.y, to.z}, 0.5, 0.8);
  const Vec3d moved = flat(to - m.p);
  m.p = {to.x, to.y, z};
  if (drives)
    roll_wheels(d.vehicle, dt, dot(moved, heading_vector(m.heading)) / dt, m.yaw_rate,
                &agent->vehicle);
  else
    agent->walker.step(dt, agent->walk_input(time), WalkGround(world, z));
}

AgentSpline::AgentSpline(const std::vector<WaypointOptions>& route, bool loops) : loop(loops) {
  const int count = static_cast<int>(route.size()), pieces = loop ? count : count - 1;
  const auto point = [&](int i) {
    const int k = loop ? (i % count + count) % count : std::clamp(i, 0, count - 1);
    return to_vec3d(route[static_cast<size_t>(k)].position);
  };
  constexpr int kSteps = 32;
  for (int i = 0; i < pieces; ++i) {
    const Vec3d a = point(i - 1), b = point(i), c = point(i + 1), d = point(i + 2);
    for (int k = i == 0 ? 0 : 1; k <= kSteps; ++k) {
      const double t = double(k) / kSteps;
      points.push_back((b * 2.0 + (c - a) * t + (a * 2.0 - b * 5.0 + c * 4.0 - d) * (t * t) +
                        (b * 3.0 - a - c * 3.0 + d) * (t * t * t)) *
                       0.5);
    }
  }
  lengths.push_back(0);
  for (size_t i = 1; i < points.size(); ++i)
    lengths.push_back(lengths.back() + norm(points[i] - points[i - 1]));
}

double AgentSpline::wrapped_way(double way) const {
  return loop && length() > 0 ? way - length() * std::floor(way / length())
                              : std::clamp(way, 0.0, length());
}

// The later end of the piece that a way lies on.
size_t AgentSpline::row_after(double way) const {
  return static_cast<size_t>(std::upper_bound(lengths.begin() + 1, lengths.end() - 1, way) -
                             lengths.begin());
}

void AgentSpline::plan_speeds(const VehicleSize& size) {
  constexpr double kFinalSpeed = 0.3;  // [m/s]
  const size_t n = points.size();
  if (n < 2) return;
  speeds.assign(n, std::numeric_limits<double>::infinity());
  const double tightest = size.turning_radius > 0 ? 1 / size.turning_radius : 2;
  for (size_t i = loop ? 0 : 1; i + 1 < n; ++i) {
    const Vec3d before = points[i] - points[i > 0 ? i - 1 : n - 2],
                after = points[i + 1] - points[i];
    const double turn = wrapped(std::atan2(after.y, after.x) - std::atan2(before.y, before.x));
    const double way = 0.5 * (flat_norm(before) + flat_norm(after));
    if (way > 0) speeds[i] = bend_speed(std::min(std::abs(turn) / way, tightest));
  }
  speeds[n - 1] = loop ? speeds[0] : kFinalSpeed;
  // Twice, so that a loop's first bends slow down its end.
  for (int round = 0; round < (loop ? 2 : 1); ++round) {
    for (size_t i = n - 1; i-- > 0;) {
      const double way = lengths[i + 1] - lengths[i];
      speeds[i] = std::min(
          speeds[i], std::sqrt(speeds[i + 1] * speeds[i + 1] + 2 * planned_slowing(size) * way));
    }
    if (loop) speeds[n - 1] = speeds[0];
  }
}

double AgentSpline::speed_at(double way) const {
  if (speeds.empty()) return std::numeric_limits<double>::infinity();
  way = wrapped_way(way);
  const size_t i = row_after(way);
  const double piece = lengths[i] - lengths[i - 1];
  const double t = piece > 0 ? (way - lengths[i - 1]) / piece : 0;
  if (!std::isfinite(speeds[i - 1]) || !std::isfinite(speeds[i])) return speeds[i];
  return speeds[i - 1] + (speeds[i] - speeds[i - 1]) * t;
}

Vec3d AgentSpline::at(double way, Vec3d* direction) const {
  way = wrapped_way(way);
  const size_t i = row_after(way);
  const Vec3d a = points[i - 1], b = points[i];
  const double piece = lengths[i] - lengths[i - 1];
  *direction = unit_or(b - a, {1, 0, 0});
  return piece > 0 ? a + (b - a) * ((way - lengths[i - 1]) / piece) : a;
}

}  // namespace gloam
