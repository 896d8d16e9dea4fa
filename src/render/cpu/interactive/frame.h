#pragma once
// A picture of the interactive tier before it is filtered, in planes of single floats with a
// border.

#include <cstdlib>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "render/kernel/interactive/interactive_constants.h"
#include "render/kernel/math/lanes.h"

namespace gloam {

/// Rows of floats with kBorder more on all sides; a lane's load may start anywhere in it.
/// PlaneMemory holds them.
class InteractivePlane {
 public:
  static constexpr int kBorder = 16;
  float* at(int x, int y) {
    return values_ + static_cast<ptrdiff_t>(y + kBorder) * stride_ + x + kBorder;
  }
  const float* at(int x, int y) const { return const_cast<InteractivePlane*>(this)->at(x, y); }
  FloatLanes load(int x, int y) const {
    FloatLanes out;
    __builtin_memcpy(&out.v, at(x, y), sizeof out.v);
    return out;
  }
  void store(int x, int y, FloatLanes v) { __builtin_memcpy(at(x, y), &v.v, sizeof v.v); }
  /// Lanes in rows of four, as tile_pixel() orders them.
  void store_block(int x, int y, FloatLanes v) {
    for (int row = 0; row < kLaneCount / 4; ++row) {
      __builtin_memcpy(at(x, y + row), reinterpret_cast<const char*>(&v.v) + 16 * row, 16);
    }
  }
  /// The values at the pixels (x, y), whole numbers up to kBorder outside.
  FloatLanes gather_at(FloatLanes x, FloatLanes y) const {
    const auto stride = static_cast<uint32_t>(stride_);
    constexpr float kShift = kBorder;
    return gather(values_, to_uint(y + kShift) * stride + to_uint(x + kShift));
  }

 private:
  friend class PlaneMemory;
  float* values_ = nullptr;
  int stride_ = 0;
};

struct InteractivePlane3 {
  InteractivePlane c[3];
  Vec3f get(int x, int y) const { return {*c[0].at(x, y), *c[1].at(x, y), *c[2].at(x, y)}; }
  void set(int x, int y, Vec3f v) {
    for (int k = 0; k < 3; ++k) *c[k].at(x, y) = v[k];
  }
  Vec3Of<FloatLanes> load(int x, int y) const {
    return {c[0].load(x, y), c[1].load(x, y), c[2].load(x, y)};
  }
  void store(int x, int y, const Vec3Of<FloatLanes>& v) {
    c[0].store(x, y, v.x);
    c[1].store(x, y, v.y);
    c[2].store(x, y, v.z);
  }
  void store_block(int x, int y, const Vec3Of<FloatLanes>& v) {
    c[0].store_block(x, y, v.x);
    c[1].store_block(x, y, v.y);
    c[2].store_block(x, y, v.z);
  }
  Vec3Of<FloatLanes> gather_at(FloatLanes x, FloatLanes y) const {
    return {c[0].gather_at(x, y), c[1].gather_at(x, y), c[2].gather_at(x, y)};
  }
};

/// The floats of planes of one size, in one piece: what goes over a picture walks along dozens of
/// planes at once, and would wait for the memory's tables of pages and for caches.
class PlaneMemory {
 public:
  /// A plane and the value that it is filled with.
  struct Member {
    InteractivePlane* plane;
    float value;
  };
  void resize(int width, int height, const std::vector<Member>& members);

 private:
  struct Free {
    void operator()(float* floats) const { std::free(floats); }
  };
  std::unique_ptr<float, Free> floats_;
};

/// The noisy parts: light of lamps, of mirrors, of the cache and, where there are media, of the
/// air in front.
enum InteractiveSignal { kDirectSignal, kSpecularSignal, kCachedSignal, kAirSignal, kSignals };

struct InteractiveFrame {
  int width = 0, height = 0;
  Vec2f offset;            ///< of the rays from the pixels' centres [px]
  int signals = kSignals;  ///< so many of the first ones are there
  InteractivePlane3 signal[kSignals];
  /// Mean and mean square of the luminance of signals over earlier pictures.
  InteractivePlane mean[kSignals], square[kSignals];
  InteractivePlane age;  ///< pictures that a pixel's signals are the mean of
  InteractivePlane3 p, n;
  InteractivePlane part;      ///< of the first solid surface; 0 = none, -1 = beyond the border
  InteractivePlane distance;  ///< [m]
  InteractivePlane roughness;
  InteractivePlane near;  ///< InteractiveSampleOf::near
  InteractivePlane3 base, albedo, gloss;
  InteractivePlane motion_x, motion_y;  ///< [px]
  std::vector<uint64_t> key;            ///< of the cache's cell
  InteractivePlane gleam;   ///< least weight of this picture in the mean: of moving highlights
  InteractivePlane3 color;  ///< of this picture

  void resize(int w, int h);

 private:
  PlaneMemory memory_;
};

/// An image of the camera's resolution: the mean over the frames so far, which have fewer pixels.
struct ResolvedImage {
  int width = 0, height = 0;
  InteractivePlane3 color;
  InteractivePlane frames;  ///< that `color` is the mean of; 0 = unknown
  InteractivePlane part;    ///< as in InteractiveFrame
  InteractivePlane edge;    ///< 1 beside another part

  void resize(int w, int h);

 private:
  PlaneMemory memory_;
};

/// Mean and deviation of a plane over 3 x 3 pixels, of those that count.
struct NeighbourMoments {
  Vec3Of<FloatLanes> mean, deviation;
};
/// Around the pixels from (x, y) on; counts(dx, dy): which of the lanes' neighbours do.
template <class Counts>
NeighbourMoments neighbour_moments(const InteractivePlane3& plane, int x, int y,
                                   const Counts& counts) {
  Vec3Of<FloatLanes> sum, squares;
  FloatLanes n = 0.0f;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const FloatLanes one = select(counts(dx, dy), FloatLanes(1.0f), FloatLanes(0.0f));
      const Vec3Of<FloatLanes> v = plane.load(x + dx, y + dy);
      sum += v * one;
      squares += v * v * one;
      n += one;
    }
  }
  const Vec3Of<FloatLanes> mean = sum / n, variance = squares / n - mean * mean;
  return {mean, {safe_sqrt(variance.x), safe_sqrt(variance.y), safe_sqrt(variance.z)}};
}

}  // namespace gloam
