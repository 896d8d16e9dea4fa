#include "scene/toml/toml_reader.h"

#include "base/nesting.h"
#include "scene/toml/table_reader.h"

namespace gloam {

bool exact_rational(double x, Rational* out) {
  constexpr double kLargestDenominator = 10000;
  if (!std::isfinite(x) || std::abs(x) > 1e12) return false;
  // Continued fractions give the best fraction for every size of denominator.
  double p0 = 0, q0 = 1, p1 = 1, q1 = 0, rest = x;
  for (int i = 0; i < 64; ++i) {
    const double whole = std::floor(rest);
    const double p2 = whole * p1 + p0, q2 = whole * q1 + q0;
    if (q2 > kLargestDenominator || std::abs(p2) > 9e15) return false;
    p0 = p1, q0 = q1, p1 = p2, q1 = q2;
    if (p1 / q1 == x) {
      *out = {static_cast<int64_t>(p1), static_cast<int64_t>(q1)};
      return true;
    }
    if (rest == whole) return false;
    rest = 1 / (rest - whole);
  }
  return false;
}

Result<toml::table> parse_toml(std::string_view text, const std::string& file) {
  GLOAM_TRY_STATUS(check_excess(toml_excess(text), text, file));
  try {
#if TOML_EXCEPTIONS
    return toml::parse(text, file);
#else
    toml::parse_result parsed = toml::parse(text, file);
    if (!parsed) throw parsed.error();
    return std::move(parsed).table();
#endif
  } catch (const toml::parse_error& error) {
    std::string message(error.description());
    for (char& c : message) {
      if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    }
    return Error{ErrorKind::kInput, std::move(message), loc_of(error, file),
                 "this is not valid TOML"};
  }
}

Status read_scene_toml(std::string_view text, const std::string& file, Scene* scene) {
  GLOAM_TRY(const toml::table root, parse_toml(text, file));
  return read_scene_toml(root, file, scene);
}

Status read_scene_toml(const toml::table& root, const std::string& file, Scene* scene) {
  if (root.empty())
    return Error{ErrorKind::kInput,
                 "the file is empty",
                 {file, 0, 0},
                 "a scene needs at least one [[robot]] or an [environment]"};
  Status status;
  SceneHeader header{scene->name};
  TableReader reader(root, file, "a scene file", &status);
  visit_tables(reader, header, *scene);
  reader.refuse_unknown();
  if (status.ok()) scene->name = header.name;
  return status;
}

}  // namespace gloam
