#pragma once
// Errors of a sensor that puts out numbers, and those of parts by their data sheets.

#include "gloam/scene/sensor.h"

namespace gloam {

/// SensorOptions with nothing left out; 0 = off. Units: the sensor's own.
struct SignalErrors {
  double noise = 0;             ///< standard deviation of a sample
  double noise_density = 0;     ///< white, one-sided [unit/√Hz]
  double bias_instability = 0;  ///< flat part of the Allan deviation
  double random_walk = 0;       ///< [unit √Hz]: Allan deviation K √(τ / 3)
  double bias = 0;              ///< standard deviation of the offset at the start
  double offset = 0;
  double scale_error = 0;  ///< standard deviation, a fraction
  double range = 0;        ///< largest magnitude
  double resolution = 0;
};

/// Values of the table, else of its preset, else nothing. For "±x" in a data sheet a typical value
/// counts as one standard deviation, a tolerance as three.
///
/// adis16470_*: Analog Devices, ADIS16470 Rev. C (2019). bmi088_*: Bosch Sensortec,
/// BST-BMI088-DS001-14 (2018), ±2000 °/s and ±24 g; noise and offsets as others quote them, so
/// approximate. mpu6050_*: InvenSense, PS-MPU-6000A-00 Rev. 3.4 (2013), ±250 °/s and ±2 g. as5048a:
/// ams, AS5048A/AS5048B v1-06 (14 bits a turn; noise at most 2.73 steps rms).
SignalErrors signal_errors(const SensorOptions& options);

}  // namespace gloam
