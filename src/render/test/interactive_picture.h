#pragma once
// Pictures of the interactive tier, and of the path tier to compare them with.

#include "render/test/probe.h"

namespace gloam {

inline RenderSettings interactive_settings(ViewHistory* history, uint32_t frame) {
  RenderSettings s;
  s.tier = RenderTier::kInteractive;
  s.history = history;
  s.frame = frame;
  s.max_depth = 8;
  return s;
}

inline double mean_luminance(const Film& film) {
  double sum = 0;
  for (const Vec3f& c : film.radiance) sum += luminance(c);
  return sum / static_cast<double>(film.radiance.size());
}

inline Film path_picture(const SceneBuilder& b, const CameraView& view, int spp, int max_depth) {
  RenderSettings path;
  path.spp = spp;
  path.max_depth = max_depth;
  return b.render(view, path);
}
inline constexpr int kEndless = 40;  // light comes round in the cache without end

/// The last of `count` pictures of what stands still.
inline Film interactive_picture(const SceneBuilder& b, const CameraView& view, uint32_t count,
                                uint64_t seed = 1) {
  const auto renderer = b.make();
  const auto history = renderer->make_history();
  Film film;
  for (uint32_t i = 0; i < count; ++i) {
    RenderSettings settings = interactive_settings(history.get(), i);
    settings.seed = seed;
    renderer->render(view, settings, &film);
  }
  return film;
}

}  // namespace gloam
