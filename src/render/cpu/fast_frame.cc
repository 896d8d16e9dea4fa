#include "render/cpu/fast_filter.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace gloam {
namespace {

constexpr float kRange = 1.2f;       // of deviations around a pixel that its past may have
constexpr float kLongest = 8;        // pictures in a mean: older ones fade
constexpr float kSpike = 4;          // times its neighbours, at most, that a mirror's light may be
constexpr int kPatch = 16;           // [px], in which a change of the light is sought:
constexpr float kNoChange = 0.01f;   // a share that may be noise,
constexpr float kHaste = 8;          // and what of the rest is taken over at once
constexpr int kRounds = 3;           // of smoothing, each twice as wide
constexpr float kTolerance = 0.01f;  // of places on one plane, over their distance

/// One patch's share of accumulate().
class Accumulation {
 public:
  Accumulation(const FastFrame& before, const LightGain* gain, int x0, int y0, FastFrame* frame,
               FastPlane3* out)
      : before_(before), gain_(gain), f_(*frame), out_(out), x0_(x0), y0_(y0) {}

  void run() {
    find_past();
    for (int y = y0_; y < y1_; ++y) {
      for (int x = x0_; x < x1_; x += kLaneCount) blend(x, y);
    }
  }

 private:
  void find_past() {
    float now[kKeptSignals] = {}, past[kKeptSignals] = {};
    for (int y = y0_; y < y1_; ++y) {
      for (int x = x0_; x < x1_; ++x) {
        Place& place = places_[y - y0_][x - x0_];
        place.known = find_before(before_, f_, x, y, &place.x, &place.y);
        if (!place.known) continue;
        for (int s = 0; s < kKeptSignals; ++s) {
          now[s] += luminance(f_.signal[s].get(x, y));
          past[s] += luminance(before_.signal[s].get(place.x, place.y));
        }
      }
    }
    // Where the light of a whole tile is another, old pictures say little.
    for (int s = 0; s < kKeptSignals; ++s) {
      const float change = fabsf(now[s] - past[s]) / max(max(now[s], past[s]), 1e-6f);
      least_share_[s] = clamp((change - kNoChange) * kHaste, 0.0f, 1.0f);
    }
  }

  void blend(int first, int y) {
    Vec3Of<FloatLanes> low[kKeptSignals], high[kKeptSignals];
    FloatLanes level, spread[kKeptSignals];
    for (int s = 0; s < kKeptSignals; ++s) {
      const auto [mean, deviation] = neighbour_moments(f_.signal[s], first, y, [&](int dx, int dy) {
        return f_.part.load(first + dx, y + dy) == f_.part.load(first, y);
      });
      if (s == kSpecularSignal) {  // without the pixel itself
        const FloatLanes own = luminance(f_.signal[s].load(first, y));
        level = max((luminance(mean) * 9.0f - own) * 0.125f, 0.0f);
      }
      spread[s] = sqr(luminance(deviation));
      low[s] = mean - deviation * FloatLanes(kRange);
      high[s] = mean + deviation * FloatLanes(kRange);
    }
    for (int x = first; x < min(first + kLaneCount, x1_); ++x) {
      const Place& place = places_[y - y0_][x - x0_];
      const float age = place.known ? min(*before_.age.at(place.x, place.y) + 1, kLongest) : 1.0f;
      *f_.age.at(x, y) = age;
      const bool moves = *f_.motion_x.at(x, y) != 0 || *f_.motion_y.at(x, y) != 0;
      for (int s = 0; s < kKeptSignals; ++s) {
        Vec3f now = f_.signal[s].get(x, y);
        float l = luminance(now), share = max(1 / age, least_share_[s]);
        if (s == kSpecularSignal) {
          // Of rays that a rough surface scatters, few meet a lamp.
          const float most = kSpike * lane(level, x - first);
          if (l > most) now = now * (most / l);
          l = min(l, most);
          // What mirrors show does not go along with them.
          if (moves && *f_.roughness.at(x, y) < kMirror) share = max(share, 0.5f);
        }
        if (!place.known) {
          out_[s].set(x, y, now);
          *f_.mean[s].at(x, y) = l;
          *f_.square[s].at(x, y) = l * l + lane(spread[s], x - first);  // until more is known
          continue;
        }
        // What is out of the range of its neighbours is a trail of what has moved on.
        const float gain = gain_[s].at(x, y);
        const Vec3f old = before_.signal[s].get(place.x, place.y) * gain;
        const Vec3f least = lane(low[s], x - first), most = lane(high[s], x - first);
        const Vec3f kept{clamp(old.x, least.x, most.x), clamp(old.y, least.y, most.y),
                         clamp(old.z, least.z, most.z)};
        out_[s].set(x, y, lerp(kept, now, share));
        *f_.mean[s].at(x, y) = lerp(*before_.mean[s].at(place.x, place.y) * gain, l, share);
        *f_.square[s].at(x, y) =
            lerp(*before_.square[s].at(place.x, place.y) * sqr(gain), l * l, share);
      }
    }
  }

  struct Place {
    int x = 0, y = 0;
    bool known = false;
  };

  const FastFrame& before_;
  const LightGain* gain_;  // of each signal
  FastFrame& f_;
  FastPlane3* out_;
  const int x0_, y0_, x1_ = min(x0_ + kPatch, f_.width), y1_ = min(y0_ + kPatch, f_.height);
  Place places_[kPatch][kPatch];
  float least_share_[kKeptSignals] = {};
};

}  // namespace

void FastFrame::resize(int w, int h) {
  width = w;
  height = h;
  for (FastPlane3& plane : signal) plane.resize(w, h, 0);
  for (int s = 0; s < kKeptSignals; ++s) {
    mean[s].resize(w, h, 0);
    square[s].resize(w, h, 0);
  }
  age.resize(w, h, 1);  // beyond the picture too: noise is divided by it
  for (FastPlane3* plane : {&p, &n, &base, &albedo, &gloss, &color, &resolved})
    plane->resize(w, h, 0);
  part.resize(w, h, -1);
  distance.resize(w, h, 0);
  for (FastPlane* plane : {&roughness, &near, &motion_x, &motion_y, &pictures, &gleam, &edge})
    plane->resize(w, h, 0);
  key.assign(static_cast<size_t>(w) * h, 0);
}

void FastFilter::resize(int width, int height) {
  for (FastPlane3& plane : a) plane.resize(width, height, 0);
  for (FastPlane3& plane : b) plane.resize(width, height, 0);
  for (LightGain& signal : gain) signal.resize(width, height);
  color_gain.resize(width, height);
}

void FastFilter::accumulate(const FastFrame& before, FastFrame* frame) {
  for (int s = 0; s < kKeptSignals; ++s) {
    gain[s].measure([&](int x, int y, float* now, float* past) {
      int bx, by;
      if (!find_before(before, *frame, x, y, &bx, &by)) return false;
      *now = luminance(frame->signal[s].get(x, y));
      *past = luminance(before.signal[s].get(bx, by));
      return true;
    });
  }
  const int columns = (frame->width + kPatch - 1) / kPatch;
  const int rows = (frame->height + kPatch - 1) / kPatch;
  parallel_for("fast history", int64_t{columns} * rows, [&](int64_t i) {
    const int x = static_cast<int>(i % columns), y = static_cast<int>(i / columns);
    Accumulation(before, gain, x * kPatch, y * kPatch, frame, a).run();
  });
  for (int s = 0; s < kKeptSignals; ++s) std::swap(frame->signal[s], a[s]);
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
        const F part = f.part.load(x, y);
        const Vec3Of<F> p = f.p.load(x, y), n = f.n.load(x, y);
        const F scale =
            1.0f / (kTolerance * static_cast<float>(step) * f.distance.load(x, y) + 1e-4f);
        const F age = f.age.load(x, y), rough = f.roughness.load(x, y);
        Vec3Of<F> sum[kFastSignals];
        F total[kFastSignals], sharp[kFastSignals], own[kFastSignals];
        for (int s = 0; s < kFastSignals; ++s) {
          sum[s] = from[s].load(x, y);
          own[s] = luminance(sum[s]);
          total[s] = 1.0f;
          if (s >= kKeptSignals) continue;
          const F mean = f.mean[s].load(x, y);
          const F variance = max(f.square[s].load(x, y) - mean * mean, 0.0f);
          const F noise = square_root(variance / age);
          sharp[s] = 1.0f / (2.0f * noise + 0.005f * own[s] + 1e-4f);
        }
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            if (dx == 0 && dy == 0) continue;
            const int qx = x + dx * step, qy = y + dy * step;
            const F same = select(f.part.load(qx, qy) == part, F(1.0f), F(0.0f));
            const F facing = max(dot(n, f.n.load(qx, qy)), 0.0f);
            const F f4 = sqr(sqr(facing)), f16 = sqr(sqr(f4));
            const F off = dot(n, f.p.load(qx, qy) - p) * scale;
            const F tap =
                same * f16 * max(1.0f - off * off, 0.0f) * (dx != 0 && dy != 0 ? 0.5f : 0.75f);
            for (int s = 0; s < kFastSignals; ++s) {
              const Vec3Of<F> v = from[s].load(qx, qy);
              F w = tap;
              if (s != kCachedSignal) {
                const F d = (luminance(v) - own[s]) * sharp[s];
                w = w / (1.0f + d * d * d * d);
              }
              // Sharp mirrors show what is far behind them.
              if (s == kSpecularSignal) w = w * min(rough * rough * 8.0f, 1.0f);
              sum[s] += v * w;
              total[s] += w;
            }
          }
        }
        for (int s = 0; s < kFastSignals; ++s) {
          to[s].store(x, y, sum[s] / total[s]);
        }
      }
    });
  }
}

}  // namespace gloam
