#include <atomic>
#include <map>

#include "base/parallel.h"
#include "gloam/mjcf.h"
#include "scene/mjcf/spec_table.h"

namespace gloam::mjcf {
namespace {

// Fields that no attribute sets: from what they follow.
const std::map<std::string_view, std::string_view> kFollowsFrom = {
    {"mjSpec.comment", "the comment at the top of the file"},
    {"mjSpec.modelfiledir", "the folder that the model was read from"},
    {"mjsActuator.type", "the element: <motor>, <position> ..."},
    {"mjsEquality.type", "the element: <connect>, <weld> ..."},
    {"mjsSensor.type", "the element: <gyro>, <touch> ..."},
    {"mjsWrap.type", "the element: <site>, <geom>, <joint>, <pulley>"},
    {"mjsElement.elemtype", "the element"},
    {"mjsPlugin.active", "the element: there is a <plugin>"},
    {"mjsBody.explicitinertial", "the element: there is an <inertial>"},
    {"mjsEquality.objtype", "which attributes are given: body1 or site1"},
    {"mjsTuple.objtype", "objtype of each <element>"},
    {"mjsCompiler.authored", "which attributes are given"},
    {"mjsElement.signature", "the compiler"},
    {"mjsCamera.intrinsic", "the compiler: of sensorsize, focal, principal"},
    {"mjsFlex.size", "the compiler: of the vertices"},
};

std::string_view follows_from(const SpecField& field, const std::string& name) {
  if (field.name == "info") return "where the element was read";
  const auto found = kFollowsFrom.find(name);
  return found == kFollowsFrom.end() ? "" : found->second;
}

}  // namespace

SchemaCoverage find_schema_coverage(const std::function<bool(double)>& progress) {
  struct Row {
    const MjcfElement* element;
    const MjcfAttribute* attribute;
    AttributeEffect effect = {};
  };
  std::vector<Row> rows;
  for (const bool spec_only : {false, true}) {
    for (const MjcfElement& element : MjcfSchema::get().elements()) {
      for (const MjcfAttribute& attribute : element.attributes) {
        if (attribute.is_spec_only() == spec_only) rows.push_back({&element, &attribute});
      }
    }
  }
  std::atomic<int> done = 0;
  std::atomic<bool> goes_on = true;
  parallel_for("schema coverage", static_cast<int64_t>(rows.size()), [&](int64_t i) {
    if (!goes_on) return;
    Row& row = rows[static_cast<size_t>(i)];
    row.effect = find_effect(*row.element, *row.attribute);
    if (progress && !progress(++done / static_cast<double>(rows.size()))) goes_on = false;
  });

  SchemaCoverage coverage;
  coverage.elements = static_cast<int>(MjcfSchema::get().elements().size());
  std::map<std::string, std::vector<std::string>> set_by;
  for (const Row& row : rows) {
    const std::string name =
        std::string(row.element->path) + "/" + std::string(row.attribute->name);
    coverage.attributes.push_back({name, row.effect.is_read, row.attribute->is_spec_only(),
                                   row.effect.is_read ? "" : row.effect.complaint,
                                   row.effect.fields});
    for (const std::string& field : row.effect.fields) set_by[field].push_back(name);
  }
  for (const SpecField& field : spec_fields()) {
    if (field.type == SpecType::kHandle || field.type == SpecType::kStruct) continue;
    const std::string name = std::string(field.owner) + "." + std::string(field.name);
    SchemaCoverage::Field row{name, set_by[name], ""};
    if (row.attributes.empty()) row.follows_from = follows_from(field, name);
    coverage.fields.push_back(std::move(row));
  }
  return coverage;
}

}  // namespace gloam::mjcf
