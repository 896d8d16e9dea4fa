#pragma once
// One BSDF for every surface: a GGX layer (dielectric, metal, or a mix of both, which share the
// roughness and are linear in F0) over a diffuse base. Single scattering is scaled up to restore
// the energy of multiple scattering (Turquin 2019, "Practical multiple scattering compensation for
// microfacet models"); the base gets what the dielectric layer does not reflect (albedo scaling,
// OpenPBR 1.1 "Albedo-scaling approximation"). Reflected light never exceeds the incoming; a white
// surface reflects all of it. Directions are in the shading frame, z along the normal, and point
// away from the surface. Device-safe.

#include "render/kernel/scene_view.h"

namespace gloam {

struct Bsdf {
  Vec3f diffuse;      ///< albedo of the base after the layer took its share
  Vec3f f0;           ///< of the layer at normal incidence, energy compensation included
  Vec3f f90;          ///< of the layer at grazing incidence, energy compensation included
  float alpha = 0;    ///< GGX width
  float root_o = 0;   ///< smith_root of the viewing direction
  float p_layer = 0;  ///< probability of sampling the layer
};

struct BsdfSample {
  Vec3f wi;
  Vec3f weight;   ///< f |cos| / pdf
  float pdf = 0;  ///< per solid angle; 0 = no direction
};

namespace ggx {

/// Smith's Lambda term times 2 cos, plus cos: sqrt(alpha² + (1 - alpha²) cos²).
GLOAM_HD float smith_root(float alpha2, float cosine) {
  return sqrtf(alpha2 + (1.0f - alpha2) * cosine * cosine);
}
GLOAM_HD float distribution(float alpha2, float cos_h) {
  const float k = cos_h * cos_h * (alpha2 - 1.0f) + 1.0f;
  return alpha2 * kInvPi / (k * k);
}
/// Half vector by the visible normals (Dupuy and Benyoub 2023, "Sampling visible GGX normals with
/// spherical caps").
GLOAM_HD Vec3f sample_half(float alpha, Vec3f wo, Vec2f u) {
  const Vec3f v = normalize({wo.x * alpha, wo.y * alpha, wo.z});
  const float z = (1.0f - u.x) * (1.0f + v.z) - v.z;
  const float r = safe_sqrt(1.0f - z * z);
  float s, c;
  sincos_turn(u.y, &s, &c);
  const Vec3f h = Vec3f{r * c, r * s, z} + v;
  return normalize({h.x * alpha, h.y * alpha, max(h.z, 1e-6f)});
}
/// (1 - cosine)^5, Schlick's weight.
GLOAM_HD float schlick(float cosine) {
  const float m = clamp(1.0f - cosine, 0.0f, 1.0f), m2 = m * m;
  return m2 * m2 * m;
}

}  // namespace ggx

/// Directional albedo of the layer: F0 *a + F90 *b.
GLOAM_HD void layer_albedo(const AlbedoTable& table, float roughness, float cosine, float* a,
                           float* b) {
  constexpr int n = AlbedoTable::kSize;
  const float x = clamp(cosine, 0.0f, 1.0f) * (n - 1), y = clamp(roughness, 0.0f, 1.0f) * (n - 1);
  const int ix = static_cast<int>(min(x, n - 1.001f)), iy = static_cast<int>(min(y, n - 1.001f));
  const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
  const int i = iy * n + ix;
  *a = lerp(lerp(table.a[i], table.a[i + 1], fx), lerp(table.a[i + n], table.a[i + n + 1], fx), fy);
  *b = lerp(lerp(table.b[i], table.b[i + 1], fx), lerp(table.b[i + n], table.b[i + n + 1], fx), fy);
}

/// `cos_o`: cosine of the viewing direction, > 0.
GLOAM_HD Bsdf make_bsdf(const AlbedoTable& table, Vec3f base_color, float metallic, float roughness,
                        float dielectric_f0, float dielectric_f90, float cos_o) {
  Bsdf bsdf;
  bsdf.alpha = max(roughness * roughness, 1e-3f);
  bsdf.root_o = ggx::smith_root(sqr(bsdf.alpha), cos_o);
  float a, b;
  layer_albedo(table, roughness, cos_o, &a, &b);
  const float single = max(a + b, 1e-3f), missing = (1.0f - single) / single;
  const float f0_d = dielectric_f0, gain_d = 1.0f + f0_d * missing;
  const float albedo_d = (f0_d * a + dielectric_f90 * b) * gain_d;
  const float dielectric = 1.0f - metallic;
  bsdf.diffuse = base_color * (dielectric * (1.0f - albedo_d));
  const Vec3f gain_m = Vec3f{1, 1, 1} + base_color * missing;
  bsdf.f0 = base_color * gain_m * metallic + Vec3f{1, 1, 1} * (f0_d * gain_d * dielectric);
  bsdf.f90 = gain_m * metallic + Vec3f{1, 1, 1} * (dielectric_f90 * gain_d * dielectric);
  const float layer = luminance(bsdf.f0 * a + bsdf.f90 * b), base = luminance(bsdf.diffuse);
  // Both parts keep a fair chance, as their lobes differ; a mere rounding error gets none.
  const float share = layer > 0 ? layer / (layer + base) : 0.0f;
  bsdf.p_layer = share < 1e-5f ? 0.0f : (share > 0.99999f ? 1.0f : clamp(share, 0.1f, 0.9f));
  return bsdf;
}

/// f times the cosine of wi, and the density with which sample_bsdf makes wi.
GLOAM_HD Vec3f eval_bsdf(const Bsdf& bsdf, Vec3f wo, Vec3f wi, float* pdf) {
  *pdf = 0;
  if (wi.z <= 0 || wo.z <= 0) return {0, 0, 0};
  Vec3f value = bsdf.diffuse * (wi.z * kInvPi);
  *pdf = (1.0f - bsdf.p_layer) * wi.z * kInvPi;
  if (bsdf.p_layer > 0) {
    const Vec3f h = normalize(wo + wi);
    const float alpha2 = bsdf.alpha * bsdf.alpha;
    const float d = ggx::distribution(alpha2, h.z);
    const float root_i = ggx::smith_root(alpha2, wi.z);
    // Height-correlated Smith: G2 / (4 cos_o cos_i) = 1 / (2 (cos_i root_o + cos_o root_i)).
    const float g = 0.5f / (wi.z * bsdf.root_o + wo.z * root_i);
    const float f = ggx::schlick(dot(wo, h));
    value += lerp(bsdf.f0, bsdf.f90, f) * (d * g * wi.z);
    *pdf += bsdf.p_layer * d / (2.0f * (wo.z + bsdf.root_o));  // G1 D / (4 cos_o)
  }
  return value;
}

GLOAM_HD BsdfSample sample_bsdf(const Bsdf& bsdf, Vec3f wo, float pick, Vec2f u) {
  BsdfSample sample;
  if (pick < bsdf.p_layer) {
    const Vec3f h = ggx::sample_half(bsdf.alpha, wo, u);
    sample.wi = h * (2.0f * dot(wo, h)) - wo;
  } else {
    sample.wi = sample_cosine_hemisphere(u);
  }
  const Vec3f value = eval_bsdf(bsdf, wo, sample.wi, &sample.pdf);
  if (!(sample.pdf > 1e-12f)) return {};
  sample.weight = value / sample.pdf;
  return sample;
}

}  // namespace gloam
