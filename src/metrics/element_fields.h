#pragma once
// Fields of MuJoCo's elements that expressions can name: a field is a row of a table.

#include <span>
#include <string_view>

#include "metrics/quantities.h"

namespace gloam {

struct ElementField {
  std::string_view name;
  int width;
  void (*read)(const MetricInstant& instant, const QuantityReader& self, double* out);
};

struct ElementKind {
  std::string_view word;  ///< "body"
  mjtObj type;
  mjtSize mjModel::* count;
  std::span<const ElementField> fields;
};

/// body, joint, actuator, site, geom, tendon.
std::span<const ElementKind> element_kinds();
/// Numbers of the scene: time, step …
std::span<const ElementField> scene_numbers();
/// count, force, depth of contacts; QuantityReader::a and b tell of which.
std::span<const ElementField> contact_fields();
/// The fields of bodies, which robot.FIELD has, too.
std::span<const ElementField> body_fields();

}  // namespace gloam
