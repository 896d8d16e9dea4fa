// Operator: options of the scene and live fields of its model.

#include <fmt/format.h>

#include <algorithm>

#include "bridge/operations/operator_private.h"
#include "gloam/program.h"

namespace gloam::bridge {
namespace {

// The files that options name must be those that the scene itself could name.
Status check_files(Scene scene, const ModelSource& source) {
  std::erase_if(scene.robots, [&](const RobotOptions& o) { return source.is_own(o.file); });
  std::erase_if(scene.overrides, [&](const OverrideOptions& o) {
    return o.robot != "environment" &&
           std::ranges::find(scene.robots, o.robot, &RobotOptions::name) == scene.robots.end();
  });
  if (scene.bare_model.empty()) {
    // A scene must hold something.
    scene.props.push_back({.name = "check_of_files", .kind = prop_kinds().front().kind});
  } else if (scene.file.empty()) {
    scene.file = scene.bare_model;
  }
  const Result<Scene> read = overlay_scene(scene, "", "options");
  return read.ok() ? Status() : Status(read.error());
}

}  // namespace

bool is_fixed_option(std::string_view path) {
  constexpr std::string_view kFixedOptions[] = {"sim",    "record", "bridge", "randomize",
                                                "metric", "goal",   "scene"};
  const std::string_view table = path.substr(0, path.find('.'));
  return std::ranges::find(kFixedOptions, table) != std::end(kFixedOptions);
}

std::vector<OptionInfo> Operator::options() const {
  return list_options(written_scene(simulation_.world()));
}

Result<std::string> Operator::option(std::string_view path) const {
  return get_option(written_scene(simulation_.world()), path);
}

Status Operator::set_options(const std::vector<std::pair<std::string, std::string>>& values) {
  Private& p = *private_;
  GLOAM_TRY_STATUS(p.need_world());
  const std::lock_guard one_at_a_time(p.change_mutex);
  Scene scene = written_scene(simulation_.world());
  for (const auto& [path, value] : values) {
    if (is_fixed_option(path))
      return Error{
          ErrorKind::kUnsupported,
          fmt::format("'{:.200}' is fixed during a run and cannot be changed by clients", path)};
    GLOAM_TRY_STATUS(set_option(scene, path, value));
  }
  GLOAM_TRY_STATUS(check_files(scene, p.source));
  return p.exchange(scene);
}

Result<std::vector<double>> Operator::live_field(std::string_view name) const {
  GLOAM_TRY(const LiveFieldId id, find_live_field(name));
  const std::lock_guard lock(private_->solved_mutex);
  GLOAM_TRY_STATUS(private_->solve());
  return private_->solved->instant.value(live_field_array(id));
}

Status Operator::set_live_field(std::string_view name, int first, std::vector<double> values) {
  GLOAM_TRY(const LiveFieldId id, find_live_field(name));
  return simulation_.post({.what = SetLiveField{id, first, std::move(values)}});
}

Status Operator::recompile(std::string_view toml) {
  Private& p = *private_;
  GLOAM_TRY_STATUS(p.need_world());
  const Scene first = p.first_scene();
  std::error_code code;
  const std::filesystem::path folder = first.file.empty()
                                           ? std::filesystem::current_path(code)
                                           : std::filesystem::absolute(first.file).parent_path();
  GLOAM_TRY(const Scene parsed, parse_scene(toml, folder, first.access));
  const Scene scene = p.without_access(parsed);
  const std::lock_guard one_at_a_time(p.change_mutex);
  GLOAM_TRY_STATUS(p.exchange(scene));
  return {};
}

}  // namespace gloam::bridge
