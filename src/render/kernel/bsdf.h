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

template <class F>
struct BsdfOf {
  Vec3Of<F> diffuse;  ///< albedo of the base after the layer took its share
  Vec3Of<F> f0;       ///< of the layer at normal incidence, energy compensation included
  Vec3Of<F> f90;      ///< of the layer at grazing incidence, energy compensation included
  F alpha{};          ///< GGX width
  F root_o{};         ///< smith_root of the viewing direction
  F p_layer{};        ///< probability of sampling the layer
};
using Bsdf = BsdfOf<float>;

template <class F>
struct BsdfSampleOf {
  Vec3Of<F> wi;
  Vec3Of<F> weight;  ///< f |cos| / pdf
  F pdf{};           ///< per solid angle; 0 = no direction
};
using BsdfSample = BsdfSampleOf<float>;

namespace ggx {

/// Smith's Lambda term times 2 cos, plus cos: sqrt(alpha² + (1 - alpha²) cos²).
template <class F>
GLOAM_HD F smith_root(F alpha2, F cosine) {
  return square_root(alpha2 + (1.0f - alpha2) * cosine * cosine);
}
template <class F>
GLOAM_HD F distribution(F alpha2, F cos_h) {
  const F k = cos_h * cos_h * (alpha2 - 1.0f) + 1.0f;
  return alpha2 * kInvPi / (k * k);
}
/// Half vector by the visible normals (Dupuy and Benyoub 2023, "Sampling visible GGX normals with
/// spherical caps").
template <class F>
GLOAM_HD Vec3Of<F> sample_half(F alpha, Vec3Of<F> wo, Vec2Of<F> u) {
  const Vec3Of<F> v = normalize(Vec3Of<F>{wo.x * alpha, wo.y * alpha, wo.z});
  const F z = (1.0f - u.x) * (1.0f + v.z) - v.z;
  const F r = safe_sqrt(1.0f - z * z);
  F s, c;
  sincos_turn(u.y, &s, &c);
  const Vec3Of<F> h = Vec3Of<F>{r * c, r * s, z} + v;
  return normalize(Vec3Of<F>{h.x * alpha, h.y * alpha, max(h.z, 1e-6f)});
}
/// (1 - cosine)^5, Schlick's weight.
template <class F>
GLOAM_HD F schlick(F cosine) {
  const F m = clamp(1.0f - cosine, 0.0f, 1.0f), m2 = m * m;
  return m2 * m2 * m;
}

}  // namespace ggx

/// Directional albedo of the layer: F0 *a + F90 *b.
template <class F>
GLOAM_HD void layer_albedo(const AlbedoTable& table, F roughness, F cosine, F* a, F* b) {
  constexpr uint32_t n = AlbedoTable::kSize;
  const F x = clamp(cosine, 0.0f, 1.0f) * (n - 1.0f), y = clamp(roughness, 0.0f, 1.0f) * (n - 1.0f);
  const UintOf<F> ix = to_uint(min(x, n - 1.001f)), iy = to_uint(min(y, n - 1.001f));
  const F fx = x - to_float(ix), fy = y - to_float(iy);
  const UintOf<F> i = iy * n + ix;
  const auto read = [&](const float* values) {
    return lerp(lerp(gather(values, i), gather(values, i + 1u), fx),
                lerp(gather(values, i + n), gather(values, i + (n + 1u)), fx), fy);
  };
  *a = read(table.a);
  *b = read(table.b);
}

/// `cos_o`: cosine of the viewing direction, > 0.
template <class F>
GLOAM_HD BsdfOf<F> make_bsdf(const AlbedoTable& table, Vec3Of<F> base_color, F metallic,
                             F roughness, F dielectric_f0, F dielectric_f90, F cos_o) {
  BsdfOf<F> bsdf;
  const F dielectric = 1.0f - metallic;
  if (!any((metallic > 0.0f) | (dielectric_f0 > 0.0f) | (dielectric_f90 > 0.0f))) {
    bsdf.diffuse = base_color * dielectric;
    return bsdf;
  }
  bsdf.alpha = max(roughness * roughness, 1e-3f);
  bsdf.root_o = ggx::smith_root(sqr(bsdf.alpha), cos_o);
  F a, b;
  layer_albedo(table, roughness, cos_o, &a, &b);
  const F single = max(a + b, 1e-3f), missing = (1.0f - single) / single;
  const F f0_d = dielectric_f0, gain_d = 1.0f + f0_d * missing;
  const F albedo_d = (f0_d * a + dielectric_f90 * b) * gain_d;
  const Vec3Of<F> white = in_all_lanes<F>({1, 1, 1});
  bsdf.diffuse = base_color * (dielectric * (1.0f - albedo_d));
  const Vec3Of<F> gain_m = white + base_color * missing;
  bsdf.f0 = base_color * gain_m * metallic + white * (f0_d * gain_d * dielectric);
  bsdf.f90 = gain_m * metallic + white * (dielectric_f90 * gain_d * dielectric);
  const F layer = luminance(bsdf.f0 * a + bsdf.f90 * b), base = luminance(bsdf.diffuse);
  // Both parts keep a fair chance, as their lobes differ; a mere rounding error gets none.
  const F share = select(layer > 0.0f, layer / (layer + base), F(0.0f));
  bsdf.p_layer =
      select(share < 1e-5f, F(0.0f), select(share > 0.99999f, F(1.0f), clamp(share, 0.1f, 0.9f)));
  return bsdf;
}

/// f times the cosine of wi, and the density with which sample_bsdf makes wi.
template <class F>
GLOAM_HD Vec3Of<F> eval_bsdf(const BsdfOf<F>& bsdf, Vec3Of<F> wo, Vec3Of<F> wi, F* pdf) {
  Vec3Of<F> value = bsdf.diffuse * (wi.z * kInvPi);
  *pdf = (1.0f - bsdf.p_layer) * wi.z * kInvPi;
  const MaskOf<F> layered = bsdf.p_layer > 0.0f;
  if (any(layered)) {
    const Vec3Of<F> h = normalize(wo + wi);
    const F alpha2 = bsdf.alpha * bsdf.alpha;
    const F d = ggx::distribution(alpha2, h.z);
    const F root_i = ggx::smith_root(alpha2, wi.z);
    // Height-correlated Smith: G2 / (4 cos_o cos_i) = 1 / (2 (cos_i root_o + cos_o root_i)).
    const F g = 0.5f / (wi.z * bsdf.root_o + wo.z * root_i);
    const F f = ggx::schlick(dot(wo, h));
    const Vec3Of<F> layer = lerp(bsdf.f0, bsdf.f90, f) * (d * g * wi.z);
    value = select<F>(layered, value + layer, value);
    const F share = bsdf.p_layer * d / (2.0f * (wo.z + bsdf.root_o));  // G1 D / (4 cos_o)
    *pdf += select(layered, share, F(0.0f));
  }
  const MaskOf<F> above = (wi.z > 0.0f) & (wo.z > 0.0f);
  *pdf = select(above, *pdf, F(0.0f));
  return select<F>(above, value, Vec3Of<F>{});
}

template <class F>
GLOAM_HD BsdfSampleOf<F> sample_bsdf(const BsdfOf<F>& bsdf, Vec3Of<F> wo, F pick, Vec2Of<F> u) {
  BsdfSampleOf<F> sample;
  const MaskOf<F> layer = pick < bsdf.p_layer;
  sample.wi = sample_cosine_hemisphere(u);
  if (any(layer)) {
    const Vec3Of<F> h = ggx::sample_half(bsdf.alpha, wo, u);
    sample.wi = select<F>(layer, h * (2.0f * dot(wo, h)) - wo, sample.wi);
  }
  const Vec3Of<F> value = eval_bsdf(bsdf, wo, sample.wi, &sample.pdf);
  const MaskOf<F> valid = sample.pdf > 1e-12f;
  sample.weight = select<F>(valid, value / sample.pdf, Vec3Of<F>{});
  sample.pdf = select(valid, sample.pdf, F(0.0f));
  return sample;
}

}  // namespace gloam
