// The interactive tier: against closed forms, against the path tier, when light goes out, and bit
// by bit.

#include <gtest/gtest.h>

#include <cstring>

#include "base/parallel.h"
#include "render/cpu/interactive/filter.h"
#include "render/test/interactive_picture.h"
#include "render/test/panel.h"
#include "render/test/room_with_window.h"

namespace gloam {
namespace {

/// A closed room with a lamp behind a wall: half of it has indirect light alone.
SceneBuilder divided_room() {
  SceneBuilder b;
  const int white = b.add_diffuse({0.7f, 0.7f, 0.7f}), red = b.add_diffuse({0.6f, 0.2f, 0.2f});
  b.add(ShapeType::kBox, {2, 2, 0.1f}, translation({0, 0, -0.1f}), white);
  b.add(ShapeType::kBox, {2, 2, 0.1f}, translation({0, 0, 2.1f}), white);
  for (const float side : {-1.0f, 1.0f}) {
    b.add(ShapeType::kBox, {0.1f, 2, 1}, translation({2.1f * side, 0, 1}), side < 0 ? red : white);
    b.add(ShapeType::kBox, {2, 0.1f, 1}, translation({0, 2.1f * side, 1}), white);
  }
  b.add(ShapeType::kBox, {0.05f, 1, 1}, translation({0, 1, 1}), white);
  b.add(ShapeType::kBox, {0.3f, 0.3f, 0.01f}, translation({1, 1, 1.9f}),
        b.add_emitter({100, 100, 100}));
  b.description.extent = 5;
  return b;
}
CameraView room_view() {
  return SceneBuilder::camera(look_at({-1.6f, -1.6f, 1.2f}, {0.3f, 0.8f, 0.8f}), 96, 72, 60);
}

/// Light of `film` over that of `exact` in block (bx, by) of 12 x 12 pixels; both are 96 wide.
double block_ratio(const Film& film, const Film& exact, int bx, int by) {
  double a = 0, c = 0;
  for (int i = 0; i < 144; ++i) {
    const size_t pixel = static_cast<size_t>((by * 12 + i / 12) * 96 + bx * 12 + i % 12);
    a += luminance(film.radiance[pixel]);
    c += luminance(exact.radiance[pixel]);
  }
  return a / c;
}

TEST(Interactive, IndirectLightIsThatOfThePathTier) {
  const SceneBuilder b = divided_room();
  const Film exact = path_picture(b, room_view(), 256, kEndless);
  constexpr uint64_t kSeeds = 8;
  Film film = interactive_picture(b, room_view(), 8, 0);
  for (uint64_t seed = 1; seed < kSeeds; ++seed) {
    const Film other = interactive_picture(b, room_view(), 8, seed);
    for (size_t i = 0; i < film.radiance.size(); ++i) film.radiance[i] += other.radiance[i];
  }
  for (Vec3f& c : film.radiance) c = c / static_cast<float>(kSeeds);
  EXPECT_NEAR(mean_luminance(film), mean_luminance(exact), 0.05 * mean_luminance(exact));
  // Blocks of 12 x 12 pixels: what is lit, what is in the shade, what is red.
  double squares = 0;
  for (int by = 0; by < 6; ++by) {
    for (int bx = 0; bx < 8; ++bx) {
      const double ratio = block_ratio(film, exact, bx, by);
      EXPECT_NEAR(ratio, 1, 0.25) << "block " << bx << " " << by;
      squares += (ratio - 1) * (ratio - 1) / 48;
    }
  }
  EXPECT_LT(std::sqrt(squares), 0.11) << "of all blocks together";
}

int add_metal(SceneBuilder* b, Vec3f color, float roughness) {
  MaterialDescription metal;
  metal.base_color = color;
  metal.metallic = 1;
  metal.roughness = roughness;
  return b->add_material(metal);
}

/// A rough metal floor before a wall of light: all that it shows is by reflection, and three of
/// four of its pixels take that from the one beside them.
SceneBuilder polished_floor() {
  SceneBuilder b;
  b.add(ShapeType::kBox, {6, 3, 0.1f}, translation({0, 0, -0.1f}),
        add_metal(&b, {0.9f, 0.7f, 0.4f}, 0.3f));
  b.add(ShapeType::kBox, {6, 0.02f, 3}, translation({0, 2, 3}), b.add_emitter({50, 60, 70}));
  b.description.extent = 5;
  return b;
}

TEST(Interactive, RoughReflectionsAreThoseOfThePathTier) {
  const SceneBuilder b = polished_floor();
  const CameraView view = SceneBuilder::camera(look_at({0, -2, 1}, {0, 1, 0.2f}), 96, 72, 50);
  const Film exact = path_picture(b, view, 256, RenderSettings{}.max_depth);
  const Film film = interactive_picture(b, view, 8);
  for (int by = 4; by < 6; ++by) {  // of the floor
    for (int bx = 0; bx < 8; ++bx) {
      EXPECT_NEAR(block_ratio(film, exact, bx, by), 1, 0.12) << "block " << bx << " " << by;
    }
  }
}

TEST(Interactive, TheSkysLightIsCountedOnce) {
  // A corner under an even sky: what its sides send each other is a third of their light.
  SceneBuilder b;
  const int white = b.add_diffuse({0.8f, 0.8f, 0.8f});
  b.add(ShapeType::kBox, {2, 2, 0.1f}, translation({0, 0, -0.1f}), white);
  b.add(ShapeType::kBox, {0.1f, 2, 1}, translation({-1.1f, 0, 1}), white);
  b.add(ShapeType::kBox, {0.1f, 2, 1}, translation({1.1f, 0, 1}), white);
  EnvironmentDescription& sky = b.description.sky.environment;
  sky.width = 2, sky.height = 1;
  sky.texels.assign(2, {100, 100, 100});
  LightDescription sun;  // a faint one: without any lamp no light is drawn at all
  sun.type = PunctualLightType::kDirectional;
  sun.intensity = {1, 1, 1};
  b.add_light(sun, {}, {0, 0, -1});
  const CameraView view = SceneBuilder::camera(look_at({0, -0.5f, 3}, {0, 0, 0}), 48, 32, 40);
  const double exact = mean_luminance(path_picture(b, view, 256, kEndless));
  EXPECT_NEAR(mean_luminance(interactive_picture(b, view, 4)), exact, 0.03 * exact);
}

TEST(Interactive, ARoomIsDarkSoonAfterItsLampGoesOut) {
  SceneBuilder b = divided_room();
  b.description.materials.back().schedule = 0;
  b.description.schedules.push_back({{Keyframes{{{0, 1}, {1, 0}}, false}}});
  const auto renderer = b.make();
  const auto history = renderer->make_history();
  Film film;
  const auto show = [&](uint32_t i, double time) {
    PoseFrame frame = b.frame;
    frame.time = time;
    renderer->update(frame, frame, frame);
    renderer->render(room_view(), interactive_settings(history.get(), i), &film);
    return mean_luminance(film);
  };
  double lit = 0;
  for (uint32_t i = 0; i < 5; ++i) lit = show(i, 0);
  for (uint32_t i = 5; i < 14; ++i) show(i, 2);
  EXPECT_LT(show(14, 2), 0.01 * lit) << "ten pictures after the lamp went out";
}

TEST(Interactive, LightThatGrowsIsNotBehind) {
  // A lamp over a floor brightens by 5 % of its first level per picture: a mean over pictures must
  // not show the level of some pictures ago.
  SceneBuilder b;
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({0.7f, 0.7f, 0.7f}));
  const int lamp = b.add_emitter({100, 100, 100});
  b.add(ShapeType::kBox, {0.5f, 0.5f, 0.02f}, translation({0, 2, 3}), lamp);
  b.description.materials[static_cast<size_t>(lamp)].schedule = 0;
  b.description.schedules.push_back({{Keyframes{{{0, 1}, {1, 2}}, true}}});
  const CameraView view = SceneBuilder::camera(look_at({0, -3, 3}, {0, 0, 0}), 96, 72, 40);
  const auto show = [&](Renderer* renderer, ViewHistory* history, uint32_t i) {
    PoseFrame frame = b.frame;
    frame.time = 0.05 * i;
    renderer->update(frame, frame, frame);
    Film film;
    renderer->render(view, interactive_settings(history, i), &film);
    return mean_luminance(film);
  };
  const auto renderer = b.make();
  const auto history = renderer->make_history();
  double followed = 0;
  for (uint32_t i = 0; i <= 12; ++i) followed = show(renderer.get(), history.get(), i);
  const auto other = b.make();
  const double expected = show(other.get(), nullptr, 12);
  EXPECT_NEAR(followed, expected, 0.03 * expected) << "a picture lasts a twentieth of a second";
}

TEST(Interactive, LampsInMirrorsLightTheRoom) {
  // Few of a cell's rays meet a lamp by way of a mirror: what they bring is kept all the same.
  SceneBuilder b = divided_room();
  b.add(ShapeType::kBox, {0.9f, 0.01f, 0.9f}, translation({1, 1.9f, 1}),
        add_metal(&b, {0.9f, 0.9f, 0.9f}, 0.05f));
  const CameraView view =
      SceneBuilder::camera(look_at({1.6f, -1.8f, 1.5f}, {0.9f, 0.9f, 0}), 96, 72, 60);
  const double exact = mean_luminance(path_picture(b, view, 512, kEndless));
  EXPECT_NEAR(mean_luminance(interactive_picture(b, view, 8)), exact, 0.03 * exact);
}

TEST(Interactive, InnerSidesOfPanesHaveLightOfTheirOwn) {
  // A lamp behind a thin pane lights its inner sides. Its outer side, two centimetres off and
  // facing the same way, gets nothing of that.
  SceneBuilder b;
  MaterialDescription pane;
  pane.base_color = {0.9f, 0.9f, 0.9f};
  pane.specular_weight = 0;
  pane.opacity = 0.35f;
  b.add(ShapeType::kBox, {1, 0.01f, 1}, {}, b.add_material(pane));
  b.add(ShapeType::kSphere, {0.1f, 0, 0}, translation({0, 1.5f, 2}), b.add_emitter({50, 50, 50}));
  b.description.extent = 5;
  const CameraView view = SceneBuilder::camera(look_at({0, -3, 0}, {}), 96, 72, 25);
  const double exact = mean_luminance(path_picture(b, view, 256, kEndless));
  EXPECT_NEAR(mean_luminance(interactive_picture(b, view, 8)), exact, 0.04 * exact);
}

TEST(Interactive, ARareBrightRayMakesNoSpot) {
  // A small bright lamp that the cells of matt walls see in a mirror alone: a block of a wall is
  // as bright as those around it, whether or not one of its cells' rays met the lamp.
  SceneBuilder b = divided_room();
  b.add(ShapeType::kBox, {0.02f, 1.5f, 0.9f}, translation({1.95f, -0.3f, 1}),
        add_metal(&b, {0.9f, 0.9f, 0.9f}, 0.03f));
  b.add(ShapeType::kSphere, {0.05f, 0, 0}, translation({0.5f, -1.2f, 1.7f}),
        b.add_emitter({2000, 2000, 2000}));
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -0.6f, 1}, {-2, -0.6f, 1}), 96, 72, 50);
  const Film exact = path_picture(b, view, 512, kEndless);
  double worst = 0, squares = 0;
  for (uint64_t seed = 0; seed < 3; ++seed) {
    const Film film = interactive_picture(b, view, 2, seed);
    for (int by = 1; by < 5; ++by) {
      for (int bx = 1; bx < 7; ++bx) {
        const double off = block_ratio(film, exact, bx, by) - 1;
        worst = std::max(worst, std::abs(off));
        squares += off * off / (3 * 4 * 6);
      }
    }
  }
  EXPECT_LT(worst, 0.25) << "a spot on an even wall";
  EXPECT_LT(std::sqrt(squares), 0.085) << "of all blocks";
}

TEST(Interactive, CellsLookForLightWhereTheGuideHasFoundIt) {
  // The sun makes a patch on the floor, which lights the room: few of the directions from a wall
  // lead there. Without the guide, which only what stands still has, as many rays know less.
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 1.5f}, {-2, 0.5f, 1.2f}), 96, 72, 60);
  double noise[2] = {};
  for (const bool is_guided : {false, true}) {
    const SceneBuilder b = room_with_window({"sun", 0, 5000, 0}, is_guided);
    constexpr uint64_t kPairs = 4;  // a ray in a thousand that finds the patch decides much
    double mean = 0;
    for (uint64_t seed = 0; seed < 2 * kPairs; seed += 2) {
      const Film one = interactive_picture(b, view, 5, seed),
                 other = interactive_picture(b, view, 5, seed + 1);
      mean += (mean_luminance(one) + mean_luminance(other)) / (2 * kPairs);
      for (int by = 0; by < 6; ++by) {
        for (int bx = 0; bx < 8; ++bx)
          noise[is_guided ? 1 : 0] += std::pow(block_ratio(one, other, bx, by) - 1, 2) / 48;
      }
    }
    const double exact = mean_luminance(path_picture(b, view, 64, kEndless));
    EXPECT_NEAR(mean, exact, 0.05 * exact);
  }
  EXPECT_LT(noise[1], 0.7 * noise[0]) << "as if half as many more rays went";
  EXPECT_LT(noise[1], 2 * std::pow(0.045, 2)) << "each picture within 4.5 %, block by block";
}

TEST(Interactive, AHairBelowBlackDoesNotSpread) {
  // Light below zero by a rounding error, where all is dark: of its neighbours' light a share of
  // nothing must not be taken.
  constexpr int kSize = 32, kMiddle = kSize / 2;
  InteractiveFrame before, frame;
  InteractiveFilter filter;
  before.resize(kSize, kSize);
  frame.resize(kSize, kSize);
  filter.resize(kSize, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      *frame.part.at(x, y) = 1;
      *frame.roughness.at(x, y) = 1;
      frame.n.set(x, y, {0, 0, 1});
    }
  }
  frame.signal[kSpecularSignal].set(kMiddle, kMiddle, {-1e-8f, -1e-8f, -1e-8f});
  filter.accumulate(before, &frame);
  filter.smooth(frame);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const float light = luminance(filter.smoothed(kSpecularSignal).get(x, y));
      ASSERT_LE(std::abs(light), 1e-8f) << x << " " << y;  // no NaN either
    }
  }
}

TEST(Interactive, ManyPanelsAreCountedOnce) {
  // Panels of which a tree takes some, with their backs to the world's origin: no light sampling
  // there would find them, but that at the floor does.
  SceneBuilder b;
  b.add(ShapeType::kBox, {2, 2, 0.1f}, translation({0, 0, -3.1f}),
        b.add_diffuse({0.5f, 0.5f, 0.5f}));
  const int mesh = b.add_mesh(make_panel()), on = add_panel_material(&b, true);
  for (int i = 0; i < 30; ++i) {
    const int column = i % 6, row = i / 6;
    const Vec3f p{0.6f * static_cast<float>(column) - 1.5f, 0.6f * static_cast<float>(row) - 1.2f,
                  -1};
    b.add(ShapeType::kMesh, {}, translation(p), on, 0, mesh);
  }
  b.description.extent = 5;
  const CameraView view = SceneBuilder::camera(look_at({0, -3, -1.2f}, {0, 0, -3}), 48, 32, 30);
  const double exact = mean_luminance(path_picture(b, view, 256, kEndless));
  EXPECT_NEAR(mean_luminance(interactive_picture(b, view, 4)), exact, 0.03 * exact);
}

TEST(Interactive, PicturesAreTheSameForAnyNumberOfThreads) {
  const SceneBuilder b = divided_room();
  std::vector<Vec3f> pictures[2];
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    const auto renderer = b.make();
    const auto history = renderer->make_history();
    Film film;
    for (uint32_t i = 0; i < 3; ++i) {
      renderer->render(room_view(), interactive_settings(history.get(), i), &film);
    }
    pictures[threads == 3] = film.radiance;
  }
  set_thread_count(0);
  ASSERT_EQ(pictures[0].size(), pictures[1].size());
  EXPECT_EQ(std::memcmp(pictures[0].data(), pictures[1].data(), pictures[0].size() * sizeof(Vec3f)),
            0);
}

TEST(Interactive, ExactChannelsAreThoseOfThePathTier) {
  const SceneBuilder b = divided_room();
  RenderSettings path;
  path.spp = 1;
  const Film exact = b.render(room_view(), path);
  const auto renderer = b.make();
  Film film;
  renderer->render(room_view(), interactive_settings(nullptr, 0), &film);
  EXPECT_EQ(film.part, exact.part);
  for (size_t i = 0; i < film.depth.size(); ++i) EXPECT_FLOAT_EQ(film.depth[i], exact.depth[i]);
}

TEST(Interactive, NothingTrailsBehindWhatMoves) {
  // A dark ball crosses a bright floor: where it was, the floor is as if it had never been there.
  SceneBuilder b;
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({0.7f, 0.7f, 0.7f}));
  const int body = b.add_body(translation({-1, 0, 0.3f}));
  b.add(ShapeType::kSphere, {0.3f, 0, 0}, {}, b.add_diffuse({0.02f, 0.02f, 0.02f}), body);
  LightDescription sun;
  sun.type = PunctualLightType::kDirectional;
  sun.intensity = {100, 100, 100};
  b.add_light(sun, {}, {0, 0, -1});
  const CameraView view = SceneBuilder::camera(look_at({0, -3, 3}, {0, 0, 0}), 96, 72, 40);
  const auto renderer = b.make();
  const auto history = renderer->make_history();
  Film film;
  PoseFrame before = b.frame, now = b.frame;
  for (uint32_t i = 0; i < 12; ++i) {
    SceneBuilder::set_body(&now, body, translation({-1 + 0.15f * static_cast<float>(i), 0, 0.3f}));
    renderer->update(now, now, before);
    renderer->render(view, interactive_settings(history.get(), i), &film);
    before = now;
  }
  const auto floor_at = [&](float x) {  // under the ball's way, once in its shade
    CameraView32 camera;
    camera.fx = camera.fy = static_cast<float>(view.intrinsics.fx);
    camera.cx = 48;
    camera.cy = 36;
    Vec2f at;
    EXPECT_TRUE(project(camera, view.X_WC_open, {x, 0, 0}, &at));
    return film.radiance[static_cast<size_t>(at.y) * 96 + static_cast<size_t>(at.x)].x;
  };
  const float clear = 0.7f * 100 / kPi;
  EXPECT_NEAR(floor_at(-1), clear, 0.05f * clear);
  EXPECT_NEAR(floor_at(0), clear, 0.05f * clear) << "left a second before";
  // A frame's pixel reaches into the shade, as it is wider than the image's.
  EXPECT_NEAR(floor_at(0.2f), clear, 0.1f * clear) << "left two pictures before";
}

}  // namespace
}  // namespace gloam
