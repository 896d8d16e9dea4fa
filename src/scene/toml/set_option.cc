#include <fmt/format.h>

#include "scene/toml/option_walker.h"
#include "scene/toml/override_reader.h"
#include "scene/toml/table_reader.h"
#include "scene/validate/validate.h"

namespace gloam {
namespace {

// Reads the value as the file's reader would.
struct OptionSetter {
  static constexpr bool kNeedsOne = true;
  const toml::node& value;
  const std::string& where;
  Status* status;

  template <class T>
  void operator()(const std::string& /*path*/, std::string_view key, T& member,
                  const FieldRule& rule) {
    toml::table table;
    table.insert_or_assign(key, value);
    TableReader(table, where, "an option", status)(key, member, rule);
  }
};

}  // namespace

std::vector<std::string> split_option_path(std::string_view path) {
  std::vector<std::string> names(1);
  bool quoted = false;
  for (const char c : path) {
    if (c == '"')
      quoted = !quoted;
    else if (c == '.' && !quoted)
      names.emplace_back();
    else
      names.back() += c;
  }
  return names;
}

Status set_option(Scene& scene, std::string_view path, std::string_view toml_value) {
  const std::string where = fmt::format("option '{}'", path);
  const std::vector<std::string> names = split_option_path(path);
  Result<toml::table> parsed = parse_toml(fmt::format("value = {}", toml_value), where);
  toml::table bare_word;
  if (!parsed.ok() || parsed->size() != 1) {
    bare_word.insert_or_assign("value", std::string(toml_value));  // a string without its quotes
    parsed = std::move(bare_word);
  }
  Scene changed = scene;
  Status status;
  if (names[0] == "override") {
    // Its keys are names and patterns, which may be quoted: TOML reads them as in a file.
    GLOAM_TRY(const toml::table line, parse_toml(fmt::format("{} = {}", path, toml_value), where));
    if (const toml::table* table = line["override"].as_table())
      status = read_overrides(*table, where, &changed.overrides);
    else
      status = Error{ErrorKind::kUsage,
                     "'override' is incomplete",
                     {where, 0, 0},
                     "as in override.ROBOT.joint.NAME.damping"};
  } else {
    OptionSetter setter{*parsed->get("value"), where, &status};
    walk_options(names, {where, 0, 0}, &changed, &setter, &status);
  }
  if (status.ok()) status = validate_scene(changed);
  if (!status.ok()) {
    Error error = status.error();
    // The value came from the command line, where lines and columns mean nothing.
    if (error.loc.file == where) error.loc = {where, 0, 0};
    error.kind = ErrorKind::kUsage;
    return error;
  }
  scene = std::move(changed);
  return {};
}

}  // namespace gloam
