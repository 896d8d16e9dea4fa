#include "sim/agents/walker.h"

#include "base/hash.h"
#include "base/rng.h"
#include "sim/agents/gait_curves.h"

namespace gloam {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kReferenceSpeed = 1.3;  // speed that amplitudes are given for [m/s]
constexpr double kWalkRatio = 0.0063;    // step length / cadence of people of 1.7 m [m min]
constexpr double kSlowestCadence = 1.2;  // [1/s]
constexpr double kStandSpeed = 0.06, kStartSpeed = 0.09;  // [m/s]
constexpr double kMaxLegExtension =
    0.9995;  // fraction of a leg's length: a knee is never quite straight
constexpr double kStandingKnee = 0.002;   // descent of the hips while standing, of their height
constexpr double kHipFilterTime = 0.03;   // in which the hips follow [s]
constexpr double kReferenceHeight = 1.7;  // height of a person that curves are given for [m]
constexpr double kReferenceHipHeight = 0.901;  // height of the hips of that person [m]

double follow(double value, double target, double dt, double time) {
  return value + (target - value) * (1 - std::exp(-dt / time));
}

}  // namespace

Walker::Walker(const PersonShape& shape, uint64_t seed)
    : shape_(shape),
      idle_phase_(2 * M_PI * RandomStream{seed, stream_id("agent.idle")}.uniform(0, 0)) {}

double Walker::cadence(double speed) const {
  const double ratio = kWalkRatio * shape_.height / kReferenceHeight;
  return std::max(std::sqrt(60 * speed / ratio) / 60, kSlowestCadence);
}

double Walker::stance_share(double speed) { return std::clamp(0.745 - 0.1 * speed, 0.58, 0.72); }

double Walker::phase_of(int foot) const {
  const double phase = state_.phase + 0.5 * foot;
  return phase - std::floor(phase);
}

// The phase at which a foot does at 1.3 m/s what it does at `phase` now.
double Walker::in_usual_cycle(double phase) const {
  if (phase < state_.stance) return phase / state_.stance * gait::kStanceFraction;
  return gait::kStanceFraction +
         (phase - state_.stance) / (1 - state_.stance) * (1 - gait::kStanceFraction);
}

// Length of a step over that of gait_curves.h, for someone of this size.
double Walker::usual_steps() const {
  const double size = shape_.hip_height / kReferenceHipHeight;
  return state_.speed / cadence(state_.speed) / (gait::kStep * size);
}

bool Walker::is_planted(int foot) const {
  return state_.is_stepping == 0 || phase_of(foot) < state_.stance;
}

Vec3d Walker::neutral(const WalkInput& in, int foot) const {
  const double side = (foot == 0 ? 1 : -1) * shape_.hip * (1 - 0.35 * state_.activity);
  const Vec3d ahead = heading_vector(in.heading);
  return in.p + Vec3d{-ahead.y, ahead.x, 0} * side;
}

// Distance of a foot from where it should stand; a turn by a radian counts as 0.3 m.
double Walker::error_of(const WalkInput& in, int foot) const {
  const Foot& f = state_.feet[foot];
  return flat_norm(f.p - neutral(in, foot)) + 0.3 * std::abs(wrapped(f.yaw - in.heading));
}

void Walker::reset(const WalkInput& in, const GroundHeight& ground) {
  state_ = {};
  state_.ground = in.p.z;
  for (int i = 0; i < 2; ++i) {
    Foot& foot = state_.feet[i];
    foot.p = neutral(in, i);
    foot.p.z = ground.at(foot.p);
    foot.yaw = in.heading;
    foot.from = foot.to = foot.p;
    foot.from_yaw = foot.to_yaw = foot.yaw;
  }
}

// The foot that is further from where it should be lifts first; of two alike the one behind.
void Walker::begin_step(const WalkInput& in) {
  double late[2];
  for (int i = 0; i < 2; ++i)
    late[i] = error_of(in, i) - dot(flat(state_.feet[i].p - in.p), in.velocity);
  const int foot = late[1] > late[0] + 1e-9 ? 1 : 0;
  state_.is_stepping = 1;
  state_.stance = stance_share(state_.speed);
  state_.phase = state_.stance + 0.5 * foot;
  state_.phase -= std::floor(state_.phase);
  Foot& f = state_.feet[foot];
  f.from = f.p, f.from_yaw = f.yaw;
}

// Landing place of a swinging foot: as far ahead of the hips as it will be left behind.
void Walker::aim(const WalkInput& in, int foot, double rate, const GroundHeight& ground) {
  Foot& f = state_.feet[foot];
  const double left = (1 - phase_of(foot)) / rate, stand = state_.stance / rate;
  const double turn = in.yaw_rate * left, speed = norm(in.velocity);
  const Vec3d v = in.velocity;
  const double c = std::cos(turn / 2), s = std::sin(turn / 2);
  const Vec3d ahead{c * v.x - s * v.y, s * v.x + c * v.y, 0};
  WalkInput then = in;
  then.heading = in.heading + turn + 0.5 * std::clamp(in.yaw_rate * stand, -0.6, 0.6);
  then.p = in.p + ahead * (left + (speed > kStandSpeed ? gait::kTouchdownFraction * stand : 0));
  f.to = neutral(then, foot);
  f.to.z = ground.at(f.to);
  f.to_yaw = f.from_yaw + wrapped(then.heading - f.from_yaw);
}

void Walker::advance(double dt, const WalkInput& in, const GroundHeight& ground) {
  const double rate = cadence(state_.speed) / 2;  // a cycle is two steps
  double before[2];
  for (int i = 0; i < 2; ++i) before[i] = phase_of(i);
  // The fraction of stance changes only so far that no foot changes its state by it.
  const double wanted = stance_share(state_.speed);
  bool is_near = false;
  for (const double phase : before) is_near |= std::abs(phase - state_.stance) < 0.06;
  if (!is_near) state_.stance += std::clamp(wanted - state_.stance, -0.02, 0.02);
  state_.phase += rate * dt;
  state_.phase -= std::floor(state_.phase);
  for (int i = 0; i < 2; ++i) {
    Foot& f = state_.feet[i];
    const double phase = phase_of(i);
    const bool swung = before[i] >= state_.stance, swings = phase >= state_.stance;
    if (swung && !swings) f.p = f.to, f.yaw = f.to_yaw;  // it is down, and stays
    if (!swung && swings) f.from = f.p, f.from_yaw = f.yaw;
    if (!swings) continue;
    aim(in, i, rate, ground);
    const double u = (phase - state_.stance) / (1 - state_.stance), t = gait::swing_progress(u);
    const double climb = 0.8 * std::abs(f.to.z - f.from.z);
    f.p = f.from + (f.to - f.from) * t;
    f.p.z += gait::swing_lift(u) + climb * 4 * u * (1 - u) * (u < 0.5 ? 1 : 4 * u * (1 - u));
    f.yaw = f.from_yaw + (f.to_yaw - f.from_yaw) * t;
  }
}

void Walker::step(double dt, const WalkInput& in, const GroundHeight& ground) {
  const double speed = norm(in.velocity);
  state_.speed = follow(state_.speed, speed, dt, 0.15);
  const double errors = std::max(error_of(in, 0), error_of(in, 1));
  if (state_.is_stepping == 0) {
    if (speed > kStartSpeed || errors > 0.16) begin_step(in);
  } else {
    const bool both_stand = is_planted(0) && is_planted(1);
    if (both_stand && speed < kStandSpeed && errors < 0.09) state_.is_stepping = 0;
  }
  if (state_.is_stepping != 0) advance(dt, in, ground);
  state_.activity = follow(state_.activity, state_.is_stepping != 0 ? 1 : 0, dt, 0.18);

  double low = 0, count = 0;
  for (int i = 0; i < 2; ++i)
    if (is_planted(i)) low += state_.feet[i].p.z, ++count;
  state_.ground = follow(state_.ground, count > 0 ? low / count : in.p.z, dt, 0.12);
  const double size = shape_.hip_height / kReferenceHipHeight, step = usual_steps();
  const double lead = kHipFilterTime * cadence(state_.speed) / 2;
  const double walks = gait::kKneeDescent + step * step * gait::hip_descent(state_.phase + lead);
  const double down =
      kStandingKnee * shape_.hip_height * (1 - state_.activity) + walks * size * state_.activity;
  state_.bob = follow(state_.bob, down, dt, kHipFilterTime);
  const Vec3d ahead = heading_vector(in.heading), left{-ahead.y, ahead.x, 0};
  const Vec3d tilt = in.acceleration * 0.045 + in.push * 0.25;
  const double forward = (1.5 + 2.5 * state_.speed / kReferenceSpeed) * kDegree;
  state_.lean[0] =
      follow(state_.lean[0], std::clamp(forward + dot(tilt, ahead), -0.25, 0.35), dt, 0.15);
  state_.lean[1] = follow(state_.lean[1], std::clamp(dot(tilt, left), -0.25, 0.25), dt, 0.15);
}

// Heel up is positive. It grows with speed as the pitch of Schwartz et al. 2008, "The effect of
// walking speed on the gait of typically developing children", does from 0.6 to 2 m/s.
double Walker::pitch_of(int foot) const {
  if (state_.is_stepping == 0) return 0;
  const double pitch = gait::foot_pitch(in_usual_cycle(phase_of(foot)));
  const double much = std::pow(usual_steps(), 1.2);
  return pitch * state_.activity * std::min(much, pitch > 0 ? 1.08 : 1.0);
}

// A foot that stands turns about its toes or its heel, whichever is on the ground.
PartPose Walker::foot_pose(int foot) const {
  const Foot& f = state_.feet[foot];
  const double pitch = pitch_of(foot);
  const double phase = phase_of(foot), u = (phase - state_.stance) / (1 - state_.stance);
  const double stands = pitch > 0 ? gait::kToe : gait::kHeel;
  const double pivot = (is_planted(foot) ? stands : gait::swing_pivot(u)) * shape_.foot;
  const Quat q = turn_z(f.yaw) * turn_y(pitch);
  const Vec3d at = f.p + heading_vector(f.yaw) * pivot;
  return {at + rotated(q, {-pivot, 0, shape_.ankle}), q};
}

void Walker::pose_trunk(const WalkInput& in, PersonPose* pose) const {
  const double a = state_.activity, much = a * std::min(state_.speed / kReferenceSpeed, 1.3);
  const double cycle = 2 * M_PI * state_.phase, mid = cycle - M_PI * state_.stance;
  const double idle = (1 - a) * std::sin(2 * M_PI * 0.21 * in.time + idle_phase_);
  const Quat heading = turn_z(in.heading);
  const double sway = 0.02 * a * std::cos(mid) + 0.008 * idle;
  const Vec3d ahead = heading_vector(in.heading), left{-ahead.y, ahead.x, 0};

  PartPose& pelvis = (*pose)[kPelvis];
  pelvis.q = heading * turn_z(-4.5 * kDegree * much * std::cos(cycle)) *
             turn_y(0.5 * state_.lean[0]) *
             turn_x(3 * kDegree * much * std::cos(mid) - 0.3 * state_.lean[1]);
  pelvis.p = {in.p.x, in.p.y, state_.ground + shape_.hip_height - state_.bob};
  pelvis.p += left * sway;
  // No lower than asked for, but so low that the legs that stand reach the ground.
  const double most = kMaxLegExtension * (shape_.thigh + shape_.shank);
  for (int i = 0; i < 2; ++i) {
    if (!is_planted(i)) continue;
    const Vec3d hip = pelvis.p + rotated(pelvis.q, {0, (i == 0 ? 1 : -1) * shape_.hip, 0});
    const Vec3d ankle = foot_pose(i).p;
    const double away = flat_norm(hip - ankle);
    const double high = ankle.z + std::sqrt(std::max(most * most - away * away, 0.0));
    pelvis.p.z = std::min(pelvis.p.z, pelvis.p.z + high - hip.z);
  }

  PartPose& chest = (*pose)[kChest];
  const double breath = 0.004 * std::sin(2 * M_PI * 0.25 * in.time + 2 * idle_phase_);
  chest.q = heading * turn_z(4 * kDegree * much * std::cos(cycle)) *
            turn_y(state_.lean[0] + breath) *
            turn_x(-state_.lean[1] - 1.2 * kDegree * much * std::cos(mid) + 0.012 * idle);
  chest.p = pelvis.p + rotated(pelvis.q, {0, 0, shape_.waist});
  PartPose& head = (*pose)[kHead];
  head.q = heading * turn_z(0.25 * in.yaw_rate * 0.5 + 0.15 * idle) * turn_y(0.02);
  head.p = chest.p + rotated(chest.q, {0, 0, shape_.trunk + shape_.neck});

  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? 1 : -1;
    const double swing = 19 * kDegree * much * -side * std::cos(cycle);  // forward
    PartPose& upper = (*pose)[static_cast<size_t>(kUpperArmL + 2 * i)];
    PartPose& fore = (*pose)[static_cast<size_t>(kForearmL + 2 * i)];
    upper.p = chest.p + rotated(chest.q, {0, side * shape_.shoulder, shape_.trunk});
    upper.q = chest.q * turn_x(side * 7 * kDegree) *
              turn_y(-(swing - 2 * kDegree) + 0.6 * state_.lean[0]);
    const double bend = 14 * kDegree + 10 * kDegree * much + 0.45 * std::max(swing, 0.0);
    fore.p = upper.p + rotated(upper.q, {0, 0, -shape_.upper_arm});
    fore.q = upper.q * turn_x(-side * 4 * kDegree) * turn_y(-bend);
  }
}

// Two bones from the hip to the ankle; the knee bends towards where pelvis and foot point.
void Walker::pose_legs(PersonPose* pose) const {
  const PartPose& pelvis = (*pose)[kPelvis];
  const double a = shape_.thigh, b = shape_.shank;
  for (int i = 0; i < 2; ++i) {
    PartPose& thigh = (*pose)[static_cast<size_t>(kThighL + 3 * i)];
    PartPose& shank = (*pose)[static_cast<size_t>(kShankL + 3 * i)];
    PartPose& foot = (*pose)[static_cast<size_t>(kFootL + 3 * i)];
    foot = foot_pose(i);
    const Vec3d hip = pelvis.p + rotated(pelvis.q, {0, (i == 0 ? 1 : -1) * shape_.hip, 0});
    const Vec3d down = unit_or(foot.p - hip, {0, 0, -1});
    const double reach = norm(foot.p - hip),
                 d = std::clamp(reach, 0.4 * (a + b), kMaxLegExtension * (a + b));
    if (!is_planted(i)) foot.p = hip + down * d;  // one that swings comes along
    const Vec3d toes = heading_vector(state_.feet[i].yaw), front = rotated(pelvis.q, {1, 0, 0});
    Vec3d forward = unit_or(toes + front, front);
    forward = unit_or(forward - down * dot(forward, down), front);
    const double along = (a * a + d * d - b * b) / (2 * d);
    const double out = std::sqrt(std::max(a * a - along * along, 0.0));
    const Vec3d knee = hip + down * along + forward * out;
    const auto bone = [&](Vec3d from, Vec3d to) {
      const Vec3d z = unit_or(from - to, {0, 0, 1});
      const Vec3d y = unit_or(cross(z, forward), {0, 1, 0});
      return PartPose{from, quat_of_axes(cross(y, z), y, z)};
    };
    thigh = bone(hip, knee);
    shank = bone(knee, hip + down * d);
  }
}

PersonPose Walker::pose(const WalkInput& in) const {
  PersonPose pose;
  pose_trunk(in, &pose);
  pose_legs(&pose);
  return pose;
}

uint64_t Walker::hash(uint64_t seed) const { return hash_bytes(&state_, sizeof(state_), seed); }

}  // namespace gloam
