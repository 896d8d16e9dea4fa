#pragma once
// The whole surface, after OpenPBR 1.1: fuzz over a coat over a mix of glass and the base of
// bsdf.h, whose diffuse part may go through thin sheets. What a layer reflects is missing below it
// (albedo scaling by the viewing direction). Lanes without layers take the base alone. Conventions
// as in bsdf.h; directions with z < 0 are on the far side of the surface. Device-safe.

#include "render/kernel/bsdf/bsdf.h"

namespace gloam {

template <class F>
struct LayeredBsdfOf {
  BsdfOf<F> base;
  MaskOf<F> layered = false;  ///< all that follows counts for these lanes alone
  F p_base = F(1.0f), p_coat{}, p_fuzz{}, p_glass{}, p_beyond{};  ///< of sampling each; sum = 1
  Vec3Of<F> under;  ///< fraction of light that passes fuzz and coat
  F coat_alpha{}, coat_root{}, coat_f0{}, coat_f90{};  ///< as in BsdfOf, coat weight included
  Vec3Of<F> fuzz;                                      ///< colour times weight
  F fuzz_alpha{};
  F glass{};  ///< weight, energy compensation included
  F eta{};    ///< index of refraction beyond / here
  Vec2Of<F> glass_alpha;
  F glass_root{};
  Vec3Of<F> tint;          ///< of light that goes through glass
  MaskOf<F> thin = false;  ///< glass is a sheet: nothing is bent
  MaskOf<F> straight =
      false;         ///< light that goes through a sheet is not scattered: no part of this
  Vec3Of<F> beyond;  ///< albedo of diffuse light that goes through
  using Members =
      MemberList<&LayeredBsdfOf::base, &LayeredBsdfOf::layered, &LayeredBsdfOf::p_base,
                 &LayeredBsdfOf::p_coat, &LayeredBsdfOf::p_fuzz, &LayeredBsdfOf::p_glass,
                 &LayeredBsdfOf::p_beyond, &LayeredBsdfOf::under, &LayeredBsdfOf::coat_alpha,
                 &LayeredBsdfOf::coat_root, &LayeredBsdfOf::coat_f0, &LayeredBsdfOf::coat_f90,
                 &LayeredBsdfOf::fuzz, &LayeredBsdfOf::fuzz_alpha, &LayeredBsdfOf::glass,
                 &LayeredBsdfOf::eta, &LayeredBsdfOf::glass_alpha, &LayeredBsdfOf::glass_root,
                 &LayeredBsdfOf::tint, &LayeredBsdfOf::thin, &LayeredBsdfOf::straight,
                 &LayeredBsdfOf::beyond>;
};
using LayeredBsdf = LayeredBsdfOf<float>;

namespace layers {

/// Share that glass reflects at the microfacet; *cos_t as in fresnel_dielectric.
template <class F>
GLOAM_HD F glass_reflects(const LayeredBsdfOf<F>& b, F cos_h, F* cos_t) {
  const F face = fresnel_dielectric(cos_h, b.eta, cos_t);
  if (!any(b.thin)) return face;
  return select(b.thin, fresnel_sheet(cos_h, b.eta, cos_t), face);
}
/// Probability of reflection where `reflects` of the light is reflected.
template <class F>
GLOAM_HD F reflection_chance(const LayeredBsdfOf<F>& b, F reflects) {
  return select(b.straight, F(1.0f), reflects);
}

/// f |cos|, and the density of sample_glass (Walter et al. 2007, "Microfacet models for refraction
/// through rough surfaces"). Radiance is squeezed where it enters glass: 1 / eta².
template <class F>
GLOAM_HD Vec3Of<F> eval_glass(const LayeredBsdfOf<F>& b, Vec3Of<F> wo, Vec3Of<F> wi, F* pdf) {
  const MaskOf<F> through = wi.z < 0.0f, bent = through & !b.thin;
  const Vec3Of<F> mirrored{wi.x, wi.y, select(through & b.thin, -wi.z, wi.z)};
  Vec3Of<F> h = wo + mirrored * select(bent, b.eta, F(1.0f));
  const F length2 = length_squared(h);
  h = h * (select(h.z < 0.0f, F(-1.0f), F(1.0f)) / square_root(max(length2, 1e-20f)));
  const F cos_o = dot(wo, h), cos_i = dot(mirrored, h), away = magnitude(wi.z);
  F cos_t;
  const F reflects = glass_reflects(b, cos_o, &cos_t);
  const F d = ggx::distribution(b.glass_alpha, h);
  const F g = ggx::visibility(wo.z, b.glass_root, away, ggx::smith_root(b.glass_alpha, wi));
  const F visible = d / (2.0f * (wo.z + b.glass_root));  // density of h over 4 cos_o
  // Density of wi for that of the half vector h: refraction spreads half vectors otherwise than a
  // mirror does.
  const F denominator = sqr(cos_i + cos_o / b.eta);
  const F spread =
      select(bent, 4.0f * cos_o * magnitude(cos_i) / max(denominator, 1e-12f), F(1.0f));
  const F fraction = select(through, select(b.straight, F(0.0f), 1.0f - reflects), reflects);
  const F chance = reflection_chance(b, reflects);
  const MaskOf<F> possible = (length2 > 1e-12f) & (cos_o > 0.0f) & (away > 0.0f) &
                             select(bent, cos_i < 0.0f, cos_i > 0.0f);
  *pdf = select(possible, visible * spread * select(through, 1.0f - chance, chance), F(0.0f));
  const F value = d * g * away * spread * fraction * select(bent, 1.0f / sqr(b.eta), F(1.0f));
  const Vec3Of<F> color = select<F>(through, b.tint, in_all_lanes<F>({1, 1, 1}));
  return color * select(possible, value, F(0.0f));
}

/// Zero where the direction is on the wrong side.
template <class F>
GLOAM_HD Vec3Of<F> sample_glass(const LayeredBsdfOf<F>& b, Vec3Of<F> wo, F pick, Vec2Of<F> u) {
  const Vec3Of<F> h = ggx::sample_half(b.glass_alpha, wo, u);
  const F cos_o = dot(wo, h);
  F cos_t;
  const F reflects = glass_reflects(b, cos_o, &cos_t);
  const MaskOf<F> mirrors = pick < reflection_chance(b, reflects);
  const Vec3Of<F> r = mirror(wo, h), t = refract(wo, h, b.eta, cos_o, cos_t);
  const MaskOf<F> bent = !(mirrors | b.thin);
  const MaskOf<F> right_side = select(bent, t.z < 0.0f, r.z > 0.0f);
  const Vec3Of<F> wi = select<F>(mirrors, r, select<F>(b.thin, Vec3Of<F>{r.x, r.y, -r.z}, t));
  return select<F>(right_side, wi, Vec3Of<F>{});
}

/// f |cos|, and the density of sampling the coat.
template <class F>
GLOAM_HD F eval_coat(const LayeredBsdfOf<F>& b, Vec3Of<F> wo, Vec3Of<F> wi, F* pdf) {
  const Vec3Of<F> h = normalize(wo + wi);
  const Vec2Of<F> alpha{b.coat_alpha, b.coat_alpha};
  const F d = ggx::distribution(alpha, h);
  const F g = ggx::visibility(wo.z, b.coat_root, wi.z, ggx::smith_root(alpha, wi));
  *pdf = d / (2.0f * (wo.z + b.coat_root));
  return lerp(b.coat_f0, b.coat_f90, ggx::schlick(dot(wo, h))) * d * g * wi.z;
}

}  // namespace layers

/// f times |cos| of wi, and the density with which sample_bsdf makes wi.
template <class F>
GLOAM_HD Vec3Of<F> eval_bsdf(const LayeredBsdfOf<F>& b, Vec3Of<F> wo, Vec3Of<F> wi, F* pdf) {
  Vec3Of<F> value = eval_bsdf(b.base, wo, wi, pdf);
  if (kPlainScenes || !any(b.layered)) return value;
  const MaskOf<F> near = b.layered & (wo.z > 0.0f) & (wi.z > 0.0f);
  const MaskOf<F> far = b.layered & (wo.z > 0.0f) & (wi.z < 0.0f);
  value = select<F>(b.layered, value * b.under, value);
  *pdf *= b.p_base;
  const auto add = [&](MaskOf<F> where, Vec3Of<F> f, F density) {
    value += select<F>(where, f, Vec3Of<F>{});
    *pdf += select(where, density, F(0.0f));
  };
  F density;
  if (const MaskOf<F> m = near & (b.p_coat > 0.0f); any(m)) {
    const F f = layers::eval_coat(b, wo, wi, &density);
    add(m, Vec3Of<F>{f, f, f}, b.p_coat * density);
  }
  if (const MaskOf<F> m = near & (b.p_fuzz > 0.0f); any(m)) {
    F f{};
    const Vec3Of<F> h = normalize(wo + wi);
    each_lane(m, [&](int i) {
      set_lane(&f, i,
               sheen::lobe(lane(b.fuzz_alpha, i), lane(wo.z, i), lane(wi.z, i), lane(h.z, i)));
    });
    add(m, b.fuzz * (f * wi.z), b.p_fuzz * wi.z * kInvPi);
  }
  if (const MaskOf<F> m = (near | far) & (b.p_glass > 0.0f); any(m)) {
    const Vec3Of<F> f = layers::eval_glass(b, wo, wi, &density);
    add(m, f * b.under * b.glass, b.p_glass * density);
  }
  if (const MaskOf<F> m = far & (b.p_beyond > 0.0f); any(m)) {
    const F cosine = -wi.z * kInvPi;
    add(m, b.under * b.beyond * cosine, b.p_beyond * cosine);
  }
  return value;
}

/// Sample as BsdfOf's; the given direction lies on the near side.
template <class F>
GLOAM_HD BsdfSampleOf<F> sample_bsdf(const LayeredBsdfOf<F>& b, Vec3Of<F> wo, F pick, Vec2Of<F> u,
                                     MaskOf<F> given = false, Vec3Of<F> wi_given = {}) {
  if (kPlainScenes || !any(b.layered)) return sample_bsdf(b.base, wo, pick, u, given, wi_given);
  // Each part takes an interval of `pick` as long as its probability, stretched to [0, 1).
  MaskOf<F> open = true;
  F own = pick, left = pick;
  const auto take = [&](F probability) {
    const MaskOf<F> mine = open & (left < probability);
    own = select(mine, clamp(left / probability, 0.0f, 0.9999999f), own);
    left -= probability;
    open = open & !mine;
    return mine;
  };
  const MaskOf<F> of_base = (!b.layered) | take(b.p_base);
  const MaskOf<F> of_coat = take(b.p_coat), of_fuzz = take(b.p_fuzz), of_glass = take(b.p_glass);
  const MaskOf<F> of_beyond = !(of_base | of_coat | of_fuzz | of_glass);
  own = select(b.layered, own, pick);
  BsdfSampleOf<F> sample;
  if (any(of_base)) sample = sample_bsdf(b.base, wo, own, u, given, wi_given);
  Vec3Of<F> wi = sample.wi;
  if (any(of_coat)) {
    const Vec3Of<F> h = ggx::sample_half(Vec2Of<F>{b.coat_alpha, b.coat_alpha}, wo, u);
    wi = select<F>(of_coat, mirror(wo, h), wi);
  }
  if (any(of_glass)) {
    wi = select<F>(of_glass, layers::sample_glass(b, wo, own, u), wi);
  }
  if (any(of_fuzz | of_beyond)) {
    const Vec3Of<F> d = sample_cosine_hemisphere(u);
    wi = select<F>(of_fuzz, d, select<F>(of_beyond, -d, wi));
  }
  // Only glass chooses the side by itself: what others put on the wrong side is lost.
  const MaskOf<F> right_side =
      select(given, wi_given.z > 0.0f, of_glass | select(of_beyond, wi.z < 0.0f, wi.z > 0.0f));
  wi = select<F>(given, wi_given, wi);
  F pdf;
  const Vec3Of<F> value = eval_bsdf(b, wo, wi, &pdf);
  const MaskOf<F> valid = right_side & (pdf > 1e-12f);
  sample.wi = select<F>(b.layered, wi, sample.wi);
  sample.weight = select<F>(b.layered, select<F>(valid, value / pdf, Vec3Of<F>{}), sample.weight);
  sample.pdf = select(b.layered, select(valid, pdf, F(0.0f)), sample.pdf);
  return sample;
}

/// Directional albedo of single scattering on rough glass of any eta.
GLOAM_HD float glass_albedo(const GlassTable& table, float roughness, float cosine, float eta) {
  constexpr int n = GlassTable::kSize;
  const float z = (GlassTable::axis_of(eta) + 1.0f) * (0.5f * (n - 1.0f));
  const float x = clamp(cosine, 0.0f, 1.0f) * (n - 1.0f),
              y = clamp(roughness, 0.0f, 1.0f) * (n - 1.0f);
  const int ix = static_cast<int>(min(x, n - 1.001f)), iy = static_cast<int>(min(y, n - 1.001f));
  const int iz = static_cast<int>(clamp(z, 0.0f, n - 1.001f));
  const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
  const float fz = clamp(z - static_cast<float>(iz), 0.0f, 1.0f);
  const float* cell = table.albedo + (iz * n + iy) * n + ix;
  const auto plane = [&](const float* at) {
    return lerp(lerp(at[0], at[1], fx), lerp(at[n], at[n + 1], fx), fy);
  };
  return max(lerp(plane(cell), plane(cell + n * n), fz), 1e-3f);
}

/// Base that a material's layers lie on, textures included.
struct SurfaceParameters {
  Vec3f base_color;
  float metallic = 0, roughness = 0, f0 = 0, f90 = 0;
  bool outside = true;
  float coat_weight = 0, coat_roughness = 0, coat_f0 = 0.04f, coat_darkening = 0, fuzz_weight = 0;
  float transmission = 0;
};

/// Roughness that lobes seem to have through a rough coat of the weight `coat`, which blurs what
/// goes in and what comes out (OpenPBR 1.1, "Roughening").
GLOAM_HD float roughness_under_coat(float roughness, float coat_roughness, float coat) {
  if (!(coat * coat_roughness > 0)) return roughness;
  const float blurred = min(sqr(sqr(roughness)) + 2.0f * sqr(sqr(coat_roughness)), 1.0f);
  return lerp(roughness, sqrtf(sqrtf(blurred)), coat);
}

/// Share of the base's light that is left where a coat throws a part back down again and again:
/// OpenPBR 1.1, "Darkening". `base`: its albedo; `roughness`: 0 mirror … 1 diffuse.
GLOAM_HD Vec3f darkened_by_coat(float coat_f0, float cosine, float roughness, Vec3f base) {
  const float root = sqrtf(coat_f0), ior = (1.0f + root) / (1.0f - root);
  const float mean = coat_f0 + (1.0f - coat_f0) * (1.0f / 21.0f);  // of Schlick's term, all around
  const float diffuse = 1.0f - (1.0f - mean) / sqr(ior);
  const float thrown_back =
      min(lerp(lerp(coat_f0, 1.0f, ggx::schlick(cosine)), diffuse, roughness), 0.999f);
  const float passes = 1.0f - thrown_back;
  return {passes / (1.0f - base.x * thrown_back), passes / (1.0f - base.y * thrown_back),
          passes / (1.0f - base.z * thrown_back)};
}

/// The layers `m` over `s`; `wo` in the shading frame, z > 0.
GLOAM_HD LayeredBsdf make_layered(const SceneView& scene, const MaterialLayers& m,
                                  const SurfaceParameters& s, Vec3f wo) {
  const AlbedoTable& table = *scene.albedo;
  LayeredBsdf b;
  b.layered = true;
  b.under = {1, 1, 1};
  float a, f;
  const float fuzz = s.fuzz_weight * (s.outside ? 1.0f : 0.0f);
  float fuzz_albedo = 0;
  if (fuzz > 0) {
    b.fuzz = m.fuzz_color * fuzz;
    b.fuzz_alpha = max(sqr(m.fuzz_roughness), 1e-2f);
    fuzz_albedo = AlbedoCellOf<float>(m.fuzz_roughness, wo.z).read(table.fuzz);
    b.under *= 1.0f - max_component(b.fuzz) * fuzz_albedo;
  }
  const Vec3f under_fuzz = b.under;
  const float coat = s.coat_weight * (s.outside ? 1.0f : 0.0f);
  float coat_albedo = 0;
  if (coat > 0) {
    b.coat_alpha = ggx_widths(s.coat_roughness, 0.0f).x;
    b.coat_root = ggx::smith_root(Vec2f{b.coat_alpha, b.coat_alpha}, wo);
    layer_albedo(table, s.coat_roughness, wo.z, &a, &f);
    const float single = max(a + f, 1e-3f);
    const float gain = 1.0f + s.coat_f0 * (1.0f - single) / single;
    coat_albedo = (s.coat_f0 * a + f) * gain;
    const float weight_f90 = coat * gain * under_fuzz.x;  // fuzz dims all channels alike
    b.coat_f0 = weight_f90 * s.coat_f0;
    b.coat_f90 = weight_f90;
    b.under = b.under * lerp(Vec3f{1, 1, 1}, m.coat_color, coat) * (1.0f - coat * coat_albedo);
  }
  const float roughness = roughness_under_coat(s.roughness, s.coat_roughness, coat);
  const float through = s.transmission * (1.0f - s.metallic);
  b.base = make_bsdf(table, s.base_color, Vec3f{1, 1, 1}, s.metallic, 1.0f - s.transmission,
                     roughness, s.f0, s.f90, m.anisotropy, wo);
  const float base_fraction = b.base.diffuse.x;  // of light that gets below the base's own layer
  const Vec3f inside = m.subsurface_color * (m.thin ? 0.5f : 1.0f);
  b.base.diffuse = lerp(s.base_color, inside, m.subsurface) * base_fraction;
  if (m.thin) b.beyond = inside * (m.subsurface * base_fraction);
  if (coat * s.coat_darkening > 0) {
    // Glass is not dimmed: what the coat throws back goes through.
    const Vec3f white{1, 1, 1};
    const Vec3f diffuse = lerp(s.base_color, m.subsurface_color, m.subsurface);
    const Vec3f albedo = lerp(lerp(diffuse, white, s.f0), s.base_color, s.metallic);
    const float smooth = lerp(s.f0, 1.0f, s.metallic);
    const Vec3f left =
        lerp(white, darkened_by_coat(s.coat_f0, wo.z, lerp(1.0f, roughness, smooth), albedo),
             coat * s.coat_darkening);
    b.base.diffuse *= left;
    b.base.f0 *= left;
    b.base.f90 *= left;
    b.beyond *= left;
  }
  if (through > 0) {
    b.thin = m.thin;
    b.straight = m.straight;
    b.eta = s.outside || m.thin ? m.ior : 1.0f / m.ior;
    b.tint = m.tint;
    b.glass_alpha = ggx_widths(roughness, m.anisotropy);
    b.glass_root = ggx::smith_root(b.glass_alpha, wo);
    layer_albedo(table, roughness, wo.z, &a, &f);
    b.glass =
        through / (m.thin ? max(a + f, 1e-3f) : glass_albedo(*scene.glass, roughness, wo.z, b.eta));
  }
  layer_albedo(table, roughness, wo.z, &a, &f);
  const float weight[5] = {luminance((b.base.diffuse + b.base.f0 * a + b.base.f90 * f) * b.under),
                           coat * coat_albedo * under_fuzz.x, max_component(b.fuzz) * fuzz_albedo,
                           through * luminance(b.under), luminance(b.beyond * b.under)};
  float total = 0;
  for (const float w : weight) total += w;
  // Surfaces that reflect no light still have one part to sample.
  const float scale = total > 0 ? 1.0f / total : 0.0f;
  b.p_coat = weight[1] * scale;
  b.p_fuzz = weight[2] * scale;
  b.p_glass = weight[3] * scale;
  b.p_beyond = weight[4] * scale;
  b.p_base = max(1.0f - b.p_coat - b.p_fuzz - b.p_glass - b.p_beyond, 0.0f);
  return b;
}

}  // namespace gloam
