#include "sim/effects/water_surface.h"

#include <algorithm>
#include <cmath>
#include <complex>

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

// Through f(-1), f(0), f(1).
double parabola(double a, double b, double c, double u) {
  return b + u * ((c - a) / 2 + u * ((a + c) / 2 - b));
}

}  // namespace

double wave_height(const WaterDescription& water, double x, double y, double time) {
  double height = 0;
  for (const WaveDescription& wave : water.waves)
    height += wave.amplitude * std::cos(wave.kx * x + wave.ky * y - wave.omega * time + wave.phase);
  return height;
}

WaveMotion wave_motion(const WaterDescription& water, double x, double y, double z, double time) {
  WaveMotion out;
  const double depth = water.depth;
  const double below = std::clamp(z, -depth, 0.0);
  for (const WaveDescription& wave : water.waves) {
    const double k = wave.k();
    const double angle = wave.kx * x + wave.ky * y - wave.omega * time + wave.phase;
    const double c = std::cos(angle), s = std::sin(angle);
    // cosh k(z + h) / sinh kh and sinh k(z + h) / sinh kh, without overflow.
    const double down = std::exp(k * below), up = std::exp(-k * (below + 2 * depth));
    const double bottom = 1 - std::exp(-2 * k * depth);
    const double level = (down + up) / bottom, upright = (down - up) / bottom;
    const double speed = wave.amplitude * wave.omega, rate = speed * wave.omega;
    const double ex = wave.kx / k, ey = wave.ky / k;
    out.velocity.x += speed * level * c * ex;
    out.velocity.y += speed * level * c * ey;
    out.velocity.z += speed * upright * s;
    out.acceleration.x += rate * level * s * ex;
    out.acceleration.y += rate * level * s * ey;
    out.acceleration.z -= rate * upright * c;
  }
  return out;
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
    : x_(x), y_(y), half_x_(half_x), half_y_(half_y) {
  for (auto& row : value_) std::fill(row, row + 3, water.level);
  for (const WaveDescription& wave : water.waves) {
    const std::complex<double> middle =
        std::polar(wave.amplitude, wave.kx * x + wave.ky * y - wave.omega * time + wave.phase);
    const double ax = wave.kx * half_x, ay = wave.ky * half_y;
    const double cx = std::cos(ax), sx = std::sin(ax), cy = std::cos(ay), sy = std::sin(ay);
    for (int j = 0; j < 3; ++j) {
      const double row_c = j == 1 ? 1 : cy, row_s = (j - 1) * sy;
      for (int i = 0; i < 3; ++i) {
        const double col_c = i == 1 ? 1 : cx, col_s = (i - 1) * sx;
        const double c = col_c * row_c - col_s * row_s, s = col_s * row_c + col_c * row_s;
        value_[j][i] += middle.real() * c - middle.imag() * s;
      }
    }
  }
  fit_ripples(water, ripples);
}

double SurfacePatch::waves(double x, double y) const {
  const double u = std::clamp((x - x_) / half_x_, -1.0, 1.0);
  const double v = std::clamp((y - y_) / half_y_, -1.0, 1.0);
  double row[3];
  for (int j = 0; j < 3; ++j) row[j] = parabola(value_[j][0], value_[j][1], value_[j][2], u);
  return parabola(row[0], row[1], row[2], v);
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
