#include <algorithm>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "render/film/denoise.h"
#include "render/kernel/film/firefly.h"

namespace gloam {
namespace {

using fireflies::kSpreadRadius;

struct PlacedFirefly {
  int x = 0;
  Vec3f spread;
};

class Fireflies {
 public:
  Fireflies(const Film& film, std::vector<Vec3f>* out, std::vector<Vec3f>* light)
      : out_(*out),
        light_(*light),
        brightness_(film.pixel_count()),
        rows_(static_cast<size_t>(film.height)) {
    light_.resize(film.pixel_count());
    parallel_for_range("fireflies", static_cast<int64_t>(film.pixel_count()), 1 << 14,
                       [&](int64_t begin, int64_t end) {
                         for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end);
                              ++i) {
                           light_[i] = fireflies::sanitize(film.radiance[i]);
                           brightness_[i] = luminance(light_[i]);
                         }
                       });
    out_ = light_;
    view_ = {film.width,
             film.height,
             out_.data(),
             brightness_.data(),
             plane(film, film.albedo),
             plane(film, film.normal)};
  }

  void find() {
    parallel_for("fireflies", view_.height, [&](int64_t row) {
      const int y = static_cast<int>(row);
      Firefly fly;
      for (int x = 0; x < view_.width; ++x) {
        if (!fireflies::dim(view_, x, y, &fly)) continue;
        const size_t i = view_.index(x, y);
        out_[i] = fly.dimmed;  // nobody else reads it
        light_[i] = fly.kept;
        rows_[static_cast<size_t>(y)].push_back({x, fly.spread});
      }
    });
  }

  /// Spreads the light in the order of the rows, so sums do not depend on threads.
  void spread() {
    parallel_for("fireflies", view_.height, [&](int64_t row) {
      const int y = static_cast<int>(row);
      const int last = fireflies::last(y, kSpreadRadius, view_.height);
      for (int v = fireflies::first(y, kSpreadRadius); v <= last; ++v) {
        for (const PlacedFirefly& fly : rows_[static_cast<size_t>(v)]) {
          const int end = fireflies::last(fly.x, kSpreadRadius, view_.width);
          for (int x = fireflies::first(fly.x, kSpreadRadius); x <= end; ++x) {
            const size_t i = view_.index(x, y);
            if (fireflies::faces(view_, view_.index(fly.x, v), i))
              out_[i] += fly.spread * fireflies::albedo(view_, i);
          }
        }
      }
    });
  }

 private:
  static const Vec3f* plane(const Film& film, const std::vector<Vec3f>& values) {
    return values.size() == film.pixel_count() ? values.data() : nullptr;
  }

  std::vector<Vec3f>& out_;
  std::vector<Vec3f>& light_;
  std::vector<float> brightness_;
  FireflyView view_;
  std::vector<std::vector<PlacedFirefly>> rows_;
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
