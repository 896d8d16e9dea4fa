// Lamps by cell: the lists themselves, and the images that the interactive tier makes with them.

#include "render/kernel/interactive/lamp_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/test/interactive_picture.h"

namespace gloam {
namespace {

constexpr uint8_t kHidden = LampCell::kHidden, kClear = LampCell::kClear;

struct Entry {
  uint16_t lamp;
  uint8_t seen, weight;
};
LampCell cell_of(const std::vector<Entry>& entries) {
  LampCell cell;
  for (const Entry& entry : entries) {
    cell.lamp[cell.count] = entry.lamp;
    cell.seen[cell.count] = entry.seen;
    cell.weight[cell.count++] = entry.weight;
    cell.visible += (entry.seen & kClear) != 0;
  }
  return cell;
}

TEST(LampCells, EachLampComesOnceForAllLanesThatListIt) {
  const LampCell a = cell_of({{1, kClear, 9}, {4, kHidden, 9}, {7, kClear | kHidden, 9}});
  const LampCell b = cell_of({{4, kClear, 9}, {7, kClear, 9}});
  LampListsOf<FloatLanes> lists;
  lists.set(0, &a), lists.set(1, &b), lists.set(3, &a);
  MaskLanes active = lists.known;
  set_lane(&active, 3, false);
  ListedLamps<FloatLanes> lamps(lists, active);
  ListedLampOf<FloatLanes> one;
  const auto expect = [&](uint32_t lamp, bool first, bool second, bool first_clear) {
    ASSERT_TRUE(lamps.next(&one));
    EXPECT_EQ(one.lamp, lamp);
    EXPECT_EQ(lane(one.lanes, 0), first);
    EXPECT_EQ(lane(one.lanes, 1), second);
    EXPECT_EQ(lane(one.clear, 0), first_clear);
    for (int i = 2; i < kLaneCount; ++i) EXPECT_FALSE(lane(one.lanes, i));
  };
  expect(1, true, false, true);
  expect(4, false, true, false);  // hidden from the first
  expect(7, true, true, false);
  EXPECT_TRUE(lane(one.clear, 1));
  EXPECT_FALSE(lamps.next(&one));
}

TEST(LampCells, LampsAreDrawnByWeight) {
  const LampCell cell =
      cell_of({{2, kClear, 10}, {3, kHidden, 255}, {5, kClear | kHidden, 30}, {9, kClear, 60}});
  int drawn[10] = {};
  constexpr int kDraws = 1000;
  for (int k = 0; k < kDraws; ++k) {
    const LampDraw draw = draw_lamp(cell, (static_cast<float>(k) + 0.5f) / kDraws);
    ++drawn[draw.lamp];
    EXPECT_FLOAT_EQ(draw.probability, draw_probability(cell, draw.lamp));
    EXPECT_EQ(draw.clear, draw.lamp != 5);
    EXPECT_GE(draw.rest, 0);
    EXPECT_LT(draw.rest, 1);
  }
  EXPECT_EQ(drawn[2], 100);
  EXPECT_EQ(drawn[5], 300);
  EXPECT_EQ(drawn[9], 600);
  EXPECT_EQ(draw_probability(cell, 3), 0);
  EXPECT_EQ(draw_lamp(cell_of({{3, kHidden, 255}}), 0.5f).probability, 0);
}

/// Three rooms in a row, each with `across` by `across` lamps; openings connect them.
SceneBuilder row_of_rooms(int across) {
  SceneBuilder b;
  const int white = b.add_diffuse({0.6f, 0.6f, 0.6f});
  b.add(ShapeType::kBox, {6, 2, 0.1f}, translation({0, 0, -0.1f}), white);
  b.add(ShapeType::kBox, {6, 2, 0.1f}, translation({0, 0, 2.6f}), white);
  for (const float side : {-1.0f, 1.0f}) {
    b.add(ShapeType::kBox, {0.1f, 2, 1.3f}, translation({6.1f * side, 0, 1.2f}), white);
    b.add(ShapeType::kBox, {6, 0.1f, 1.3f}, translation({0, 2.1f * side, 1.2f}), white);
    b.add(ShapeType::kBox, {0.05f, 1.3f, 1.3f}, translation({2 * side, -0.7f, 1.2f}), white);
  }
  const auto at = [&](int k) {
    return 3.0f * (static_cast<float>(k) + 0.5f) / static_cast<float>(across) - 1.5f;
  };
  for (const float room : {-4.0f, 0.0f, 4.0f})
    for (int i = 0; i < across * across; ++i)
      b.add(ShapeType::kSphere, {0.05f, 0, 0},
            translation({room + at(i % across), at(i / across), 2.2f}),
            b.add_emitter({300, 280, 240}));
  b.description.extent = 10;
  return b;
}

/// Means of 4 x 3 parts of two images that are 96 x 72.
void expect_same_parts(const Film& film, const Film& exact, double tolerance) {
  for (int part = 0; part < 12; ++part) {
    double a = 0, c = 0;
    for (int i = 0; i < 24 * 24; ++i) {
      const size_t pixel =
          static_cast<size_t>((part / 4 * 24 + i / 24) * 96 + part % 4 * 24 + i % 24);
      a += luminance(film.radiance[pixel]);
      c += luminance(exact.radiance[pixel]);
    }
    EXPECT_NEAR(a / c, 1, tolerance) << "column " << part % 4 << " of row " << part / 4;
  }
}

TEST(LampCells, RoomsWithManyLampsAreThoseOfThePathTier) {
  for (const int across : {2, 4}) {  // few lamps of a room: all are sampled; many: some
    SCOPED_TRACE(across);
    const SceneBuilder b = row_of_rooms(across);
    const CameraView view =
        SceneBuilder::camera(look_at({-5.6f, 1.2f, 1.5f}, {-1.5f, 0.9f, 0}), 96, 72, 40);
    const Film exact = path_picture(b, view, 128, kEndless);
    const Film film = interactive_picture(b, view, 8);
    EXPECT_NEAR(mean_luminance(film) / mean_luminance(exact), 1, 0.05);
    expect_same_parts(film, exact, 0.15);
  }
}

/// A lamp over a floor, and a plate on a body of its own.
struct ShadedFloor {
  SceneBuilder b;
  int plate = 0;
  const CameraView view = SceneBuilder::camera(look_at({0, -3, 2}, {0, 0, 0}), 96, 72, 50);

  ShadedFloor() {
    b.add(ShapeType::kBox, {3, 3, 0.1f}, translation({0, 0, -0.1f}),
          b.add_diffuse({0.5f, 0.5f, 0.5f}));
    b.add(ShapeType::kSphere, {0.05f, 0, 0}, translation({0, 0, 2.5f}),
          b.add_emitter({2000, 2000, 2000}));
    plate = b.add_body(translation({9, 9, 1}));
    b.add(ShapeType::kBox, {0.6f, 0.6f, 0.01f}, translation({0, 0, 0}),
          b.add_diffuse({0.2f, 0.2f, 0.2f}), plate);
    b.description.extent = 5;
  }
};

TEST(LampCells, WhatMovesThrowsItsShadowAtOnce) {
  ShadedFloor scene;
  const auto renderer = scene.b.make();
  const auto history = renderer->make_history();
  Film film;
  PoseFrame before = scene.b.frame;
  for (uint32_t i = 0; i < 8; ++i) {  // the plate comes when all lists are made
    if (i == 4) SceneBuilder::set_body(&scene.b.frame, scene.plate, translation({0, 0.3f, 1}));
    renderer->update(scene.b.frame, scene.b.frame, before);
    renderer->render(scene.view, interactive_settings(history.get(), i), &film);
    before = scene.b.frame;
  }
  const Film exact = path_picture(scene.b, scene.view, 256, kEndless);
  expect_same_parts(film, exact, 0.15);
}

TEST(LampCells, LightComesFromWhereALampHasMoved) {
  SceneBuilder b;
  b.add(ShapeType::kBox, {3, 3, 0.1f}, translation({0, 0, -0.1f}),
        b.add_diffuse({0.5f, 0.5f, 0.5f}));
  LightDescription lamp;
  lamp.intensity = {50, 50, 50};
  b.add_light(lamp, {-2, 0, 1});
  b.description.extent = 5;
  const CameraView view = SceneBuilder::camera(look_at({0, -3, 2}, {0, 0, 0}), 96, 72, 50);
  const auto renderer = b.make();
  const auto history = renderer->make_history();
  Film film;
  for (uint32_t i = 0; i < 12; ++i) {
    if (i < 5) b.frame.light_p[0] = -2 + static_cast<float>(i);
    renderer->update(b.frame, b.frame, b.frame);
    renderer->render(view, interactive_settings(history.get(), i), &film);
  }
  const Film exact = path_picture(b, view, 128, kEndless);
  expect_same_parts(film, exact, 0.1);
}

}  // namespace
}  // namespace gloam
