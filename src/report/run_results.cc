#include "report/run_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/hash.h"
#include "base/nesting.h"
#include "record/run_folder.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;
constexpr uint64_t kMostSummaryBytes = 16 << 20;

std::string text_of(const Json& json, const char* key) {
  if (!json.is_object()) return {};
  const auto found = json.find(key);
  if (found == json.end()) return {};
  if (found->is_string()) return found->get<std::string>();
  return found->is_number() ? found->dump() : std::string();
}

double number_of(const Json& json, const char* key) {
  if (!json.is_object()) return 0;
  const auto found = json.find(key);
  const double value = found != json.end() && found->is_number() ? found->get<double>() : 0;
  return std::isfinite(value) ? value : 0;
}

RunResults::Texts texts_of(const Json& json, const char* key) {
  RunResults::Texts out;
  if (const auto found = json.find(key); found != json.end() && found->is_object())
    for (const auto& [name, value] : found->items())
      if (value.is_string() || value.is_number() || value.is_boolean())
        out.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
  return out;
}

RunResults::Numbers numbers_of(const Json& json, const char* key) {
  RunResults::Numbers out;
  if (const auto found = json.find(key); found != json.end() && found->is_object())
    for (const auto& [name, value] : found->items())
      if (value.is_number() && std::isfinite(value.get<double>()))
        out.emplace_back(name, value.get<double>());
  return out;
}

std::vector<RunResults::Camera> cameras_of(const Json& json) {
  std::vector<RunResults::Camera> out;
  const auto found = json.find("cameras");
  if (found == json.end() || !found->is_array()) return out;
  for (const Json& one : *found) {
    RunResults::Camera camera{text_of(one, "name"), text_of(one, "folder"),
                              static_cast<int64_t>(std::clamp(number_of(one, "frames"), 0.0, 1e9))};
    // A folder is a plain name: a summary cannot lead elsewhere.
    if (!camera.folder.empty() && camera.folder == safe_file_name(camera.folder))
      out.push_back(std::move(camera));
  }
  return out;
}

std::string without_number(const std::string& label) {
  const size_t last = label.find_last_not_of("0123456789");
  if (last == std::string::npos || last + 1 == label.size()) return label;
  const std::string stem = label.substr(0, last + 1);
  const size_t end = stem.find_last_not_of("-_ .");
  return end == std::string::npos || end + 1 == stem.size() ? label : stem.substr(0, end + 1);
}

// The last `parts` names of a path.
std::string path_end(const fs::path& folder, size_t parts) {
  std::vector<std::string> names;
  for (const fs::path& part : folder.lexically_normal())
    if (!part.empty() && part != "." && part != "/") names.push_back(part.string());
  std::string out;
  for (size_t i = names.size() - std::min(parts, names.size()); i < names.size(); ++i)
    out += (out.empty() ? "" : "/") + names[i];
  return out.empty() ? folder.string() : out;
}

// Digest of where robots were, or of the state at the end; "" = nothing is known, or nothing moves.
std::string motion_of(const RunResults& run) {
  constexpr const char* kEndings[] = {".x_m",      ".y_m",       ".z_m",
                                      ".roll_rad", ".pitch_rad", ".yaw_rad"};
  std::string digest;
  bool moves = false;
  for (size_t i = 0; i < run.metrics.columns.size(); ++i) {
    const std::string& column = run.metrics.columns[i];
    const std::vector<double>& values = run.metrics.values[i];
    if (std::none_of(std::begin(kEndings), std::end(kEndings),
                     [&](const char* ending) { return column.ends_with(ending); }))
      continue;
    moves = moves || std::any_of(values.begin(), values.end(),
                                 [&](double v) { return v != values.front(); });
    digest += fmt::format("{} {:016x} ", column,
                          hash_bytes(values.data(), values.size() * sizeof(double)));
  }
  if (moves) return digest;
  return run.final_hash.empty() ? "" : fmt::format("{} {}", run.final_hash, run.steps);
}

}  // namespace

double RunResults::result(const std::string& name) const {
  for (const auto& [own, value] : results)
    if (own == name) return value;
  return std::numeric_limits<double>::quiet_NaN();
}

Result<RunResults> read_run_results(const fs::path& folder, std::vector<Error>* problems) {
  const fs::path summary = folder / kSummaryName;
  std::error_code code;
  if (!fs::is_directory(folder, code))
    return Error{ErrorKind::kInput,
                 "is not a results folder",
                 {folder.string(), 0, 0},
                 "create one with gloam run FILE --out FOLDER or, from a log, gloam replay LOG "
                 "--out FOLDER"};
  GLOAM_TRY(const std::string text, read_text_file(summary, kMostSummaryBytes));
  const Json json = parse_bounded<Json>(text);
  if (!json.is_object() || !text_of(json, "format").starts_with("gloam-run "))
    return Error{ErrorKind::kInput, "is not the summary of a Gloam run", {summary.string(), 0, 0}};
  RunResults run;
  run.folder = folder;
  run.title = text_of(json, "title");
  run.state = text_of(json, "state");
  run.exit_reason = text_of(json, "exit_reason");
  run.seed = text_of(json, "seed");
  run.final_hash = text_of(json, "final_state_hash");
  if (const auto scene = json.find("scene"); scene != json.end()) {
    run.scene_file = text_of(*scene, "file");
    run.scene_hash = text_of(*scene, "hash");
  }
  run.versions = texts_of(json, "versions");
  run.settings = texts_of(json, "settings");
  run.drawn = texts_of(json, "drawn");
  run.simulated = number_of(json, "simulated_s");
  run.planned = number_of(json, "planned_s");
  run.steps = static_cast<int64_t>(std::clamp(number_of(json, "steps"), 0.0, 1e15));
  run.results = numbers_of(json, "results");
  run.timings = numbers_of(json, "timings_s");
  run.cameras = cameras_of(json);
  if (const fs::path table = folder / "metrics.csv"; fs::exists(table, code)) {
    auto read = read_metric_table(table);
    if (read.ok())
      run.metrics = std::move(*read);
    else
      problems->push_back(read.error());
  }
  return run;
}

void label_runs(std::vector<RunResults>* runs) {
  for (size_t i = 0; i < runs->size(); ++i) {
    RunResults& run = (*runs)[i];
    run.color = static_cast<int>(i);
    for (size_t parts = 1; parts <= 32; ++parts) {
      run.label = path_end(run.folder, parts);
      size_t alike = 0;
      for (const RunResults& other : *runs)
        alike += path_end(other.folder, parts) == run.label ? 1 : 0;
      if (alike == 1) break;
    }
  }
}

std::vector<RunGroup> group_runs(const std::vector<RunResults>& runs) {
  std::vector<RunGroup> groups;
  std::map<std::string, size_t> known;
  for (size_t i = 0; i < runs.size(); ++i) {
    const RunResults& run = runs[i];
    std::string key = run.scene_file + "\n" + run.scene_hash + "\n" + without_number(run.label);
    for (const auto& [name, value] : run.settings) key += "\n" + name + "=" + value;
    const auto [at, is_new] = known.try_emplace(key, groups.size());
    if (is_new) groups.push_back({without_number(run.label), {}});
    groups[at->second].runs.push_back(i);
  }
  for (RunGroup& group : groups)
    if (group.runs.size() == 1) group.label = runs[group.runs[0]].label;
  return groups;
}

std::vector<RunGroup> same_motions(const std::vector<RunResults>& runs) {
  std::map<std::string, RunGroup> by_motion;
  for (size_t i = 0; i < runs.size(); ++i) {
    const std::string motion = motion_of(runs[i]);
    if (!motion.empty()) by_motion[motion].runs.push_back(i);
  }
  std::vector<RunGroup> out;
  for (auto& [motion, group] : by_motion) {
    if (group.runs.size() < 2) continue;
    const RunResults& first = runs[group.runs[0]];
    bool same_hash = true;
    for (const size_t i : group.runs)
      same_hash = same_hash && runs[i].final_hash == first.final_hash;
    if (same_hash) group.label = first.final_hash;
    out.push_back(std::move(group));
  }
  return out;
}

}  // namespace gloam
