#include "report/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "record/contact_sheet.h"

namespace gloam {
namespace {

constexpr int kColors = 7, kPatterns = 3;
constexpr double kLeft = 58, kRight = 10, kTop = 24, kBottom = 36;  // margins [px]

// Values beyond this are gaps, too: their ranges would not be finite.
bool is_shown(double v) { return std::fabs(v) < 1e100; }

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  double size() const { return high - low; }
  void widen(double by) {
    low -= by;
    high += by;
  }
};

Range widened(Range range) {
  if (!(range.low <= range.high)) return {0, 1};
  const double least = std::max(1e-9, 1e-6 * std::max(std::fabs(range.low), std::fabs(range.high)));
  if (range.size() < least) range.widen(std::max(0.5 * least, 0.05 * std::fabs(range.high)));
  if (range.size() < 1e-8) range.widen(0.5);
  return range;
}

/// From numbers to pixels.
struct Axes {
  Range x, y;
  double left, top, width, height;
  double px(double v) const { return left + (v - x.low) / x.size() * width; }
  double py(double v) const { return top + (y.high - v) / y.size() * height; }
};

Axes axes_of(const Chart& chart) {
  Range x, y;
  for (const ChartCurve& curve : chart.curves)
    for (size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i)
      if (is_shown(curve.x[i]) && is_shown(curve.y[i])) {
        x.add(curve.x[i]);
        y.add(curve.y[i]);
      }
  if (std::isfinite(chart.x_low) && std::isfinite(chart.x_high) && chart.x_low < chart.x_high)
    x = {chart.x_low, chart.x_high};
  x = widened(x);
  y = widened(y);
  Axes axes{x, y, kLeft, kTop, chart.width - kLeft - kRight, chart.height - kTop - kBottom};
  axes.y.widen(0.05 * y.size());
  if (chart.equal_scale) {
    axes.x.widen(0.05 * x.size());
    const double per_x = axes.x.size() / axes.width, per_y = axes.y.size() / axes.height;
    if (per_x < per_y) axes.x.widen(0.5 * (per_y * axes.width - axes.x.size()));
    if (per_y < per_x) axes.y.widen(0.5 * (per_x * axes.height - axes.y.size()));
  }
  return axes;
}

std::string grid(const Chart& chart, const Axes& axes) {
  std::string out;
  const double bottom = axes.top + axes.height, right = axes.left + axes.width;
  for (const double v : axis_ticks(axes.y.low, axes.y.high, 5)) {
    if (v < axes.y.low || v > axes.y.high) continue;
    out += fmt::format(
        R"(<line class="grid" x1="{:.1f}" x2="{:.1f}" y1="{:.1f}" y2="{:.1f}"/><text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)",
        axes.left, right, axes.py(v), axes.py(v), axes.left - 6, axes.py(v) + 3.5, short_number(v));
  }
  for (const double v : axis_ticks(axes.x.low, axes.x.high, 8)) {
    if (v < axes.x.low || v > axes.x.high) continue;
    out += fmt::format(
        R"(<line class="grid" x1="{:.1f}" x2="{:.1f}" y1="{:.1f}" y2="{:.1f}"/><text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)",
        axes.px(v), axes.px(v), axes.top, bottom, axes.px(v), bottom + 14, short_number(v));
  }
  out +=
      fmt::format(R"(<rect class="frame" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/>)",
                  axes.left, axes.top, axes.width, axes.height);
  out += fmt::format(
      R"(<text class="name" x="{:.1f}" y="15">{}</text><text class="tick" x="{:.1f}" y="{}" text-anchor="middle">{}</text>)",
      axes.left, html_text(chart.title), axes.left + axes.width / 2, chart.height - 6,
      html_text(chart.x_label));
  out += fmt::format(R"(<text class="tick" x="{:.1f}" y="15" text-anchor="end">{}</text>)", right,
                     html_text(chart.y_label));
  return out;
}

/// Points of a curve in pixels: of all that fall into one column the first, the least, the
/// greatest and the last, which is what can be seen of them.
class PathPen {
 public:
  explicit PathPen(const Axes& axes) : axes_(axes) {}

  std::string draw(const ChartCurve& curve, bool by_columns) {
    for (size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
      if (!is_shown(curve.x[i]) || !is_shown(curve.y[i])) {
        end_column();
        is_down_ = false;
        continue;
      }
      const double x = axes_.px(curve.x[i]), y = axes_.py(curve.y[i]);
      if (!by_columns) {
        if (!is_down_ || std::hypot(x - last_x_, y - last_y_) > 0.7) move_to(x, y);
        continue;
      }
      if (!column_.empty() && std::floor(x) != std::floor(column_x_)) end_column();
      column_x_ = x;
      column_.push_back(y);
    }
    end_column();
    return std::move(path_);
  }

 private:
  void move_to(double x, double y) {
    path_ += fmt::format("{}{:.1f} {:.1f}", is_down_ ? "L" : "M", x, y);
    is_down_ = true;
    last_x_ = x;
    last_y_ = y;
  }
  void end_column() {
    if (column_.empty()) return;
    const auto [least, greatest] = std::minmax_element(column_.begin(), column_.end());
    const double low = *least, high = *greatest, first = column_.front(), last = column_.back();
    const bool low_first = least < greatest;
    move_to(column_x_, first);
    if (high - low > 0.5) {
      move_to(column_x_, low_first ? low : high);
      move_to(column_x_, low_first ? high : low);
      move_to(column_x_, last);
    }
    column_.clear();
  }

  const Axes& axes_;
  std::string path_;
  std::vector<double> column_;
  double column_x_ = 0, last_x_ = 0, last_y_ = 0;
  bool is_down_ = false;
};

std::string ends_of(const ChartCurve& curve, const Axes& axes) {
  std::string out;
  const size_t n = std::min(curve.x.size(), curve.y.size());
  size_t first = n, last = n;
  for (size_t i = 0; i < n; ++i)
    if (is_shown(curve.x[i]) && is_shown(curve.y[i])) {
      if (first == n) first = i;
      last = i;
    }
  if (first == n) return out;
  out += fmt::format(R"(<circle class="start {}" cx="{:.1f}" cy="{:.1f}" r="4"/>)",
                     curve_class(curve.color), axes.px(curve.x[first]), axes.py(curve.y[first]));
  out += fmt::format(R"(<rect class="end {}" x="{:.1f}" y="{:.1f}" width="7" height="7"/>)",
                     curve_class(curve.color), axes.px(curve.x[last]) - 3.5,
                     axes.py(curve.y[last]) - 3.5);
  return out;
}

std::string body_of(const Chart& chart) {
  const Axes axes = axes_of(chart);
  std::string out = grid(chart, axes);
  for (const bool targets : {true, false})
    for (const ChartCurve& curve : chart.curves) {
      if (curve.is_target != targets) continue;
      const std::string path = PathPen(axes).draw(curve, !chart.equal_scale);
      if (path.empty()) continue;
      out += fmt::format(R"(<path class="{}{}" d="{}"><title>{}</title></path>)",
                         curve.is_target ? "target " : "curve ", curve_class(curve.color), path,
                         html_text(curve.label));
      if (chart.equal_scale && !curve.is_target) out += ends_of(curve, axes);
    }
  return out;
}

}  // namespace

std::string html_text(const std::string& text) {
  std::string out;
  for (const char c : as_utf8(text)) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else
      out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return out;
}

std::string short_number(double value) {
  if (!std::isfinite(value)) return value > 0 ? "inf" : value < 0 ? "-inf" : "–";
  const double size = std::fabs(value);
  if (size < 1e-12) return "0";
  if (value == std::floor(value) && size < 1e7) return fmt::format("{:.0f}", value);
  if (size < 1e-3 || size >= 1e6) return fmt::format("{:.3g}", value);
  std::string text = fmt::format("{:.{}f}", value,
                                 std::max(0, 3 - static_cast<int>(std::floor(std::log10(size)))));
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string curve_class(int color) {
  return fmt::format("c{} d{}", color % kColors, color / kColors % kPatterns);
}

// Okabe and Ito 2008, "Color Universal Design", without their yellow; lighter on dark ground.
std::string chart_style() {
  return R"(:root{--c0:#0072b2;--c1:#d55e00;--c2:#009e73;--c3:#aa4499;--c4:#3aa0da;--c5:#c98a00;--c6:#555;
--ink:#1a1f24;--soft:#5c6670;--line:#dfe3e7;--paper:#fff;--panel:#f6f7f9;--mark:#e3f1e8}
@media(prefers-color-scheme:dark){:root{--c0:#56b4e9;--c1:#ff8c42;--c2:#2cc79a;--c3:#e08ad0;--c4:#9fd3f5;--c5:#f0c14b;--c6:#b5bcc4;
--ink:#e6e9ec;--soft:#9aa4ae;--line:#353c44;--paper:#14181c;--panel:#1c2227;--mark:#1d3a2b}}
@media print{:root{--c0:#0072b2;--c1:#d55e00;--c2:#009e73;--c3:#aa4499;--c4:#3aa0da;--c5:#c98a00;--c6:#555;
--ink:#000;--soft:#444;--line:#ddd;--paper:#fff;--panel:#f6f7f9;--mark:#e3f1e8}}
.c0{--own:var(--c0)}.c1{--own:var(--c1)}.c2{--own:var(--c2)}.c3{--own:var(--c3)}.c4{--own:var(--c4)}.c5{--own:var(--c5)}.c6{--own:var(--c6)}
.chart text{font:11px system-ui,sans-serif;fill:var(--soft)}.chart text.name{font-weight:600;font-size:12px;fill:var(--ink)}
.grid{stroke:var(--line);stroke-width:1}.frame{fill:none;stroke:var(--soft);stroke-width:.6;opacity:.6}
.curve{fill:none;stroke:var(--own);stroke-width:1.7;stroke-linejoin:round}
.target{fill:none;stroke:var(--own);stroke-width:1.4;stroke-dasharray:1.5 3.5;stroke-linecap:round}
.curve.d1{stroke-dasharray:7 3}.curve.d2{stroke-dasharray:3 2}
.start{fill:var(--paper);stroke:var(--own);stroke-width:2}.end{fill:var(--own)}
)";
}

std::string chart_svg(const Chart& chart) {
  return fmt::format(
      R"(<svg class="chart" viewBox="0 0 {} {}" width="{}" height="{}" role="img" aria-label="{}">{}</svg>)",
      chart.width, chart.height, chart.width, chart.height, html_text(chart.title), body_of(chart));
}

std::string chart_file(const std::vector<Chart>& charts) {
  int width = 0, height = 0;
  for (const Chart& chart : charts) {
    width = std::max(width, chart.width);
    height += chart.height;
  }
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\"><style>{2}</style><rect width=\"{0}\" height=\"{1}\" "
      "fill=\"var(--paper)\"/>",
      width, height, chart_style());
  int top = 0;
  for (const Chart& chart : charts) {
    out += fmt::format("<g transform=\"translate(0 {})\">{}</g>", top, body_of(chart));
    top += chart.height;
  }
  return out + "</svg>\n";
}

}  // namespace gloam
