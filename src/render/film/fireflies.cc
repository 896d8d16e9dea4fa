#include <algorithm>
#include <span>

#include "base/check.h"
#include "base/parallel.h"
#include "render/film/denoise.h"

namespace gloam {
namespace {

constexpr float kFireflyRatio = 4;    // to the third brightest of the pixels around
constexpr int kRadius = 2;            // of those [px]
constexpr int kSpreadRadius = 16;     // how far the light of a firefly is spread [px]
constexpr float kMostSpread = 0.02f;  // fraction of a firefly's limit that one pixel may get of it
constexpr float kMostKept = 10;       // light of a firefly, in that of all pixels around it
constexpr float kFacing = 0.9f;       // cosine between surfaces that take each other's light

/// Values that are infinite or no number are errors elsewhere, not light.
float sanitize(float x) { return x > 0 && x < INFINITY ? min(x, 1e9f) : 0.0f; }

struct Firefly {
  int x = 0, y = 0;
  Vec3f light;  ///< [cd/m²] that each pixel around gets, on white surfaces that face its way
};

class Fireflies {
 public:
  Fireflies(const Film& film, std::vector<Vec3f>* out, std::vector<Vec3f>* light)
      : width_(film.width),
        height_(film.height),
        albedo_(plane(film, film.albedo)),
        normal_(plane(film, film.normal)),
        out_(*out),
        light_(*light),
        rows_(static_cast<size_t>(film.height)) {
    out_.resize(film.pixel_count());
    std::vector<float> brightness(film.pixel_count());
    parallel_for_range("fireflies", height_, 16, [&](int64_t begin, int64_t end) {
      for (size_t i = index(0, static_cast<int>(begin)); i < index(0, static_cast<int>(end)); ++i) {
        const Vec3f c = film.radiance[i];
        out_[i] = {sanitize(c.x), sanitize(c.y), sanitize(c.z)};
        brightness[i] = luminance(out_[i]);
      }
    });
    brightness_ = std::move(brightness);
    light_ = out_;
  }

  void find() {
    parallel_for("fireflies", height_, [&](int64_t y) {
      for (int x = 0; x < width_; ++x) dim(x, static_cast<int>(y));
    });
  }

  /// Spreads the light in the order of the rows, so sums do not depend on threads.
  void spread() {
    parallel_for("fireflies", height_, [&](int64_t row) {
      const int y = static_cast<int>(row), last = std::min(height_ - 1, y + kSpreadRadius);
      for (int v = std::max(0, y - kSpreadRadius); v <= last; ++v) {
        for (const Firefly& fly : rows_[static_cast<size_t>(v)]) {
          for (int x = first_x(fly); x <= last_x(fly); ++x) {
            if (faces(index(fly.x, v), index(x, y)))
              out_[index(x, y)] += fly.light * albedo(index(x, y));
          }
        }
      }
    });
  }

 private:
  static std::span<const Vec3f> plane(const Film& film, const std::vector<Vec3f>& values) {
    return values.size() == film.pixel_count() ? std::span(values) : std::span<const Vec3f>();
  }
  size_t index(int x, int y) const { return static_cast<size_t>(y) * width_ + x; }
  int first_x(const Firefly& fly) const { return std::max(0, fly.x - kSpreadRadius); }
  int last_x(const Firefly& fly) const { return std::min(width_ - 1, fly.x + kSpreadRadius); }
  bool faces(size_t i, size_t j) const {
    return normal_.empty() || dot(normal_[i], normal_[j]) >= kFacing;
  }
  Vec3f albedo(size_t i) const {
    if (albedo_.empty()) return {1, 1, 1};
    constexpr float kMinReflectance = 0.02f;  // black surfaces reflect a little too
    const Vec3f a = albedo_[i];
    return {max(a.x, kMinReflectance), max(a.y, kMinReflectance), max(a.z, kMinReflectance)};
  }

  /// Brings the pixel down to its limit if it is a firefly.
  void dim(int x, int y) {
    float first = 0, second = 0, third = 0;  // brightest neighbours
    for (int v = std::max(0, y - kRadius); v <= std::min(height_ - 1, y + kRadius); ++v) {
      for (int u = std::max(0, x - kRadius); u <= std::min(width_ - 1, x + kRadius); ++u) {
        if (u == x && v == y) continue;
        float b = brightness_[index(u, v)];
        if (b > first) std::swap(b, first);
        if (b > second) std::swap(b, second);
        if (b > third) third = b;
      }
    }
    // Among all-black neighbours there is nothing to compare with: the pixel stays.
    const size_t i = index(x, y);
    const float limit = kFireflyRatio * third;
    if (!(limit > 0 && brightness_[i] > limit)) return;
    const Vec3f whole = out_[i];
    out_[i] *= limit / brightness_[i];
    const Vec3f a = albedo(i), excess = whole - out_[i];
    Firefly fly{x, y, {excess.x / a.x, excess.y / a.y, excess.z / a.z}};
    light_[i] = out_[i] + excess * min(1, kMostKept * light_around(fly, limit) / luminance(excess));
    const float received = luminance(fly.light * reflected_around(fly));
    if (!(received > 0)) return;  // nothing around looks the same way
    const float fraction = luminance(excess) / received;
    const float most = kMostSpread * limit / luminance(fly.light);
    fly.light *= min(fraction, most);
    rows_[static_cast<size_t>(y)].push_back(fly);
  }

  /// Brightness of all pixels that the firefly's light may be spread over; of other fireflies what
  /// would be no firefly here.
  float light_around(const Firefly& fly, float limit) const {
    float sum = 0;
    const int last = std::min(height_ - 1, fly.y + kSpreadRadius);
    for (int v = std::max(0, fly.y - kSpreadRadius); v <= last; ++v) {
      for (int u = first_x(fly); u <= last_x(fly); ++u) sum += min(brightness_[index(u, v)], limit);
    }
    return sum;
  }

  /// Sum of the albedo of the pixels that the firefly's light is spread over.
  Vec3f reflected_around(const Firefly& fly) const {
    Vec3f sum;
    const size_t i = index(fly.x, fly.y);
    const int last = std::min(height_ - 1, fly.y + kSpreadRadius);
    for (int v = std::max(0, fly.y - kSpreadRadius); v <= last; ++v) {
      for (int u = first_x(fly); u <= last_x(fly); ++u) {
        if (faces(i, index(u, v))) sum += albedo(index(u, v));
      }
    }
    return sum;
  }

  const int width_, height_;
  const std::span<const Vec3f> albedo_, normal_;
  std::vector<Vec3f>& out_;
  std::vector<Vec3f>& light_;
  std::vector<float> brightness_;
  std::vector<std::vector<Firefly>> rows_;
};

}  // namespace

void remove_fireflies(const Film& film, std::vector<Vec3f>* out, std::vector<Vec3f>* light) {
  GLOAM_CHECK(film.radiance.size() == film.pixel_count(),
              "a film without radiance cannot be denoised");
  Fireflies fireflies(film, out, light);
  fireflies.find();
  fireflies.spread();
}

}  // namespace gloam
