#pragma once
// Charts as SVG: lines over a shared axis, or the ground from above. Colours are classes, so that
// the page decides them, for light and for dark.

#include <limits>
#include <string>
#include <vector>

namespace gloam {

struct ChartCurve {
  std::string label;
  std::vector<double> x, y;  ///< a gap where one is not finite
  int color = 0;             ///< number of the run; colours repeat after seven, then broken lines
  bool is_target = false;    ///< drawn thin and dotted: a commanded value, a reference
};

struct Chart {
  std::string title;
  std::string x_label, y_label;  ///< with units: "time [s]"
  std::vector<ChartCurve> curves;
  bool equal_scale = false;  ///< a metre is as long in x as in y; starts and ends are marked
  double x_low = std::numeric_limits<double>::quiet_NaN();  ///< of several charts; else the data's
  double x_high = std::numeric_limits<double>::quiet_NaN();
  int width = 560, height = 230;  ///< [px]
};

/// Element of a page, without a namespace; texts are escaped.
std::string chart_svg(const Chart& chart);
/// Styles of these classes, for a page or a file of its own.
std::string chart_style();
/// Charts one below the other as a file.
std::string chart_file(const std::vector<Chart>& charts);

/// Class of the curve's colour and pattern: "c0 d0".
std::string curve_class(int color);

/// "&lt;" for "<" and so on, for texts and attributes; bytes that are no UTF-8 become U+FFFD,
/// control characters spaces.
std::string html_text(const std::string& text);

/// Few digits for people: 4 that count, no exponent between 0.001 and 1e6.
std::string short_number(double value);

}  // namespace gloam
