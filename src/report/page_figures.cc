// Figures of a report: strips of pictures, curves, ways from above.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/metric_names.h"
#include "report/page.h"
#include "report/svg_chart.h"

namespace gloam {
namespace {

constexpr size_t kMostCharts = 80;

std::string legend(const ReportContent& content) {
  std::string out = "<div class=\"legend\">";
  for (const RunResults& run : content.runs) out += run_tag(run);
  return out + "</div>";
}

std::vector<std::string> column_names(const std::vector<RunResults>& runs) {
  std::vector<std::string> names;
  for (const RunResults& run : runs)
    for (const std::string& column : run.metrics.columns)
      if (column != "time_s" && std::find(names.begin(), names.end(), column) == names.end())
        names.push_back(column);
  return names;
}

// "ada.vx_goal_mps" of "ada.vx_mps": what was commanded.
std::string goal_column(const std::string& column) {
  const size_t point = column.rfind('.');
  const size_t unit = column.rfind('_');
  if (unit == std::string::npos || (point != std::string::npos && unit < point)) return {};
  return column.substr(0, unit) + "_goal" + column.substr(unit);
}

/// Range of a column's values over all runs.
struct ColumnRange {
  bool any = false, is_constant = true, are_equal = true;
  double first = 0;
};

ColumnRange range_of(const std::vector<RunResults>& runs, const std::string& column) {
  ColumnRange out;
  const std::vector<double>* model = nullptr;
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (const RunResults& run : runs) {
    const std::vector<double>* values = run.metrics.find(column);
    if (values == nullptr) continue;
    for (const double v : *values) {
      if (std::isnan(v)) continue;
      if (!out.any) out.first = v;
      out.any = true;
      out.is_constant = out.is_constant && v == out.first;
    }
    if (model != nullptr)
      out.are_equal = out.are_equal && std::equal(model->begin(), model->end(), values->begin(),
                                                  values->end(), same);
    model = values;
  }
  return out;
}

void add_curves(const ReportContent& content, const std::string& column, bool is_target,
                Chart* chart) {
  for (const RunResults& run : content.runs) {
    const std::vector<double>* times = run.metrics.find("time_s");
    const std::vector<double>* values = run.metrics.find(column);
    if (times == nullptr || values == nullptr) continue;
    chart->curves.push_back(
        {is_target ? run.label + ", commanded" : run.label, *times, *values, run.color, is_target});
  }
}

double last_time(const ReportContent& content) {
  double last = 0;
  for (const RunResults& run : content.runs)
    if (const std::vector<double>* times = run.metrics.find("time_s"))
      for (const double t : *times)
        if (t > last) last = t;
  return last;
}

}  // namespace

namespace {

std::string time_text(double t) { return fmt::format("{:.3f}", t); }

std::string time_label(double t) {
  return fmt::format("<div class=\"time\">{} s</div>", time_text(t));
}

}  // namespace

std::string pictures_section(const ReportContent& content) {
  if (content.strips.empty()) return {};
  std::string out = "<h2>The same instants</h2>";
  for (const PictureStrip& strip : content.strips) {
    out += fmt::format(
        "<h3>Camera {}</h3><div class=\"strip\" style=\"grid-template-columns:minmax(70px,110px) "
        "repeat({},1fr)\"><div></div>",
        html_text(strip.camera), strip.instants.size());
    for (const double t : strip.instants) out += time_label(t);
    for (const PictureStrip::Row& row : strip.rows) {
      const RunResults& run = content.runs[row.run];
      out += "<div class=\"row\">" + run_tag(run) + "</div>";
      for (size_t i = 0; i < row.pictures.size(); ++i) {
        const StripPicture& picture = row.pictures[i];
        if (picture.data_uri.empty()) {
          out += "<div class=\"gap\">none</div>";
          continue;
        }
        const std::string own = time_label(picture.time);
        out += fmt::format(
            "<div><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}, {} at {} s\">{}</div>",
            picture.data_uri, picture.width, picture.height, html_text(run.label),
            html_text(strip.camera), time_text(picture.time),
            own == time_label(strip.instants[i]) ? "" : own);
      }
    }
    out += "</div>";
  }
  return out;
}

std::string curves_section(const ReportContent& content) {
  const std::vector<std::string> columns = column_names(content.runs);
  const double end = last_time(content);
  std::string charts, constants;
  size_t count = 0, beyond = 0;
  for (const std::string& column : columns) {
    if (column.find("_goal_") != std::string::npos) {
      std::string measured = column;
      measured.erase(measured.rfind("_goal_"), 5);
      if (std::find(columns.begin(), columns.end(), measured) != columns.end()) continue;
    }
    const MetricName name = split_metric_name(column);
    const ColumnRange range = range_of(content.runs, column);
    const std::string goal = goal_column(column);
    const bool has_goal = std::find(columns.begin(), columns.end(), goal) != columns.end();
    const std::string full = (name.subject.empty() ? "" : name.subject + " ") + name.text;
    if (!range.any) continue;
    if (range.is_constant && !has_goal) {
      constants += fmt::format("{}{} {}{}", constants.empty() ? "" : "; ", html_text(full),
                               short_number(range.first),
                               name.unit.empty() ? "" : " " + html_text(name.unit));
      continue;
    }
    if (count == kMostCharts) {
      ++beyond;
      continue;
    }
    ++count;
    Chart chart;
    chart.title = full;
    if (content.runs.size() > 1 && range.are_equal) chart.title += " (equal in all runs)";
    chart.x_label = "time [s]";
    chart.y_label = name.unit.empty() ? "" : "[" + name.unit + "]";
    chart.x_low = 0;
    chart.x_high = end;
    if (has_goal) add_curves(content, goal, true, &chart);
    add_curves(content, column, false, &chart);
    charts += chart_svg(chart);
  }
  if (charts.empty() && constants.empty()) return {};
  std::string out = "<h2>Over time</h2>" + legend(content);
  if (charts.find("class=\"target") != std::string::npos)
    out += "<p class=\"soft\">Dotted: commanded.</p>";
  out += "<div class=\"charts\">" + charts + "</div>";
  if (!constants.empty())
    out += "<p class=\"soft\">Constant and equal in all runs: " + constants + ".</p>";
  if (beyond > 0)
    out += fmt::format("<p class=\"note\">{} more columns are in metrics.csv.</p>", beyond);
  return out;
}

std::string ground_section(const ReportContent& content) {
  std::string charts;
  for (const std::string& column : column_names(content.runs)) {
    if (!column.ends_with(".x_m")) continue;
    const std::string subject = column.substr(0, column.size() - 4);
    Chart chart;
    chart.title = subject;
    chart.x_label = "x [m]";
    chart.y_label = "y [m]";
    chart.equal_scale = true;
    chart.height = 380;
    bool moves = false;
    for (const RunResults& run : content.runs) {
      const std::vector<double>* x = run.metrics.find(column);
      const std::vector<double>* y = run.metrics.find(subject + ".y_m");
      if (x == nullptr || y == nullptr) continue;
      chart.curves.push_back({run.label, *x, *y, run.color, false});
      for (size_t i = 1; i < std::min(x->size(), y->size()); ++i)
        moves = moves || std::hypot((*x)[i] - (*x)[0], (*y)[i] - (*y)[0]) > 0.01;
    }
    if (moves) charts += chart_svg(chart);
  }
  if (charts.empty()) return {};
  return "<h2>From above</h2>" + legend(content) + "<div class=\"charts\">" + charts +
         "</div><p class=\"soft\">Circle: start. Square: end. Equal scales.</p>";
}

}  // namespace gloam
