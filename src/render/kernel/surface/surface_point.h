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
  using Members = MemberList<&RayConeOf::width, &RayConeOf::spread>;
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
  using Members =
      MemberList<&SurfaceOf::p, &SurfaceOf::geometric, &SurfaceOf::normal, &SurfaceOf::t,
                 &SurfaceOf::outside, &SurfaceOf::instance, &SurfaceOf::base_color,
                 &SurfaceOf::emission, &SurfaceOf::metallic, &SurfaceOf::roughness, &SurfaceOf::f0,
                 &SurfaceOf::f90, &SurfaceOf::opacity, &SurfaceOf::straight, &SurfaceOf::tangent,
                 &SurfaceOf::coat_weight, &SurfaceOf::coat_roughness, &SurfaceOf::coat_f0,
                 &SurfaceOf::coat_darkening, &SurfaceOf::fuzz_weight, &SurfaceOf::transmission>;
  /// Members that textures change.
  using Textured = MemberList<&SurfaceOf::normal, &SurfaceOf::base_color, &SurfaceOf::emission,
                              &SurfaceOf::metallic, &SurfaceOf::roughness, &SurfaceOf::opacity>;
};
using Surface = SurfaceOf<float>;

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
