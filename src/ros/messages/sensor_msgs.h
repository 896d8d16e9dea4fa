#pragma once
// Messages of ROS 2's package sensor_msgs: measurements. Pictures and points: sensor_images.h.
// Covariances are row-major 3x3; a first element of -1 says that the quantity is not measured.

#include "ros/messages/geometry_msgs.h"

namespace gloam::sensor_msgs {

inline constexpr std::string_view kPackage = "sensor_msgs/msg";

/// All four of one length, or empty.
struct JointState {
  std_msgs::Header header;
  std::vector<std::string> name;
  std::vector<double> position;  ///< [rad or m]
  std::vector<double> velocity;  ///< [rad/s or m/s]
  std::vector<double> effort;    ///< [N m or N]
  GLOAM_MESSAGE(JointState, header, name, position, velocity, effort)
};

struct Imu {
  std_msgs::Header header;
  geometry_msgs::Quaternion orientation;
  std::array<double, 9> orientation_covariance = {};
  geometry_msgs::Vector3 angular_velocity;  ///< [rad/s]
  std::array<double, 9> angular_velocity_covariance = {};
  geometry_msgs::Vector3 linear_acceleration;  ///< [m/s^2], gravity included: +9.81 upwards at rest
  std::array<double, 9> linear_acceleration_covariance = {};
  GLOAM_MESSAGE(Imu, header, orientation, orientation_covariance, angular_velocity,
                angular_velocity_covariance, linear_acceleration, linear_acceleration_covariance)
};

/// As of ROS Iron; Humble's has no variance and therefore another hash.
struct Range {
  std_msgs::Header header;
  uint8_t radiation_type = 0;                     ///< ULTRASOUND or INFRARED
  float field_of_view = 0;                        ///< [rad]
  float min_range = 0, max_range = 0, range = 0;  ///< [m]
  float variance = 0;                             ///< [m^2]; 0 = unknown
  GLOAM_CONSTANTS(uint8, ULTRASOUND = 0, INFRARED = 1)
  GLOAM_MESSAGE(Range, header, radiation_type, field_of_view, min_range, max_range, range, variance)
};

struct MagneticField {
  std_msgs::Header header;
  geometry_msgs::Vector3 magnetic_field;  ///< [T]
  std::array<double, 9> magnetic_field_covariance = {};
  GLOAM_MESSAGE(MagneticField, header, magnetic_field, magnetic_field_covariance)
};

struct LaserScan {
  std_msgs::Header header;                                  ///< stamp of the first ray
  float angle_min = 0, angle_max = 0, angle_increment = 0;  ///< about +Z from +X [rad]
  float time_increment = 0, scan_time = 0;                  ///< [s]
  float range_min = 0, range_max = 0;                       ///< [m]
  std::vector<float> ranges;                                ///< [m]; inf = nothing there
  std::vector<float> intensities;                           ///< as many, or none
  GLOAM_MESSAGE(LaserScan, header, angle_min, angle_max, angle_increment, time_increment, scan_time,
                range_min, range_max, ranges, intensities)
};

struct Temperature {
  std_msgs::Header header;
  double temperature = 0;  ///< [degrees Celsius]
  double variance = 0;     ///< 0 = unknown
  GLOAM_MESSAGE(Temperature, header, temperature, variance)
};

struct Illuminance {
  std_msgs::Header header;
  double illuminance = 0;  ///< [lx]
  double variance = 0;     ///< 0 = unknown
  GLOAM_MESSAGE(Illuminance, header, illuminance, variance)
};

struct FluidPressure {
  std_msgs::Header header;
  double fluid_pressure = 0;  ///< absolute [Pa]
  double variance = 0;        ///< 0 = unknown
  GLOAM_MESSAGE(FluidPressure, header, fluid_pressure, variance)
};

/// Floats that are not measured are NaN.
struct BatteryState {
  std_msgs::Header header;
  float voltage = 0;          ///< [V]
  float temperature = 0;      ///< [degrees Celsius]
  float current = 0;          ///< negative = it discharges [A]
  float charge = 0;           ///< [A h]
  float capacity = 0;         ///< of the last full charge [A h]
  float design_capacity = 0;  ///< [A h]
  float percentage = 0;       ///< 0 … 1
  uint8_t power_supply_status = 0, power_supply_health = 0, power_supply_technology = 0;
  bool present = false;
  std::vector<float> cell_voltage, cell_temperature;  ///< [V], [degrees Celsius]; empty = unknown
  std::string location, serial_number;
  GLOAM_CONSTANTS(uint8, POWER_SUPPLY_STATUS_UNKNOWN = 0, POWER_SUPPLY_STATUS_CHARGING = 1,
                  POWER_SUPPLY_STATUS_DISCHARGING = 2, POWER_SUPPLY_STATUS_NOT_CHARGING = 3,
                  POWER_SUPPLY_STATUS_FULL = 4, POWER_SUPPLY_HEALTH_UNKNOWN = 0,
                  POWER_SUPPLY_HEALTH_GOOD = 1, POWER_SUPPLY_HEALTH_OVERHEAT = 2,
                  POWER_SUPPLY_HEALTH_DEAD = 3, POWER_SUPPLY_HEALTH_OVERVOLTAGE = 4,
                  POWER_SUPPLY_HEALTH_UNSPEC_FAILURE = 5, POWER_SUPPLY_HEALTH_COLD = 6,
                  POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE = 7,
                  POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE = 8, POWER_SUPPLY_TECHNOLOGY_UNKNOWN = 0,
                  POWER_SUPPLY_TECHNOLOGY_NIMH = 1, POWER_SUPPLY_TECHNOLOGY_LION = 2,
                  POWER_SUPPLY_TECHNOLOGY_LIPO = 3, POWER_SUPPLY_TECHNOLOGY_LIFE = 4,
                  POWER_SUPPLY_TECHNOLOGY_NICD = 5, POWER_SUPPLY_TECHNOLOGY_LIMN = 6)
  GLOAM_MESSAGE(BatteryState, header, voltage, temperature, current, charge, capacity,
                design_capacity, percentage, power_supply_status, power_supply_health,
                power_supply_technology, present, cell_voltage, cell_temperature, location,
                serial_number)
};

}  // namespace gloam::sensor_msgs
