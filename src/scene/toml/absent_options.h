#pragma once
// Options that a table's type does not have (FieldRule::not_of), for the readers of options.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "gloam/result.h"
#include "scene/options/field_rule.h"

namespace gloam {

class AbsentOptions {
 public:
  void note(std::string_view key, const FieldRule& rule) {
    keys_.emplace_back(key);
    type_ = rule.not_of;
  }
  /// Error with the nearest of the `known` options of the type; none if `key` has not been noted.
  Status error(std::string_view key, const std::vector<std::string>& known, SourceLoc loc) const {
    if (std::ranges::find(keys_, key) == keys_.end()) return {};
    return Error{ErrorKind::kInput, fmt::format("'{}' has no '{}'", type_, key), std::move(loc),
                 suggest_name(std::string(key), known)};
  }

 private:
  std::vector<std::string> keys_;
  std::string type_;
};

}  // namespace gloam
