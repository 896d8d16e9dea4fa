#pragma once
// Fresnel terms and microfacet distributions. Directions are in the shading frame, z along the
// normal, and point away from the surface. Device-safe.

#include "render/kernel/math/ray.h"

namespace gloam {

/// Fractions of light that a smooth dielectric reflects, by its polarisation: across the plane of
/// incidence and in it.
template <class F>
struct FresnelOf {
  F s, p;
};

/// `eta` = index of refraction of the far side over that of the near side. *cos_t: cosine of the
/// refracted direction, 0 = total reflection.
template <class F>
GLOAM_HD FresnelOf<F> fresnel_polarised(F cos_i, F eta, F* cos_t) {
  const F sin2_t = (1.0f - cos_i * cos_i) / (eta * eta);
  *cos_t = safe_sqrt(1.0f - sin2_t);
  const F s = (cos_i - eta * *cos_t) / (cos_i + eta * *cos_t);
  const F p = (eta * cos_i - *cos_t) / (eta * cos_i + *cos_t);
  return {select(sin2_t >= 1.0f, F(1.0f), s * s), select(sin2_t >= 1.0f, F(1.0f), p * p)};
}

/// Fraction of unpolarised light that a smooth dielectric reflects.
template <class F>
GLOAM_HD F fresnel_dielectric(F cos_i, F eta, F* cos_t) {
  const FresnelOf<F> r = fresnel_polarised(cos_i, eta, cos_t);
  return 0.5f * (r.s + r.p);
}

/// Fraction of unpolarised light that a smooth sheet with two parallel faces reflects, with all the
/// reflections between them: the first face polarises, so each polarisation has its own series
/// R + T² R (1 + R² + …) = 2 R / (1 + R) (Born and Wolf 1999, "Principles of optics", 1.5.2; the
/// sheet is thicker than light is coherent).
template <class F>
GLOAM_HD F fresnel_sheet(F cos_i, F eta, F* cos_t) {
  const FresnelOf<F> r = fresnel_polarised(cos_i, eta, cos_t);
  return r.s / (1.0f + r.s) + r.p / (1.0f + r.p);
}

/// wo mirrored about h.
template <class F>
GLOAM_HD Vec3Of<F> mirror(Vec3Of<F> wo, Vec3Of<F> h) {
  return h * (2.0f * dot(wo, h)) - wo;
}
/// wo refracted at h into a medium of relative index eta, with the cosines of both sides.
template <class F>
GLOAM_HD Vec3Of<F> refract(Vec3Of<F> wo, Vec3Of<F> h, F eta, F cos_o, F cos_t) {
  return h * (cos_o / eta - cos_t) - wo / eta;
}

namespace ggx {

/// Smith's Lambda term times 2 cos, plus cos. `alpha`: widths along x and y.
template <class F>
GLOAM_HD F smith_root(Vec2Of<F> alpha, Vec3Of<F> w) {
  return square_root(sqr(alpha.x * w.x) + sqr(alpha.y * w.y) + sqr(w.z));
}
/// Density of half vectors per solid angle and projected area.
template <class F>
GLOAM_HD F distribution(Vec2Of<F> alpha, Vec3Of<F> h) {
  const F area = alpha.x * alpha.y, stretch = alpha.y / alpha.x;
  const F k = sqr(h.x) * stretch + sqr(h.y) / stretch + sqr(h.z) * area;
  return area * kInvPi / (k * k);
}
/// Half vector by the visible normals (Dupuy and Benyoub 2023, "Sampling visible GGX normals with
/// spherical caps") at a point of the unit disc, given as by to_disc().
template <class F>
GLOAM_HD Vec3Of<F> half_at(Vec2Of<F> alpha, Vec3Of<F> wo, Vec2Of<F> polar) {
  const Vec3Of<F> v = normalize(Vec3Of<F>{wo.x * alpha.x, wo.y * alpha.y, wo.z});
  const F z = (1.0f - polar.x) * (1.0f + v.z) - v.z;
  const F r = safe_sqrt(1.0f - z * z);
  F s, c;
  sincos_turn(polar.y, &s, &c);
  const Vec3Of<F> h = Vec3Of<F>{r * c, r * s, z} + v;
  return normalize(Vec3Of<F>{h.x * alpha.x, h.y * alpha.y, max(h.z, 1e-6f)});
}
template <class F>
GLOAM_HD Vec3Of<F> sample_half(Vec2Of<F> alpha, Vec3Of<F> wo, Vec2Of<F> u) {
  return half_at(alpha, wo, to_disc(u));
}
/// (1 - cosine)^5, Schlick's weight.
template <class F>
GLOAM_HD F schlick(F cosine) {
  const F m = clamp(1.0f - cosine, 0.0f, 1.0f), m2 = m * m;
  return m2 * m2 * m;
}
/// G2 / (4 cos_o cos_i) of the height-correlated Smith function, from both roots.
template <class F>
GLOAM_HD F visibility(F cos_o, F root_o, F cos_i, F root_i) {
  return 0.5f / (cos_i * root_o + cos_o * root_i);
}
/// G2 / G1: fraction of the light leaving a visible microfacet that others do not catch.
template <class F>
GLOAM_HD F escaping(F cos_o, F root_o, F cos_i, F root_i) {
  return cos_i * (cos_o + root_o) / (cos_i * root_o + cos_o * root_i);
}

}  // namespace ggx

namespace sheen {

/// Visibility times distribution of fibres that stand up (Estevez and Kulla 2017, "Production
/// friendly microfacet sheen BRDF"; visibility of Neubelt and Pettineo 2013). alpha in (0, 1].
GLOAM_HD float lobe(float alpha, float cos_o, float cos_i, float cos_h) {
  const float sin_h = safe_sqrt(1.0f - cos_h * cos_h), power = 1.0f / alpha;
  const float d = (2.0f + power) * powf(sin_h, power) * (0.5f * kInvPi);
  return d / (4.0f * (cos_o + cos_i - cos_o * cos_i));
}

}  // namespace sheen
}  // namespace gloam
