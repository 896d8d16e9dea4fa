#include <fmt/format.h>

#include <toml++/toml.h>

#include "gloam/controller.h"

namespace gloam {

Result<std::vector<double>> controller_param(const ControllerOptions& options,
                                             std::string_view key) {
  std::vector<double> numbers;
  if (options.params.text.empty()) return numbers;
  const auto fault = [&](std::string_view what) {
    return Error{ErrorKind::kInput, fmt::format("'params' of a controller: {}", what), options.loc,
                 "use a table of numbers, as in params = { gain = 2.5, offset = [0, 0.1] }"};
  };
  toml::table document;
  try {
    document = toml::parse("params = " + options.params.text);
  } catch (const toml::parse_error&) {
    return fault("not a table");
  }
  const toml::table* table = document["params"].as_table();
  if (table == nullptr) return fault("not a table");
  const toml::node* node = table->get(key);
  if (node == nullptr) return numbers;
  const auto add = [&](const toml::node& one) {
    const auto number = one.value<double>();
    if (number) numbers.push_back(*number);
    return number.has_value();
  };
  bool ok = true;
  if (const toml::array* array = node->as_array())
    for (const toml::node& one : *array) ok = ok && add(one);
  else
    ok = add(*node);
  if (!ok) return fault(fmt::format("'{:.80}' is not a number", key));
  return numbers;
}

}  // namespace gloam
