// Any bytes as a photometric file: an Error of one line, or a grid of light.

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "world/lights/ies_profile.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto profile = gloam::parse_ies({reinterpret_cast<const char*>(data), size}, "fuzz.ies");
  if (profile.ok()) {
    const float candela = profile->intensity({0.36f, 0.48f, -0.8f});
    if (!std::isfinite(profile->flux) || !(candela >= 0 && candela <= profile->most)) std::abort();
  } else if (profile.error().to_string().find('\n') != std::string::npos) {
    std::abort();
  }
  return 0;
}
