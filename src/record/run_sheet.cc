#include "record/run_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "record/contact_sheet.h"
#include "render/film/png.h"

namespace gloam {
namespace {

constexpr int kColumns = 5;
constexpr size_t kMaxCameras = 4;
constexpr Rgb8 kCommanded = {168, 178, 191};
constexpr Rgb8 kMeasured[] = {{99, 179, 255}, {255, 176, 84}, {126, 214, 141}, {233, 128, 201}};

/// The kept frames of a camera that are nearest to the columns' times.
std::vector<const Thumbnail*> pick(const std::vector<Thumbnail>& all,
                                   const std::vector<double>& times) {
  std::vector<const Thumbnail*> out;
  for (const double time : times) {
    const Thumbnail* best = nullptr;
    for (const Thumbnail& one : all)
      if (best == nullptr || std::fabs(one.time - time) < std::fabs(best->time - time)) best = &one;
    out.push_back(best);
  }
  return out;
}

/// Times of the columns: evenly over what the first camera with pictures has kept.
std::vector<double> column_times(std::span<const CameraRecorder* const> cameras) {
  for (const CameraRecorder* camera : cameras) {
    const std::vector<Thumbnail>& all = camera->thumbnails();
    if (all.empty()) continue;
    const size_t n = std::min<size_t>(kColumns, all.size());
    std::vector<double> times;
    for (size_t i = 0; i < n; ++i)
      times.push_back(all[n == 1 ? 0 : (i * (all.size() - 1) + (n - 1) / 2) / (n - 1)].time);
    return times;
  }
  return {};
}

/// Every pixel that `color` gives a colour for.
template <class T, class F>
SheetPicture paint(const Thumbnail* thumbnail, const std::vector<T> Thumbnail::* plane, F&& color) {
  SheetPicture out;
  if (thumbnail == nullptr || (thumbnail->*plane).empty()) return out;
  out.width = thumbnail->width;
  out.height = thumbnail->height;
  for (const T value : thumbnail->*plane) {
    const Rgb8 c = color(value);
    out.rgb.insert(out.rgb.end(), c.begin(), c.end());
  }
  return out;
}

bool any_has(const std::vector<const Thumbnail*>& frames, auto Thumbnail::* plane) {
  return std::any_of(frames.begin(), frames.end(),
                     [&](const Thumbnail* t) { return t != nullptr && !(t->*plane).empty(); });
}

SheetRow color_row(const std::string& name, const std::vector<const Thumbnail*>& frames) {
  SheetRow row{.label = name, .detail = "colour"};
  for (const Thumbnail* frame : frames) {
    const bool has = frame != nullptr && !frame->rgb.empty();
    row.pictures.push_back(has ? SheetPicture{frame->width, frame->height, frame->rgb}
                               : SheetPicture{});
  }
  return row;
}

/// Near is red, far is blue; equal steps of 1/depth, as the eye and a stereo camera resolve them.
SheetRow depth_row(const std::string& name, const std::vector<const Thumbnail*>& frames) {
  std::vector<float> depths;
  for (const Thumbnail* frame : frames)
    for (const float d : frame->depth)
      if (std::isfinite(d) && d > 0) depths.push_back(d);
  if (depths.empty()) depths.push_back(1);
  std::sort(depths.begin(), depths.end());
  const float near = depths[depths.size() / 100],
              far = depths[depths.size() - 1 - depths.size() / 100];
  SheetRow row{.label = name, .detail = "depth"};
  row.bar_low = fmt::format("{:.1f} m", far);
  row.bar_high = fmt::format("{:.1f} m", near);
  const float span = 1 / near - 1 / far;
  for (const Thumbnail* frame : frames)
    row.pictures.push_back(paint(frame, &Thumbnail::depth, [&](float d) {
      if (!std::isfinite(d) || d <= 0) return Rgb8{24, 24, 28};
      return turbo_color(0.06f + 0.88f * (span > 0 ? (1 / d - 1 / far) / span : 0.5f));
    }));
  return row;
}

SheetRow instance_row(const std::string& name, const std::vector<const Thumbnail*>& frames,
                      const std::vector<LabelRow>& labels) {
  std::map<uint32_t, int64_t> area;
  for (const Thumbnail* frame : frames)
    for (const uint32_t id : frame->instance) ++area[id];
  std::map<uint32_t, std::string> names;
  for (const LabelRow& label : labels) names.try_emplace(label.instance, label.instance_name);
  std::vector<std::pair<int64_t, uint32_t>> by_area;
  for (const auto& [id, pixels] : area)
    if (id != 0) by_area.push_back({-pixels, id});
  std::sort(by_area.begin(), by_area.end());
  SheetRow row{.label = name, .detail = "instances"};
  for (const auto& [pixels, id] : by_area)
    row.legend.push_back({label_color(id), names.contains(id) && !names[id].empty()
                                               ? names[id]
                                               : fmt::format("object {}", id)});
  for (const Thumbnail* frame : frames)
    row.pictures.push_back(paint(frame, &Thumbnail::instance, label_color));
  return row;
}

SheetCurve curve_of(const RunInfo& info, const std::vector<std::vector<double>>& rows,
                    const std::string& column) {
  SheetCurve curve;
  const auto found = std::find(info.metric_columns.begin(), info.metric_columns.end(), column);
  if (found == info.metric_columns.end()) return curve;
  const size_t index = static_cast<size_t>(found - info.metric_columns.begin());
  for (const std::vector<double>& row : rows) {
    curve.x.push_back(static_cast<float>(row[0]));
    curve.y.push_back(static_cast<float>(row[index]));
  }
  return curve;
}

std::string subtitle(const RunInfo& info, const RunOutcome& outcome) {
  std::string text = fmt::format("{:.1f} s simulated, {} steps, seed {}", outcome.simulated,
                                 outcome.steps, info.seed);
  for (const auto& [name, value] : info.versions) text += fmt::format(", {} {}", name, value);
  if (!outcome.final_state_hash.empty()) text += ", state " + outcome.final_state_hash;
  if (outcome.exit_reason != "completed") text += ", " + outcome.exit_reason;
  return text;
}

}  // namespace

std::vector<uint8_t> run_sheet_png(const RunInfo& info, const RunOutcome& outcome,
                                   std::span<const CameraRecorder* const> cameras,
                                   const std::vector<std::vector<double>>& rows) {
  ContactSheet sheet;
  sheet.title = info.title;
  sheet.subtitle = subtitle(info, outcome);
  const std::vector<double> times = column_times(cameras);
  for (const double time : times) sheet.columns.push_back(fmt::format("t = {:.2f} s", time));
  const auto shown = cameras.first(std::min(cameras.size(), kMaxCameras));
  for (const CameraRecorder* camera : shown) {
    const std::vector<const Thumbnail*> frames = pick(camera->thumbnails(), times);
    if (any_has(frames, &Thumbnail::rgb))
      sheet.rows.push_back(color_row(camera->camera().name, frames));
  }
  // Depth and instances of one camera are enough to see that they are right.
  for (const CameraRecorder* camera : shown) {
    const std::vector<const Thumbnail*> frames = pick(camera->thumbnails(), times);
    const bool depth = any_has(frames, &Thumbnail::depth);
    const bool instance = any_has(frames, &Thumbnail::instance);
    if (depth) sheet.rows.push_back(depth_row(camera->camera().name, frames));
    if (instance) sheet.rows.push_back(instance_row(camera->camera().name, frames, info.labels));
    if (depth || instance) break;
  }
  for (size_t i = 0; i < info.plots.size() && !rows.empty(); ++i) {
    const MetricPlot& plot = info.plots[i];
    SheetPlot drawn{plot.title, plot.unit, {}};
    SheetCurve commanded = curve_of(info, rows, plot.commanded);
    SheetCurve measured = curve_of(info, rows, plot.measured);
    measured.label = "measured";
    measured.color = kMeasured[i % std::size(kMeasured)];
    commanded.label = "commanded";
    commanded.color = kCommanded;
    commanded.dashed = true;
    if (!measured.x.empty()) drawn.curves.push_back(std::move(measured));
    if (!commanded.x.empty()) drawn.curves.push_back(std::move(commanded));
    if (!drawn.curves.empty()) sheet.plots.push_back(std::move(drawn));
  }
  const Canvas canvas = draw_contact_sheet(sheet);
  return encode_png8(canvas.width(), canvas.height(), 3, canvas.pixels());
}

}  // namespace gloam
