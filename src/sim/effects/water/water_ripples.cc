#include "sim/effects/water/water_ripples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/hash.h"
#include "base/wave_math.h"
#include "sim/effects/shared_version.h"

namespace gloam {
namespace {

constexpr double kDecay = 2 * std::numbers::pi;  // decay with depth, for waves of 1 m [1/m]
constexpr float kLoss = 0.15f;           // loss of the rate of change, to walls and eddies [1/s]
constexpr float kSmoothing = 0.02f;      // loss of waves as short as a cell, per step
constexpr float kCalmThreshold = 2e-6f;  // [m] and [m/s]: nobody sees it
constexpr int kFirstFields = 4;

int substeps_of(const WaterDescription& water, double interval) {
  const double cell = std::min(water.ripples.dx, water.ripples.dy);
  // 0.9 of the limit of the scheme in two dimensions (Courant, Friedrichs and Lewy 1928).
  return static_cast<int>(
      std::ceil(interval * water.ripple_speed * std::numbers::sqrt2 / (0.9 * cell)));
}

}  // namespace

WaterRipples::WaterRipples(const WaterDescription& water, double interval)
    : water_(water), grid_(water.ripples), substeps_(substeps_of(water, interval)) {
  const size_t n = static_cast<size_t>(grid_.nx) * static_cast<size_t>(grid_.ny);
  for (auto* values : {&height_, &rate_, &column_, &before_, &next_}) values->resize(n);
  tent_.resize(static_cast<size_t>(grid_.nx));
  for (int i = 0; i < kFirstFields; ++i) {
    pool_.push_back(std::make_shared<SurfaceHeights>());
    pool_.back()->height.resize(n);
    pool_.back()->rate.resize(n);
  }
}

void WaterRipples::reset() {
  for (auto* values : {&height_, &rate_, &column_, &before_})
    std::fill(values->begin(), values->end(), 0.0f);
  calm_ = true, displaced_ = false;
  shown_.reset();
}

void WaterRipples::take_over(const WaterRipples& before) {
  height_ = before.height_;
  rate_ = before.rate_;
  before_ = before.before_;
  calm_ = before.calm_;
  shown_ = before.shown_;
}

void WaterRipples::displace(const ImmersedShape& shape, const double* p, const double* R,
                            double surface) {
  // An element lies spread over a tent that is as wide as itself or as two cells.
  double extent[3];
  for (int a = 0; a < 3; ++a) {
    extent[a] = std::abs(R[3 * a]) * shape.cell[0] + std::abs(R[3 * a + 1]) * shape.cell[1] +
                std::abs(R[3 * a + 2]) * shape.cell[2];
  }
  const double wx = std::max(extent[0], 2 * grid_.dx), wy = std::max(extent[1], 2 * grid_.dy);
  const double per_area = 1 / (wx * wy), deepest = water_.level - water_.depth;
  for (const VolumeElement& e : shape.elements) {
    const double x = p[0] + R[0] * e.p[0] + R[1] * e.p[1] + R[2] * e.p[2] - water_.low_x();
    const double y = p[1] + R[3] * e.p[0] + R[4] * e.p[1] + R[5] * e.p[2] - water_.low_y();
    const double z = p[2] + R[6] * e.p[0] + R[7] * e.p[1] + R[8] * e.p[2];
    const double share = std::clamp((surface - z) / extent[2] + 0.5, 0.0, 1.0);
    if (share == 0 || z < deepest) continue;
    const double column =
        e.volume * share * exponential(-kDecay * std::max(surface - z, 0.0)) * per_area;
    const int i0 = std::max(static_cast<int>(std::ceil((x - wx) / grid_.dx - 0.5)), 0);
    const int i1 = std::min(static_cast<int>(std::floor((x + wx) / grid_.dx - 0.5)), grid_.nx - 1);
    const int j0 = std::max(static_cast<int>(std::ceil((y - wy) / grid_.dy - 0.5)), 0);
    const int j1 = std::min(static_cast<int>(std::floor((y + wy) / grid_.dy - 0.5)), grid_.ny - 1);
    if (i1 < i0 || j1 < j0) continue;
    displaced_ = true;
    for (int i = i0; i <= i1; ++i)
      tent_[static_cast<size_t>(i - i0)] =
          static_cast<float>(column * (1 - std::abs((i + 0.5) * grid_.dx - x) / wx));
    for (int j = j0; j <= j1; ++j) {
      const auto ty = static_cast<float>(1 - std::abs((j + 0.5) * grid_.dy - y) / wy);
      float* row = column_.data() + j * grid_.nx + i0;
      for (int i = 0; i <= i1 - i0; ++i) row[i] += tent_[static_cast<size_t>(i)] * ty;
    }
  }
}

void WaterRipples::advance(double interval) {
  if (calm_ && !displaced_) return;
  for (size_t i = 0; i < height_.size(); ++i) height_[i] += column_[i] - before_[i];
  const bool alone = !displaced_;
  column_.swap(before_);
  std::fill(column_.begin(), column_.end(), 0.0f);
  displaced_ = false;
  calm_ = false;
  const auto dt = static_cast<float>(interval / substeps_);
  for (int n = 0; n < substeps_; ++n) substep(dt);
  if (alone && settle()) {
    reset();
    return;
  }
  publish();
}

// Symplectic Euler: rates from heights, then heights from rates. Beyond the sides lies what lies
// before them, so that nothing flows through.
void WaterRipples::substep(float dt) {
  const int nx = grid_.nx, ny = grid_.ny;
  const double c2 = water_.ripple_speed * water_.ripple_speed;
  const auto ax = static_cast<float>(c2 / (grid_.dx * grid_.dx)) * dt;
  const auto ay = static_cast<float>(c2 / (grid_.dy * grid_.dy)) * dt;
  const float keep = 1 - kLoss * dt;
  for (int j = 0; j < ny; ++j) {
    const size_t row = static_cast<size_t>(j) * static_cast<size_t>(nx);
    const size_t south = j > 0 ? row - static_cast<size_t>(nx) : row;
    const size_t north = j + 1 < ny ? row + static_cast<size_t>(nx) : row;
    const float *h = height_.data() + row, *w = rate_.data() + row;
    const float *hs = height_.data() + south, *ws = rate_.data() + south;
    const float *hn = height_.data() + north, *wn = rate_.data() + north;
    float* to = next_.data() + row;
    const auto step = [=](int i, int west, int east) {
      const float bend = ax * (h[west] - 2 * h[i] + h[east]) + ay * (hs[i] - 2 * h[i] + hn[i]);
      const float spread = w[west] + w[east] + ws[i] + wn[i] - 4 * w[i];
      to[i] = keep * (w[i] + kSmoothing * spread) + bend;
    };
    step(0, 0, 1);
    for (int i = 1; i + 1 < nx; ++i) step(i, i - 1, i + 1);
    step(nx - 1, nx - 2, nx - 1);
  }
  rate_.swap(next_);
  for (size_t i = 0; i < height_.size(); ++i) height_[i] += dt * rate_[i];
}

// Without bodies what is left of waves too small to be seen is nothing.
bool WaterRipples::settle() {
  float most = 0;
  for (size_t i = 0; i < height_.size(); ++i)
    most = std::max({most, std::abs(height_[i]), std::abs(rate_[i])});
  return most < kCalmThreshold;
}

void WaterRipples::publish() {
  auto free = std::find_if(pool_.begin(), pool_.end(), is_free<SurfaceHeights>);
  if (free == pool_.end()) {  // readers hold all
    pool_.push_back(std::make_shared<SurfaceHeights>());
    free = pool_.end() - 1;
  }
  (*free)->height = height_;
  (*free)->rate = rate_;
  shown_ = *free;
}

uint64_t WaterRipples::digest() const {
  if (calm_) return 0;
  return hash_span<float>(before_, hash_span<float>(rate_, hash_span<float>(height_)));
}

double WaterRipples::energy() const {
  const auto nx = static_cast<size_t>(grid_.nx), ny = static_cast<size_t>(grid_.ny);
  const double c2 = water_.ripple_speed * water_.ripple_speed;
  double sum = 0;
  for (size_t j = 0; j < ny; ++j) {
    for (size_t i = 0; i < nx; ++i) {
      const size_t n = j * nx + i;
      const double h = height_[n], w = rate_[n];
      const double sx = i + 1 < nx ? (height_[n + 1] - h) / grid_.dx : 0;
      const double sy = j + 1 < ny ? (height_[n + nx] - h) / grid_.dy : 0;
      sum += (w * w + c2 * (sx * sx + sy * sy)) / 2;
    }
  }
  return sum * grid_.dx * grid_.dy;
}

}  // namespace gloam
