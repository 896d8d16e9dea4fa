#include "sensors/depth/stereo_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "geometry/lens.h"
#include "render/kernel/media/medium_march.h"
#include "scene/options/pattern_names.h"
#include "sensors/signal/draw.h"

namespace gloam {
namespace {

// In the order of kStereoPresets.
constexpr std::array<StereoDepthModel, kStereoPresets.size()> kModelsOfPresets = {{
    {.baseline = 0},
    {.baseline = 0.05,
     .subpixel = 1.0 / 32,
     .noise = 0.08,
     .max_range = 10,
     .max_disparity = 126,
     .occlusion = true,
     .edge_loss = 1,
     .half_signal = 0.003},
    {.baseline = 0.075,
     .subpixel = 1.0 / 8,
     .noise = 1.0 / 16,
     .min_range = 0.5,
     .max_range = 5,
     .occlusion = true,
     .edge_loss = 2,
     .half_signal = 0.003},
}};

constexpr double kDisparityStep = 1;   // [px] of disparity between neighbours: two surfaces
constexpr double kBeamsMeet = 0.1;     // [m] before it, with eyes 5 cm apart
constexpr float kSmoothMetal = 0.35f;  // roughness from which on metal scatters enough

/// Share of the light that a material sends back in all directions.
float scattered_share(const MaterialDescription& m) {
  const float rough = std::clamp(m.roughness / kSmoothMetal, 0.0f, 1.0f);
  const float through = m.thin_walled || m.transmission_weight > 0 ? m.transmission_weight : 0;
  return m.opacity * (1 - through) * (1 - m.metallic * (1 - rough * rough));
}

/// Part of a signal that media on the way let through.
float signal_through(const MediaView& media, Vec3f origin, Vec3f direction, float distance,
                     float signal) {
  const Bands bands = Bands::only(MediumBand::k905nm);
  double passed = 1, back = 0;  // on both ways
  each_step(media, origin, direction, double{distance}, [&](Vec3f p, double from, double to) {
    const MediumPoint at = medium_at(media, p, bands);
    if (!(at.extinction.x > 0)) return;
    const double lost = 1 - std::exp(-2 * double{at.extinction.x} * (to - from));
    const float g = at.g_scattering.x / std::max(at.scattering.x, 1e-9f);
    const double beta = double{at.scattering.x * henyey_greenstein(g, -1.0f)};
    const double near = std::max(from, kBeamsMeet), far = std::max(to, kBeamsMeet);
    back += double{kPi} * beta * passed * (1 - 0.5 * lost) * (1 / near - 1 / far);
    passed *= 1 - lost;
  });
  const double left = double{signal} * passed;
  return left > 0 ? static_cast<float>(left * left / (left + back)) : 0.0f;
}

/// Pixels within `reach` [px] of a jump in disparity, in the direction of rows and columns.
std::vector<uint8_t> near_jumps(const std::vector<float>& disparity, int width, int height,
                                int reach) {
  const size_t n = disparity.size(), w = static_cast<size_t>(width);
  std::vector<uint8_t> marked(n, 0), spread(n, 0);
  const auto jump = [&](size_t a, size_t b) {
    if (std::abs(double{disparity[a]} - double{disparity[b]}) > kDisparityStep)
      marked[a] = marked[b] = 1;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const size_t i = static_cast<size_t>(y) * w + static_cast<size_t>(x);
      if (x + 1 < width) jump(i, i + 1);
      if (y + 1 < height) jump(i, i + w);
    }
  }
  // The pixels at the jump are its first; the rest by a square of 2 (reach - 1) + 1.
  const int more = reach - 1;
  parallel_for_range("edge_loss", height, 16, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < width; ++x) {
        uint8_t any = 0;
        for (int v = std::max(0, y - more); v <= std::min(height - 1, y + more) && any == 0; ++v)
          for (int u = std::max(0, x - more); u <= std::min(width - 1, x + more); ++u)
            any |= marked[static_cast<size_t>(v) * w + static_cast<size_t>(u)];
        spread[static_cast<size_t>(y) * w + static_cast<size_t>(x)] = any;
      }
    }
  });
  return spread;
}

/// Marks pixels of one row that the second eye does not see: occluded, or outside of its image.
void mark_occluded(const float* disparity, int width, double side, uint8_t* hidden) {
  // The second eye sees pixel u at u - side d. Towards it (from the far side of the row), places
  // fall; a point whose place was passed already is covered.
  constexpr double kRounding = 1e-3;  // [px]: places that meet are one place
  double reached =
      side > 0 ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
  for (int i = 0; i < width; ++i) {
    const int u = side > 0 ? width - 1 - i : i;
    const double place = u + 0.5 - side * double{disparity[u]};
    const bool covered = side > 0 ? place > reached - kRounding : place < reached + kRounding;
    const bool outside = place < 0 || place > width;
    if (covered || outside) hidden[u] = 1;
    reached = side > 0 ? std::min(reached, place) : std::max(reached, place);
  }
}

}  // namespace

StereoDepthModel stereo_depth_model(const StereoDepthOptions& o) {
  const StereoDepthModel& preset = kModelsOfPresets[place_of(o.preset, kStereoPresets)];
  StereoDepthModel out;
  out.baseline = o.baseline.value_or(preset.baseline);
  out.subpixel = o.subpixel.value_or(preset.subpixel);
  out.noise = o.noise.value_or(preset.noise);
  out.min_range = o.min_range.value_or(preset.min_range);
  out.max_range = o.max_range.value_or(preset.max_range);
  out.max_disparity = o.max_disparity.value_or(preset.max_disparity);
  out.occlusion = o.occlusion.value_or(preset.occlusion);
  out.edge_loss = o.edge_loss.value_or(preset.edge_loss);
  out.half_signal = o.half_signal.value_or(preset.half_signal);
  return out;
}

std::vector<float> projector_signal(const RenderDescription& description, const MediaView& media,
                                    const Film& film, const CameraView& view) {
  std::vector<float> signal(film.depth.size(), 0);
  const PixelRays rays(view.intrinsics);
  parallel_for_range("projector", film.height, 4, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < film.width; ++x) {
        const size_t i =
            static_cast<size_t>(y) * static_cast<size_t>(film.width) + static_cast<size_t>(x);
        if (film.part[i] == 0) continue;
        const std::optional<PixelRay> ray_C = rays.at(x + 0.5, y + 0.5);
        if (!ray_C) continue;
        const Vec3f ray = transform_vector(view.X_WC_open, to_vec3f(ray_C->d_C));
        const float cosine = std::abs(dot(ray, film.center_normal[i]));
        const auto material = static_cast<size_t>(description.instances[film.part[i] - 1].material);
        signal[i] = luminance(film.center_albedo[i]) * cosine *
                    scattered_share(description.materials[material]) /
                    (film.depth[i] * film.depth[i]);
        if (media.volumes.empty()) continue;
        const Vec3f origin = transform_point(view.X_WC_open, to_vec3f(ray_C->p_C));
        signal[i] = signal_through(media, origin, ray, film.distance[i], signal[i]);
      }
    }
  });
  return signal;
}

std::vector<float> measure_stereo_depth(const StereoDepthModel& model, const Intrinsics& k,
                                        const std::vector<float>& depth,
                                        const std::vector<float>& signal, uint64_t seed,
                                        int64_t frame) {
  const size_t n = depth.size(), w = static_cast<size_t>(k.width);
  const double scale = k.fx * std::abs(model.baseline);
  const double side = model.baseline > 0 ? 1 : -1;
  std::vector<float> disparity(n);
  for (size_t i = 0; i < n; ++i)
    disparity[i] = static_cast<float>(scale / std::max(double{depth[i]}, 1e-6));  // 0 for +inf
  std::vector<uint8_t> lost(n, 0);
  if (model.edge_loss > 0) lost = near_jumps(disparity, k.width, k.height, model.edge_loss);
  if (model.occlusion) {
    for (size_t row = 0; row < n; row += w)
      mark_occluded(disparity.data() + row, k.width, side, lost.data() + row);
  }
  std::vector<float> out(n, 0);
  const RandomStream noise{seed, stream_id("stereo.noise")}, loss{seed, stream_id("stereo.loss")};
  parallel_for_range(
      "stereo_depth", static_cast<int64_t>(n), 4096, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
          if (lost[i] != 0 || !std::isfinite(depth[i])) continue;
          const auto key = static_cast<uint32_t>(i);
          const auto counter = static_cast<uint64_t>(frame);
          if (model.half_signal > 0) {
            const double s2 = double{signal[i]} * double{signal[i]};
            const double kept = s2 / (s2 + model.half_signal * model.half_signal);
            if (loss.uniform(counter, key) >= kept) continue;
          }
          double d = double{disparity[i]};
          if (model.noise > 0) d += model.noise * draw_normal(noise, counter, key);
          if (model.subpixel > 0) d = model.subpixel * std::round(d / model.subpixel);
          if (d <= 0 || (model.max_disparity > 0 && d > model.max_disparity)) continue;
          const double z = scale / d;
          if (z < model.min_range || (model.max_range > 0 && z > model.max_range)) continue;
          out[i] = static_cast<float>(z);
        }
      });
  return out;
}

}  // namespace gloam
