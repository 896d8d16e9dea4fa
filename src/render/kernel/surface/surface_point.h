#pragma once
// Place on a surface: position, normals and material there. Device-safe.

#include "render/kernel/scene_view.h"

namespace gloam {

/// The vector v_A in a frame B whose axes are orthonormal.
template <class F>
GLOAM_HD Vec3Of<F> to_frame(const AffineOf<F>& X_AB, Vec3Of<F> v_A) {
  return {dot(v_A, X_AB.x), dot(v_A, X_AB.y), dot(v_A, X_AB.z)};
}

/// Width of a ray: a cone of `width` [m] at its origin that grows by `spread` [m/m].
template <class F>
struct RayConeOf {
  F width{}, spread{};
};
using RayCone = RayConeOf<float>;

template <class F>
struct SurfaceOf {
  Vec3Of<F> p;               ///< world [m]
  Vec3Of<F> geometric;       ///< unit normal of the geometry, towards the viewer
  Vec3Of<F> normal;          ///< unit shading normal, towards the viewer
  F t{};                     ///< distance at which it was found [m]
  MaskOf<F> outside = true;  ///< seen from the side that normals point to
  UintOf<F> instance{};      ///< row of SceneView::instances
  Vec3Of<F> base_color;
  Vec3Of<F> emission;  ///< towards the viewer
  F metallic{}, roughness{};
  F f0{}, f90{};  ///< as in MaterialView
  F opacity = F(1.0f);
  Vec3Of<F> straight;  ///< transmittance straight through the opaque part: sheets
  Vec3Of<F> tangent;   ///< unit, across `normal`: highlights are drawn out along it; zero = round
  // Layers, in materials that have some: as in MaterialLayers, patterns and weather included.
  F coat_weight{}, coat_roughness{}, coat_f0{}, coat_darkening{}, fuzz_weight{}, transmission{};
};
using Surface = SurfaceOf<float>;

template <class F>
GLOAM_HD Surface lane(const SurfaceOf<F>& s, int i) {
  return {lane(s.p, i),
          lane(s.geometric, i),
          lane(s.normal, i),
          lane(s.t, i),
          lane(s.outside, i),
          lane(s.instance, i),
          lane(s.base_color, i),
          lane(s.emission, i),
          lane(s.metallic, i),
          lane(s.roughness, i),
          lane(s.f0, i),
          lane(s.f90, i),
          lane(s.opacity, i),
          lane(s.straight, i),
          lane(s.tangent, i),
          lane(s.coat_weight, i),
          lane(s.coat_roughness, i),
          lane(s.coat_f0, i),
          lane(s.coat_darkening, i),
          lane(s.fuzz_weight, i),
          lane(s.transmission, i)};
}

/// Lane i of the members that textures and layers change.
template <class F>
GLOAM_HD void set_lane(SurfaceOf<F>* s, int i, const Surface& value) {
  set_lane(&s->normal, i, value.normal);
  set_lane(&s->base_color, i, value.base_color);
  set_lane(&s->emission, i, value.emission);
  set_lane(&s->metallic, i, value.metallic);
  set_lane(&s->roughness, i, value.roughness);
  set_lane(&s->opacity, i, value.opacity);
  set_lane(&s->straight, i, value.straight);
  set_lane(&s->tangent, i, value.tangent);
  set_lane(&s->coat_weight, i, value.coat_weight);
  set_lane(&s->coat_roughness, i, value.coat_roughness);
  set_lane(&s->coat_f0, i, value.coat_f0);
  set_lane(&s->coat_darkening, i, value.coat_darkening);
  set_lane(&s->fuzz_weight, i, value.fuzz_weight);
  set_lane(&s->transmission, i, value.transmission);
}

/// Opacity of a surface, the part that lets rays straight through left out: the rest of the light
/// passes as if nothing were there.
template <class F>
GLOAM_HD F opacity_of(const SurfaceOf<F>& s) {
  return s.opacity * (1.0f - max_component(s.straight));
}
/// Light that passes straight through the surface.
template <class F>
GLOAM_HD Vec3Of<F> passing_light(const SurfaceOf<F>& s) {
  const F gap = 1.0f - s.opacity;
  return Vec3Of<F>{gap, gap, gap} + s.straight * s.opacity;
}

}  // namespace gloam
