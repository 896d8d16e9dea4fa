#include "sensors/camera/lens_drops.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "render/kernel/math/field.h"

namespace gloam {
namespace {

constexpr float kGlass = 0.015f;        // [m] from the pupil to the outer side of the glass
constexpr float kSmallPupil = 0.0005f;  // [m]
constexpr float kMinDropRadius = 0.0005f,
                kMaxDropRadius = 0.002f;  // [m] radii; drops of more than 2 mm run off
// Focal length of a drop over its radius: a cap with a contact angle of some 70 degrees on glass is
// a thin lens of n = 1.33 whose surface has the radius 1.06 of its rim's, f = 1.06 r / (n - 1).
constexpr float kFocal = 3.2f;
constexpr double kLifetime = 12, kSpread = 0.1, kWiped = 0.4;  // [s]

/// The picture and its means over 2 x 2, 4 x 4 … pixels; the border goes on outside.
class Pyramid {
 public:
  Pyramid(const std::vector<Vec3f>& picture, int width, int height) {
    levels_.push_back({picture, width, height});
    while (std::min(levels_.back().width, levels_.back().height) > 3) {
      const Level& fine = levels_.back();
      Level next{{}, fine.width / 2, fine.height / 2};
      next.light.resize(static_cast<size_t>(next.width) * static_cast<size_t>(next.height));
      for (int y = 0; y < next.height; ++y) {
        for (int x = 0; x < next.width; ++x)
          next.light[static_cast<size_t>(y) * static_cast<size_t>(next.width) +
                     static_cast<size_t>(x)] =
              (fine.at(2 * x, 2 * y) + fine.at(2 * x + 1, 2 * y) + fine.at(2 * x, 2 * y + 1) +
               fine.at(2 * x + 1, 2 * y + 1)) *
              0.25f;
      }
      levels_.push_back(std::move(next));
    }
  }
  /// Mean over about `size` pixels.
  Vec3f at(Vec2f uv, float size) const {
    const float level =
        clamp(std::log2(std::max(size, 1.0f)), 0.0f, static_cast<float>(levels_.size() - 1));
    const auto low = static_cast<size_t>(level);
    const size_t high = std::min(low + 1, levels_.size() - 1);
    return lerp(smooth(low, uv), smooth(high, uv), level - static_cast<float>(low));
  }

 private:
  struct Level {
    std::vector<Vec3f> light;
    int width, height;
    Vec3f at(int x, int y) const {
      x = std::clamp(x, 0, width - 1), y = std::clamp(y, 0, height - 1);
      return light[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
  };
  Vec3f smooth(size_t row, Vec2f uv) const {
    const Level& level = levels_[row];
    const float scale = 1 / static_cast<float>(1u << row);
    const float x = clamp(uv.x * scale - 0.5f, -1.0f, static_cast<float>(level.width));
    const float y = clamp(uv.y * scale - 0.5f, -1.0f, static_cast<float>(level.height));
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j);
    return lerp(lerp(level.at(i, j), level.at(i + 1, j), fx),
                lerp(level.at(i, j + 1), level.at(i + 1, j + 1), fx), fy);
  }
  std::vector<Level> levels_;
};

}  // namespace

LensDrops::LensDrops(const Intrinsics& intrinsics, double share, bool falling, double aperture,
                     uint64_t seed)
    : width_(intrinsics.width),
      height_(intrinsics.height),
      focal_(static_cast<float>(intrinsics.fx)),
      pupil_(aperture > 0 ? static_cast<float>(aperture) : kSmallPupil),
      falling_(falling),
      seed_(seed) {
  // Radii are even between the least and the most; drops overlap at random.
  const double mean2 = (kMinDropRadius * kMinDropRadius + kMinDropRadius * kMaxDropRadius +
                        kMaxDropRadius * kMaxDropRadius) /
                       3.0;
  const double scale = static_cast<double>(focal_) / static_cast<double>(kGlass);
  const double area = M_PI * mean2 * scale * scale;
  const double reach = static_cast<double>(kMaxDropRadius) * scale;
  const double field = (width_ + 2 * reach) * (height_ + 2 * reach);
  slots_ = static_cast<int>(std::lround(-std::log1p(-std::min(share, 0.98)) * field / area));
  if (share > 0) slots_ = std::clamp(slots_, 1, 4096);
}

LensDrops::Drop LensDrops::drop_at(int slot, double time) const {
  const RandomStream random{seed_, stream_id("lens.drops")};
  const auto row = static_cast<uint32_t>(slot);
  double age = kLifetime / 2, life = kLifetime;
  uint64_t count = 0;
  if (falling_) {
    const Philox4 own = random.draw(0, row);
    life = kLifetime * (0.5 + static_cast<double>(uniform_float(own.v[0])));
    const double turns = time / life + static_cast<double>(uniform_float(own.v[1]));
    count = static_cast<uint64_t>(std::floor(turns));
    age = (turns - std::floor(turns)) * life;
  }
  const Philox4 draw = random.draw(count + 1, row);
  const float reach = kMaxDropRadius * focal_ / kGlass;
  Drop drop;
  drop.center = {uniform_float(draw.v[0]) * (static_cast<float>(width_) + 2 * reach) - reach,
                 uniform_float(draw.v[1]) * (static_cast<float>(height_) + 2 * reach) - reach};
  drop.radius = kMinDropRadius + (kMaxDropRadius - kMinDropRadius) * uniform_float(draw.v[2]);
  drop.there =
      static_cast<float>(std::clamp(std::min(age / kSpread, (life - age) / kWiped), 0.0, 1.0));
  return drop;
}

void LensDrops::draw(double time, std::vector<Vec3f>* picture) const {
  std::vector<Drop> drops;
  for (int slot = 0; slot < slots_; ++slot) {
    const Drop drop = drop_at(slot, time);
    if (drop.there > 0) drops.push_back(drop);
  }
  if (drops.empty()) return;
  const Pyramid behind(*picture, width_, height_);
  const float scale = focal_ / kGlass, soft = pupil_ * scale;
  parallel_for("lens drops", height_, [&](int64_t row) {
    const float py = static_cast<float>(row) + 0.5f;
    for (const Drop& drop : drops) {
      const float radius = drop.radius * std::sqrt(drop.there) * scale, reach = radius + soft;
      const float dy = py - drop.center.y;
      if (std::fabs(dy) >= reach) continue;
      const int x0 = std::max(0, static_cast<int>(drop.center.x - reach));
      const int x1 = std::min(width_, static_cast<int>(drop.center.x + reach) + 2);
      const float bend = kGlass / (kFocal * drop.radius);
      for (int x = x0; x < x1; ++x) {
        const float dx = static_cast<float>(x) + 0.5f - drop.center.x;
        const float d = std::sqrt(dx * dx + dy * dy);
        // Share of the pupil that looks through the drop.
        const float share = smooth_step(0, 2 * soft, reach - d);
        if (!(share > 0)) continue;
        const Vec2f from{static_cast<float>(x) + 0.5f - dx * bend, py - dy * bend};
        // At its rim light is turned away from the lens.
        const float rim = min(d / radius, 1.0f), passes = 1 - 0.55f * rim * rim * rim * rim;
        const Vec3f through = behind.at(from, soft * std::fabs(1 - bend)) * passes;
        Vec3f& pixel = (*picture)[static_cast<size_t>(row) * static_cast<size_t>(width_) +
                                  static_cast<size_t>(x)];
        pixel = lerp(pixel, through, share);
      }
    }
  });
}

}  // namespace gloam
