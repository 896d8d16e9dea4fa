#include "scene/overcast.h"

#include <cmath>

namespace gloam {

std::optional<SkyOptions> overcast_sky(const WeatherOptions& weather) {
  constexpr double kIlluminance = 15000, kHalved = 10;  // [lx], [mm/h]
  const double falls = weather.rain.value_or(0) + weather.snow.value_or(0);
  if (!(falls > 0)) return {};
  SkyOptions sky;
  sky.luminance = kIlluminance / (1 + falls / kHalved) / M_PI;
  sky.loc = weather.loc;
  return sky;
}

double overcast_ev100(const SkyOptions& sky) {
  return std::log2(M_PI * *sky.luminance * 100 / 250);
}

}  // namespace gloam
