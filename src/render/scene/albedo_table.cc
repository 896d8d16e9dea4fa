#include "render/scene/albedo_table.h"

#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "render/kernel/bsdf/bsdf.h"
#include "render/kernel/math/sampler.h"

namespace gloam {

void fill_albedo_table(AlbedoTable* table) {
  constexpr int n = AlbedoTable::kSize;
  constexpr uint32_t kPoints = 256;
  parallel_for("albedo table", n, [table](int64_t row) {
    const float roughness = static_cast<float>(row) / (n - 1);
    const Vec2f alpha = ggx_widths(roughness, 0.0f);
    for (int column = 0; column < n; ++column) {
      const float cos_o = max(static_cast<float>(column) / (n - 1), 2e-3f);
      const Vec3f wo{safe_sqrt(1.0f - cos_o * cos_o), 0, cos_o};
      float a = 0, b = 0;
      // Few points integrate what is smooth best where they are even in polar coordinates.
      for (uint32_t i = 0; i < kPoints; ++i) {
        const Vec2f polar{(static_cast<float>(i) + 0.5f) / kPoints, uniform_float(reverse_bits(i))};
        const Vec3f h = ggx::half_at(alpha, wo, polar);
        const float cos_oh = dot(wo, h), cos_i = 2.0f * cos_oh * h.z - cos_o;
        if (cos_i <= 0) continue;
        const Vec3f wi = mirror(wo, h);
        const float g =
            ggx::escaping(cos_o, ggx::smith_root(alpha, wo), cos_i, ggx::smith_root(alpha, wi));
        const float f = ggx::schlick(cos_oh);
        a += g * (1.0f - f);
        b += g * f;
      }
      table->a[row * n + column] = a / kPoints;
      table->b[row * n + column] = b / kPoints;
      const float fuzz_alpha = max(roughness * roughness, 1e-2f);
      float fuzz = 0;
      for (uint32_t i = 0; i < kPoints; ++i) {
        const float r2 = (static_cast<float>(i) + 0.5f) / kPoints;
        float sine, cosine;
        sincos_turn(uniform_float(reverse_bits(i)), &sine, &cosine);
        const Vec3f wi{sqrtf(r2) * cosine, sqrtf(r2) * sine, sqrtf(1.0f - r2)};
        fuzz += sheen::lobe(fuzz_alpha, cos_o, wi.z, normalize(wo + wi).z) * kPi;
      }
      table->fuzz[row * n + column] = fuzz / kPoints;
    }
  });
}

void fill_glass_table(GlassTable* table) {
  constexpr int n = GlassTable::kSize;
  constexpr uint32_t kPoints = 256;
  parallel_for("glass table", n * n, [table](int64_t row) {
    const int64_t plane = row / n;
    const float axis = 2.0f * static_cast<float>(plane) / (n - 1) - 1.0f;
    const float roughness = static_cast<float>(row % n) / (n - 1);
    const Vec2f alpha = ggx_widths(roughness, 0.0f);
    const float eta = GlassTable::eta_at(axis);
    for (int column = 0; column < n; ++column) {
      const float cos_o = max(static_cast<float>(column) / (n - 1), 1e-2f);
      const Vec3f wo{safe_sqrt(1.0f - cos_o * cos_o), 0, cos_o};
      const float root_o = ggx::smith_root(alpha, wo);
      float sum = 0;
      for (uint32_t i = 0; i < kPoints; ++i) {
        const float x = (static_cast<float>(i) + 0.5f) / kPoints;
        const Vec2f polar{x, uniform_float(reverse_bits(i))};
        // Both sides of each microfacet: the choice between them adds no noise.
        const Vec3f h = ggx::half_at(alpha, wo, polar);
        float cos_t;
        const float cos_h = dot(wo, h), f = fresnel_dielectric(cos_h, eta, &cos_t);
        const Vec3f r = mirror(wo, h), t = refract(wo, h, eta, cos_h, cos_t);
        const auto seen = [&](Vec3f wi) {
          return ggx::escaping(cos_o, root_o, std::fabs(wi.z), ggx::smith_root(alpha, wi));
        };
        if (r.z > 0) sum += f * seen(r);
        if (t.z < 0 && f < 1) sum += (1 - f) * seen(t);
      }
      table->albedo[row * n + column] = sum / kPoints;
    }
  });
}

}  // namespace gloam
