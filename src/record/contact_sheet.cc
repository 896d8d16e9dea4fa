#include "record/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace gloam {
namespace {

constexpr Rgb8 kPaper = {19, 22, 27}, kPanel = {27, 31, 38}, kGrid = {48, 54, 64},
               kFrame = {74, 82, 94}, kText = {236, 239, 243}, kMuted = {150, 160, 173},
               kAccent = {255, 176, 84};
constexpr int kMargin = 36, kGutter = 156, kGap = 8, kRowGap = 10;
constexpr int kTitleHeight = 78, kHeadingHeight = 26;
constexpr int kPlotHeight = 226, kPlotGap = 28;
constexpr int kPlotLeft = 54, kPlotRight = 14, kPlotTop = 42, kPlotBottom = 44;
constexpr float kTitleSize = 19, kTextSize = 10.5f, kSmallSize = 9;
constexpr int kMinContent = 900;  // so that titles and plots have room beside few pictures

struct Area {
  float x0, y0, x1, y1;  // [px], y0 above y1
};

struct Range {
  double low = 0, high = 1;
};

Range range_of(const std::vector<SheetCurve>& curves, bool of_x) {
  Range range{1e30, -1e30};
  for (const SheetCurve& curve : curves) {
    for (const float v : of_x ? curve.x : curve.y) {
      if (!std::isfinite(v)) continue;
      range.low = std::min(range.low, static_cast<double>(v));
      range.high = std::max(range.high, static_cast<double>(v));
    }
  }
  if (range.low > range.high) return {};
  if (of_x) return range.high > range.low ? range : Range{range.low, range.low + 1};
  const double room = std::max(0.08 * (range.high - range.low), 0.02);
  return {range.low - room, range.high + room};
}

std::string tick_text(double value, double step) {
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  const std::string text = fmt::format("{:.{}f}", value, digits);
  return text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos
             ? text.substr(1)
             : text;
}

/// The curve in pixels, cut where values are missing; dashes are pieces of 7 px with gaps of 5.
std::vector<Polyline> place_curve(const SheetCurve& curve, const Range& x, const Range& y,
                                  const Area& area) {
  std::vector<Polyline> lines(1);
  for (size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
    if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) {
      lines.emplace_back();
      continue;
    }
    const double u = (curve.x[i] - x.low) / (x.high - x.low);
    const double v = (curve.y[i] - y.low) / (y.high - y.low);
    lines.back().push_back({lerp(area.x0, area.x1, static_cast<float>(u)),
                            lerp(area.y1, area.y0, static_cast<float>(v))});
  }
  if (!curve.dashed) return lines;
  constexpr float kDash = 7, kSpace = 5;
  std::vector<Polyline> dashes;
  for (const Polyline& line : lines) {
    float left = kDash;
    bool on = true;
    if (!line.empty()) dashes.push_back({line[0]});
    for (size_t i = 0; i + 1 < line.size(); ++i) {
      Vec2f a = line[i];
      const Vec2f b = line[i + 1];
      for (;;) {
        const Vec2f d = b - a;
        const float length = std::sqrt(d.x * d.x + d.y * d.y);
        if (length <= left) {
          if (on) dashes.back().push_back(b);
          left -= length;
          break;
        }
        a = a + d * (left / length);
        if (on) dashes.back().push_back(a);
        on = !on;
        if (on) dashes.push_back({a});
        left = on ? kDash : kSpace;
      }
    }
  }
  return dashes;
}

void draw_line(Canvas* canvas, Vec2f a, Vec2f b, float width, Rgb8 color) {
  const Polyline line{a, b};
  canvas->stroke({&line, 1}, width, color);
}

void draw_plot(Canvas* canvas, const SheetPlot& plot, const std::string& x_label, int left, int top,
               int width) {
  canvas->fill(left, top, width, kPlotHeight, kPanel);
  const Area area{static_cast<float>(left + kPlotLeft), static_cast<float>(top + kPlotTop),
                  static_cast<float>(left + width - kPlotRight),
                  static_cast<float>(top + kPlotHeight - kPlotBottom)};
  const std::string title = plot.unit.empty() ? plot.title : plot.title + " [" + plot.unit + "]";
  const float title_y = static_cast<float>(top) + 22;
  canvas->text(static_cast<float>(left) + 14, title_y, title, kTextSize, kText);

  // Legend, from the right end of the title line.
  float legend_x = area.x1;
  for (size_t i = plot.curves.size(); i-- > 0;) {
    const SheetCurve& curve = plot.curves[i];
    legend_x -= text_width(curve.label, kSmallSize);
    canvas->text(legend_x, title_y, curve.label, kSmallSize, kMuted);
    legend_x -= 30;
    const SheetCurve sample{"", curve.color, {0, 1}, {0, 0}, curve.dashed};
    const Area line{legend_x, title_y - 4.5f, legend_x + 22, title_y - 3.5f};
    const std::vector<Polyline> key = place_curve(sample, {0, 1}, {-1, 1}, line);
    canvas->stroke(key, 2, curve.color);
    legend_x -= 16;
  }

  const Range x = range_of(plot.curves, true), y = range_of(plot.curves, false);
  const std::vector<double> x_ticks = axis_ticks(x.low, x.high, 6);
  const std::vector<double> y_ticks = axis_ticks(y.low, y.high, 5);
  const auto step = [](const std::vector<double>& ticks) {
    return ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  };
  for (const double tick : y_ticks) {
    const float v =
        std::round(lerp(area.y1, area.y0, static_cast<float>((tick - y.low) / (y.high - y.low)))) +
        0.5f;
    draw_line(canvas, {area.x0, v}, {area.x1, v}, 1, std::fabs(tick) < 1e-12 ? kFrame : kGrid);
    canvas->text(area.x0 - 8, v + kSmallSize / 2, tick_text(tick, step(y_ticks)), kSmallSize,
                 kMuted, Align::kRight);
  }
  for (const double tick : x_ticks) {
    const float u =
        std::round(lerp(area.x0, area.x1, static_cast<float>((tick - x.low) / (x.high - x.low)))) +
        0.5f;
    draw_line(canvas, {u, area.y1}, {u, area.y1 + 4}, 1, kFrame);
    canvas->text(u, area.y1 + 8 + kSmallSize, tick_text(tick, step(x_ticks)), kSmallSize, kMuted,
                 Align::kCenter);
  }
  draw_line(canvas, {area.x0, area.y1 + 0.5f}, {area.x1, area.y1 + 0.5f}, 1, kFrame);
  canvas->text((area.x0 + area.x1) / 2, static_cast<float>(top + kPlotHeight) - 9, x_label,
               kSmallSize, kMuted, Align::kCenter);
  for (const SheetCurve& curve : plot.curves)
    canvas->stroke(place_curve(curve, x, y, area), 2, curve.color);
}

void draw_row_label(Canvas* canvas, const SheetRow& row, int top, int height) {
  const float x = kMargin;
  float y = static_cast<float>(top) + kTextSize + 3;
  canvas->text(x, y, fit_text(row.label, kTextSize, kGutter - 16), kTextSize, kText, Align::kLeft,
               true);
  y += 20;
  canvas->text(x, y, fit_text(row.detail, kSmallSize, kGutter - 16), kSmallSize, kMuted);
  y += 18;
  if (!row.bar_low.empty()) {
    constexpr int kBarWidth = 120, kBarHeight = 10;
    for (int i = 0; i < kBarWidth; ++i)
      canvas->fill(kMargin + i, static_cast<int>(y), 1, kBarHeight,
                   turbo_color((static_cast<float>(i) + 0.5f) / kBarWidth));
    y += kBarHeight + 8 + kSmallSize;
    canvas->text(x, y, row.bar_low, kSmallSize, kMuted);
    canvas->text(x + kBarWidth, y, row.bar_high, kSmallSize, kMuted, Align::kRight);
  }
  constexpr int kEntry = 19;
  const int room = std::max(1, static_cast<int>((static_cast<float>(top + height) - y) / kEntry));
  const int all = static_cast<int>(row.legend.size());
  const int shown = all <= room ? all : room - 1;
  for (int i = 0; i < shown; ++i, y += kEntry) {
    const SheetLegendEntry& entry = row.legend[static_cast<size_t>(i)];
    canvas->fill(kMargin, static_cast<int>(y) + 1, 11, 11, entry.color);
    canvas->text(x + 19, y + 11, fit_text(entry.text, kSmallSize, kGutter - 36), kSmallSize,
                 kMuted);
  }
  if (shown < all)
    canvas->text(x + 19, y + 11, fmt::format("and {} more", all - shown), kSmallSize, kMuted);
}

}  // namespace

std::vector<double> axis_ticks(double low, double high, int most) {
  GLOAM_CHECK(high > low && most > 0, "an axis has a length");
  const double raw = (high - low) / most;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double nice : {1.0, 2.0, 5.0}) {
    if (nice * power >= raw * (1 - 1e-9)) {
      step = nice * power;
      break;
    }
  }
  std::vector<double> ticks;
  const double slack = 1e-9 * (high - low);
  for (double i = std::ceil((low - slack) / step); i * step <= high + slack; ++i)
    ticks.push_back(i * step);
  return ticks;
}

Canvas draw_contact_sheet(const ContactSheet& sheet) {
  int cell_width = 0, rows_height = 0;
  std::vector<int> heights;
  for (const SheetRow& row : sheet.rows) {
    int height = 0;
    for (const SheetPicture& picture : row.pictures) {
      cell_width = std::max(cell_width, picture.width);
      height = std::max(height, picture.height);
    }
    heights.push_back(height);
    rows_height += height + kRowGap;
  }
  const int columns = static_cast<int>(sheet.columns.size());
  const int pictures_width = columns * cell_width + std::max(0, columns - 1) * kGap;
  const int content = std::max(kMinContent, kGutter + pictures_width);
  const int plots_top = kMargin + kTitleHeight + (columns > 0 ? kHeadingHeight : 0) + rows_height;
  const int height = plots_top + (sheet.plots.empty() ? 0 : kRowGap + kPlotHeight) + kMargin;
  Canvas canvas(content + 2 * kMargin, height, kPaper);

  canvas.fill(kMargin, kMargin, 4, 50, kAccent);
  canvas.text(kMargin + 18, kMargin + kTitleSize + 1,
              fit_text(sheet.title, kTitleSize, static_cast<float>(content - 20)), kTitleSize,
              kText, Align::kLeft, true);
  canvas.text(kMargin + 18, kMargin + 47,
              fit_text(sheet.subtitle, kTextSize, static_cast<float>(content - 20)), kTextSize,
              kMuted);

  int y = kMargin + kTitleHeight;
  const auto column_x = [&](int i) { return kMargin + kGutter + i * (cell_width + kGap); };
  for (int i = 0; i < columns; ++i)
    canvas.text(static_cast<float>(column_x(i)) + static_cast<float>(cell_width) / 2,
                static_cast<float>(y + 12), sheet.columns[static_cast<size_t>(i)], kTextSize,
                kMuted, Align::kCenter);
  if (columns > 0) y += kHeadingHeight;
  for (size_t r = 0; r < sheet.rows.size(); ++r) {
    const SheetRow& row = sheet.rows[r];
    draw_row_label(&canvas, row, y, heights[r]);
    for (size_t i = 0; i < row.pictures.size(); ++i) {
      const SheetPicture& picture = row.pictures[i];
      const int x = column_x(static_cast<int>(i)) + (cell_width - picture.width) / 2;
      if (picture.rgb.empty()) {
        canvas.fill(column_x(static_cast<int>(i)), y, cell_width, heights[r], kPanel);
      } else {
        canvas.paste(x, y, picture.width, picture.height, picture.rgb);
      }
    }
    y += heights[r] + kRowGap;
  }

  const int plots = static_cast<int>(sheet.plots.size());
  for (int i = 0; i < plots; ++i) {
    const int width = (content - (plots - 1) * kPlotGap) / plots;
    draw_plot(&canvas, sheet.plots[static_cast<size_t>(i)], sheet.x_label,
              kMargin + i * (width + kPlotGap), plots_top + kRowGap, width);
  }
  return canvas;
}

}  // namespace gloam
