// LiDARs on the card: their returns are the CPU's.

#include <chrono>

#include "render/cuda/test/cuda_cases.h"
#include "render/lidar_view.h"

namespace gloam {
namespace {

class CudaLidar : public OnCard {};

constexpr int kRings = 64, kColumns = 1024;

/// Beams all around, 45 degrees up and down.
std::vector<LidarBeam> beams_around() {
  std::vector<LidarBeam> beams;
  for (int column = 0; column < kColumns; ++column) {
    for (int ring = 0; ring < kRings; ++ring) {
      const float azimuth = 2 * kPi * static_cast<float>(column) / kColumns;
      const float up = 0.5f * kPi * (static_cast<float>(ring) / (kRings - 1) - 0.5f);
      beams.push_back(
          {{std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up)},
           static_cast<float>(column) / kColumns,
           static_cast<uint32_t>(beams.size())});
    }
  }
  return beams;
}

TEST_F(CudaLidar, ReturnsAreTheCpus) {
  const std::vector<LidarBeam> beams = beams_around();
  const LidarMotion motion{.X_WL = translation({-1.5f, -1, 1.2f}), .shift = {0.1f, 0, 0}};
  for (const size_t row : {0u, 1u, 2u, 5u}) {
    const Case c = cases()[row];
    LidarView view;
    view.motions = {&motion, 1};
    view.beams = beams;
    view.optics.divergence = {0.003f, 0.003f};
    view.optics.footprint_rays = 5;
    view.optics.returns = LidarReturns::kDual;
    view.optics.most_returns = 2;
    view.optics.noisy = true;
    view.optics.range_sigma = 0.01f;
    view.optics.threshold = 1e-5f;
    std::vector<LidarReturn> card(2 * beams.size()), cpu(card.size());
    const auto renderer = on_card(c);
    renderer->scan(view, card);
    const auto start = std::chrono::steady_clock::now();
    renderer->scan(view, card);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    on_cpu(c)->scan(view, cpu);
    size_t unlike = 0, some = 0;
    for (size_t i = 0; i < card.size(); ++i) {
      some += cpu[i].range > 0;
      unlike += card[i].part != cpu[i].part ||
                !(std::fabs(card[i].range - cpu[i].range) <= 1e-4f * max(cpu[i].range, 1.0f)) ||
                !(std::fabs(card[i].signal - cpu[i].signal) <= 1e-3f * cpu[i].signal);
    }
    std::printf("%s: %zu of %zu returns differ; %.2f ms\n", c.name, unlike, some, time.count());
    EXPECT_GT(some, beams.size() / 2) << c.name;
    EXPECT_LE(unlike, some / 100) << c.name;  // beams that graze an edge
  }
}

}  // namespace
}  // namespace gloam
