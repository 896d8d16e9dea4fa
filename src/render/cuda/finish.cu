// Kernels between a picture's samples and the host's memory: what goes before and after the
// denoiser, and the tone map.
#include "render/cuda/finish_kernels.h"
#include "render/kernel/film/border.h"
#include "render/kernel/film/firefly.h"
#include "render/kernel/film/light_gain.h"

namespace gloam::cuda {
namespace {

constexpr int kLane = 32, kRows = 8, kThreads = kLane * kRows;

/// Blocks of 32 x 8 pixels.
dim3 blocks_over(int width, int height) {
  return dim3(static_cast<unsigned>((width + kLane - 1) / kLane),
              static_cast<unsigned>((height + kRows - 1) / kRows));
}

__device__ FireflyView view_of(const FinishPicture& p) {
  return {p.width, p.height, p.color, p.brightness, p.albedo, p.normal};
}

__global__ void sanitize_kernel(const __grid_constant__ FinishPicture p) {
  const size_t i = size_t{blockIdx.x} * kThreads + threadIdx.x;
  if (i >= size_t(p.width) * p.height) return;
  const Vec3f color = fireflies::sanitize(p.radiance[i]);
  p.color[i] = p.light[i] = color;
  p.brightness[i] = luminance(color);
}

__global__ void dim_kernel(const __grid_constant__ FinishPicture p) {
  const int x = static_cast<int>(blockIdx.x * kLane + threadIdx.x);
  const int y = static_cast<int>(blockIdx.y * kRows + threadIdx.y);
  const FireflyView view = view_of(p);
  Firefly fly;
  const bool dims = x < p.width && y < p.height && fireflies::dim(view, x, y, &fly);
  const uint32_t bits = __ballot_sync(~0u, dims);
  if (y < p.height && threadIdx.x == 0) p.flies[y * p.words() + blockIdx.x] = bits;
  if (!dims) return;
  const size_t i = view.index(x, y);
  p.color[i] = fly.dimmed;  // no other thread reads it
  p.light[i] = fly.kept;
  p.spread[i] = fly.spread;
}

/// Light of the fireflies around (x, y) that arrives there, row by row, as on the CPU.
__device__ Vec3f arriving(const FinishPicture& p, const FireflyView& view, int x, int y) {
  constexpr int kRadius = fireflies::kSpreadRadius;
  const size_t i = view.index(x, y);
  const int left = fireflies::first(x, kRadius), right = fireflies::last(x, kRadius, p.width);
  const int low = fireflies::last(y, kRadius, p.height);
  Vec3f sum = p.color[i];
  for (int v = fireflies::first(y, kRadius); v <= low; ++v) {
    for (int word = left / 32; word <= right / 32; ++word) {
      for (uint32_t bits = p.flies[v * p.words() + word]; bits != 0; bits &= bits - 1) {
        const int u = 32 * word + __ffs(static_cast<int>(bits)) - 1;
        if (u < left || u > right) continue;
        const size_t j = view.index(u, v);
        if (fireflies::faces(view, j, i)) sum += p.spread[j] * fireflies::albedo(view, i);
      }
    }
  }
  return sum;
}

__global__ void widen_kernel(const __grid_constant__ FinishPicture p) {
  const int u = static_cast<int>(blockIdx.x * kLane + threadIdx.x);
  const int v = static_cast<int>(blockIdx.y * kRows + threadIdx.y);
  if (u >= p.wide_width() || v >= p.wide_height()) return;
  const FireflyView view = view_of(p);
  const int x = mirrored(u - p.border, p.width), y = mirrored(v - p.border, p.height);
  const size_t to = p.wide_index(u - p.border, v - p.border), from = view.index(x, y);
  p.wide_color[to] = arriving(p, view, x, y);
  p.wide_albedo[to] = p.albedo[from];
  p.wide_normal[to] = p.normal[from];
}

/// A tile of pictures: 32 lines, each with kOut places and what lies around them.
struct Tile {
  static constexpr int kOut = 64, kMid = kOut + 2 * kWindowRadius, kIn = kMid + 2 * kWindowRadius;
  float in[kIn][kLane + 1], mid[kMid][kLane + 1];
};

/// Sums over the windows of a line, twice, which weighs pixels by a tent. Sums of floats, none of
/// which is taken off again: running sums would need double precision.
__device__ float window_sum(const float (*line)[kLane + 1], int at, int lane) {
  float sum = 0;
  for (int k = 0; k <= 2 * kWindowRadius; ++k) sum += line[at + k][lane];
  return sum;
}

/// `along` x or y. The light of picture 1 has a border where it lies along rows.
template <bool kAlongX>
__global__ void tent_kernel(const __grid_constant__ FinishPicture p) {
  __shared__ Tile tile;
  const int which = static_cast<int>(blockIdx.z);
  const int length = kAlongX ? p.width : p.height, lines = kAlongX ? p.height : p.width;
  const int first = static_cast<int>(blockIdx.x) * Tile::kOut;
  const int line = static_cast<int>(blockIdx.y) * kLane;
  const int lane = static_cast<int>(threadIdx.x) % kLane,
            row = static_cast<int>(threadIdx.x) / kLane;
  const auto pixel = [&](int a, int b) -> size_t {
    const int x = kAlongX ? a : b, y = kAlongX ? b : a;
    if (kAlongX && which == 1) return p.wide_index(x, y);
    return static_cast<size_t>(y) * static_cast<size_t>(p.width) + static_cast<size_t>(x);
  };
  const Vec3f* from = !kAlongX ? p.rows[which] : (which == 0 ? p.light : p.clean);
  Vec3f* to = kAlongX ? p.rows[which] : p.windows[which];
  const auto is_inside = [&](int a, int b) { return a >= 0 && a < length && b < lines; };
  for (int c = 0; c < 3; ++c) {
    for (int e = static_cast<int>(threadIdx.x); e < Tile::kIn * kLane; e += kThreads) {
      const int i = kAlongX ? e % Tile::kIn : e / kLane, k = kAlongX ? e / Tile::kIn : e % kLane;
      const int a = first - 2 * kWindowRadius + i, b = line + k;
      tile.in[i][k] = is_inside(a, b) ? (&from[pixel(a, b)].x)[c] : 0.0f;
    }
    __syncthreads();
    for (int i = row; i < Tile::kMid; i += kRows) {
      const bool inside = is_inside(first - kWindowRadius + i, line + lane);
      tile.mid[i][lane] = inside ? window_sum(tile.in, i, lane) : 0.0f;
    }
    __syncthreads();
    for (int i = row; i < Tile::kOut; i += kRows) tile.in[i][lane] = window_sum(tile.mid, i, lane);
    __syncthreads();
    for (int e = static_cast<int>(threadIdx.x); e < Tile::kOut * kLane; e += kThreads) {
      const int i = kAlongX ? e % Tile::kOut : e / kLane, k = kAlongX ? e / Tile::kOut : e % kLane;
      const int a = first + i, b = line + k;
      if (!is_inside(a, b)) continue;
      const size_t at = static_cast<size_t>(kAlongX ? b : a) * static_cast<size_t>(p.width) +
                        static_cast<size_t>(kAlongX ? a : b);
      (&to[at].x)[c] = tile.in[i][k];
    }
    __syncthreads();
  }
}

/// Sums of the six values over the block, in a fixed order; valid in thread 0.
__device__ void sum_block(double (*shared)[kThreads], const double* own) {
  const int t = static_cast<int>(threadIdx.x);
  for (int c = 0; c < 6; ++c) shared[c][t] = own[c];
  for (int step = kThreads / 2; step > 0; step /= 2) {
    __syncthreads();
    for (int c = 0; t < step && c < 6; ++c) shared[c][t] += shared[c][t + step];
  }
  __syncthreads();
}

__global__ void window_gain_kernel(const __grid_constant__ FinishPicture p) {
  __shared__ double shared[6][kThreads];
  const size_t count = size_t(p.width) * p.height;
  double sum[6] = {};
  for (size_t i = size_t{blockIdx.x} * kThreads + threadIdx.x; i < count;
       i += size_t{gridDim.x} * kThreads) {
    const int x = static_cast<int>(i % p.width), y = static_cast<int>(i / p.width);
    const Vec3f light = p.light[i];
    const Vec3f out =
        p.clean[p.wide_index(x, y)] * light_gain(p.windows[0][i], p.windows[1][i], kMostWindowGain);
    p.finished[i] = out;
    for (int c = 0; c < 3; ++c) {
      sum[c] += light[c];
      sum[3 + c] += out[c];
    }
  }
  sum_block(shared, sum);
  if (threadIdx.x < 6) p.totals[6 * blockIdx.x + threadIdx.x] = shared[threadIdx.x][0];
}

__global__ void whole_gain_kernel(const __grid_constant__ FinishPicture p) {
  static_assert(FinishPicture::kTotalBlocks == kThreads);
  __shared__ double shared[6][kThreads];
  sum_block(shared, p.totals + 6 * threadIdx.x);
  if (threadIdx.x > 0) return;
  const Vec3Of<double> wanted{shared[0][0], shared[1][0], shared[2][0]};
  const Vec3Of<double> found{shared[3][0], shared[4][0], shared[5][0]};
  *p.gain = light_gain(wanted, found, kMostWholeGain);
}

__global__ void scale_kernel(const __grid_constant__ FinishPicture p) {
  const size_t i = size_t{blockIdx.x} * kThreads + threadIdx.x;
  if (i < size_t(p.width) * p.height) p.finished[i] *= *p.gain;
}

__global__ void tone_map_kernel(const Vec3f* light, int width, int height, float scale,
                                ToneMapSettings settings, uint8_t* rgb) {
  const int x = static_cast<int>(blockIdx.x * kLane + threadIdx.x);
  const int y = static_cast<int>(blockIdx.y * kRows + threadIdx.y);
  if (x >= width || y >= height) return;
  const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  tone_map_pixel(light[i] * scale, x, y, settings, rgb + 3 * i);
}

unsigned blocks_of(const FinishPicture& p) {
  return static_cast<unsigned>((size_t(p.width) * p.height + kThreads - 1) / kThreads);
}

template <bool kAlongX>
void launch_tents(const FinishPicture& p, Stream stream) {
  const int length = kAlongX ? p.width : p.height, lines = kAlongX ? p.height : p.width;
  const dim3 blocks(static_cast<unsigned>((length + Tile::kOut - 1) / Tile::kOut),
                    static_cast<unsigned>((lines + kLane - 1) / kLane), 2);
  tent_kernel<kAlongX><<<blocks, kThreads, 0, stream>>>(p);
}

}  // namespace

void launch_prepare(const FinishPicture& p, Stream stream) {
  const dim3 threads(kLane, kRows);
  sanitize_kernel<<<blocks_of(p), kThreads, 0, stream>>>(p);
  dim_kernel<<<blocks_over(p.width, p.height), threads, 0, stream>>>(p);
  widen_kernel<<<blocks_over(p.wide_width(), p.wide_height()), threads, 0, stream>>>(p);
}

void launch_restore(const FinishPicture& p, Stream stream) {
  launch_tents<true>(p, stream);
  launch_tents<false>(p, stream);
  window_gain_kernel<<<FinishPicture::kTotalBlocks, kThreads, 0, stream>>>(p);
  whole_gain_kernel<<<1, kThreads, 0, stream>>>(p);
  scale_kernel<<<blocks_of(p), kThreads, 0, stream>>>(p);
}

void launch_tone_map(const Vec3f* light, int width, int height, float max_luminance,
                     const ToneMapSettings& settings, uint8_t* rgb, Stream stream) {
  tone_map_kernel<<<blocks_over(width, height), dim3(kLane, kRows), 0, stream>>>(
      light, width, height, 1 / max_luminance, settings, rgb);
}

}  // namespace gloam::cuda
