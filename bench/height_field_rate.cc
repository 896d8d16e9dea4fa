// How fast ground is sampled from triangles: a turned terrain of waves, all in memory.
//
//   height_field_rate TRIANGLES SAMPLES THREADS [LAYERS]
//
// About TRIANGLES and SAMPLES; with LAYERS > 1 (1) a roof of as many triangles hangs over it.
// Prints JSON: triangles, samples, the median seconds of seven samplings, each from the mesh to the
// heights, and samples / s.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "base/parallel.h"
#include "geometry/height_field.h"

namespace gloam {
namespace {

constexpr float kSize = 100;  // [m]

TriangleMesh waves(uint32_t quads, float z) {
  TriangleMesh mesh;
  for (uint32_t r = 0; r <= quads; ++r) {
    for (uint32_t c = 0; c <= quads; ++c) {
      const float x = kSize * static_cast<float>(c) / static_cast<float>(quads);
      const float y = kSize * static_cast<float>(r) / static_cast<float>(quads);
      mesh.positions.push_back({x, y, z + 2 * std::sin(x / 5) * std::cos(y / 7)});
    }
  }
  for (uint32_t r = 0; r < quads; ++r) {
    for (uint32_t c = 0; c < quads; ++c) {
      const uint32_t i = r * (quads + 1) + c, w = quads + 1;
      for (const uint32_t k : {i, i + 1, i + w, i + 1, i + w + 1, i + w}) mesh.indices.push_back(k);
    }
  }
  return mesh;
}

Status run(double triangles, double samples, int layers) {
  const auto quads = static_cast<uint32_t>(std::sqrt(triangles / 2));
  const TriangleMesh ground = waves(quads, 0), roof = waves(quads, 10);
  // Turned, so that nothing of the mesh runs along the grid; the region is all inside.
  const double c = std::cos(0.3), s = std::sin(0.3), middle = kSize / 2.0, half = 35;
  const AffineOf<double> X = {
      {c, s, 0}, {-s, c, 0}, {0, 0, 1}, {-(c - s) * middle, -(s + c) * middle, 0}};
  std::vector<PlacedMesh> meshes = {{&ground, X}};
  if (layers > 1) meshes.push_back({&roof, X});
  const double step = 2 * half / (std::sqrt(samples) - 1);
  GLOAM_TRY(const HeightGrid grid, make_height_grid({-half, -half}, {half, half}, step, layers));
  std::vector<double> seconds;
  for (int i = 0; i < 7; ++i) {
    const auto start = std::chrono::steady_clock::now();
    GLOAM_TRY(const Floors floors, sample_floors(meshes, grid, layers));
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    for (const float z : floors.z)
      if (!std::isfinite(z)) return Error{ErrorKind::kInput, "a sample met nothing"};
    seconds.push_back(passed.count());
  }
  std::nth_element(seconds.begin(), seconds.begin() + 3, seconds.end());
  const auto count = static_cast<double>(grid.size()) * layers;
  fmt::print("{{\"triangles\": {}, \"samples\": {}, \"seconds\": {:.4f}, \"rate\": {:.0f}}}\n",
             2 * uint64_t{quads} * quads * static_cast<uint64_t>(meshes.size()), count, seconds[3],
             count / seconds[3]);
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  if (argc < 4 || argc > 5) {
    fmt::print(stderr, "usage: height_field_rate TRIANGLES SAMPLES THREADS [LAYERS]\n");
    return 2;
  }
  gloam::set_thread_count(std::atoi(argv[3]));
  const gloam::Status status =
      gloam::run(std::atof(argv[1]), std::atof(argv[2]), argc == 5 ? std::atoi(argv[4]) : 1);
  if (!status) fmt::print(stderr, "gloam: error: {}\n", status.error().to_string());
  return status.ok() ? 0 : status.error().exit_code();
}
