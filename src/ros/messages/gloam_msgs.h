#pragma once
// Gloam's own messages, for what ROS has none.

#include "ros/messages/geometry_msgs.h"

namespace gloam::gloam_msgs {

inline constexpr std::string_view kPackage = "gloam_msgs/msg";

/// A contact of two geoms at one point, world frame.
struct Contact {
  std::string body1, body2, geom1, geom2;  ///< full names
  geometry_msgs::Point position;           ///< [m]
  geometry_msgs::Vector3 normal;           ///< unit, from geom1 to geom2
  geometry_msgs::Wrench wrench;            ///< on body1, about `position` [N, N m]
  double depth = 0;                        ///< of the penetration [m]; negative = a gap
  GLOAM_MESSAGE(Contact, body1, body2, geom1, geom2, position, normal, wrench, depth)
};

struct Contacts {
  std_msgs::Header header;
  std::vector<Contact> contacts;
  GLOAM_MESSAGE(Contacts, header, contacts)
};

/// The weather of a scene at an instant.
struct Weather {
  std_msgs::Header header;
  double visibility =
      0;  ///< through what hangs in the air, without rain and snow [m]; +inf = clear
  double rain = 0, snow = 0;    ///< rates, snow as water [mm/h]
  geometry_msgs::Vector3 wind;  ///< 10 m above the ground, with its gust [m/s]
  double mean_wind = 0;         ///< speed there without gusts [m/s]
  GLOAM_MESSAGE(Weather, header, visibility, rain, snow, wind, mean_wind)
};

/// The air of one [[gas]] at an instant.
struct Gas {
  std_msgs::Header header;
  std::string name;
  double medium_mass = 0;          ///< of the smoke, dust … in it [kg]
  double highest_temperature = 0;  ///< of its cells [K]
  double mean_temperature = 0;     ///< of its cells [K]
  double heat_release = 0;         ///< of its fires, as the scene asks for [W]
  double fuel_rate = 0;            ///< fuel for that [kg/s]
  double heat_released = 0;        ///< since the beginning [J]
  double fuel_burned = 0;          ///< since the beginning [kg]
  GLOAM_MESSAGE(Gas, header, name, medium_mass, highest_temperature, mean_temperature, heat_release,
                fuel_rate, heat_released, fuel_burned)
};

/// The actuator models of a robot at an instant: docs/actuators.md. NaN = not modelled.
struct ActuatorStates {
  std_msgs::Header header;
  std::vector<std::string> name;    ///< of joints and of propellers' actuators, without the robot's
  std::vector<double> torque;       ///< applied to the joint [N m]; of a propeller, its thrust [N]
  std::vector<double> current;      ///< of the winding [A]
  std::vector<double> temperature;  ///< of the winding [degrees Celsius]
  std::vector<double> speed;        ///< of the motor [rad/s]
  double power = 0;                 ///< electrical, of all actuators [W]
  double energy = 0;                ///< electrical, since the beginning [J]
  GLOAM_MESSAGE(ActuatorStates, header, name, torque, current, temperature, speed, power, energy)
};

/// Numbers of a probe at an instant, world axes: docs/sensors.md.
struct Probe {
  std_msgs::Header header;
  std::string quantity;            ///< "sun_disc"
  std::vector<std::string> names;  ///< of each number: "u"
  std::vector<std::string> units;  ///< of each; "" = none
  std::vector<double> values;      ///< NaN = there is none there now
  GLOAM_MESSAGE(Probe, header, quantity, names, units, values)
};

/// Metrics of a run at an instant: docs/metrics.md.
struct Metrics {
  std_msgs::Header header;
  std::vector<std::string> names;  ///< as columns of metrics.csv: "ada.path_length_m"
  std::vector<std::string> units;  ///< of each; "" = none
  std::vector<double> values;      ///< NaN = has none now
  GLOAM_MESSAGE(Metrics, header, names, units, values)
};

/// Where a simulation stands at an instant: of Gloam's own, for replays.
struct State {
  std_msgs::Header header;
  int64_t run = 0, step = 0;  ///< resets before it; physics steps since the last
  uint64_t hash = 0;          ///< of the state, chained over all steps of the run
  std::vector<double> state;  ///< mjSTATE_INTEGRATION
  GLOAM_MESSAGE(State, header, run, step, hash, state)
};

/// Numbers of the state that a program wrote before a step, beside Commands: for replays.
struct StepInput {
  std_msgs::Header header;
  int64_t run = 0, step = 0;
  std::vector<int32_t> index;  ///< in mjSTATE_INTEGRATION
  std::vector<double> value;
  GLOAM_MESSAGE(StepInput, header, run, step, index, value)
};

}  // namespace gloam::gloam_msgs
