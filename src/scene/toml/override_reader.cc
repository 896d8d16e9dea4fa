#include "scene/toml/override_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/mjcf/toml_value.h"
#include "scene/overrides.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace {

class OverrideReader {
 public:
  OverrideReader(const std::string& file, std::vector<OverrideOptions>* out)
      : file_(file), out_(out) {}

  Status read_robot(const std::string& robot, const toml::node& node, const SourceLoc& loc) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return wanted(fmt::format("[override.{}.TAG]", robot), loc);
    for (const auto& [key, below] : *table)
      GLOAM_TRY_STATUS(read_tag(robot, std::string(key.str()), below, loc_of(key, file_)));
    return {};
  }

  Error wanted(const std::string& what, const SourceLoc& loc) const {
    return {ErrorKind::kInput, "an override must be a table", loc, "write " + what};
  }

 private:
  Status read_tag(const std::string& robot, const std::string& tag, const toml::node& node,
                  const SourceLoc& loc) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return wanted(fmt::format("[override.{}.{}.\"NAME\"]", robot, tag), loc);
    const std::vector<const MjcfElement*> elements = overridden_elements(tag);
    const bool once = !elements.empty() && is_once(*elements[0]);
    OverrideOptions override{.robot = robot, .tag = tag};
    override.loc = loc;
    if (elements.empty()) return check_override(override);  // suggests the nearest one
    for (const auto& [key, below] : *table) {
      const std::string name(key.str());
      override.loc = loc_of(key, file_);
      if (once && below.is_table()) {
        GLOAM_TRY_STATUS(read_tag(robot, tag + "/" + name, below, override.loc));
      } else if (once) {
        GLOAM_TRY_STATUS(read_value(override, name, below));
      } else if (const toml::table* attributes = below.as_table()) {
        override.pattern = name;
        for (const auto& [attribute, value] : *attributes) {
          override.loc = loc_of(attribute, file_);
          GLOAM_TRY_STATUS(read_value(override, std::string(attribute.str()), value));
        }
      } else {
        return wanted(fmt::format("[override.{}.{}.\"NAME\"]", robot, tag), override.loc);
      }
    }
    return {};
  }

  Status read_value(OverrideOptions override, const std::string& attribute,
                    const toml::node& node) {
    const std::optional<std::string> text = mjcf_text(node);
    override.attribute = attribute;
    override.value = text.value_or("");
    if (!text)
      return Error{
          ErrorKind::kInput,
          fmt::format("'{}' must be a number, a string, true or false, or an array of these",
                      attribute),
          override.loc};
    out_->push_back(std::move(override));
    return {};
  }

  const std::string& file_;
  std::vector<OverrideOptions>* out_;
};

}  // namespace

Status read_overrides(const toml::table& table, const std::string& file,
                      std::vector<OverrideOptions>* overrides) {
  std::vector<OverrideOptions> read;
  OverrideReader reader(file, &read);
  for (const auto& [robot, node] : table)
    GLOAM_TRY_STATUS(reader.read_robot(std::string(robot.str()), node, loc_of(robot, file)));
  // toml++ sorts keys.
  std::ranges::stable_sort(read, {}, [](const OverrideOptions& override) {
    return std::pair(override.loc.line, override.loc.column);
  });
  overrides->insert(overrides->end(), read.begin(), read.end());
  return {};
}

}  // namespace gloam
