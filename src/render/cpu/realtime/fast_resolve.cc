// Pictures into one: each goes through other points of the pixels (temporal antialiasing; Karis,
// "High-quality temporal supersampling", 2014; clipping after Salvi 2016).

#include "base/parallel.h"
#include "render/cpu/realtime/fast_filter.h"
#include "render/kernel/camera/camera.h"

namespace gloam {
namespace {

using F = FloatLanes;

/// Neighbourhood of 3 x 3 pixels around those from (x, y) on.
struct Around {
  Vec3Of<F> now;  ///< their colours, weighted by the pixel filter
  NeighbourMoments color;
  F motion_x, motion_y;  ///< of what is in front, so that edges go with it
  MaskLanes edge = false;
};

/// The pixel filter over 3 x 3 pixels of a picture, row by row.
struct FilterWeights {
  explicit FilterWeights(Vec2f offset) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        of[3 * dy + dx + 4] =
            pixel_filter(offset + Vec2f{static_cast<float>(dx), static_cast<float>(dy)});
      }
    }
  }
  float of[9];
};

Around look_around(const FastFrame& f, const FilterWeights& weights, int x, int y) {
  Around out;
  F nearest = f.distance.load(x, y);
  const F part = f.part.load(x, y);
  out.motion_x = f.motion_x.load(x, y);
  out.motion_y = f.motion_y.load(x, y);
  F total;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const F other = f.part.load(x + dx, y + dy);
      const MaskLanes inside = other >= 0.0f, apart = inside & !(other == part);
      const F w = select(inside, F(weights.of[3 * dy + dx + 4]), F(0.0f));
      out.now += f.color.load(x + dx, y + dy) * w;
      total += w;
      out.edge = out.edge | apart;
      const F distance = f.distance.load(x + dx, y + dy);
      const MaskLanes nearer = apart & (distance < nearest);
      nearest = select(nearer, distance, nearest);
      out.motion_x = select(nearer, f.motion_x.load(x + dx, y + dy), out.motion_x);
      out.motion_y = select(nearer, f.motion_y.load(x + dx, y + dy), out.motion_y);
    }
  }
  out.now = out.now / max(total, F(1e-6f));
  out.color = neighbour_moments(
      f.color, x, y, [&](int dx, int dy) { return f.part.load(x + dx, y + dy) >= 0.0f; });
  return out;
}

/// Weights of Catmull and Rom's cubic at t in [0, 1) between the second and third of four values.
void cubic(F t, F weight[4]) {
  const F t2 = t * t, t3 = t2 * t;
  weight[0] = -0.5f * t + t2 - 0.5f * t3;
  weight[1] = 1.0f - 2.5f * t2 + 1.5f * t3;
  weight[2] = 0.5f * t + 2.0f * t2 - 1.5f * t3;
  weight[3] = 0.5f * (t3 - t2);
}

/// A plane at the points (x, y) [px] inside the picture; pixel centres lie at whole numbers.
Vec3Of<F> interpolate(const FastPlane3& plane, int width, int height, F x, F y) {
  const F x0 = floor_of(x), y0 = floor_of(y);
  F wx[4], wy[4];
  cubic(x - x0, wx);
  cubic(y - y0, wy);
  Vec3Of<F> sum;
  for (int j = 0; j < 4; ++j) {
    const F py = clamp(y0 + static_cast<float>(j - 1), 0.0f, static_cast<float>(height - 1));
    for (int i = 0; i < 4; ++i) {
      const F px = clamp(x0 + static_cast<float>(i - 1), 0.0f, static_cast<float>(width - 1));
      sum += plane.gather_at(px, py) * (wx[i] * wy[j]);
    }
  }
  return sum;
}

void resolve_lanes(const FastFrame& before, const LightGain& gain, const FilterWeights& weights,
                   int x, int y, FastFrame* frame) {
  FastFrame& f = *frame;
  const Around around = look_around(f, weights, x, y);
  const Vec3Of<F>& now = around.now;
  F column;
  for (int i = 0; i < kLaneCount; ++i) set_lane(&column, i, static_cast<float>(x + i));
  const F from_x = column - around.motion_x, from_y = static_cast<float>(y) - around.motion_y;
  const float right = static_cast<float>(f.width) - 0.5f, low = static_cast<float>(f.height) - 0.5f;
  const MaskLanes inside = (from_x > -0.5f) & (from_x < right) & (from_y > -0.5f) & (from_y < low);
  Vec3Of<F> past;
  F pictures, part, edge;
  const MaskLanes rests = (around.motion_x == F(0.0f)) & (around.motion_y == F(0.0f));
  if (all(rests)) {
    past = before.resolved.load(x, y);
    pictures = before.pictures.load(x, y);
    part = before.part.load(x, y);
    edge = before.edge.load(x, y);
  } else {
    const F px = select(inside, from_x, F(0.0f)), py = select(inside, from_y, F(0.0f));
    past = interpolate(before.resolved, f.width, f.height, px, py);
    const F nx = floor_of(px + 0.5f), ny = floor_of(py + 0.5f);
    pictures = before.pictures.gather_at(nx, ny);
    part = before.part.gather_at(nx, ny);
    edge = before.edge.gather_at(nx, ny);
  }
  past = past * gain.from(x, y);
  const MaskLanes same = around.edge | (edge > 0.0f) | (part == f.part.load(x, y));
  const MaskLanes known = inside & same & (pictures > 0.0f);
  const Vec3Of<F> reach = around.color.deviation * F(realtime::kMeanClampSigma) +
                          around.color.mean * F(realtime::kMeanClampSlack);
  const Vec3Of<F> least = around.color.mean - reach, most = around.color.mean + reach;
  const auto keep = [](F value, F low, F high) { return max(clamp(value, low, high), F(0.0f)); };
  const Vec3Of<F> kept{keep(past.x, least.x, most.x), keep(past.y, least.y, most.y),
                       keep(past.z, least.z, most.z)};
  const F longest = select(rests, F(realtime::kMostPictures), F(realtime::kMostMoving));
  pictures = select(known, min(pictures + 1.0f, longest), F(1.0f));
  const F weight = max(1.0f / pictures, f.gleam.load(x, y));
  f.edge.store(x, y, select(around.edge, F(1.0f), F(0.0f)));
  f.resolved.store(x, y, select<F>(known, kept + (now - kept) * weight, now));
  f.pictures.store(x, y, pictures);
}

}  // namespace

void resolve(const FastFrame& before, LightGain* gain, FastFrame* frame) {
  const LightChange change{before.color, frame->color, gain};
  measure_gains(before, *frame, {&change, 1});
  const FilterWeights weights(frame->offset);
  parallel_for("fast resolve", frame->height, [&](int64_t y) {
    for (int x = 0; x < frame->width; x += kLaneCount) {
      resolve_lanes(before, *gain, weights, x, static_cast<int>(y), frame);
    }
  });
}

}  // namespace gloam
