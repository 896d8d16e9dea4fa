#pragma once
// A denoiser's guides, from the exact channels: where one ray at a pixel's centre cannot tell what
// the pixel shows, and the media before it. Device-safe.

#include "render/kernel/camera/channels.h"
#include "render/kernel/math/sampler.h"
#include "render/kernel/media/medium_march.h"

namespace gloam::guides {

/// Whether the centres of two pixels differ so much that one ray each cannot tell what lies
/// between. `Film_`: Film or DeviceFilm.
template <class Film_>
GLOAM_HD bool differs(const Film_& film, size_t i, size_t j) {
  constexpr float kCosine = 0.9f, kAlbedo = 0.15f;
  const Vec3f d = film.center_albedo[i] - film.center_albedo[j];
  return film.part[i] != film.part[j] || dot(d, d) > kAlbedo * kAlbedo ||
         (film.part[i] != 0 && dot(film.center_normal[i], film.center_normal[j]) < kCosine);
}

template <class Film_>
GLOAM_HD bool is_edge(const Film_& film, int width, int height, int x, int y) {
  const auto at = [width](int u, int v) {
    return static_cast<size_t>(v) * static_cast<size_t>(width) + static_cast<size_t>(u);
  };
  for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < height; ++v) {
    for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < width; ++u) {
      if (differs(film, at(x, y), at(u, v))) return true;
    }
  }
  return false;
}

/// Ray k of a pixel at an edge. One pattern for every pixel and picture: what stands still must not
/// flicker.
GLOAM_HD Ray edge_ray(const CameraView32& camera, int x, int y, int k, bool has_motion,
                      RayCone* cone) {
  Sampler sampler = Sampler::make(0, 0, 0, 0, static_cast<uint32_t>(k), 0);
  const Vec2f offset = sample_pixel_filter(sampler.next_2d());
  const float u = has_motion ? sampler.next_1d() : 0.0f;
  const float time = has_motion ? camera.time_of(y, u) : 0.0f;
  return camera_ray(camera, static_cast<float>(x) + 0.5f + offset.x,
                    static_cast<float>(y) + 0.5f + offset.y, time, cone);
}

/// Adds media before a surface at `distance` to its guides, each by the share of light that it
/// scatters first. Returns the luminance of the transmittance up to the surface.
GLOAM_HD float veil(const MediaView& media, const CameraView32& camera, int x, int y,
                    float distance, Vec3f* albedo, Vec3f* normal) {
  constexpr int kSteps = 64;
  RayCone cone;
  const Ray ray =
      camera_ray(camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.0f, &cone);
  const MarchResult m = march(media, ray, min(distance, 1e30f), 0.0f, kSteps, {}, true,
                              [](const MarchStep& step) { return step.medium.scattering; });
  const Vec3f veiled = *albedo * m.transmittance + m.radiance;
  // Emission is brighter than any albedo.
  *albedo = {min(veiled.x, 1.0f), min(veiled.y, 1.0f), min(veiled.z, 1.0f)};
  const float clear = luminance(m.transmittance);
  *normal *= clear;
  return clear;
}

}  // namespace gloam::guides
