#include "render/cpu/lidar_scan.h"

#include <algorithm>

#include "base/check.h"
#include "render/cpu/path/tile.h"
#include "render/kernel/lidar/lidar.h"

namespace gloam {
namespace {

constexpr int kLanes = kLaneCount;

struct ScanJob {
  const SceneView& scene;
  const CpuTracer& tracer;
  const LidarView& view;
  DeviceSpan<const LidarMotion> motions;
  std::array<Vec2f, kMostFootprintRays> footprint;
  bool has_media;
};

/// Scan of up to kLanes beams that follow each other.
void scan_packet(const ScanJob& job, const LidarBeam* beams, int count, LidarReturn* out) {
  const LidarOptics& optics = job.view.optics;
  Vec3Of<FloatLanes> d_L;
  FloatLanes time;
  MaskLanes active = false;
  LidarEchoes echoes[kLanes];
  LidarKey keys[kLanes];
  Backscatter soft[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const LidarBeam& beam = beams[std::min(i, count - 1)];
    set_lane(&d_L, i, beam.d);
    set_lane(&time, i, beam.time);
    set_lane(&active, i, i < count);
    keys[i] = {job.view.seed, job.view.scan, beam.id};
    if (job.has_media) soft[i] = Backscatter(optics, keys[i], &echoes[i]);
  }
  const int rays = optics.footprint_rays;
  for (int k = 0; k < rays; ++k) {
    const Vec3Of<FloatLanes> d =
        rays > 1 ? footprint_direction(optics, d_L, job.footprint[static_cast<size_t>(k)]) : d_L;
    // Media hardly vary within a footprint: one ray measures their backscatter.
    trace_echoes(job.scene, job.tracer, optics, beam_ray(job.motions, d, time), active,
                 1.0f / static_cast<float>(rays), echoes, job.has_media && k == 0 ? soft : nullptr);
  }
  for (int i = 0; i < count; ++i) {
    if (job.has_media) soft[i].finish();
    detect(optics, keys[i], &echoes[i], out + static_cast<size_t>(i) * optics.most_returns);
  }
}

}  // namespace

void scan_beams(const SceneView& scene, const CpuTracer& tracer, const LidarView& view,
                RenderSlices* slices, std::span<LidarReturn> returns) {
  const LidarOptics& optics = view.optics;
  GLOAM_CHECK(optics.footprint_rays >= 1 && optics.footprint_rays <= kMostFootprintRays &&
                  optics.most_returns >= 1 && optics.most_returns <= kMostLidarReturns,
              "the number of rays or returns is out of range");
  GLOAM_CHECK(returns.size() == view.beams.size() * static_cast<size_t>(optics.most_returns),
              "the output must have room for every return");
  const DeviceSpan<const LidarMotion> motions{view.motions.data(),
                                              static_cast<uint32_t>(view.motions.size())};
  const ScanJob job{scene,
                    tracer,
                    view,
                    motions,
                    footprint_points(optics.footprint_rays),
                    !scene.media.volumes.empty()};
  const auto beams = static_cast<int64_t>(view.beams.size());
  constexpr int64_t kTask = int64_t{16} * kLanes;  // beams
  slices->run("lidar beams", (beams + kTask - 1) / kTask, [&](int64_t task) {
    const FlushDenormals flush;
    const int64_t end = std::min((task + 1) * kTask, beams);
    for (int64_t first = task * kTask; first < end; first += kLanes) {
      scan_packet(job, &view.beams[static_cast<size_t>(first)],
                  static_cast<int>(std::min<int64_t>(kLanes, end - first)),
                  &returns[static_cast<size_t>(first * optics.most_returns)]);
    }
  });
}

}  // namespace gloam
