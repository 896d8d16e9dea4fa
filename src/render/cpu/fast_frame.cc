#include "render/cpu/fast_frame.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace gloam {
namespace {

constexpr float kRange = 1.5f;       // of deviations around a pixel that its past may have
constexpr float kLongest = 8;        // pictures in a mean: older ones fade
constexpr int kRounds = 3;           // of smoothing, each twice as wide
constexpr float kTolerance = 0.01f;  // of places on one plane, over their distance

FloatLanes load(const float* p) {
  FloatLanes out;
  __builtin_memcpy(&out.v, p, sizeof out.v);
  return out;
}
void store(float* p, FloatLanes x) { __builtin_memcpy(p, &x.v, sizeof x.v); }
Vec3Of<FloatLanes> load3(const FastPlane3& plane, int x, int y) {
  return {load(plane.c[0].at(x, y)), load(plane.c[1].at(x, y)), load(plane.c[2].at(x, y))};
}
void store3(FastPlane3* plane, int x, int y, const Vec3Of<FloatLanes>& v) {
  store(plane->c[0].at(x, y), v.x);
  store(plane->c[1].at(x, y), v.y);
  store(plane->c[2].at(x, y), v.z);
}

/// Means and deviations of a signal around the pixels from x on, of each on its own part.
void around(const FastFrame& f, int s, int x, int y, Vec3Of<FloatLanes>* mean,
            Vec3Of<FloatLanes>* deviation) {
  using F = FloatLanes;
  const F part = load(f.part.at(x, y));
  Vec3Of<F> sum, squares;
  F n = 0.0f;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const F same = select(load(f.part.at(x + dx, y + dy)) == part, F(1.0f), F(0.0f));
      const Vec3Of<F> v = load3(f.signal[s], x + dx, y + dy);
      sum += v * same;
      squares += v * v * same;
      n += same;
    }
  }
  *mean = sum / n;
  const Vec3Of<F> variance = squares / n - *mean * *mean;
  *deviation = {safe_sqrt(variance.x), safe_sqrt(variance.y), safe_sqrt(variance.z)};
}

/// Where a pixel was in the picture before, if it is the same place.
bool find_before(const FastFrame& before, const FastFrame& f, int x, int y, int* bx, int* by) {
  const Vec2f motion = f.motion[static_cast<size_t>(y) * f.width + x];
  *bx = static_cast<int>(std::floor(static_cast<float>(x) + 0.5f - motion.x));
  *by = static_cast<int>(std::floor(static_cast<float>(y) + 0.5f - motion.y));
  if (*bx < 0 || *by < 0 || *bx >= f.width || *by >= f.height) return false;
  const float part = *f.part.at(x, y);
  return part > 0 && *before.part.at(*bx, *by) == part &&
         dot(f.n.get(x, y), before.n.get(*bx, *by)) > 0.8f;
}

}  // namespace

void FastFrame::resize(int w, int h) {
  if (w == width && h == height) return;
  width = w;
  height = h;
  for (int s = 0; s < kFastSignals; ++s) {
    signal[s].resize(w, h, 0);
    mean[s].resize(w, h, 0);
    square[s].resize(w, h, 0);
  }
  age.resize(w, h, 1);  // beyond the picture too: noise is divided by it
  for (FastPlane3* plane : {&p, &n, &base, &albedo, &gloss, &through}) plane->resize(w, h, 0);
  part.resize(w, h, -1);
  distance.resize(w, h, 0);
  roughness.resize(w, h, 0);
  motion.assign(static_cast<size_t>(w) * h, {});
  key.assign(motion.size(), 0);
}

void FastFilter::resize(int width, int height) {
  for (FastPlane3& plane : a) plane.resize(width, height, 0);
  for (FastPlane3& plane : b) plane.resize(width, height, 0);
}

void FastFilter::accumulate(const FastFrame& before, FastFrame* frame) {
  FastFrame& f = *frame;
  const bool has_before = before.width == f.width && before.height == f.height;
  parallel_for("fast history", f.height, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int first = 0; first < f.width; first += kLaneCount) {
      Vec3Of<FloatLanes> low[kFastSignals], high[kFastSignals];
      for (int s = 0; s < kFastSignals; ++s) {
        Vec3Of<FloatLanes> mean, deviation;
        around(f, s, first, y, &mean, &deviation);
        low[s] = mean - deviation * FloatLanes(kRange);
        high[s] = mean + deviation * FloatLanes(kRange);
      }
      for (int x = first; x < min(first + kLaneCount, f.width); ++x) {
        int bx, by;
        const bool known = has_before && find_before(before, f, x, y, &bx, &by);
        const float age = known ? min(*before.age.at(bx, by) + 1, kLongest) : 1.0f;
        *f.age.at(x, y) = age;
        for (int s = 0; s < kFastSignals; ++s) {
          const Vec3f now = f.signal[s].get(x, y);
          const float l = luminance(now);
          if (!known) {
            a[s].set(x, y, now);
            *f.mean[s].at(x, y) = l;
            *f.square[s].at(x, y) = l * l;
            continue;
          }
          // What is out of the range of its neighbours is a trail of what has moved on.
          const Vec3f old = before.signal[s].get(bx, by);
          const Vec3f least = lane(low[s], x - first), most = lane(high[s], x - first);
          const Vec3f kept{clamp(old.x, least.x, most.x), clamp(old.y, least.y, most.y),
                           clamp(old.z, least.z, most.z)};
          a[s].set(x, y, lerp(kept, now, 1 / age));
          *f.mean[s].at(x, y) = lerp(*before.mean[s].at(bx, by), l, 1 / age);
          *f.square[s].at(x, y) = lerp(*before.square[s].at(bx, by), l * l, 1 / age);
        }
      }
    }
  });
  for (int s = 0; s < kFastSignals; ++s) std::swap(f.signal[s], a[s]);
}

void FastFilter::smooth(const FastFrame& f) {
  static_assert(kRounds % 2 == 1, "the last round ends in a");
  for (int round = 0; round < kRounds; ++round) {
    const int step = 1 << round;
    const FastPlane3* from = round == 0 ? f.signal : (round % 2 == 1 ? a : b);
    FastPlane3* to = round % 2 == 0 ? a : b;
    parallel_for("fast filter", f.height, [&](int64_t row) {
      using F = FloatLanes;
      const int y = static_cast<int>(row);
      for (int x = 0; x < f.width; x += kLaneCount) {
        const F part = load(f.part.at(x, y));
        const Vec3Of<F> p = load3(f.p, x, y), n = load3(f.n, x, y);
        const F scale =
            1.0f / (kTolerance * static_cast<float>(step) * load(f.distance.at(x, y)) + 1e-4f);
        const F age = load(f.age.at(x, y)), rough = load(f.roughness.at(x, y));
        Vec3Of<F> sum[kFastSignals];
        F total[kFastSignals], sharp[kFastSignals], own[kFastSignals];
        for (int s = 0; s < kFastSignals; ++s) {
          sum[s] = load3(from[s], x, y);
          own[s] = luminance(sum[s]);
          total[s] = 1.0f;
          // Few pictures say little about the noise: they are smoothed as if it were large.
          const F mean = load(f.mean[s].at(x, y));
          const F variance = max(load(f.square[s].at(x, y)) - mean * mean, 0.0f);
          const F noise = square_root(variance / age) + select(age < 4.0f, own[s] * 0.3f, F(0.0f));
          sharp[s] = 1.0f / (2.0f * noise + 0.005f * own[s] + 1e-4f);
        }
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            if (dx == 0 && dy == 0) continue;
            const int qx = x + dx * step, qy = y + dy * step;
            const F same = select(load(f.part.at(qx, qy)) == part, F(1.0f), F(0.0f));
            const F facing = max(dot(n, load3(f.n, qx, qy)), 0.0f);
            const F f4 = sqr(sqr(facing)), f16 = sqr(sqr(f4));
            const F off = dot(n, load3(f.p, qx, qy) - p) * scale;
            const F tap =
                same * f16 * max(1.0f - off * off, 0.0f) * (dx != 0 && dy != 0 ? 0.5f : 0.75f);
            for (int s = 0; s < kFastSignals; ++s) {
              const Vec3Of<F> v = load3(from[s], qx, qy);
              F w = tap;
              if (s != kCachedSignal) {
                const F d = (luminance(v) - own[s]) * sharp[s];
                w = w / (1.0f + d * d * d * d);
              }
              // Sharp mirrors show what is far behind them.
              if (s == kSpecularSignal) w = w * min(rough * 4.0f, 1.0f);
              sum[s] += v * w;
              total[s] += w;
            }
          }
        }
        for (int s = 0; s < kFastSignals; ++s) {
          store3(&to[s], x, y, sum[s] / total[s]);
        }
      }
    });
  }
}

}  // namespace gloam
