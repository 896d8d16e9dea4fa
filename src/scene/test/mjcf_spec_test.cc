// What MuJoCo's parser makes of each attribute, and the same made of a model that is parsed already.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "scene/mjcf/spec_table.h"
#include "scene/mjcf/specimen.h"

namespace gloam {
namespace {

TEST(MjcfSpec, EveryElementHasASpecimenThatMuJoCoReads) {
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    const mjcf::Specimen specimen = mjcf::make_specimen(element);
    EXPECT_EQ(specimen.element.path(), element.path);
    const Result<mjcf::OwnedSpec> spec = mjcf::parse_document(specimen.document);
    EXPECT_TRUE(spec.ok()) << element.path << ": " << spec.error().to_string() << "\n"
                           << specimen.document.to_xml();
  }
}

TEST(MjcfSpec, EveryAttributeIsFoundInTheSpec) {
  std::map<std::string, std::vector<std::string>> attributes_of;
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    for (const MjcfAttribute& attribute : element.attributes) {
      const std::vector<std::string> places = spec_places(element, attribute);
      if (places.empty()) printf("NOTHING %s/%s\n", std::string(element.path).c_str(), std::string(attribute.name).c_str());
      for (const std::string& place : places) attributes_of[place].push_back(std::string(element.path) + "/" + std::string(attribute.name));
    }
  }
  for (const SpecField& field : spec_fields()) {
    if (field.type == SpecType::kHandle || field.type == SpecType::kStruct || field.name == "info") continue;
    bool found = false;
    for (const auto& [place, list] : attributes_of) {
      const size_t dot = place.rfind('.');
      found = found || (place.substr(dot + 1) == field.name);
    }
    if (!found) printf("UNREACHED %s.%s\n", std::string(field.owner).c_str(), std::string(field.name).c_str());
  }
}

TEST(MjcfSpec, SettingAfterwardsIsTheSameAsWritingItInTheFile) {
  int same = 0, tried = 0;
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    const mjtObj type = object_of(element);
    if (element.path.find("plugin") != std::string_view::npos || element.path.starts_with("mujoco/default") || element.path.find("flexcomp") != std::string_view::npos) continue;
    for (const MjcfAttribute& attribute : element.attributes) {
      for (const std::string& value : mjcf::values_to_try(attribute)) {
        mjcf::Specimen specimen = mjcf::make_specimen(element, attribute.name);
        const Result<mjcf::OwnedSpec> before = mjcf::parse_document(specimen.document);
        if (!before.ok() || !specimen.element.set(attribute.name, value).ok()) continue;
        const Result<mjcf::OwnedSpec> written = mjcf::parse_document(specimen.document);
        if (!written.ok()) continue;
        mjsElement* target = type == mjOBJ_UNKNOWN ? nullptr : mjs_findElement(before->get(), type, mjcf::kSpecimenName);
        if (type != mjOBJ_UNKNOWN && target == nullptr) { printf("NOTARGET %s\n", std::string(element.path).c_str()); break; }
        ++tried;
        const Status status = set_spec_attribute(before->get(), target, element, attribute, value);
        std::string text;
        for (const std::string& place : spec_difference(before->get(), written->get())) if (!place.ends_with(".info")) text += " " + place;
        if (!status.ok() || !text.empty())
          printf("DIFFERS %s/%s=%s:%s%s\n", std::string(element.path).c_str(), std::string(attribute.name).c_str(), value.c_str(), text.substr(0, 200).c_str(), status.ok() ? "" : (" " + status.error().message).c_str());
        else ++same;
        break;
      }
    }
  }
  printf("same %d of %d\n", same, tried);
}

}  // namespace
}  // namespace gloam
