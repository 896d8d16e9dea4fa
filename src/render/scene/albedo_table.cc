#include "render/scene/albedo_table.h"

#include "base/parallel.h"
#include "base/rng.h"
#include "render/kernel/sampler.h"

namespace gloam {

void fill_albedo_table(AlbedoTable* table) {
  constexpr int n = AlbedoTable::kSize;
  constexpr uint32_t kPoints = 256;
  parallel_for("albedo table", n, [table](int64_t row) {
    const float roughness = static_cast<float>(row) / (n - 1);
    const float alpha = max(roughness * roughness, 1e-3f), alpha2 = alpha * alpha;
    for (int column = 0; column < n; ++column) {
      const float cos_o = max(static_cast<float>(column) / (n - 1), 2e-3f);
      const Vec3f wo{safe_sqrt(1.0f - cos_o * cos_o), 0, cos_o};
      float a = 0, b = 0;
      for (uint32_t i = 0; i < kPoints; ++i) {
        const Vec2f u{(static_cast<float>(i) + 0.5f) / kPoints, uniform_float(reverse_bits(i))};
        const Vec3f h = ggx::sample_half(alpha, wo, u);
        const float cos_oh = dot(wo, h), cos_i = 2.0f * cos_oh * h.z - cos_o;
        if (cos_i <= 0) continue;
        const float root_o = ggx::smith_root(alpha2, cos_o);
        const float root_i = ggx::smith_root(alpha2, cos_i);
        // G2 / G1 of the height-correlated Smith function.
        const float g = cos_i * (cos_o + root_o) / (cos_i * root_o + cos_o * root_i);
        const float f = ggx::schlick(cos_oh);
        a += g * (1.0f - f);
        b += g * f;
      }
      table->a[row * n + column] = a / kPoints;
      table->b[row * n + column] = b / kPoints;
    }
  });
}

}  // namespace gloam
