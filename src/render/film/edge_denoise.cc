#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/film/denoise.h"

namespace gloam {
namespace {

constexpr int kIterations = 5;  // reach: 2 * (1 + 2 + 4 + 8 + 16) pixels
constexpr float kKernel[3] = {3.0f / 8, 1.0f / 4, 1.0f / 16};  // B3 spline
constexpr float kMinAlbedo = 0.02f;
constexpr float kSigmaLight = 3;           // in standard deviations of the noise
constexpr float kSigmaAlbedo = 0.3f;       // difference of colour that separates materials
constexpr float kDepthTolerance = 0.002f;  // relative: rounding, curvature
// Mixed pixels: see mend_edges().
constexpr float kLeastSupport = 0.4f;
constexpr float kSigmaMixedAlbedo = 0.15f, kSigmaMixedNormal = 0.5f;
constexpr int kMixedReach = 3;  // [px]

/// Geometry of a pixel that says whether two pixels belong together.
struct Guide {
  float depth = INFINITY;  // [m]
  float slope = 0;         // change of depth per pixel that the surface itself explains [m]
  Vec3f normal;            // 0 = unknown
  Vec3f albedo;
};

float power64(float x) {
  for (int i = 0; i < 6; ++i) x *= x;
  return x;
}

class EdgeDenoiser : public Denoiser {
 public:
  Status denoise(const Film& film, std::vector<Vec3f>* out) override {
    width_ = film.width;
    height_ = film.height;
    remove_fireflies(film, &color_, &light_before_);
    demodulate(film);
    gather_guides(film);
    estimate_variance(film);
    const size_t n = film.pixel_count();
    filtered_.resize(n);
    filtered_variance_.resize(n);
    support_.resize(n);
    normal_ = film.normal.size() == n ? film.normal : std::vector<Vec3f>(n);
    for (int i = 0; i < kIterations; ++i) {
      filter_once(1 << i);
      std::swap(color_, filtered_);
      std::swap(variance_, filtered_variance_);
    }
    out->resize(n);
    for (size_t i = 0; i < n; ++i) (*out)[i] = color_[i] * albedo_[i];
    mend_edges(out);
    restore_light(light_before_, width_, height_, out);
    return {};
  }

  const char* name() const override { return "Gloam edge filter"; }

 private:
  // Texture belongs to albedo, so it is divided out and survives any blur.
  void demodulate(const Film& film) {
    const size_t n = film.pixel_count();
    albedo_.assign(n, Vec3f{1, 1, 1});
    if (film.albedo.size() != n) return;
    for (size_t i = 0; i < n; ++i) {
      const Vec3f a = film.albedo[i];
      if (!(max_component(a) >= kMinAlbedo)) continue;  // sky, lamps
      albedo_[i] = {max(a.x, kMinAlbedo), max(a.y, kMinAlbedo), max(a.z, kMinAlbedo)};
      color_[i] = {color_[i].x / albedo_[i].x, color_[i].y / albedo_[i].y,
                   color_[i].z / albedo_[i].z};
    }
  }

  void gather_guides(const Film& film) {
    const size_t n = film.pixel_count();
    guides_.assign(n, Guide{});
    const bool has_depth = film.depth.size() == n, has_normal = film.normal.size() == n;
    for (size_t i = 0; i < n; ++i) {
      guides_[i].albedo = albedo_[i];
      if (has_depth) guides_[i].depth = film.depth[i];
      if (has_normal && length_squared(film.normal[i]) > 0.25f)
        guides_[i].normal = normalize(film.normal[i]);
    }
    if (!has_depth) return;
    each_row("denoise.slope", [&](int x, int y) {
      Guide& guide = guides_[index(x, y)];
      const auto change = [&](int u, int v) {
        if (u < 0 || v < 0 || u >= width_ || v >= height_) return INFINITY;
        const float d = std::fabs(guides_[index(u, v)].depth - guide.depth);
        return d >= 0 ? d : INFINITY;  // inf - inf
      };
      // The flatter side of each axis: the other may lie across an edge.
      const float slope =
          max(min(change(x - 1, y), change(x + 1, y)), min(change(x, y - 1), change(x, y + 1)));
      if (std::isfinite(slope)) guide.slope = slope;
    });
  }

  // Variance of the luminance of demodulated pixels; from their 7 x 7 neighbours where the renderer
  // gives none. Smoothed over 3 x 3: a variance from few samples is itself noisy.
  void estimate_variance(const Film& film) {
    const size_t n = film.pixel_count();
    const bool given = film.variance.size() == n;
    std::vector<float> raw(n);
    each_row("denoise.variance", [&](int x, int y) {
      const size_t i = index(x, y);
      if (given) {
        const Vec3f v = film.variance[i], a = albedo_[i];
        const float sum =
            sqr(0.2126f / a.x) * v.x + sqr(0.7152f / a.y) * v.y + sqr(0.0722f / a.z) * v.z;
        raw[i] = sum > 0 ? min(sum, 1e18f) : 0.0f;
        return;
      }
      float sum = 0, sum_squares = 0, weights = 0;
      each_neighbour(x, y, 3, 1, [&](size_t j, int dx, int dy) {
        const float w = std::exp(-difference(guides_[i], guides_[j], max_abs(dx, dy))) *
                        facing(guides_[i], guides_[j]);
        const float l = luminance(color_[j]);
        sum += w * l;
        sum_squares += w * l * l;
        weights += w;
      });
      raw[i] = max(0, sum_squares / weights - sqr(sum / weights));
    });
    variance_.resize(n);
    each_row("denoise.variance", [&](int x, int y) {
      float sum = 0, weights = 0;
      each_neighbour(x, y, 1, 1, [&](size_t j, int dx, int dy) {
        const float w = kKernel[std::abs(dx)] * kKernel[std::abs(dy)];
        sum += w * raw[j];
        weights += w;
      });
      variance_[index(x, y)] = sum / weights;
    });
  }

  // A pixel across which an edge runs is a mixture of surfaces: its depth is that of one of them,
  // so the passes above find few neighbours of its kind. Those are along the edge: pixels whose
  // mean albedo and normal are the same mixture.
  void mend_edges(std::vector<Vec3f>* radiance) const {
    const std::vector<Vec3f> plain = *radiance;
    each_row("denoise.edges", [&](int x, int y) {
      const size_t i = index(x, y);
      if (support_[i] >= kLeastSupport) return;
      float weights = 0;
      Vec3f sum;
      each_neighbour(x, y, kMixedReach, 1, [&](size_t j, int dx, int dy) {
        const float unlike = length_squared(albedo_[j] - albedo_[i]) / sqr(kSigmaMixedAlbedo) +
                             length_squared(normal_[j] - normal_[i]) / sqr(kSigmaMixedNormal) +
                             static_cast<float>(dx * dx + dy * dy) / sqr(kMixedReach);
        const float w = std::exp(-unlike);
        weights += w;
        sum += plain[j] * w;
      });
      const float own = support_[i] / kLeastSupport;
      (*radiance)[i] = plain[i] * own + sum * ((1 - own) / weights);
    });
  }

  // Smoothed light that pixels are compared by: a raw noisy pixel would choose neighbours like
  // itself, so rare bright ones would stand out and the rest would lose their light.
  void smooth_light() {
    light_.resize(color_.size());
    light_variance_.resize(color_.size());
    each_row("denoise.light", [&](int x, int y) {
      const size_t i = index(x, y);
      float sum = 0, weights = 0, variance = 0;
      each_neighbour(x, y, 2, 1, [&](size_t j, int dx, int dy) {
        const float w = std::exp(-difference(guides_[i], guides_[j], max_abs(dx, dy))) *
                        facing(guides_[i], guides_[j]);
        sum += w * luminance(color_[j]);
        variance += w * w * variance_[j];
        weights += w;
      });
      light_[i] = sum / weights;
      light_variance_[i] = variance / sqr(weights);
    });
  }

  void filter_once(int step) {
    if (step == 1) {
      smooth_light();
    } else {
      light_variance_ = variance_;
      for (size_t i = 0; i < light_.size(); ++i) light_[i] = luminance(color_[i]);
    }
    each_row("denoise.filter", [&](int x, int y) {
      const size_t i = index(x, y);
      const float inv_tolerance =
          1 / (kSigmaLight * std::sqrt(light_variance_[i]) + 1e-3f * light_[i] + 1e-9f);
      Vec3f sum;
      float weights = 0, variance = 0;
      each_neighbour(x, y, 2, step, [&](size_t j, int dx, int dy) {
        const float away = difference(guides_[i], guides_[j], step * max_abs(dx, dy)) +
                           std::fabs(light_[j] - light_[i]) * inv_tolerance;
        const float w = away < 12 ? kKernel[std::abs(dx)] * kKernel[std::abs(dy)] *
                                        std::exp(-away) * facing(guides_[i], guides_[j])
                                  : 0.0f;
        sum += color_[j] * w;
        weights += w;
        variance += w * w * variance_[j];
      });
      if (step == 1) {  // 1 = all neighbours are of this surface
        constexpr float kOwn = kKernel[0] * kKernel[0];
        support_[i] = (weights - kOwn) / (1 - kOwn);
      }
      filtered_[i] = sum * (1 / weights);
      filtered_variance_[i] = variance / sqr(weights);
    });
  }

  // 0 = one surface of one material; grows with the distance in depth and colour.
  static float difference(const Guide& a, const Guide& b, int pixels) {
    const Vec3f c = a.albedo - b.albedo;
    float sum = length_squared(c) / sqr(kSigmaAlbedo);
    if (std::isinf(a.depth) != std::isinf(b.depth)) return INFINITY;
    if (!std::isinf(a.depth))
      sum += std::fabs(a.depth - b.depth) /
             (a.slope * static_cast<float>(pixels) + kDepthTolerance * a.depth + 1e-6f);
    return sum;
  }
  // 1 = same direction. A pixel without a normal goes with its like only.
  static float facing(const Guide& a, const Guide& b) {
    const float aa = length_squared(a.normal), bb = length_squared(b.normal);
    if (aa == 0 || bb == 0) return aa == bb ? 1.0f : 0.0f;
    return power64(clamp(dot(a.normal, b.normal), 0, 1));
  }

  static int max_abs(int a, int b) { return std::max(std::abs(a), std::abs(b)); }
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }

  template <class F>
  void each_row(const char* name, F&& f) const {
    parallel_for_range(name, height_, 8, [&](int64_t begin, int64_t end) {
      for (int y = static_cast<int>(begin); y < end; ++y)
        for (int x = 0; x < width_; ++x) f(x, y);
    });
  }

  // All of the (2 radius + 1)² pixels around (x, y), `step` apart, that are in the picture.
  template <class F>
  void each_neighbour(int x, int y, int radius, int step, F&& f) const {
    for (int dy = -radius; dy <= radius; ++dy) {
      const int v = y + dy * step;
      if (v < 0 || v >= height_) continue;
      for (int dx = -radius; dx <= radius; ++dx) {
        const int u = x + dx * step;
        if (u >= 0 && u < width_) f(index(u, v), dx, dy);
      }
    }
  }

  int width_ = 0, height_ = 0;
  std::vector<Vec3f> color_, albedo_, filtered_, light_before_;
  std::vector<float> variance_, filtered_variance_, light_, light_variance_, support_;
  std::vector<Vec3f> normal_;  // means over pixels, not of unit length; 0 where unknown
  std::vector<Guide> guides_;
};

}  // namespace

std::unique_ptr<Denoiser> make_edge_denoiser() { return std::make_unique<EdgeDenoiser>(); }

}  // namespace gloam
