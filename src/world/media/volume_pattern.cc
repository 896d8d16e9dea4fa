#include "world/media/volume_pattern.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"

namespace gloam {
namespace {

/// Noise of lattice values in 0..1 under a smooth trilinear weight.
double lattice_noise(const RandomStream& random, double x, double y, double z) {
  const double fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double tx = smooth(x - fx), ty = smooth(y - fy), tz = smooth(z - fz);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
    // 21 bits of each coordinate; cells around zero are apart from each other.
    const auto bits = [](double f, int d) {
      return (static_cast<uint64_t>(static_cast<int64_t>(f) + d) & 0x1FFFFF);
    };
    const uint64_t cell = bits(fx, dx) | bits(fy, dy) << 21 | bits(fz, dz) << 42;
    const double weight =
        (dx != 0 ? tx : 1 - tx) * (dy != 0 ? ty : 1 - ty) * (dz != 0 ? tz : 1 - tz);
    sum += weight * random.uniform(cell, 0);
  }
  return sum;
}

/// Octaves of it, 0..1.
double billows(const RandomStream& random, double x, double y, double z) {
  double sum = 0, weight = 0.5, scale = 1;
  constexpr int kOctaves = 5;
  for (int i = 0; i < kOctaves; ++i, weight /= 2, scale *= 2.03) {
    const double shift = 17.3 * i;  // octaves do not line up
    sum += weight * lattice_noise(random, scale * x + shift, scale * y - shift, scale * z + shift);
  }
  return sum / (1 - std::pow(0.5, kOctaves));
}

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// x, y in -1..1 across the box, z in 0..1 up; n: the same point for the noise, with equal scales.
double plume(const RandomStream& random, double x, double y, double z, const double n[3]) {
  // A turbulent plume widens in proportion to its height; eddies wind it about.
  const double sway = 0.5 * z;
  const double u = x + sway * (billows(random, 1.3 * n[0], 5, 1.3 * n[2]) - 0.5);
  const double v = y + sway * (billows(random, 9, 1.3 * n[1], 1.3 * n[2]) - 0.5);
  const double width = 0.12 + 0.45 * z, r = std::hypot(u, v) / width;
  const double torn = billows(random, 4 * n[0], 4 * n[1], 3 * n[2]);
  const double dilution = 0.12 * 0.12 / (width * width);  // rising smoke is spread over its section
  const double edge = std::max(std::exp(-r * r) - 0.02, 0.0) *
                      smooth_step(0.15 + 0.25 * z, 0.75, torn + 0.35 * (1 - z));
  return edge * std::sqrt(dilution) * (1 - smooth_step(0.85, 1, z));
}

double cloud(const RandomStream& random, double x, double y, double z, const double n[3]) {
  const double h = 2 * z - 1, r = std::sqrt(x * x + y * y + h * h);
  const double lump = billows(random, 3 * n[0], 3 * n[1], 3 * n[2]);
  return smooth_step(0.35, 0.65, lump + 0.45 * (0.6 - r)) * (1 - smooth_step(0.8, 1, r));
}

}  // namespace

VolumeFile make_pattern(const VolumePatternOptions& options, Vec3f size) {
  const double longest = max_component(size);
  const auto voxels = [&](float edge) {
    return std::max(1, static_cast<int>(std::lround(options.resolution * edge / longest)));
  };
  VolumeFile out;
  out.nx = voxels(size.x), out.ny = voxels(size.y), out.nz = voxels(size.z);
  const auto nx = static_cast<size_t>(out.nx), ny = static_cast<size_t>(out.ny);
  out.values.resize(nx * ny * static_cast<size_t>(out.nz));
  const RandomStream random{options.seed, stream_id("volume.pattern")};
  const auto value = options.kind == "plume" ? plume : cloud;
  parallel_for("volume pattern", out.nz, [&](int64_t k) {
    const double z = (static_cast<double>(k) + 0.5) / out.nz;
    float* row = &out.values[static_cast<size_t>(k) * ny * nx];
    for (size_t j = 0; j < ny; ++j, row += nx) {
      const double y = 2 * (static_cast<double>(j) + 0.5) / out.ny - 1;
      for (size_t i = 0; i < nx; ++i) {
        const double x = 2 * (static_cast<double>(i) + 0.5) / out.nx - 1;
        const double n[3] = {x * size.x / longest, y * size.y / longest, 2 * z * size.z / longest};
        row[i] = static_cast<float>(value(random, x, y, z, n));
      }
    }
  });
  return out;
}

std::vector<float> haze_layer(const GridShape& shape, Vec3f size, float low, double scale_height,
                              double turbulence, float density, uint64_t seed) {
  constexpr double kAcross = 40, kUp = 15;  // size of the largest billows [m]
  const auto nx = static_cast<size_t>(shape.nx), ny = static_cast<size_t>(shape.ny);
  const auto nz = static_cast<size_t>(shape.nz);
  std::vector<float> out(nx * ny * nz);
  const RandomStream random{seed, stream_id("haze.billows")};
  const auto middle = [](size_t i, float edge, size_t n) {
    return (static_cast<double>(i) + 0.5) * static_cast<double>(edge) / static_cast<double>(n);
  };
  if (turbulence > 0) {
    parallel_for("haze", shape.nz, [&](int64_t k) {
      const double z = middle(static_cast<size_t>(k), size.z, nz) / kUp;
      float* row = &out[static_cast<size_t>(k) * ny * nx];
      for (size_t j = 0; j < ny; ++j, row += nx) {
        for (size_t i = 0; i < nx; ++i)
          row[i] = static_cast<float>(
              billows(random, middle(i, size.x, nx) / kAcross, middle(j, size.y, ny) / kAcross, z));
      }
    });
  }
  double mean = 0, square = 0;
  for (const float value : out)
    mean += static_cast<double>(value) / static_cast<double>(out.size());
  for (const float value : out)
    square += (static_cast<double>(value) - mean) * (static_cast<double>(value) - mean) /
              static_cast<double>(out.size());
  // Log-normal: never below nothing.
  const double sigma = std::sqrt(std::log1p(turbulence * turbulence));
  const double scale = square > 0 ? sigma / std::sqrt(square) : 0;
  for (size_t k = 0; k < nz; ++k) {
    const double height = std::max(middle(k, size.z, nz) + static_cast<double>(low), 0.0);
    const double level =
        static_cast<double>(density) * (scale_height > 0 ? std::exp(-height / scale_height) : 1.0);
    for (size_t i = k * nx * ny; i < (k + 1) * nx * ny; ++i)
      out[i] = static_cast<float>(
          level * std::exp(scale * (static_cast<double>(out[i]) - mean) - sigma * sigma / 2));
  }
  return out;
}

}  // namespace gloam
