#pragma once
// Words of a scene file that stand for the values of an enum, in the order of the enum.

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace gloam {

inline constexpr std::array<std::string_view, 9> kPatternKinds = {
    "noise", "wood", "marble", "concrete", "brick", "tiles", "fabric", "scratches", "dirt"};
inline constexpr std::array<std::string_view, 4> kNoiseBases = {"fbm", "turbulence", "ridged",
                                                                "cells"};
inline constexpr std::array<std::string_view, 3> kBrickBonds = {"running", "stack", "english"};
inline constexpr std::array<std::string_view, 2> kTileShapes = {"square", "hexagon"};
inline constexpr std::array<std::string_view, 2> kWeaves = {"plain", "twill"};
inline constexpr std::array<std::string_view, 3> kStereoPresets = {"none", "d435", "kinect"};
inline constexpr std::array<std::string_view, 8> kSignalPresets = {
    "none",         "adis16470_gyro", "adis16470_accel", "bmi088_gyro",
    "bmi088_accel", "mpu6050_gyro",   "mpu6050_accel",   "as5048a"};

/// Place of a word that validate_scene() allows.
inline size_t place_of(std::string_view word, std::span<const std::string_view> list) {
  size_t i = 0;
  while (i + 1 < list.size() && list[i] != word) ++i;
  return i;
}

}  // namespace gloam
