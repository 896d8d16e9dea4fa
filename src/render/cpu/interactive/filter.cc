#include "render/cpu/interactive/filter.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>

#include "base/parallel.h"

namespace gloam {
namespace {

using F = FloatLanes;

/// Mean luminance of a signal two pixels away on the same part; without bound where there is none.
/// Pixels beside one another may show what one ray has brought.
F luminance_about(const InteractiveFrame& f, int signal, int x, int y) {
  const F part = f.part.load(x, y);
  F sum, n;
  for (int dy = -2; dy <= 2; dy += 2) {
    for (int dx = -2; dx <= 2; dx += 2) {
      if (dx == 0 && dy == 0) continue;
      const F one = select(f.part.load(x + dx, y + dy) == part, F(1.0f), F(0.0f));
      sum += one * luminance(f.signal[signal].load(x + dx, y + dy));
      n += one;
    }
  }
  return select(n > 0.0f, sum / max(n, 1.0f), F(1e30f));
}

/// One patch of accumulate().
class Accumulation {
 public:
  Accumulation(const InteractiveFrame& before, const LightGain* gain, int x0, int y0,
               InteractiveFrame* frame, InteractivePlane3* out)
      : before_(before), gain_(gain), f_(*frame), out_(out), x0_(x0), y0_(y0) {}

  void run() {
    find_places();
    for (int y = y0_; y < y1_; ++y) {
      for (int part = 0; part < kParts; ++part) blend(x0_ + part * kLaneCount, y, part);
    }
  }

 private:
  static constexpr int kParts = interactive::kPatch / kLaneCount;  // of a row

  void find_places() {
    // Sums by columns, so that they are the same for any number of lanes.
    F now[kSignals][kParts], past[kSignals][kParts];
    for (int y = y0_; y < y1_; ++y) {
      for (int part = 0; part < kParts; ++part) {
        const int x = x0_ + part * kLaneCount;
        InteractivePast& place = places_[y - y0_][part];
        place = find_past(before_, f_, x, y);
        for (int s = 0; s < f_.signals; ++s) {
          const F new_light = luminance(f_.signal[s].load(x, y));
          const F old_light = luminance(place.of(before_.signal[s], x, y));
          now[s][part] += select(place.known, new_light, F(0.0f));
          past[s][part] += select(place.known, old_light, F(0.0f));
        }
      }
    }
    // Weight of the new picture grows where the light of a whole patch has changed: old pictures
    // say little there.
    for (int s = 0; s < f_.signals; ++s) {
      const float a = sum_of(now[s]), b = sum_of(past[s]);
      const float change = fabsf(a - b) / max(max(a, b), 1e-6f);
      least_weight_[s] =
          clamp((change - interactive::kNoChange) * interactive::kChangeResponse, 0.0f, 1.0f);
    }
  }
  static float sum_of(const F (&columns)[kParts]) {
    float sum = 0;
    for (int i = 0; i < interactive::kPatch; ++i)
      sum += lane(columns[i / kLaneCount], i % kLaneCount);
    return sum;
  }

  void blend(int x, int y, int part) {
    const InteractivePast& place = places_[y - y0_][part];
    const F own_part = f_.part.load(x, y);
    const F longer = min(place.of(before_.age, x, y) + 1.0f, interactive::kMaxHistory);
    const F age = select(place.known, longer, F(1.0f));
    f_.age.store(x, y, age);
    for (int s = 0; s < f_.signals; ++s) {
      const auto [mean, deviation] = neighbour_moments(f_.signal[s], x, y, [&](int dx, int dy) {
        return f_.part.load(x + dx, y + dy) == own_part;
      });
      Vec3Of<F> now = f_.signal[s].load(x, y);
      F l = luminance(now), weight = max(1.0f / age, least_weight_[s]);
      if (s == kSpecularSignal) {
        // Rays that a rough surface scatters seldom meet a lamp: one that does is made no brighter
        // than the others.
        // A rounding error below zero must not become 0 / 0 where all is dark.
        const F most = max(interactive::kMaxSpikeRatio * luminance_about(f_, s, x, y), F(0.0f));
        now = select<F>(l > most, now * (most / l), now);
        l = min(l, most);
        // Images in mirrors do not move with the mirror's surface.
        const MaskLanes moves =
            !((f_.motion_x.load(x, y) == F(0.0f)) & (f_.motion_y.load(x, y) == F(0.0f)));
        weight = select(moves & (f_.roughness.load(x, y) < interactive::kSharpMirror),
                        max(weight, interactive::kMovingMirrorWeight), weight);
      }
      // Old light out of the range of its neighbours is a trail of something that has moved on.
      const F gain = gain_[s].from(x, y);
      const Vec3Of<F> old = place.of(before_.signal[s], x, y) * gain;
      const Vec3Of<F> least = mean - deviation * F(interactive::kHistoryClampSigma),
                      most = mean + deviation * F(interactive::kHistoryClampSigma);
      const Vec3Of<F> kept{clamp(old.x, least.x, most.x), clamp(old.y, least.y, most.y),
                           clamp(old.z, least.z, most.z)};
      out_[s].store(x, y, select<F>(place.known, lerp(kept, now, weight), now));
      const F old_mean = place.of(before_.mean[s], x, y) * gain;
      f_.mean[s].store(x, y, select(place.known, lerp(old_mean, l, weight), l));
      const F old_square = place.of(before_.square[s], x, y) * sqr(gain);
      const F spread = sqr(luminance(deviation));  // until more is known
      f_.square[s].store(x, y,
                         select(place.known, lerp(old_square, l * l, weight), l * l + spread));
    }
  }

  const InteractiveFrame& before_;
  const LightGain* gain_;  // of each signal
  InteractiveFrame& f_;
  InteractivePlane3* out_;
  const int x0_, y0_, y1_ = min(y0_ + interactive::kPatch, f_.height);
  InteractivePast places_[interactive::kPatch][kParts];
  float least_weight_[kSignals] = {};
};

}  // namespace

void PlaneMemory::resize(int width, int height, const std::vector<Member>& members) {
  constexpr size_t kPage = size_t{2} << 20;  // [B] of x86-64's large pages
  constexpr size_t kLine = 16,
                   kWay = 1024;  // floats of a cache's line, and of a way of the first cache
  constexpr int kBorder = InteractivePlane::kBorder;
  const int stride = (width + kLaneCount - 1) / kLaneCount * kLaneCount + 2 * kBorder;
  const size_t size = static_cast<size_t>(stride) * static_cast<size_t>(height + 2 * kBorder);
  // The same pixel of planes beside one another must not fall into one set of the caches.
  const size_t pitch = (size + kWay - 1) / kWay * kWay + 5 * kLine;
  const size_t bytes = (pitch * members.size() * sizeof(float) + kPage - 1) / kPage * kPage;
  floats_.reset();
  floats_.reset(static_cast<float*>(std::aligned_alloc(kPage, bytes)));
  if (!floats_) throw std::bad_alloc();
  madvise(floats_.get(), bytes, MADV_HUGEPAGE);  // refused: slower, no more
  float* next = floats_.get();
  for (const auto& [plane, value] : members) {
    plane->values_ = next;
    plane->stride_ = stride;
    std::fill_n(next, size, value);
    next += pitch;
  }
}

void InteractiveFrame::resize(int w, int h) {
  width = w;
  height = h;
  std::vector<PlaneMemory::Member> members;
  const auto add = [&](InteractivePlane& plane, float value = 0) {
    members.push_back({&plane, value});
  };
  const auto add3 = [&](InteractivePlane3& planes) {
    for (InteractivePlane& plane : planes.c) add(plane);
  };
  for (int s = 0; s < kSignals; ++s) {
    add3(signal[s]);
    add(mean[s]);
    add(square[s]);
  }
  add(age, 1);  // beyond the picture too: noise is divided by it
  for (InteractivePlane3* planes : {&p, &n, &base, &albedo, &gloss, &color}) add3(*planes);
  add(part, -1);
  for (InteractivePlane* plane : {&distance, &roughness, &near, &motion_x, &motion_y, &gleam}) {
    add(*plane);
  }
  memory_.resize(w, h, members);
  key.assign(static_cast<size_t>(w) * h, 0);
}

void ResolvedImage::resize(int w, int h) {
  width = w;
  height = h;
  std::vector<PlaneMemory::Member> members;
  for (InteractivePlane& plane : color.c) members.push_back({&plane, 0});
  for (InteractivePlane* plane : {&frames, &part, &edge}) members.push_back({plane, 0});
  memory_.resize(w, h, members);
}

void InteractiveFilter::resize(int width, int height) {
  std::vector<PlaneMemory::Member> members;
  for (int s = 0; s < kSignals; ++s) {
    for (int k = 0; k < 3; ++k) {
      members.push_back({&a[s].c[k], 0});
      members.push_back({&b[s].c[k], 0});
    }
    members.push_back({&deviation[s], 0});
    gain[s].resize(width, height);
  }
  memory_.resize(width, height, members);
  color_gain.resize(width, height);
}

void InteractiveFilter::accumulate(const InteractiveFrame& before, InteractiveFrame* frame) {
  std::vector<LightChange> changes;
  for (int s = 0; s < frame->signals; ++s)
    changes.push_back({before.signal[s], frame->signal[s], &gain[s]});
  measure_gains(before, *frame, changes);
  const int columns = (frame->width + interactive::kPatch - 1) / interactive::kPatch;
  const int rows = (frame->height + interactive::kPatch - 1) / interactive::kPatch;
  parallel_for("interactive history", int64_t{columns} * rows, [&](int64_t i) {
    const int x = static_cast<int>(i % columns), y = static_cast<int>(i / columns);
    Accumulation(before, gain, x * interactive::kPatch, y * interactive::kPatch, frame, a).run();
  });
  for (int s = 0; s < frame->signals; ++s) std::swap(frame->signal[s], a[s]);
}

namespace {

/// Deviation of what is shown of a signal: of the pixels around together, as few samples say little
/// of it.
F deviation_at(const InteractiveFrame& f, int signal, int x, int y) {
  const F part = f.part.load(x, y);
  F variance, n;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const F one = select(f.part.load(x + dx, y + dy) == part, F(1.0f), F(0.0f));
      const F mean = f.mean[signal].load(x + dx, y + dy);
      variance += one * max(f.square[signal].load(x + dx, y + dy) - mean * mean, 0.0f);
      n += one;
    }
  }
  return square_root(variance / (n * f.age.load(x, y)));
}

/// Deviation of a signal's luminance among the pixels that a round takes together and that count:
/// each of them finds about the same, so that none gives what the others do not take.
template <class Counts>
F spread_around(const InteractivePlane3& signal, int step, int x, int y, const Counts& counts) {
  F sum, squares, n;
  for (int dy = -step; dy <= step; dy += step) {
    for (int dx = -step; dx <= step; dx += step) {
      const F one = select(counts(x + dx, y + dy), F(1.0f), F(0.0f));
      const F l = one * luminance(signal.load(x + dx, y + dy));
      sum += l, squares += l * l, n += one;
    }
  }
  const F mean = sum / max(n, 1.0f);
  return safe_sqrt(squares / max(n, 1.0f) - mean * mean);
}

/// Inverse of the difference of light that may be chance, for likeness().
F sharpness(F deviation, F light) { return 1.0f / (2.0f * deviation + 0.005f * light + 1e-4f); }
F likeness(F light, F own, F sharp) {
  const F d = (light - own) * sharp;
  return 1.0f / (1.0f + sqr(min(d * d, interactive::kMaxSquaredDeviation)));
}
F corner_weight(int dx, int dy) { return dx != 0 && dy != 0 ? 0.5f : 0.75f; }

}  // namespace

template <int kFirst>
void InteractiveFilter::smooth_signals(const InteractiveFrame& f, int round,
                                       const InteractivePlane3* from, InteractivePlane3* to) {
  const int step = 1 << round;
  parallel_for("interactive filter", f.height, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < f.width; x += kLaneCount) {
      const F part = f.part.load(x, y);
      const Vec3Of<F> p = f.p.load(x, y), n = f.n.load(x, y);
      const F scale =
          1.0f /
          (interactive::kPlaneTolerance * static_cast<float>(step) * f.distance.load(x, y) + 1e-4f);
      const F rough = f.roughness.load(x, y);
      const F mirror = min(rough * rough * 8.0f, 1.0f);
      Vec3Of<F> sum[kAirSignal];
      F total[kAirSignal], sharp[kAirSignal], own[kAirSignal];
      for (int s = kFirst; s < kAirSignal; ++s) {
        sum[s] = from[s].load(x, y);
        total[s] = 1.0f;
        if (round == 0) deviation[s].store(x, y, deviation_at(f, s, x, y));
        F spread = deviation[s].load(x, y);
        if (s != kDirectSignal &&
            round < interactive::kSpikeFilterRounds) {  // light of lamps has edges
          spread = max(spread, spread_around(from[s], step, x, y, [&](int qx, int qy) {
                         return f.part.load(qx, qy) == part;
                       }));
        }
        own[s] = luminance(sum[s]);
        sharp[s] = sharpness(spread, own[s]);
      }
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (dx == 0 && dy == 0) continue;
          const int qx = x + dx * step, qy = y + dy * step;
          const F same = select(f.part.load(qx, qy) == part, F(1.0f), F(0.0f));
          const F facing = max(dot(n, f.n.load(qx, qy)), 0.0f);
          const F f4 = sqr(sqr(facing)), f16 = sqr(sqr(f4));
          const F off = dot(n, f.p.load(qx, qy) - p) * scale;
          const F tap = same * f16 * max(1.0f - off * off, 0.0f) * corner_weight(dx, dy);
          Vec3Of<F> v[kAirSignal];
          F weight[kAirSignal];
          for (int s = kFirst; s < kAirSignal; ++s) {
            v[s] = from[s].load(qx, qy);
            weight[s] = tap * likeness(luminance(v[s]), own[s], sharp[s]);
          }
          // Sharp mirrors show what is far behind them.
          if constexpr (kFirst <= kSpecularSignal) weight[kSpecularSignal] *= mirror;
          for (int s = kFirst; s < kAirSignal; ++s) {
            sum[s] += v[s] * weight[s];
            total[s] += weight[s];
          }
        }
      }
      for (int s = kFirst; s < kAirSignal; ++s) to[s].store(x, y, sum[s] / total[s]);
    }
  });
}

void InteractiveFilter::smooth_air(const InteractiveFrame& f, int round,
                                   const InteractivePlane3& from, InteractivePlane3* to) {
  const int step = 1 << round;
  parallel_for("interactive air", f.height, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < f.width; x += kLaneCount) {
      if (round == 0) deviation[kAirSignal].store(x, y, deviation_at(f, kAirSignal, x, y));
      F spread = deviation[kAirSignal].load(x, y);
      spread = max(spread, spread_around(from, step, x, y, [&](int qx, int qy) {
                     return f.part.load(qx, qy) >= 0.0f;
                   }));
      Vec3Of<F> sum = from.load(x, y);
      const F own = luminance(sum), sharp = sharpness(spread, own);
      const F distance = f.distance.load(x, y), scale = 1.0f / (interactive::kSameDepth * distance);
      F total = 1.0f;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (dx == 0 && dy == 0) continue;
          const int qx = x + dx * step, qy = y + dy * step;
          const F off = (f.distance.load(qx, qy) - distance) * scale;
          const F near = max(1.0f - off * off, 0.0f) * corner_weight(dx, dy);
          const Vec3Of<F> v = from.load(qx, qy);
          const F weight = select(f.part.load(qx, qy) >= 0.0f,
                                  near * likeness(luminance(v), own, sharp), F(0.0f));
          sum += v * weight;
          total += weight;
        }
      }
      to->store(x, y, sum / total);
    }
  });
}

void InteractiveFilter::smooth(const InteractiveFrame& f) {
  smooth_signals<0>(f, 0, f.signal, a);
  smooth_signals<0>(f, 1, a, b);
  // Light of lamps has edges; that of the cache has few.
  smooth_signals<kCachedSignal>(f, 2, b, a);
  if (f.signals > kAirSignal) {
    const InteractivePlane3* from = &f.signal[kAirSignal];
    for (int round = 0; round < 4; ++round) {
      InteractivePlane3* to = round % 2 == 0 ? &a[kAirSignal] : &b[kAirSignal];
      smooth_air(f, round, *from, to);
      from = to;
    }
  }
}

}  // namespace gloam
