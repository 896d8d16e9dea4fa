// Guides for a denoiser: nearly those of many samples, at the cost of few.

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/test/media_probe.h"

namespace gloam {
namespace {

/// Slats and balls of two colours before a wall, half of them on a body that moves nowhere.
SceneBuilder make_slats() {
  SceneBuilder b;
  const int red = b.add_diffuse({0.8f, 0.1f, 0.1f}), white = b.add_diffuse({0.9f, 0.9f, 0.9f});
  const int body = b.add_body({});
  b.add(ShapeType::kBox, {4, 0.1f, 4}, translation({0, 2, 0}), white);
  for (int i = 0; i < 12; ++i) {
    const float x = -1.1f + 0.2f * static_cast<float>(i);
    b.add(ShapeType::kBox, {0.03f, 0.03f, 0.8f}, rigid({0, 1, 0}, 0.2f, {x, 0, 0}), red,
          i % 2 == 0 ? body : 0);
  }
  b.add(ShapeType::kSphere, {0.4f, 0, 0}, translation({0, -0.5f, 0}), white, body);
  b.description.sky.ambient = {100, 100, 100};
  return b;
}

double difference(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += dot(a[i] - b[i], a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

class EdgeSamplesTest : public testing::Test {
 protected:
  Film render(int spp, int guide_samples, uint32_t frame = 0) const {
    RenderSettings settings;
    settings.spp = spp;
    settings.guide_samples = guide_samples;
    settings.frame = frame;
    return make_slats().render(view_, settings);
  }
  const CameraView view_ = SceneBuilder::camera(look_at({0.3f, -4, 0.4f}, {}), 160, 120, 40);
};

TEST_F(EdgeSamplesTest, AreMuchNearerToManySamplesThanOneSampleIs) {
  const Film many = render(64, 0), one = render(1, 0), refined = render(1, 4);
  EXPECT_LT(difference(refined.albedo, many.albedo), 0.5 * difference(one.albedo, many.albedo));
  EXPECT_LT(difference(refined.normal, many.normal), 0.5 * difference(one.normal, many.normal));
}

TEST_F(EdgeSamplesTest, DoNotFlickerWhereNothingMoves) {
  const Film first = render(1, 4, 0), second = render(1, 4, 1);
  EXPECT_EQ(first.albedo, second.albedo);
  EXPECT_EQ(first.normal, second.normal);
  EXPECT_NE(first.radiance, second.radiance);
}

/// Smoke that is not in its guides is taken for the pattern behind it, and that for smoke.
TEST_F(EdgeSamplesTest, SmokeHidesWhatIsBehindItByItsTransmittance) {
  const float depth = 0.7f;
  MediaBuilder smoke;
  smoke.add_box({8, 1, 8}, {0, 0, 0}, 1,
                smoke.add_medium({depth, depth, depth}, {0.6f, 0.5f, 0.4f}));
  SceneBuilder b;
  b.add(ShapeType::kBox, {4, 0.1f, 4}, translation({0, 2, 0}), b.add_diffuse({0.8f, 0.1f, 0.1f}));
  b.description.sky.ambient = {100, 100, 100};
  b.description.media = smoke.media;
  b.description.volumes = smoke.volumes;
  const CameraView view = SceneBuilder::camera(look_at({0, -4, 0}, {}), 16, 16, 2);
  RenderSettings settings;
  settings.spp = 1;
  settings.guide_samples = 4;
  const Film refined = b.render(view, settings);
  const float through = std::exp(-depth);
  const Vec3f truth = Vec3f{0.8f, 0.1f, 0.1f} * through + Vec3f{0.6f, 0.5f, 0.4f} * (1 - through);
  settings.spp = 1024;
  const Film many = b.render(view, settings);
  Vec3f mean;
  for (size_t i = 0; i < refined.albedo.size(); ++i) {
    EXPECT_LT(length(refined.albedo[i] - truth), 2e-3f) << "albedo of pixel " << i;
    EXPECT_LT(length(refined.normal[i] - Vec3f{0, -through, 0}), 2e-3f) << "normal of pixel " << i;
    mean += many.albedo[i] / static_cast<float>(many.albedo.size());
  }
  EXPECT_LT(length(mean - truth), 5e-3f) << "many samples say otherwise";
}

TEST_F(EdgeSamplesTest, LeaveLightAndExactChannelsAlone) {
  const Film plain = render(1, 0), refined = render(1, 4);
  EXPECT_EQ(plain.radiance, refined.radiance);
  EXPECT_EQ(plain.center_albedo, refined.center_albedo);
  EXPECT_EQ(plain.part, refined.part);
}

TEST_F(EdgeSamplesTest, AreNotTakenWhereThePictureHasAsMany) {
  EXPECT_EQ(render(4, 4).albedo, render(4, 0).albedo);
}

TEST_F(EdgeSamplesTest, AreEqualForAnyNumberOfThreads) {
  set_thread_count(1);
  const Film one = render(1, 4);
  set_thread_count(4);
  const Film four = render(1, 4);
  set_thread_count(0);
  EXPECT_EQ(one.albedo, four.albedo);
  EXPECT_EQ(one.normal, four.normal);
}

}  // namespace
}  // namespace gloam
