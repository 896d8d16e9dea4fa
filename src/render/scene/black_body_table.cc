#include "render/scene/black_body_table.h"

#include "world/lights/black_body.h"

namespace gloam {

std::vector<Vec3f> make_black_body_table() {
  constexpr double low = 1.0 / BlackBodyTable::kLow, high = 1.0 / BlackBodyTable::kHigh;
  std::vector<Vec3f> table(BlackBodyTable::kSize);
  for (int i = 0; i < BlackBodyTable::kSize; ++i) {
    table[i] = black_body_luminance(1 / (low + (high - low) * i / (BlackBodyTable::kSize - 1)));
  }
  return table;
}

}  // namespace gloam
