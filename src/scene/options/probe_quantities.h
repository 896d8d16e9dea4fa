#pragma once
// The table of quantities that a [[probe]] reads: a row each. What computes them is in
// sensors/probe/.

#include <array>
#include <cstdint>
#include <string_view>

namespace gloam {

/// Kinds of places, which decide the keys that a probe needs.
enum class ProbePlace : uint8_t {
  kPoint,          ///< `position`, in the world or in the frame of `body`
  kSurface,        ///< the same with a `normal`
  kBodies,         ///< `body`, several by *, or `agent`
  kBodiesOrPoint,  ///< either
  kCamera,         ///< `camera`
};

/// One number of a quantity.
struct ProbeNumber {
  std::string_view name;  ///< "" = there is none
  std::string_view unit;
};

struct ProbeQuantity {
  std::string_view word;  ///< value of the key `quantity`
  ProbePlace place;
  std::array<ProbeNumber, 4> numbers;  ///< vectors have world axes
  constexpr int count() const {
    int n = 0;
    while (n < 4 && !numbers[static_cast<size_t>(n)].name.empty()) ++n;
    return n;
  }
  constexpr bool is_vector() const { return count() == 3 && numbers[2].name == "z"; }
};

inline constexpr std::array<ProbeQuantity, 12> kProbeQuantities = {{
    {"wind", ProbePlace::kPoint, {{{"x", "m/s"}, {"y", "m/s"}, {"z", "m/s"}}}},
    {"gas_velocity", ProbePlace::kPoint, {{{"x", "m/s"}, {"y", "m/s"}, {"z", "m/s"}}}},
    {"gas_density", ProbePlace::kPoint, {{{"density", "kg/m³"}}}},
    {"gas_temperature", ProbePlace::kPoint, {{{"temperature", "K"}}}},
    {"visibility", ProbePlace::kPoint, {{{"visibility", "m"}}}},
    {"water_height", ProbePlace::kPoint, {{{"height", "m"}}}},
    {"illuminance", ProbePlace::kSurface, {{{"illuminance", "lx"}}}},
    {"contact_force", ProbePlace::kBodies, {{{"x", "N"}, {"y", "N"}, {"z", "N"}}}},
    {"sinkage", ProbePlace::kBodiesOrPoint, {{{"sinkage", "m"}}}},
    {"soil_work", ProbePlace::kBodies, {{{"work", "J"}}}},
    {"exposure", ProbePlace::kCamera, {{{"ev100", "EV"}}}},
    {"sun_disc",
     ProbePlace::kCamera,
     {{{"u", "px"}, {"v", "px"}, {"in_picture", ""}, {"visible", ""}}}},
}};

inline constexpr auto kProbeWords = [] {
  std::array<std::string_view, kProbeQuantities.size()> words;
  for (size_t i = 0; i < words.size(); ++i) words[i] = kProbeQuantities[i].word;
  return words;
}();

/// Row of a word that is one of the table.
constexpr const ProbeQuantity* find_probe_quantity(std::string_view word) {
  for (const ProbeQuantity& quantity : kProbeQuantities)
    if (quantity.word == word) return &quantity;
  return nullptr;
}

}  // namespace gloam
