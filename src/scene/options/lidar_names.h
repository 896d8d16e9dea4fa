#pragma once
// The closed lists of words in a [[lidar]].

#include <array>
#include <string_view>

namespace gloam {

inline constexpr std::array<std::string_view, 6> kLidarPresets = {"VLP-16",  "HDL-32E", "OS1-64",
                                                                  "HDL-64E", "OS1-128", "Mid-40"};
inline constexpr std::array<std::string_view, 4> kLidarPatterns = {"spinning", "raster", "flash",
                                                                   "rosette"};
/// In the order of LidarReturns (render/kernel/lidar/lidar_detect.h).
inline constexpr std::array<std::string_view, 5> kLidarReturns = {"first", "strongest", "last",
                                                                  "dual", "all"};

}  // namespace gloam
