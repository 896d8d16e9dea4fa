#include "sim/effects/water/water_surface.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "base/wave_math.h"

namespace gloam {
namespace {

// A point of a grid of cells, between the middles of four.
struct GridPoint {
  size_t cell[4];
  double share[4];
};

GridPoint locate(const WaterDescription& water, double x, double y) {
  const WaterGrid& g = water.ripples;
  const double u = std::clamp((x - water.low_x()) / g.dx - 0.5, 0.0, g.nx - 1.0);
  const double v = std::clamp((y - water.low_y()) / g.dy - 0.5, 0.0, g.ny - 1.0);
  const int i = std::min(static_cast<int>(u), g.nx - 2),
            j = std::min(static_cast<int>(v), g.ny - 2);
  const double a = u - i, b = v - j;
  const size_t first = static_cast<size_t>(j) * static_cast<size_t>(g.nx) + static_cast<size_t>(i);
  const size_t next = first + static_cast<size_t>(g.nx);
  return {{first, first + 1, next, next + 1}, {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b}};
}

// Waves side by side, as many as make vector code; what is missing of the last is still.
constexpr size_t kLanes = 8;
struct Lanes {
  double amplitude[kLanes] = {}, kx[kLanes] = {}, ky[kLanes] = {}, omega[kLanes] = {};
  double angle[kLanes] = {};

  Lanes(const std::vector<WaveDescription>& waves, size_t from, double x, double y, double time) {
    for (size_t i = 0; i < kLanes && from + i < waves.size(); ++i) {
      const WaveDescription& wave = waves[from + i];
      amplitude[i] = wave.amplitude, omega[i] = wave.omega;
      kx[i] = wave.kx, ky[i] = wave.ky;
      angle[i] = wave.kx * x + wave.ky * y - wave.omega * time + wave.phase;
    }
  }
};

double sum_of(const double* lanes) {
  double sum = 0;
  for (size_t i = 0; i < kLanes; ++i) sum += lanes[i];
  return sum;
}

}  // namespace

double wave_height(const WaterDescription& water, double x, double y, double time) {
  double height[kLanes] = {};
  for (size_t from = 0; from < water.waves.size(); from += kLanes) {
    const Lanes wave(water.waves, from, x, y, time);
    for (size_t i = 0; i < kLanes; ++i) height[i] += wave.amplitude[i] * sin_cos(wave.angle[i]).cos;
  }
  return sum_of(height);
}

WaveMotion wave_motion(const WaterDescription& water, double x, double y, double z, double time) {
  const double depth = water.depth;
  const double below = std::clamp(z, -depth, 0.0);
  double v[3][kLanes] = {}, a[3][kLanes] = {};
  for (size_t from = 0; from < water.waves.size(); from += kLanes) {
    const Lanes wave(water.waves, from, x, y, time);
    for (size_t i = 0; i < kLanes; ++i) {
      const double k = std::sqrt(wave.kx[i] * wave.kx[i] + wave.ky[i] * wave.ky[i]) + 1e-300;
      const SinCos turn = sin_cos(wave.angle[i]);
      // cosh k(z + h) / sinh kh and sinh k(z + h) / sinh kh, without overflow.
      const double down = exponential(k * below), up = exponential(-k * (below + 2 * depth));
      const double bottom = 1 - exponential(-2 * k * depth) + 1e-300;
      const double speed = wave.amplitude[i] * wave.omega[i] / bottom, rate = speed * wave.omega[i];
      const double level = (down + up) / k, upright = down - up;
      v[0][i] += speed * level * turn.cos * wave.kx[i];
      v[1][i] += speed * level * turn.cos * wave.ky[i];
      v[2][i] += speed * upright * turn.sin;
      a[0][i] += rate * level * turn.sin * wave.kx[i];
      a[1][i] += rate * level * turn.sin * wave.ky[i];
      a[2][i] -= rate * upright * turn.cos;
    }
  }
  return {{sum_of(v[0]), sum_of(v[1]), sum_of(v[2])}, {sum_of(a[0]), sum_of(a[1]), sum_of(a[2])}};
}

double ripple_height(const WaterDescription& water, const HeightChange& ripples, double x,
                     double y) {
  if (ripples.field == nullptr) return 0;
  const GridPoint at = locate(water, x, y);
  double height = 0;
  for (int n = 0; n < 4; ++n) {
    height += at.share[n] * double{ripples.field->height[at.cell[n]] +
                                   ripples.since * ripples.field->rate[at.cell[n]]};
  }
  return height;
}

void surface_heights(const WaterDescription& water, const HeightChange& ripples, double time,
                     std::span<float> heights) {
  const WaterGrid& mesh = water.mesh;
  size_t n = 0;
  for (int j = 0; j <= mesh.ny; ++j) {
    const double y = water.low_y() + mesh.dy * j;
    for (int i = 0; i <= mesh.nx; ++i, ++n)
      heights[n] =
          static_cast<float>(ripple_height(water, ripples, water.low_x() + mesh.dx * i, y));
  }
  // Along a row each wave turns by the same angle from corner to corner.
  for (const WaveDescription& wave : water.waves) {
    const std::complex<double> turn = std::polar(1.0, wave.kx * mesh.dx);
    n = 0;
    for (int j = 0; j <= mesh.ny; ++j) {
      const double y = water.low_y() + mesh.dy * j;
      std::complex<double> pointer = std::polar(
          wave.amplitude, wave.kx * water.low_x() + wave.ky * y - wave.omega * time + wave.phase);
      for (int i = 0; i <= mesh.nx; ++i, ++n) {
        heights[n] += static_cast<float>(pointer.real());
        pointer = {pointer.real() * turn.real() - pointer.imag() * turn.imag(),
                   pointer.real() * turn.imag() + pointer.imag() * turn.real()};
      }
    }
  }
}

SurfacePatch::SurfacePatch(const WaterDescription& water, const HeightChange& ripples, double x,
                           double y, double half_x, double half_y, double time)
    : x_(x),
      y_(y),
      half_x_(half_x),
      half_y_(half_y),
      per_half_x_(1 / half_x),
      per_half_y_(1 / half_y) {
  double sums[3][3][kLanes] = {};
  for (size_t from = 0; from < water.waves.size(); from += kLanes) {
    const Lanes wave(water.waves, from, x, y, time);
    for (size_t n = 0; n < kLanes; ++n) {
      const SinCos middle = sin_cos(wave.angle[n]);
      const SinCos along = sin_cos(wave.kx[n] * half_x), across = sin_cos(wave.ky[n] * half_y);
      for (int j = 0; j < 3; ++j) {
        const double row_c = j == 1 ? 1 : across.cos, row_s = (j - 1) * across.sin;
        for (int i = 0; i < 3; ++i) {
          const double col_c = i == 1 ? 1 : along.cos, col_s = (i - 1) * along.sin;
          const double c = col_c * row_c - col_s * row_s, s = col_s * row_c + col_c * row_s;
          sums[j][i][n] += wave.amplitude[n] * (middle.cos * c - middle.sin * s);
        }
      }
    }
  }
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) value_[j][i] = water.level + sum_of(sums[j][i]);
  fit_ripples(water, ripples);
  // Between three points a parabola is at most an eighth of its bend higher than they are.
  double low = value_[0][0], high = low;
  for (const auto& row : value_) {
    for (const double z : row) low = std::min(low, z), high = std::max(high, z);
  }
  most_ = high + (high - low) + ripple_[0] + std::abs(ripple_[1]) * half_x_ +
          std::abs(ripple_[2]) * half_y_;
}

void SurfacePatch::fit_ripples(const WaterDescription& water, const HeightChange& ripples) {
  if (ripples.field == nullptr) return;
  constexpr int kPoints = 8;
  const double rx = half_x_ + 2 * water.ripples.dx, ry = half_y_ + 2 * water.ripples.dy;
  for (int n = 0; n < kPoints; ++n) {
    constexpr double kHalf = 0.70710678118654752;
    constexpr double kCos[kPoints] = {1, kHalf, 0, -kHalf, -1, -kHalf, 0, kHalf};
    const double c = kCos[n], s = kCos[(n + 6) % kPoints];
    const double height = ripple_height(water, ripples, x_ + rx * c, y_ + ry * s);
    ripple_[0] += height / kPoints;
    ripple_[1] += height * c * 2 / kPoints / rx;
    ripple_[2] += height * s * 2 / kPoints / ry;
  }
}

}  // namespace gloam
