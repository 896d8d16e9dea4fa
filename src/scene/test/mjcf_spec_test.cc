// What MuJoCo's parser makes of each attribute, and the same made of a model that is parsed
// already.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "scene/mjcf/spec_kinds.h"
#include "scene/mjcf/spec_table.h"
#include "scene/mjcf/spec_values.h"
#include "scene/mjcf/specimen.h"

namespace gloam {
namespace {

std::string path_of(const MjcfElement& element, const MjcfAttribute& attribute) {
  return std::string(element.path.substr(element.path.find('/') + 1)) + "/" +
         std::string(attribute.name);
}

std::set<std::string> words(std::string_view text) {
  std::set<std::string> list;
  for (const std::string_view word : split_words(text)) list.emplace(word);
  return list;
}

std::string joined(const std::set<std::string>& list) {
  std::string text;
  for (const std::string& word : list) text += word + "\n";
  return text;
}

Status set_attribute(mjSpec* spec, mjsElement* target, const MjcfElement& element,
                     const MjcfAttribute& attribute, const std::string& value) {
  GLOAM_TRY(const AttributeValue read, AttributeValue::read(element, attribute, value));
  return read.set(spec, target);
}

TEST(MjcfSpec, EveryElementHasASpecimenThatMuJoCoReads) {
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    const mjcf::Specimen specimen = mjcf::make_specimen(element);
    EXPECT_EQ(specimen.element.path(), element.path);
    const Result<mjcf::OwnedSpec> spec = mjcf::parse_document(specimen.document);
    EXPECT_TRUE(spec.ok()) << element.path << ": " << spec.error().to_string() << "\n"
                           << specimen.document.to_xml();
  }
}

// "1 0 ... 0" as the numbers that are written out.
std::string written_out(std::string_view otherwise) {
  return std::string(otherwise.substr(0, otherwise.find(" ...")));
}

// Attributes that the parser takes for more than their value when they are given.
bool says_more_when_given(std::string_view name) {
  return name == "input" ||      // which inputs an actuator has: all that it can, or these
         name == "timeconst" ||  // of a servo without a filter
         name == "relpose";      // all of it, or what the compiler finds
}

// -0 is 0.
std::string unsigned_zeros(std::string text) {
  for (size_t at = 0; (at = text.find("-0 ", at)) != std::string::npos;) text.erase(at, 1);
  return text;
}

// Given or left out, MuJoCo parses the same.
TEST(MjcfSpec, DefaultsOfTheTableAreMuJoCos) {
  int held = 0;
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    for (const MjcfAttribute& attribute : element.attributes) {
      if (attribute.otherwise.empty() || attribute.is_required ||
          attribute.most == MjcfAttribute::kAnyLength ||  // as many as the model asks for
          says_more_when_given(attribute.name))
        continue;
      mjcf::Specimen specimen = mjcf::make_specimen(element, attribute.name);
      ASSERT_TRUE(specimen.element.clear(attribute.name).ok());
      const Result<mjcf::OwnedSpec> without = mjcf::parse_document(specimen.document);
      if (!specimen.element.set(attribute.name, written_out(attribute.otherwise)).ok()) continue;
      const Result<mjcf::OwnedSpec> with = mjcf::parse_document(specimen.document);
      if (!without.ok() || !with.ok()) continue;  // its default fits another size of the element
      ++held;
      std::map<std::string, SpecObject> before, after;
      for (const SpecObject& object : spec_objects(without->get()))
        before.emplace(object.label, object);
      for (const SpecObject& object : spec_objects(with->get()))
        after.emplace(object.label, object);
      ASSERT_EQ(before.size(), after.size()) << path_of(element, attribute);
      for (const auto& [label, object] : after) {
        for (const SpecField& field : spec_fields_of(object.owner)) {
          if (field.name == "info" || field.name == "authored") continue;
          EXPECT_EQ(unsigned_zeros(spec_text(before.at(label), field)),
                    unsigned_zeros(spec_text(object, field)))
              << path_of(element, attribute) << " is " << attribute.otherwise << " by the manual; "
              << label << " " << field.name << " is not what MuJoCo has without it";
        }
      }
    }
  }
  EXPECT_GE(held, 1200);
}

// Attributes that are read and leave nothing in a spec's fields.
constexpr std::string_view kLeaveNothing =
    // Gone with the parser: what is attached, included or replicated is there as if written out.
    "asset/model/content_type asset/model/file asset/model/name body/attach/body body/attach/frame "
    "body/attach/model include/file body/replicate/sep compiler/coordinate default/class "
    // In tables of their own: plugins' settings, the path of a tendon.
    "actuator/plugin/config/key actuator/plugin/config/value asset/mesh/plugin/config/key "
    "asset/mesh/plugin/config/value body/flexcomp/plugin/config/key "
    "body/flexcomp/plugin/config/value body/geom/plugin/config/key body/geom/plugin/config/value "
    "body/plugin/config/key body/plugin/config/value extension/plugin/instance/config/key "
    "extension/plugin/instance/config/value extension/plugin/plugin sensor/plugin/config/key "
    "sensor/plugin/config/value tendon/fixed/joint/coef tendon/fixed/joint/joint "
    "tendon/spatial/geom/geom tendon/spatial/geom/sidesite tendon/spatial/pulley/divisor "
    "tendon/spatial/site/site "
    // Count only beside others, which their specimens have not.
    "actuator/dcmotor/nominal actuator/intvelocity/actlimited actuator/pid/imax asset/mesh/params "
    "body/flexcomp/cellcount body/flexcomp/contact/margin body/flexcomp/edge/solimp "
    "body/flexcomp/edge/solref body/flexcomp/file body/flexcomp/mesh body/flexcomp/origin "
    "body/flexcomp/scale body/geom/castshadow default/dcmotor/nominal default/geom/castshadow "
    "default/intvelocity/actlimited default/pid/imax";

TEST(MjcfSpec, EveryAttributeIsReadAndEveryFieldIsMirrored) {
  const mjcf::SchemaCoverage coverage = mjcf::find_schema_coverage();
  EXPECT_EQ(coverage.elements, static_cast<int>(MjcfSchema::get().elements().size()));
  EXPECT_GE(coverage.attributes.size(), 1900U);
  EXPECT_GE(coverage.fields.size(), 464U) << "of MuJoCo 4.0.1; a later one has more";
  std::set<std::string> nothing;
  for (const auto& field : coverage.fields) {
    EXPECT_TRUE(field.is_mirrored())
        << field.name
        << ": no attribute sets it. If a user may: add it to SPEC_ONLY of"
           " generate_schema.py; else say in coverage.cc what it follows from";
    EXPECT_TRUE(field.attributes.empty() || field.follows_from.empty()) << field.name;
  }
  for (const auto& attribute : coverage.attributes) {
    EXPECT_TRUE(attribute.is_mirrored)
        << attribute.name << ": no value of it is read; " << attribute.complaint;
    if (attribute.fields.empty())
      nothing.insert(attribute.name.substr(attribute.name.find('/') + 1));
  }
  EXPECT_EQ(joined(nothing), joined(words(kLeaveNothing)));
}

// Parts of elements (bones, layers, wraps), and what ceases to be with the parser.
constexpr std::string_view kOnlyInFiles = R"(
actuator/dcmotor/nominal actuator/intvelocity/actlimited actuator/pid/imax
asset/material/layer/role asset/material/layer/texture asset/mesh/params asset/model/content_type
asset/model/name asset/skin/bone/bindpos asset/skin/bone/bindquat asset/skin/bone/body
asset/skin/bone/vertid asset/skin/bone/vertweight body/attach/body body/attach/frame
body/attach/model body/attach/prefix
body/geom/castshadow body/replicate/count body/replicate/euler body/replicate/offset
body/replicate/sep compiler/coordinate custom/tuple/element/objname custom/tuple/element/objtype
custom/tuple/element/prm deformable/skin/bone/bindpos deformable/skin/bone/bindquat
deformable/skin/bone/body deformable/skin/bone/vertid deformable/skin/bone/vertweight
sensor/frameangvel/reftype sensor/framelinvel/reftype sensor/framepos/reftype
sensor/framequat/reftype sensor/framexaxis/reftype sensor/frameyaxis/reftype
sensor/framezaxis/reftype tendon/fixed/joint/coef tendon/fixed/joint/joint
tendon/spatial/geom/geom tendon/spatial/geom/sidesite tendon/spatial/pulley/divisor
tendon/spatial/site/site
)";

TEST(MjcfSpec, SettingAfterwardsIsTheSameAsWritingItInTheFile) {
  std::set<std::string> different;
  int same = 0;
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    const mjtObj type = object_of(element);
    // Classes, plugins and flexcomps make no element of their own.
    if (element.path.find("plugin") != std::string_view::npos ||
        element.path.starts_with("mujoco/default") ||
        element.path.find("flexcomp") != std::string_view::npos)
      continue;
    for (const MjcfAttribute& attribute : element.attributes) {
      int tried = 0;
      for (const std::string& value : mjcf::values_to_try(attribute)) {
        mjcf::Specimen specimen = mjcf::make_specimen(element, attribute.name);
        const Result<mjcf::OwnedSpec> later = mjcf::parse_document(specimen.document);
        if (!later.ok() || !specimen.element.set(attribute.name, value).ok()) continue;
        const Result<mjcf::OwnedSpec> written = mjcf::parse_document(specimen.document);
        if (!written.ok()) continue;
        mjsElement* target = type == mjOBJ_UNKNOWN
                                 ? nullptr
                                 : mjs_findElement(later->get(), type, mjcf::kSpecimenName);
        ASSERT_TRUE(type == mjOBJ_UNKNOWN || target != nullptr) << element.path;
        const Status status = set_attribute(later->get(), target, element, attribute, value);
        std::vector<SpecDifference> difference = spec_difference(later->get(), written->get());
        std::erase_if(difference,
                      [](const SpecDifference& d) { return d.field.ends_with(".info"); });
        if (!status.ok() || !difference.empty()) different.insert(path_of(element, attribute));
        if (status.ok() && difference.empty()) ++same;
        if (++tried == 2) break;
      }
    }
  }
  EXPECT_EQ(joined(different), joined(words(kOnlyInFiles)));
  EXPECT_GT(same, 1300);
}

TEST(MjcfSpec, AServosGainIsSetWithAllThatFollowsFromIt) {
  const MjcfElement& position = *MjcfSchema::get().find("mujoco/actuator/position");
  const Result<mjcf::Document> document = mjcf::Document::from_xml(
      "<mujoco><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody><actuator>"
      "<position name='p' joint='j' kp='20' kv='3'/></actuator></mujoco>");
  const Result<mjcf::OwnedSpec> spec = mjcf::parse_document(*document);
  ASSERT_TRUE(spec.ok());
  mjsElement* element = mjs_findElement(spec->get(), mjOBJ_ACTUATOR, "p");
  EXPECT_EQ(written_as(element), &position);
  ASSERT_TRUE(set_attribute(spec->get(), element, position, *position.find("kp"), "55").ok());
  const mjsActuator* actuator = mjs_asActuator(element);
  EXPECT_EQ(actuator->gainprm[0], 55);
  EXPECT_EQ(actuator->biasprm[1], -55);
  EXPECT_EQ(actuator->biasprm[2], -3) << "the damping stays";
  const Status status = set_attribute(spec->get(), element, position, *position.find("kp"), "much");
  EXPECT_FALSE(status.ok());
}

TEST(MjcfSpec, ElementsKnowWhatTheyAreWrittenWith) {
  for (const char* path : {"mujoco/actuator/muscle", "mujoco/sensor/gyro", "mujoco/equality/weld",
                           "mujoco/tendon/fixed", "mujoco/tendon/spatial", "mujoco/body/geom"}) {
    const MjcfElement& element = *MjcfSchema::get().find(path);
    const Result<mjcf::OwnedSpec> spec =
        mjcf::parse_document(mjcf::make_specimen(element).document);
    ASSERT_TRUE(spec.ok()) << path;
    EXPECT_EQ(written_as(mjs_findElement(spec->get(), object_of(element), mjcf::kSpecimenName)),
              &element);
  }
}

}  // namespace
}  // namespace gloam
