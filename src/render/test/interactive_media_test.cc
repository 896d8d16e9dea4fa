// Media in the interactive tier: closed forms, and the light of the path tier.

#include <gtest/gtest.h>

#include "render/test/flame.h"
#include "render/test/interactive_picture.h"
#include "render/test/room_with_window.h"

namespace gloam {
namespace {

TEST(Interactive, MediaDimByBeerLambert) {
  for (const float k : {0.2f, 1.0f}) {
    MediaBuilder fog;
    fog.add_box({2, 2, 2}, {0, 0, 0}, 1, fog.add_medium({k, k, k}, {}));
    SceneBuilder b;
    b.description.media = fog.media;
    b.description.volumes = fog.volumes;
    b.add(ShapeType::kBox, {1, 0.1f, 1}, translation({0, 3, 0}), b.add_emitter({100, 100, 100}));
    const CameraView view = SceneBuilder::camera(look_at({0, -4, 0}, {0, 0, 0}), 8, 8, 1);
    Film film;
    b.make()->render(view, interactive_settings(nullptr, 0), &film);
    const double expected = 100 * std::exp(-2 * k);
    EXPECT_NEAR(mean_luminance(film), expected, 0.02 * expected) << "extinction " << k;
  }
}

/// A closed room of 4 x 4 x 2 m with a lamp under its ceiling, and a camera in a corner.
SceneBuilder closed_room(float lamp) {
  SceneBuilder b;
  const int grey = b.add_diffuse({0.5f, 0.45f, 0.4f});
  for (const float side : {-1.0f, 1.0f}) {
    b.add(ShapeType::kBox, {2, 2, 0.1f}, translation({0, 0, 1 + 1.1f * side}), grey);
    b.add(ShapeType::kBox, {0.1f, 2, 1}, translation({2.1f * side, 0, 1}), grey);
    b.add(ShapeType::kBox, {2, 0.1f, 1}, translation({0, 2.1f * side, 1}), grey);
  }
  if (lamp > 0) {
    b.add(ShapeType::kBox, {0.4f, 0.4f, 0.01f}, translation({0.8f, 0.8f, 1.6f}),
          b.add_emitter({lamp, lamp, lamp}));
  }
  b.description.extent = 5;
  return b;
}
CameraView corner_view() {
  return SceneBuilder::camera(look_at({-1.8f, -1.8f, 1.3f}, {0.4f, 0.5f, 0.9f}), 96, 72, 70);
}

/// The mean of interactive pictures, whose caches differ by chance.
Film mean_interactive_picture(const SceneBuilder& b) {
  constexpr uint64_t kSeeds = 3;
  Film sum = interactive_picture(b, corner_view(), 8);
  for (uint64_t seed = 2; seed <= kSeeds; ++seed) {
    const Film film = interactive_picture(b, corner_view(), 8, seed);
    for (size_t i = 0; i < film.radiance.size(); ++i) sum.radiance[i] += film.radiance[i];
  }
  for (Vec3f& radiance : sum.radiance) radiance = radiance / float{kSeeds};
  return sum;
}

/// Quotients of the light of the two tiers' pictures in 3 x 2 parts, and in all.
void expect_same_light(const SceneBuilder& b, double all, double parts) {
  const Film film = mean_interactive_picture(b),
             exact = path_picture(b, corner_view(), 128, kEndless);
  EXPECT_NEAR(mean_luminance(film) / mean_luminance(exact), 1, all);
  for (int part = 0; part < 6; ++part) {
    double a = 0, c = 0;
    for (int y = part / 3 * 36; y < part / 3 * 36 + 36; ++y) {
      for (int x = part % 3 * 32; x < part % 3 * 32 + 32; ++x) {
        a += luminance(film.radiance[static_cast<size_t>(y * 96 + x)]);
        c += luminance(exact.radiance[static_cast<size_t>(y * 96 + x)]);
      }
    }
    EXPECT_NEAR(a / c, 1, parts) << "column " << part % 3 << " of row " << part / 3;
  }
}

TEST(InteractiveMedia, SmokeIsLitAsByThePathTier) {
  for (const float k : {0.3f, 1.5f}) {
    SceneBuilder b = closed_room(100);
    MediaBuilder smoke;  // a layer under the ceiling, thinner below
    const int medium = smoke.add_medium({k, k, k}, {0.8f, 0.8f, 0.8f}, {0.5f, 0.5f, 0.5f});
    smoke.add_box({4, 4, 1}, {0, 0, 1.5f}, 1, medium);
    smoke.add_box({4, 4, 1}, {0, 0, 0.5f}, 0.3f, medium);
    b.description.media = smoke.media;
    b.description.volumes = smoke.volumes;
    SCOPED_TRACE(k);
    expect_same_light(b, 0.15, 0.25);  // of dense smoke the seeds differ by 0.06
  }
}

/// Fills a box with one grey medium.
void fill(SceneBuilder* b, Vec3f size, Vec3f center, float k, float albedo, float g) {
  MediaBuilder media;
  const int medium = media.add_medium({k, k, k}, {albedo, albedo, albedo}, {g, g, g});
  media.add_box(size, center, 1, medium);
  b->description.media = media.media;
  b->description.volumes = media.volumes;
}

TEST(InteractiveMedia, WallsKeepTheLightOfFogOutside) {
  // Fog inside and out, where the sun lights it a hundred times as brightly.
  SceneBuilder b = room_with_window({"sun", 0, 50000, 0}, true);
  fill(&b, {14, 14, 8}, {0, 0, 1.5f}, 0.2f, 0.7f, 0.5f);
  // Away from the window.
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 1.5f}, {-2, 0.5f, 1.2f}), 96, 72, 60);
  const double exact = mean_luminance(path_picture(b, view, 256, kEndless));
  EXPECT_NEAR(mean_luminance(interactive_picture(b, view, 8)) / exact, 1, 0.3)
      << "light of the fog outside came through the walls";
}

/// A beam through fog before a wall, and where it goes, by the light of the left half of a picture
/// over that of the right.
struct FoggyBeam {
  SceneBuilder b;
  // The filter reaches over some 20 pixels, which must be little of the image.
  const CameraView view = SceneBuilder::camera(look_at({0, -4, 1}, {0, 0, 1}), 136, 102, 50);

  explicit FoggyBeam(float cd) {
    b.add(ShapeType::kBox, {3, 0.1f, 3}, translation({0, 2, 1}), b.add_diffuse({0.3f, 0.3f, 0.3f}));
    LightDescription spot;
    spot.type = PunctualLightType::kSpot;
    spot.cos_cutoff = std::cos(0.2f);
    spot.intensity = {cd, cd, cd};
    b.add_light(spot, {0, 0, -0.5f});
    fill(&b, {6, 6, 4}, {0, 0, 1}, 0.1f, 0.9f, 0.3f);
    aim(0);
  }
  void aim(float angle) { b.frame.light_dir = {std::sin(angle), 0, std::cos(angle)}; }
  static double lean(const Film& film) {
    double sum[2] = {};
    const auto width = static_cast<size_t>(film.width);
    for (size_t i = 0; i < film.radiance.size(); ++i)
      sum[2 * (i % width) / width] += luminance(film.radiance[i]);
    return sum[0] / sum[1];
  }
};

TEST(InteractiveMedia, BeamsInFogAreWhereTheirLampsPoint) {
  FoggyBeam beam(1000);
  const auto renderer = beam.b.make();
  const auto history = renderer->make_history();
  Film film;
  for (uint32_t i = 0; i < 9; ++i) {  // from the left to the right
    beam.aim(0.1f * (static_cast<float>(i) - 4));
    renderer->update(beam.b.frame, beam.b.frame, beam.b.frame);
    renderer->render(beam.view, interactive_settings(history.get(), i), &film);
  }
  const double exact = FoggyBeam::lean(path_picture(beam.b, beam.view, 64, kEndless));
  EXPECT_LT(exact, 0.5);
  EXPECT_NEAR(FoggyBeam::lean(film), exact, 0.25) << "the beam trails behind";
}

TEST(InteractiveMedia, SkyThroughAHoleLightsThinDustAsInThePathTier) {
  SceneBuilder b = room_with_window({"sky", 0, 0, 3000}, true);
  fill(&b, {4, 4, 3}, {0, 0, 1.5f}, 0.25f, 0.95f, 0.75f);  // scatters forward
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 1.5f}, {-2, 0.5f, 1.2f}), 48, 36, 60);
  const double exact = mean_luminance(path_picture(b, view, 512, kEndless));
  EXPECT_NEAR(mean_luminance(interactive_picture(b, view, 8)) / exact, 1, 0.15);
}

TEST(InteractiveMedia, FlamesLightTheRoomAsInThePathTier) {
  for (const float k : {2.0f, 40.0f}) {
    SceneBuilder b = closed_room(0);
    add_flame(&b, {0.5f, 0.5f, 0.05f}, k);
    SCOPED_TRACE(k);
    expect_same_light(b, 0.1, 0.2);
  }
}

}  // namespace
}  // namespace gloam
