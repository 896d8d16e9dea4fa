#pragma once
// Things of the catalogue that drive: how large they are and where their wheels stand. Their part 0
// is the chassis, "fork" that of a forklift; then come four wheels, each about an axle along y.

#include <array>
#include <string_view>

#include "places/prop.h"

namespace gloam {

/// Left before right, front before rear.
inline constexpr std::array<std::string_view, 4> kWheelNames = {
    "front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel"};

struct VehicleAxle {
  float x = 0;                  ///< in the frame of the prop [m]
  float track = 0;              ///< between the middles of its wheels [m]
  float radius = 0, width = 0;  ///< size of its wheels [m]
};

struct VehicleSize {
  float front = 0, rear = 0;    ///< its ends, along x in the frame of the prop [m]
  float width = 0, height = 0;  ///< [m]
  VehicleAxle front_axle, rear_axle;
  double mass = 0;  ///< [kg]
  /// Least turning radius of the middle of its unsteered axle [m]; 0 = turns there.
  double turning_radius = 0;
  bool steers_rear = false;           ///< else by the front wheels
  double thrust = 1.2, brakes = 2.2;  ///< accelerations that a driver uses [m/s²]
};

/// Hatchback of the B segment: 3.97 x 1.68 x 1.46 m on a wheelbase of 2.47 m, tyres 185/60 R 15,
/// 10.6 m between kerbs, some 1.1 t (Volkswagen AG 2014, Polo, technical data). Drivers accelerate
/// from rest with some 2 m/s² (Bokare and Maurya 2017, "Acceleration-deceleration behaviour of
/// various vehicle types") and brake with up to 3.4 m/s² (AASHTO 2011, "A policy on geometric
/// design of highways and streets", 3.2.2).
inline constexpr VehicleSize kCarSize{1.985f,
                                      -1.985f,
                                      1.68f,
                                      1.46f,
                                      {1.235f, 1.46f, 0.302f, 0.185f},
                                      {-1.235f, 1.46f, 0.302f, 0.185f},
                                      1100,
                                      3.9,
                                      false,
                                      2.0,
                                      3.4};
/// Counterbalance truck with forks of 1.15 m: sheets of makers after VDI 2198 have 1.15 m of width,
/// 2.1 m of height and 3 to 4 t for 1.6 to 2.5 t of load; steers by its rear wheels, up to 68
/// degrees.
inline constexpr VehicleSize kForkliftSize{
    1.87f, -1.835f, 1.14f, 2.21f, {0.22f, 0.92f, 0.325f, 0.21f}, {-1.28f, 0.90f, 0.26f, 0.17f},
    3500,  0.6,     true};
/// Platform of 1.1 x 0.7 m that drives itself: deck, load and handle as EN 1757-3 has them for
/// trucks pushed by hand; 40 kg and a load of 80 kg.
inline constexpr VehicleSize kCartSize{
    0.55f, -0.6f, 0.7f, 1.0f, {0.36f, 0.54f, 0.08f, 0.04f}, {-0.36f, 0.58f, 0.1f, 0.045f},
    120,   0,     false};

/// Adds the four wheels as parts fixed to the chassis, as show(part, axle, side) makes them about
/// the origin; side = 1 on the left. Each collides as a cylinder and weighs `mass` [kg].
template <class Show>
void add_wheels(const VehicleSize& size, double mass, const Show& show, Prop* prop) {
  for (size_t i = 0; i < kWheelNames.size(); ++i) {
    const VehicleAxle& axle = i < 2 ? size.front_axle : size.rear_axle;
    const float side = i % 2 == 0 ? 1.0f : -1.0f;
    PropPart& wheel = prop->parts.emplace_back();
    wheel.name = kWheelNames[i];
    wheel.parent = 0;
    wheel.p_P = {axle.x, side * axle.track / 2, axle.radius};
    wheel.mass = mass;
    show(&wheel, axle, side);
    wheel.collide_cylinder(Vec3f{0, -axle.width / 2, 0}, Vec3f{0, axle.width / 2, 0}, axle.radius);
  }
}

}  // namespace gloam
