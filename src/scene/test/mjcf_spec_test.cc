// What MuJoCo's parser makes of each attribute.

#include <gtest/gtest.h>

#include "scene/mjcf/spec_fields.h"
#include "scene/test/mjcf_specimen.h"

namespace gloam::mjcf {
namespace {

std::vector<std::string> values_to_try(const MjcfAttribute& attribute) {
  std::vector<std::string> values;
  if (attribute.type == MjcfType::kKeyword)
    for (const std::string_view word : split_words(attribute.keywords)) values.emplace_back(word);
  if (attribute.type == MjcfType::kString) values = {"b2", "rgb"};
  if (attribute.type == MjcfType::kInt || attribute.type == MjcfType::kReal) {
    const int count = attribute.most == MjcfAttribute::kAnyLength ? 3 : attribute.most;
    for (const char* number : {"2", "0.75", "0", "5"}) {
      if (attribute.type == MjcfType::kInt && std::string_view(number).size() > 1) continue;
      std::string text;
      for (int i = 0; i < count; ++i) text += (i > 0 ? " " : "") + std::string(number);
      values.push_back(text);
    }
  }
  return values;
}

TEST(MjcfSpec, Print) {
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    if (element.path == "mujoco/include" || element.path == "mujoco/asset/model" || element.path.find("plugin") != std::string_view::npos) continue;
    Specimen specimen = make_specimen(element);
    std::string why;
    const Spec plain = parsed(specimen.document, &why);
    if (plain == nullptr) {
      std::printf("REFUSED %s: %s\n", std::string(element.path).c_str(), why.c_str());
      continue;
    }
    for (const MjcfAttribute& attribute : element.attributes) {
      const auto before = *specimen.element.get(attribute.name);
      std::vector<std::string> difference;
      for (const std::string& value : values_to_try(attribute)) {
        if (!specimen.element.set(attribute.name, value).ok()) continue;
        const Spec with = parsed(specimen.document, &why);
        if (with == nullptr) continue;
        difference = spec_difference(plain.get(), with.get());
        if (!difference.empty()) break;
      }
      std::string text;
      for (const std::string& place : difference) text += " " + place;
      std::printf("MAP %s/%s ->%s%s\n", std::string(element.path).c_str(), std::string(attribute.name).c_str(), text.substr(0,300).c_str(), difference.empty() ? (" NOTHING " + why).c_str() : "");
      if (before) (void)specimen.element.set(attribute.name, *before).ok(); else (void)specimen.element.clear(attribute.name).ok();
    }
  }
}

}  // namespace
}  // namespace gloam::mjcf
