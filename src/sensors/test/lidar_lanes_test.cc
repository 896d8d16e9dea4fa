// The LiDAR kernel with one float (as a GPU runs it) and with lanes.

#include "render/cpu/lidar_scan.h"
#include "render/kernel/lidar/lidar.h"
#include "render/test/media_probe.h"
#include "sensors/test/lidar_scene.h"

namespace gloam {
namespace {

TEST(LidarKernel, OneFloatAndLanesSeeTheSame) {
  SceneBuilder b;
  const int gray = b.add_diffuse({0.4f, 0.4f, 0.4f});
  add_wall(&b, {0.5f, 50, 50}, {15, 0, 0}, gray);
  const int body = b.add_body({});
  b.add(ShapeType::kMesh, {}, translation({9, 1, 0}), gray, body, b.add_mesh(make_ball(40, 0.1f)));
  b.add(ShapeType::kSphere, {0.8f, 0, 0}, translation({8, -1.5f, 0.3f}), gray);
  MaterialDescription pane;
  pane.transmission_weight = 1;
  pane.roughness = 0;
  pane.thin_walled = true;
  b.add(ShapeType::kBox, {0.01f, 1, 1}, rigid({0, 0, 1}, 0.1f, {4, 1, 0}), b.add_material(pane));
  pane.thin_walled = false;
  b.add(ShapeType::kBox, {0.2f, 1, 1}, rigid({0, 1, 0}, 0.2f, {4, -1.3f, 0}), b.add_material(pane));
  MaterialDescription net;
  net.opacity = 0.4f;
  add_wall(&b, {0.01f, 3, 0.5f}, {6, 0, 1}, b.add_material(net));
  MediumDescription haze;
  haze.name = "fog";
  haze.mass_extinction.fill(0.05f);
  haze.albedo.fill(1);
  b.description.media.push_back(haze);
  VolumeDescription cloud = make_noise_volume(30, 30, 30, 1, 5);
  cloud.X_WV.p = {7, 0, 0};
  cloud.size = {5, 4, 4};
  b.description.volumes.push_back(cloud);
  const Probe probe(b);

  LidarView view;
  const Affine3f turned = rigid({0, 0, 1}, 0.05f, {0.3f, 0.1f, 0});
  const LidarMotion stretches[2] = {make_lidar_motion({}, turned), make_lidar_motion(turned, {})};
  view.motions = stretches;
  view.optics.divergence = {0.004f, 0.002f};
  view.optics.returns = LidarReturns::kAll;
  view.optics.most_returns = 5;
  view.optics.threshold = 1e-5f;
  view.optics.range_sigma = 0.02f;
  view.optics.noisy = true;
  std::vector<LidarBeam> beams;
  for (uint32_t i = 0; i < 1000; ++i) {
    const float left = 0.4f * (static_cast<float>(i % 40) / 20 - 1);
    const float up = 0.3f * (static_cast<float>(i / 40) / 12.5f - 1);
    beams.push_back({normalize(Vec3f{1, left, up}), static_cast<float>(i) / 1000, i});
  }
  view.beams = beams;
  std::vector<LidarReturn> in_lanes(beams.size() * 5), one_by_one = in_lanes;
  RenderSlices whole(nullptr, {});
  scan_beams(probe.view, probe.tracer, view, &whole, in_lanes);
  for (const LidarBeam& beam : beams) {
    const LidarKey key{view.seed, view.scan, beam.id};
    LidarEchoes echoes;
    Backscatter soft(view.optics, key, &echoes);
    trace_echoes<float>(probe.view, probe.tracer, view.optics,
                        beam_ray<float>({stretches, 2}, beam.d, beam.time), true, 1, &echoes,
                        &soft);
    soft.finish();
    detect(view.optics, key, &echoes, &one_by_one[beam.id * 5]);
  }
  int several = 0, unlike = 0;
  for (size_t i = 0; i < in_lanes.size(); ++i) {
    const LidarReturn &a = in_lanes[i], &c = one_by_one[i];
    several += i % 5 > 0 && a.range > 0;
    // Single rays and packets of Embree differ in their last bits, which decide at silhouettes.
    unlike += a.part != c.part || std::abs(a.range - c.range) > 1e-3f ||
              std::abs(a.signal - c.signal) > 1e-2f * a.signal;
  }
  EXPECT_GT(several, 200);
  EXPECT_LE(unlike, 5);
}

}  // namespace
}  // namespace gloam
