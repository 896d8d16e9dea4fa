#pragma once
// One BSDF for every surface: a GGX layer (dielectric, metal, or a mix of both, which share the
// roughness and are linear in F0) over a diffuse base. Single scattering is scaled up to restore
// the energy of multiple scattering (Turquin 2019, "Practical multiple scattering compensation for
// microfacet models"); the base gets what the dielectric layer does not reflect (albedo scaling,
// OpenPBR 1.1 "Albedo-scaling approximation"). Reflected light never exceeds the incoming; a white
// surface reflects all of it. Directions are in the shading frame, z along the normal, and point
// away from the surface. Device-safe.

#include "render/kernel/bsdf/microfacet.h"
#include "render/kernel/scene_view.h"

namespace gloam {

template <class F>
struct BsdfOf {
  Vec3Of<F> diffuse;  ///< albedo of the base under the layer
  Vec3Of<F> f0;       ///< of the layer at normal incidence, energy compensation included
  Vec3Of<F> f90;      ///< of the layer at grazing incidence, energy compensation included
  Vec2Of<F> alpha;    ///< GGX widths along x and y
  F root_o{};         ///< smith_root of the viewing direction
  F p_layer{};        ///< probability of sampling the layer
  using Members = MemberList<&BsdfOf::diffuse, &BsdfOf::f0, &BsdfOf::f90, &BsdfOf::alpha,
                             &BsdfOf::root_o, &BsdfOf::p_layer>;
};
using Bsdf = BsdfOf<float>;

template <class F>
struct BsdfSampleOf {
  Vec3Of<F> wi;
  Vec3Of<F> weight;  ///< f |cos| / pdf
  F pdf{};           ///< per solid angle; 0 = no direction
};
using BsdfSample = BsdfSampleOf<float>;

/// A table of AlbedoTable at a roughness and a cosine, linearly in between.
template <class F>
struct AlbedoCellOf {
  UintOf<F> i;
  F fx, fy;
  GLOAM_HD AlbedoCellOf(F roughness, F cosine) {
    constexpr uint32_t n = AlbedoTable::kSize;
    const F x = clamp(cosine, 0.0f, 1.0f) * (n - 1.0f);
    const F y = clamp(roughness, 0.0f, 1.0f) * (n - 1.0f);
    const UintOf<F> ix = to_uint(min(x, n - 1.001f)), iy = to_uint(min(y, n - 1.001f));
    fx = x - to_float(ix);
    fy = y - to_float(iy);
    i = iy * n + ix;
  }
  GLOAM_HD F read(const float* values) const {
    constexpr uint32_t n = AlbedoTable::kSize;
    return lerp(lerp(gather(values, i), gather(values, i + 1u), fx),
                lerp(gather(values, i + n), gather(values, i + (n + 1u)), fx), fy);
  }
};

/// Directional albedo of the layer: F0 *a + F90 *b.
template <class F>
GLOAM_HD void layer_albedo(const AlbedoTable& table, F roughness, F cosine, F* a, F* b) {
  const AlbedoCellOf<F> cell(roughness, cosine);
  *a = cell.read(table.a);
  *b = cell.read(table.b);
}

/// GGX widths of a roughness (OpenPBR 1.1): `anisotropy` in [0, 1) draws highlights out along x.
template <class F>
GLOAM_HD Vec2Of<F> ggx_widths(F roughness, F anisotropy) {
  const F across = 1.0f - anisotropy, r2 = roughness * roughness;
  const F along =
      r2 * select(anisotropy > 0.0f, square_root(2.0f / (1.0f + across * across)), F(1.0f));
  return {max(along, 1e-3f), max(along * across, 1e-3f)};
}

/// `opaque`: fraction of the non-metal that is no glass. `wo`: viewing direction, z > 0.
template <class F>
GLOAM_HD BsdfOf<F> make_bsdf(const AlbedoTable& table, Vec3Of<F> metal_color,
                             Vec3Of<F> diffuse_color, F metallic, F opaque, F roughness,
                             F dielectric_f0, F dielectric_f90, F anisotropy, Vec3Of<F> wo) {
  BsdfOf<F> bsdf;
  const F dielectric = (1.0f - metallic) * opaque;
  if (!any((metallic > 0.0f) | (dielectric_f0 > 0.0f) | (dielectric_f90 > 0.0f))) {
    bsdf.diffuse = diffuse_color * dielectric;
    return bsdf;
  }
  bsdf.alpha = ggx_widths(roughness, anisotropy);
  bsdf.root_o = ggx::smith_root(bsdf.alpha, wo);
  F a, b;
  layer_albedo(table, roughness, wo.z, &a, &b);
  const F single = max(a + b, 1e-3f), missing = (1.0f - single) / single;
  const F f0_d = dielectric_f0, gain_d = 1.0f + f0_d * missing;
  const F albedo_d = (f0_d * a + dielectric_f90 * b) * gain_d;
  const Vec3Of<F> white = in_all_lanes<F>({1, 1, 1});
  bsdf.diffuse = diffuse_color * (dielectric * (1.0f - albedo_d));
  const Vec3Of<F> gain_m = white + metal_color * missing;
  bsdf.f0 = metal_color * gain_m * metallic + white * (f0_d * gain_d * dielectric);
  bsdf.f90 = gain_m * metallic + white * (dielectric_f90 * gain_d * dielectric);
  const F layer = luminance(bsdf.f0 * a + bsdf.f90 * b), base = luminance(bsdf.diffuse);
  // Both parts keep a fair chance, as their lobes differ; a mere rounding error gets none.
  const F probability = select(layer > 0.0f, layer / (layer + base), F(0.0f));
  bsdf.p_layer = select(probability < 1e-5f, F(0.0f),
                        select(probability > 0.99999f, F(1.0f), clamp(probability, 0.1f, 0.9f)));
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
    const F d = ggx::distribution(bsdf.alpha, h);
    const F g = ggx::visibility(wo.z, bsdf.root_o, wi.z, ggx::smith_root(bsdf.alpha, wi));
    const F f = ggx::schlick(dot(wo, h));
    const Vec3Of<F> layer = lerp(bsdf.f0, bsdf.f90, f) * (d * g * wi.z);
    value = select<F>(layered, value + layer, value);
    const F layer_pdf = bsdf.p_layer * d / (2.0f * (wo.z + bsdf.root_o));  // G1 D / (4 cos_o)
    *pdf += select(layered, layer_pdf, F(0.0f));
  }
  const MaskOf<F> above = (wi.z > 0.0f) & (wo.z > 0.0f);
  *pdf = select(above, *pdf, F(0.0f));
  return select<F>(above, value, Vec3Of<F>{});
}

/// The lanes of `given` take the direction `wi` instead of one by `pick` and `u`.
template <class F>
GLOAM_HD BsdfSampleOf<F> sample_bsdf(const BsdfOf<F>& bsdf, Vec3Of<F> wo, F pick, Vec2Of<F> u,
                                     MaskOf<F> given = false, Vec3Of<F> wi = {}) {
  BsdfSampleOf<F> sample;
  const MaskOf<F> layer = pick < bsdf.p_layer;
  sample.wi = sample_cosine_hemisphere(u);
  if (any(layer)) {
    const Vec3Of<F> h = ggx::sample_half(bsdf.alpha, wo, u);
    sample.wi = select<F>(layer, mirror(wo, h), sample.wi);
  }
  sample.wi = select<F>(given, wi, sample.wi);
  const Vec3Of<F> value = eval_bsdf(bsdf, wo, sample.wi, &sample.pdf);
  const MaskOf<F> valid = sample.pdf > 1e-12f;
  sample.weight = select<F>(valid, value / sample.pdf, Vec3Of<F>{});
  sample.pdf = select(valid, sample.pdf, F(0.0f));
  return sample;
}

}  // namespace gloam
