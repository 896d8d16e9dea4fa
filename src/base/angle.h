#pragma once

namespace gloam {

inline constexpr double kDegree = 3.14159265358979323846 / 180;  ///< [rad]

}  // namespace gloam
