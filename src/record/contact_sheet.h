#pragma once
// One picture that shows a run at a glance: rows of pictures over time, and curves below.

#include <string>
#include <vector>

#include "record/canvas.h"

namespace gloam {

struct SheetPicture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;  ///< (height x width x 3); empty = a gap
};

struct SheetLegendEntry {
  Rgb8 color;
  std::string text;
};

/// One row: the same view at several times. All pictures of a row have one size.
struct SheetRow {
  std::string label, detail;
  std::vector<SheetPicture> pictures;  ///< one per column
  std::string bar_low, bar_high;       ///< ends of a turbo colour bar; empty = no bar
  std::vector<SheetLegendEntry> legend;
};

struct SheetCurve {
  std::string label;
  Rgb8 color;
  std::vector<float> x, y;
  bool dashed = false;
};

struct SheetPlot {
  std::string title, unit;
  std::vector<SheetCurve> curves;
};

struct ContactSheet {
  std::string title, subtitle;
  std::vector<std::string> columns;  ///< headings
  std::vector<SheetRow> rows;
  std::vector<SheetPlot> plots;
  std::string x_label = "time [s]";
};

/// Draws it; pictures are shown at their own size.
Canvas draw_contact_sheet(const ContactSheet& sheet);

/// Round numbers that divide [low, high] into at most `most` steps, low and high included or not.
std::vector<double> axis_ticks(double low, double high, int most);

}  // namespace gloam
