#include <fmt/format.h>

#include <charconv>

#include "scene/toml/table_reader.h"
#include "scene/validate.h"

namespace gloam {
namespace {

template <class T>
concept OptionStruct = requires(TableReader& v, T& o) { visit_fields(v, o); };

// Walks down the path one name at a time; the last one is read by the same reader as the file.
class OptionSetter {
 public:
  OptionSetter(std::vector<std::string> names, size_t depth, const toml::node& value,
               const std::string& where, Status* status)
      : names_(std::move(names)), depth_(depth), value_(value), where_(where), status_(status) {}

  template <class T>
  void operator()(std::string_view key, T& member, const FieldRule& rule) {
    known_.emplace_back(key);
    if (found_ || names_[depth_] != key) return;
    found_ = true;
    set(key, member, rule, depth_ + 1);
  }

  void finish() {
    if (found_ || !status_->ok()) return;
    *status_ = usage(fmt::format("unknown option '{}'", names_[depth_]),
                     suggest_name(names_[depth_], known_));
  }

 private:
  Error usage(std::string message, std::string hint = {}) const {
    return {ErrorKind::kUsage, std::move(message), {where_, 0, 0}, std::move(hint)};
  }

  template <class T>
  void set(std::string_view key, T& member, const FieldRule& rule, size_t next) {
    if constexpr (OptionStruct<T>) {
      if (next < names_.size()) return descend(member, next);
    }
    if (next < names_.size()) {
      *status_ = usage(fmt::format("'{}' has no option '{}'", key, names_[next]));
      return;
    }
    assign(key, member, rule);
  }

  // A table that may be left out comes into being with its first option.
  template <OptionStruct T>
  void set(std::string_view key, std::optional<T>& member, const FieldRule& rule, size_t next) {
    if (next >= names_.size()) return assign(key, member, rule);
    if (!member) member.emplace();
    descend(*member, next);
  }

  template <class T>
  void assign(std::string_view key, T& member, const FieldRule& rule) {
    toml::table table;
    table.insert_or_assign(key, value_);
    TableReader(table, where_, "an option", status_)(key, member, rule);
  }

  template <OptionStruct T>
  void set(std::string_view key, std::vector<T>& members, const FieldRule& rule, size_t next) {
    if (next >= names_.size()) return assign(key, members, rule);
    if (next + 1 >= names_.size()) {
      *status_ = usage(fmt::format("'{}' needs a name or number and an option", key),
                       fmt::format("as in {}.0.{}", key, "name"));
      return;
    }
    const std::string& which = names_[next];
    size_t index = members.size();
    std::from_chars(which.data(), which.data() + which.size(), index);
    std::vector<std::string> present;
    if constexpr (requires { members[0].name; }) {
      for (size_t i = 0; i < members.size(); ++i) {
        present.push_back(members[i].name);
        if (members[i].name == which) index = i;
      }
    }
    if (index >= members.size()) {
      *status_ =
          usage(fmt::format("there is no {} '{}'", key, which), suggest_name(which, present));
      return;
    }
    descend(members[index], next + 1);
  }

  template <class T>
  void descend(T& options, size_t depth) {
    OptionSetter inner(names_, depth, value_, where_, status_);
    visit_fields(inner, options);
    inner.finish();
  }

  std::vector<std::string> names_;
  size_t depth_;
  const toml::node& value_;
  const std::string& where_;
  Status* status_;
  std::vector<std::string> known_;
  bool found_ = false;
};

}  // namespace

Status set_option(Scene& scene, std::string_view path, std::string_view toml_value) {
  const std::string where = fmt::format("option '{}'", path);
  std::vector<std::string> names;
  for (size_t begin = 0; begin <= path.size();) {
    const size_t end = std::min(path.find('.', begin), path.size());
    names.emplace_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  Result<toml::table> parsed = parse_toml(fmt::format("value = {}", toml_value), where);
  toml::table bare_word;
  if (!parsed.ok() || parsed->size() != 1) {
    bare_word.insert_or_assign("value", std::string(toml_value));  // a string without its quotes
    parsed = std::move(bare_word);
  }
  Scene changed = scene;
  SceneHeader header{scene.name};
  Status status;
  if (names[0] == "override") {
    // Its keys are names and patterns, which may be quoted: TOML reads them as in a file.
    GLOAM_TRY(const toml::table line, parse_toml(fmt::format("{} = {}", path, toml_value), where));
    if (const toml::table* table = line["override"].as_table())
      status = read_overrides(*table, where, &changed.overrides);
    else
      status = Error{ErrorKind::kUsage,
                     "'override' needs more",
                     {where, 0, 0},
                     "as in override.ROBOT.joint.NAME.damping"};
  } else {
    OptionSetter setter(names, 0, *parsed->get("value"), where, &status);
    visit_tables(setter, header, changed);
    setter.finish();
  }
  if (status.ok()) {
    changed.name = header.name;
    status = validate_scene(changed);
  }
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
