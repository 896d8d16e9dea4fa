// Frames into one image: each goes through other points of the pixels (temporal antialiasing and
// upsampling; Karis, "High-quality temporal supersampling", 2014; clipping after Salvi 2016).

#include "base/parallel.h"
#include "render/cpu/interactive/filter.h"
#include "render/kernel/camera/camera.h"

namespace gloam {
namespace {

using F = FloatLanes;

/// Samples of a frame about each pixel of the image, along one axis.
class FilterAxis {
 public:
  /// `offset`: of a frame's rays from the centres of its pixels [px of the frame].
  FilterAxis(int pixels, int samples, float offset)
      : scale_(static_cast<float>(samples) / static_cast<float>(pixels)) {
    // Lanes beyond the border of the image load the rest of a row.
    for (int i = 0; i < pixels + kLaneCount; ++i) {
      const float at = (static_cast<float>(i) + 0.5f) * scale_ - 0.5f - offset;
      const float nearest = clamp(floorf(at + 0.5f), 0.0f, static_cast<float>(samples - 1));
      nearest_.push_back(nearest);
      for (int k = 0; k < 3; ++k) {
        const float distance = (nearest + static_cast<float>(k - 1) - at) / scale_;
        weight_[k].push_back(expf(-0.5f * sqr(distance / kPixelFilterSigma)));
      }
    }
  }
  /// Pixels of the frame per pixel of the image.
  float scale() const { return scale_; }
  float nearest(int i) const { return nearest_[static_cast<size_t>(i)]; }
  /// Weight of the sample k - 1 after the nearest.
  float weight(int i, int k) const { return weight_[k][static_cast<size_t>(i)]; }
  F nearest_from(int i) const { return load(nearest_, i); }
  F weight_from(int i, int k) const { return load(weight_[k], i); }

 private:
  static F load(const std::vector<float>& values, int i) {
    F out;
    __builtin_memcpy(&out.v, values.data() + i, sizeof out.v);
    return out;
  }
  float scale_;
  std::vector<float> nearest_, weight_[3];
};

/// Neighbourhood of 3 x 3 samples around pixels of the image.
struct Around {
  Vec3Of<F> now;              ///< their colours, weighted by the pixel filter
  F confidence;               ///< weight of the nearest sample, 0 … 1
  Vec3Of<F> mean, deviation;  ///< of their colours
  F part, gleam;              ///< of the nearest sample
  F motion_x, motion_y;       ///< of the foremost, so that edges go with it [px of the image]
  MaskLanes edge = false;
};

Around look_around(const InteractiveFrame& f, const FilterAxis& across, const FilterAxis& down,
                   int x, int y) {
  const F sx = across.nearest_from(x), sy = down.nearest(y);
  Around out;
  out.part = f.part.gather_at(sx, sy);
  out.gleam = f.gleam.gather_at(sx, sy);
  out.confidence = across.weight_from(x, 1) * down.weight(y, 1);
  F nearest = f.distance.gather_at(sx, sy), front_x = sx, front_y = sy;
  Vec3Of<F> sum, squares;
  F total, n;
  for (int k = 0; k < 9; ++k) {
    const int i = k % 3, j = k / 3;
    const F px = sx + static_cast<float>(i - 1), py = sy + static_cast<float>(j - 1);
    const F other = f.part.gather_at(px, py);
    const MaskLanes inside = other >= 0.0f, apart = inside & !(other == out.part);
    const F one = select(inside, F(1.0f), F(0.0f));
    const F w = across.weight_from(x, i) * down.weight(y, j) * one;
    const Vec3Of<F> color = f.color.gather_at(px, py);
    out.now += color * w;
    total += w;
    sum += color * one;
    squares += color * color * one;
    n += one;
    out.edge = out.edge | apart;
    const F distance = f.distance.gather_at(px, py);
    const MaskLanes nearer = apart & (distance < nearest);
    nearest = select(nearer, distance, nearest);
    front_x = select(nearer, px, front_x);
    front_y = select(nearer, py, front_y);
  }
  out.now = out.now / max(total, F(1e-6f));
  out.mean = sum / n;
  const Vec3Of<F> variance = squares / n - out.mean * out.mean;
  out.deviation = {safe_sqrt(variance.x), safe_sqrt(variance.y), safe_sqrt(variance.z)};
  out.motion_x = f.motion_x.gather_at(front_x, front_y) / across.scale();
  out.motion_y = f.motion_y.gather_at(front_x, front_y) / down.scale();
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

/// Colours at the points (x, y) [px] inside the image; pixel centres lie at whole numbers.
Vec3Of<F> interpolate(const ResolvedImage& image, F x, F y) {
  const F x0 = floor_of(x), y0 = floor_of(y);
  F wx[4], wy[4];
  cubic(x - x0, wx);
  cubic(y - y0, wy);
  const float right = static_cast<float>(image.width - 1),
              low = static_cast<float>(image.height - 1);
  Vec3Of<F> sum;
  for (int j = 0; j < 4; ++j) {
    const F py = clamp(y0 + static_cast<float>(j - 1), 0.0f, low);
    for (int i = 0; i < 4; ++i) {
      const F px = clamp(x0 + static_cast<float>(i - 1), 0.0f, right);
      sum += image.color.gather_at(px, py) * (wx[i] * wy[j]);
    }
  }
  return sum;
}

/// The past of pixels, where they were then.
struct Past {
  Vec3Of<F> color;
  F frames, part, edge;
  MaskLanes inside = false, rests = false;
};

Past look_back(const ResolvedImage& past, F motion_x, F motion_y, int x, int y) {
  F column;
  for (int i = 0; i < kLaneCount; ++i) set_lane(&column, i, static_cast<float>(x + i));
  const F from_x = column - motion_x, from_y = static_cast<float>(y) - motion_y;
  const float right = static_cast<float>(past.width) - 0.5f,
              low = static_cast<float>(past.height) - 0.5f;
  Past out;
  out.inside = (from_x > -0.5f) & (from_x < right) & (from_y > -0.5f) & (from_y < low);
  out.rests = (motion_x == F(0.0f)) & (motion_y == F(0.0f));
  if (all(out.rests)) {
    out.color = past.color.load(x, y);
    out.frames = past.frames.load(x, y);
    out.part = past.part.load(x, y);
    out.edge = past.edge.load(x, y);
    return out;
  }
  const F px = select(out.inside, from_x, F(0.0f)), py = select(out.inside, from_y, F(0.0f));
  out.color = interpolate(past, px, py);
  const F nx = floor_of(px + 0.5f), ny = floor_of(py + 0.5f);
  out.frames = past.frames.gather_at(nx, ny);
  out.part = past.part.gather_at(nx, ny);
  out.edge = past.edge.gather_at(nx, ny);
  return out;
}

/// Places of a frame's samples and of the image's pixels relative to each other.
struct Grid {
  FilterAxis across, down;
};

void resolve_lanes(const InteractiveFrame& f, const LightGain& gain, const Grid& grid,
                   const ResolvedImage& past, int x, int y, ResolvedImage* image) {
  const Around around = look_around(f, grid.across, grid.down, x, y);
  const Past before = look_back(past, around.motion_x, around.motion_y, x, y);
  const MaskLanes same = around.edge | (before.edge > 0.0f) | (before.part == around.part);
  const MaskLanes known = before.inside & same & (before.frames > 0.0f);
  const Vec3Of<F> old = before.color * gain.at(grid.across.nearest_from(x), grid.down.nearest(y));
  const Vec3Of<F> reach = around.deviation * F(interactive::kMeanClampSigma) +
                          around.mean * F(interactive::kMeanClampSlack);
  const Vec3Of<F> least = around.mean - reach, most = around.mean + reach;
  const auto keep = [](F value, F low, F high) { return max(clamp(value, low, high), F(0.0f)); };
  const Vec3Of<F> kept{keep(old.x, least.x, most.x), keep(old.y, least.y, most.y),
                       keep(old.z, least.z, most.z)};
  // A past that was out of reach shows something else: soon the mean is of new frames alone.
  const F off = magnitude(luminance(old) - luminance(kept));
  const MaskLanes wrong = off > interactive::kWrongPast * luminance(around.mean);
  const F longest =
      select(wrong, F(1.0f),
             select(before.rests, F(interactive::kMostFrames), F(interactive::kMostMoving)));
  const F frames =
      select(known, min(before.frames, longest) + around.confidence, around.confidence);
  const F weight = max(around.confidence / max(frames, F(1e-6f)), around.gleam);
  image->color.store(
      x, y, select<F>(known, kept + (around.now - kept) * min(weight, F(1.0f)), around.now));
  image->frames.store(x, y, max(frames, F(1e-3f)));
  image->part.store(x, y, around.part);
  image->edge.store(x, y, select(around.edge, F(1.0f), F(0.0f)));
}

}  // namespace

void resolve(const InteractiveFrame& before, const InteractiveFrame& frame, LightGain* gain,
             const ResolvedImage& past, ResolvedImage* out) {
  const LightChange change{before.color, frame.color, gain};
  measure_gains(before, frame, {&change, 1});
  const Grid grid{{out->width, frame.width, frame.offset.x},
                  {out->height, frame.height, frame.offset.y}};
  parallel_for("interactive resolve", out->height, [&](int64_t y) {
    for (int x = 0; x < out->width; x += kLaneCount) {
      resolve_lanes(frame, *gain, grid, past, x, static_cast<int>(y), out);
    }
  });
}

}  // namespace gloam
