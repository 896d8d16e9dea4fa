#include "record/contact_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "record/camera_recorder.h"
#include "record/csv.h"
#include "record/font.h"
#include "record/timeline.h"

namespace gloam {
namespace {

constexpr Rgb8 kBlack = {0, 0, 0}, kWhite = {255, 255, 255};

int bright_pixels(const Canvas& canvas) {
  int count = 0;
  for (size_t i = 0; i < canvas.pixels().size(); i += 3) count += canvas.pixels()[i] > 60 ? 1 : 0;
  return count;
}

TEST(Font, EveryCharacterIsDrawnAndNoTwoAreAlike) {
  std::map<std::string, char> seen;
  for (char c = ' '; c <= '~'; ++c) {
    Canvas canvas(60, 60, kBlack);
    canvas.text(10, 40, std::string_view(&c, 1), 24, kWhite);
    EXPECT_GE(bright_pixels(canvas), c == ' ' ? 0 : 4) << c;
    const std::string picture(canvas.pixels().begin(), canvas.pixels().end());
    const auto [other, is_new] = seen.try_emplace(picture, c);
    EXPECT_TRUE(is_new) << c << " looks like " << other->second;
  }
}

TEST(Font, GlyphsStayInTheirCell) {
  for (char c = ' '; c <= '~'; ++c) {
    const Glyph glyph = make_glyph(c);
    for (const auto& line : glyph.lines) {
      for (const Vec2f p : line) {
        EXPECT_GE(p.x, -0.2f) << c;
        EXPECT_LE(p.x, glyph.width + 0.2f) << c;
        EXPECT_GE(p.y, -3.01f) << c;
        EXPECT_LE(p.y, 8.01f) << c;
      }
    }
  }
}

TEST(Font, WidthsAddUpAndUnknownCharactersCountOnce) {
  EXPECT_EQ(text_width("", 10), 0);
  EXPECT_NEAR(text_width("ab", 14) - text_width("a", 14) - text_width("b", 14), 2 * kFontSpacing,
              1e-4);
  EXPECT_FLOAT_EQ(text_width("\xc2\xb0", 10), text_width("?", 10));
  EXPECT_EQ(fit_text("short", 10, 500), "short");
  const std::string cut = fit_text("a rather long piece of text", 10, 80);
  EXPECT_LE(text_width(cut, 10), 80);
  EXPECT_TRUE(cut.ends_with(".."));
}

TEST(Canvas, LinesCoverTheirAreaAndClip) {
  Canvas canvas(100, 40, kBlack);
  const Polyline line{{10, 20}, {90, 20}};
  canvas.stroke({&line, 1}, 4, kWhite);
  double sum = 0;
  for (size_t i = 0; i < canvas.pixels().size(); i += 3) sum += canvas.pixels()[i] / 255.0;
  EXPECT_NEAR(sum, 80 * 4 + std::acos(-1.0) * 4, 8);  // a rectangle and two round ends
  const Polyline outside{{-500, -20}, {500, 70}};
  canvas.stroke({&outside, 1}, 6, kWhite);
  canvas.fill(-10, -10, 1000, 1000, kWhite);
  EXPECT_EQ(canvas.pixels().front(), 255);
  EXPECT_EQ(canvas.pixels().back(), 255);
}

TEST(ContactSheet, TicksAreRoundNumbersInsideTheAxis) {
  EXPECT_EQ(axis_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  const std::vector<double> ticks = axis_ticks(-0.13, 0.52, 5);
  ASSERT_EQ(ticks.size(), 3u);
  EXPECT_NEAR(ticks[0], 0, 1e-12);
  EXPECT_NEAR(ticks[2], 0.4, 1e-12);
  for (const double range : {1e-3, 0.7, 3.0, 42.0, 1e5}) {
    const std::vector<double> t = axis_ticks(0.3 * range, 1.3 * range, 6);
    EXPECT_GE(t.size(), 2u);
    EXPECT_LE(t.size(), 8u);
    EXPECT_GE(t.front(), 0.3 * range * 0.999);
    EXPECT_LE(t.back(), 1.3 * range * 1.001);
  }
}

TEST(ContactSheet, PlacesPicturesAndGrowsWithItsContent) {
  ContactSheet sheet;
  sheet.title = "title";
  sheet.columns = {"t = 0 s", "t = 1 s"};
  SheetPicture red{60, 40, {}}, gap;
  for (int i = 0; i < 60 * 40; ++i) red.rgb.insert(red.rgb.end(), {250, 10, 10});
  sheet.rows.push_back({.label = "front", .detail = "colour", .pictures = {red, gap}});
  const Canvas one = draw_contact_sheet(sheet);
  const auto reds = [](const Canvas& canvas) {
    int count = 0;
    for (size_t i = 0; i < canvas.pixels().size(); i += 3)
      count += canvas.pixels()[i] == 250 && canvas.pixels()[i + 1] == 10 ? 1 : 0;
    return count;
  };
  EXPECT_EQ(reds(one), 60 * 40);
  sheet.rows.push_back(sheet.rows[0]);
  const Canvas two = draw_contact_sheet(sheet);
  EXPECT_EQ(reds(two), 2 * 60 * 40);
  EXPECT_GT(two.height(), one.height());
  sheet.plots.push_back({"speed", "m/s", {{"measured", kWhite, {0, 1, 2}, {0, NAN, 1}, false}}});
  EXPECT_GT(draw_contact_sheet(sheet).height(), two.height());
}

TEST(ContactSheet, TakesNothingAtAllAndConstantCurves) {
  EXPECT_GT(draw_contact_sheet({}).width(), 100);
  ContactSheet sheet;
  sheet.plots.push_back({"empty", "", {}});
  sheet.plots.push_back({"constant", "m", {{"a", kWhite, {1, 1}, {5, 5}, true}}});
  EXPECT_GT(draw_contact_sheet(sheet).height(), 200);
}

TEST(Timeline, KeepsAnEvenSelectionOfAnyLength) {
  for (const int n : {1, 5, 8, 9, 100, 1000, 4097}) {
    Timeline<std::vector<int>> line(8);
    for (int i = 0; i < n; ++i) {
      if (line.wants_next()) {
        line.add({i});
      } else {
        line.skip();
      }
    }
    const auto& kept = line.items();
    ASSERT_GE(kept.size(), static_cast<size_t>(std::min(n, 4)));
    ASSERT_LE(kept.size(), 8u);
    ASSERT_EQ(kept[0], std::vector<int>{0});
    for (size_t i = 2; i < kept.size(); ++i)
      EXPECT_EQ(kept[i].at(0) - kept[i - 1].at(0), kept[1].at(0) - kept[0].at(0)) << n;
  }
}

TEST(Csv, QuotesWhatNeedsIt) {
  EXPECT_EQ(csv_field("vx_mps"), "vx_mps");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"hi\""), "\"say \"\"hi\"\"\"");
  EXPECT_EQ(csv_field("=HYPERLINK(\"x\")"), "\"'=HYPERLINK(\"\"x\"\")\"");
  EXPECT_EQ(csv_field("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(csv_field("-1+cmd|' /C calc'!A0"), "'-1+cmd|' /C calc'!A0");
  EXPECT_EQ(csv_field("\t=1"), "'\t=1");
  for (const char* number : {"-1.5", "+2", "-3e-7", "1", "-inf"})
    EXPECT_EQ(csv_field(number), number);
}

TEST(Thumbnail, AveragesColoursAndPicksIds) {
  CameraFrame frame;
  frame.intrinsics.width = 4;
  frame.intrinsics.height = 2;
  for (int i = 0; i < 8; ++i)
    for (int c = 0; c < 3; ++c) frame.rgb.push_back(static_cast<uint8_t>(i % 2 == 0 ? 100 : 200));
  frame.instance = {1, 1, 5, 5, 1, 1, 5, 5};
  const Thumbnail small = make_thumbnail(frame, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.rgb, std::vector<uint8_t>(6, 150));
  EXPECT_EQ(small.instance, (std::vector<uint32_t>{1, 5}));
  EXPECT_TRUE(small.depth.empty());
}

}  // namespace
}  // namespace gloam
