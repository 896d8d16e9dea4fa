#include "sim/agents/vehicle.h"

namespace gloam {
namespace {

// Passengers find 2 m/s² to the side comfortable (Bosetti et al. 2014).
constexpr double kMaxLateralAcceleration = 1.8;  // [m/s²]
constexpr double kSteerRate = 0.8;               // rate of the wheels' steering [rad/s]
constexpr double kLookaheadTime = 0.8;           // ahead of which a driver looks [s]
constexpr double kSpinRate = 1.2;                // rate of vehicles that turn on the spot [rad/s]

double unsteered_x(const VehicleSize& s) {
  return static_cast<double>(s.steers_rear ? s.front_axle.x : s.rear_axle.x);
}
double wheelbase(const VehicleSize& s) {
  return static_cast<double>(s.front_axle.x) - static_cast<double>(s.rear_axle.x);
}

// Place of a wheel in the frame of the prop, `x` from the unsteered axle [m].
Vec3d wheel_place(const VehicleSize& s, size_t i) {
  const VehicleAxle& axle = i < 2 ? s.front_axle : s.rear_axle;
  const double side = i % 2 == 0 ? 0.5 : -0.5;
  return {static_cast<double>(axle.x), side * static_cast<double>(axle.track),
          static_cast<double>(axle.radius)};
}

}  // namespace

double bend_speed(double curvature) {
  return std::sqrt(kMaxLateralAcceleration / std::max(std::abs(curvature), 1e-3));
}

void drive(const VehicleSize& size, double dt, Vec3d wanted, Vec3d* velocity, double* heading,
           double* yaw_rate, VehicleState* state) {
  const double speed = dot(*velocity, heading_vector(*heading)), most = norm(wanted);
  const bool spins = size.turning_radius == 0;
  double target = 0, error = 0, curvature = state->curvature;
  if (most > 0.02) {
    error = wrapped(std::atan2(wanted.y, wanted.x) - *heading);
    target = most * std::max(std::cos(error), 0.25);
    // The circle to a point that far ahead in the wanted direction (Coulter 1992, pure pursuit).
    const double look = std::max(kLookaheadTime * speed, wheelbase(size));
    const double sine = std::abs(error) < M_PI / 2 ? std::sin(error) : std::copysign(1, error);
    const double tightest = spins ? 1e9 : 1 / size.turning_radius;
    curvature = std::clamp(2 * sine / look, -tightest, tightest);
    if (!spins)
      target =
          std::min(target, bend_speed(std::max(std::abs(curvature), std::abs(state->curvature))));
  }
  const double change = target > speed ? size.thrust : size.brakes;
  const double now = speed + std::clamp(target - speed, -change * dt, change * dt);
  if (spins) {
    const double rate = most > 0.02 ? std::clamp(2.5 * error, -kSpinRate, kSpinRate) : 0;
    *yaw_rate += std::clamp(rate - *yaw_rate, -4 * dt, 4 * dt);
  } else {
    const double base = wheelbase(size), steer = std::atan(base * state->curvature);
    const double by =
        std::clamp(std::atan(base * curvature) - steer, -kSteerRate * dt, kSteerRate * dt);
    state->curvature = std::tan(steer + by) / base;
    *yaw_rate = now * state->curvature;
  }
  *heading = wrapped(*heading + *yaw_rate * dt);
  // The unsteered axle goes where the vehicle looks; the reference point swings about it.
  const Vec3d ahead = heading_vector(*heading), left{-ahead.y, ahead.x, 0};
  *velocity = ahead * now + left * (*yaw_rate * (axle_middle(size) - unsteered_x(size)));
}

void roll_wheels(const VehicleSize& size, double dt, double speed, double yaw_rate,
                 VehicleState* state) {
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d p = wheel_place(size, i);
    const double x = p.x - unsteered_x(size);
    // Velocity of the hub, in the frame of the chassis.
    const Vec3d v{speed - yaw_rate * p.y, yaw_rate * x, 0};
    double& angle = state->angle[i];
    if (size.turning_radius > 0)
      angle = std::atan2(state->curvature * x, 1 - state->curvature * p.y);
    else if (x != 0 && norm(v) > 0.02)
      angle = v.x != 0 ? std::atan(v.y / v.x) : std::copysign(M_PI / 2, v.y);
    state->roll[i] = wrapped(state->roll[i] + dot(v, heading_vector(angle)) * dt / p.z);
  }
}

std::array<PartPose, kVehicleParts> vehicle_pose(const VehicleSize& size, Vec3d p, double heading,
                                                 const VehicleState& state) {
  constexpr double kForkHeight = 0.15;  // carried low [m]
  std::array<PartPose, kVehicleParts> pose;
  const Quat q = turn_z(heading);
  const Vec3d origin = p - heading_vector(heading) * axle_middle(size);
  pose[kChassis] = {origin, q};
  pose[kFork] = {origin + Vec3d{0, 0, kForkHeight}, q};
  for (size_t i = 0; i < 4; ++i)
    pose[kWheelFL + i] = {origin + rotated(q, wheel_place(size, i)),
                          q * turn_z(state.angle[i]) * turn_y(state.roll[i])};
  return pose;
}

}  // namespace gloam
