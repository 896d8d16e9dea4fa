// Options of a controller as text, for Commands that set one.

#include <fmt/format.h>

#include <sstream>

#include "gloam/controller.h"
#include "scene/toml/table_reader.h"
#include "scene/toml/table_writer.h"

namespace gloam {

std::string to_toml(const ControllerOptions& options) {
  ControllerOptions copy = options;
  std::ostringstream text;
  text << TableWriter::table_of(copy, {});
  return text.str();
}

Result<ControllerOptions> parse_controller(std::string_view text) {
  constexpr const char* kWhere = "the controller's options";
  GLOAM_TRY(const toml::table table, parse_toml(text, kWhere));
  ControllerOptions options;
  Status status;
  TableReader reader(table, kWhere, kWhere, &status);
  visit_fields(reader, options);
  reader.refuse_unknown();
  GLOAM_TRY_STATUS(status);
  return options;
}

}  // namespace gloam
