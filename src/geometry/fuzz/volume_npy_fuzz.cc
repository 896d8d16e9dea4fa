#include <cmath>
#include <cstdlib>

#include "geometry/volume_file.h"

// Any bytes as an .npy file: an Error of one line, or a grid of finite numbers.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto grid = gloam::decode_npy({data, size}, "fuzz.npy", 1 << 20);
  if (!grid.ok()) {
    if (grid.error().to_string().find('\n') != std::string::npos) std::abort();
    return 0;
  }
  if (grid->values.size() != size_t(grid->nx) * size_t(grid->ny) * size_t(grid->nz)) std::abort();
  for (const float value : grid->values) {
    if (!(value >= 0 && std::isfinite(value))) std::abort();
  }
  return 0;
}
