// The table of MJCF's grammar against the library that reads MJCF.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <map>
#include <regex>
#include <set>

#include "scene/mjcf/schema.h"

namespace gloam {
namespace {

/// path -> attributes, out of what the library prints: an indented list.
std::map<std::string, std::set<std::string>> printed_grammar() {
  std::string text(1 << 20, 0);
  text.resize(static_cast<size_t>(
      mj_printSchema(nullptr, text.data(), static_cast<int>(text.size()), 0, 0)));
  static const std::regex kElement(R"(^( *)(\S+) \(.\)(.*)$)");
  std::map<std::string, std::set<std::string>> grammar;
  std::vector<std::string> above;
  std::string path, line;
  std::istringstream lines(text);
  while (std::getline(lines, line)) {
    std::smatch match;
    std::string names = line;
    if (std::regex_match(line, match, kElement) && match[1].length() < 30) {
      const auto depth = static_cast<size_t>(match[1].length()) / 3;
      above.resize(depth);
      above.push_back(match[2] == "(world)body" ? "body" : match[2].str());
      path.clear();
      for (const std::string& part : above) path += (path.empty() ? "" : "/") + part;
      names = match[3];
      grammar[path];
    }
    std::istringstream words(names);
    for (std::string word; words >> word;) grammar[path].insert(word);
  }
  return grammar;
}

TEST(MjcfSchema, TheTableIsWhatTheLibraryReads) {
  const MjcfSchema& schema = MjcfSchema::get();
  const auto printed = printed_grammar();
  EXPECT_GE(printed.size(), 171U);
  size_t attributes = 0;
  for (const auto& [path, names] : printed) {
    const MjcfElement* element = schema.find(path);
    ASSERT_NE(element, nullptr) << path << " is read by MuJoCo and missing in the table";
    std::set<std::string> known;
    for (const MjcfAttribute& attribute : element->attributes) {
      if (!attribute.is_spec_only()) known.emplace(attribute.name);
    }
    EXPECT_EQ(known, names) << path;
    attributes += names.size();
  }
  constexpr size_t kMeta = 3;  // <frame>, <replicate>, <include>: read, and not printed
  EXPECT_EQ(schema.elements().size(), printed.size() + kMeta);
  EXPECT_EQ(static_cast<size_t>(schema.attribute_count()),
            attributes + schema.find("mujoco/body/frame")->attributes.size() +
                schema.find("mujoco/body/replicate")->attributes.size() + 1);
}

TEST(MjcfSchema, EveryAttributeSaysWhatItTakes) {
  int with_text = 0, with_unit = 0;
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    std::set<std::string_view> names;
    for (const MjcfAttribute& attribute : element.attributes) {
      const std::string where = std::string(element.path) + "/" + std::string(attribute.name);
      EXPECT_EQ(attribute.type == MjcfType::kKeyword, !attribute.keywords.empty()) << where;
      EXPECT_TRUE(attribute.most == MjcfAttribute::kAnyLength || attribute.least <= attribute.most)
          << where;
      EXPECT_TRUE(names.insert(attribute.name).second) << where << " is there twice";
      if (attribute.type == MjcfType::kKeyword && !attribute.otherwise.empty()) {
        EXPECT_TRUE(check_mjcf_value(attribute, attribute.otherwise).ok())
            << where << " otherwise " << attribute.otherwise;
      }
      with_text += attribute.text.empty() ? 0 : 1;
      with_unit += attribute.unit.empty() ? 0 : 1;
    }
    for (const MjcfElement* child : element.children)
      EXPECT_FALSE(names.contains(child->name))
          << element.path << ": one TOML key for an attribute and an element " << child->name;
  }
  EXPECT_GT(with_text, 1900);
  EXPECT_GT(with_unit, 900);
}

const MjcfAttribute& attribute(std::string_view path, std::string_view name) {
  return *MjcfSchema::get().find(path)->find(name);
}

TEST(MjcfSchema, TypesLengthsKeywordsAndUnitsAreThoseOfTheManual) {
  const MjcfAttribute& axis = attribute("mujoco/body/joint", "axis");
  EXPECT_EQ(axis.type, MjcfType::kReal);
  EXPECT_EQ(axis.least, 3);
  EXPECT_EQ(axis.most, 3);
  EXPECT_EQ(axis.otherwise, "0 0 1");
  EXPECT_EQ(attribute("mujoco/body/geom", "size").least, 1);
  EXPECT_EQ(attribute("mujoco/body/geom", "size").most, 3);
  EXPECT_EQ(attribute("mujoco/body/joint", "type").keywords, "free ball slide hinge");
  EXPECT_EQ(attribute("mujoco/body/geom", "group").type, MjcfType::kInt);
  EXPECT_EQ(attribute("mujoco/body/geom", "mass").unit, "kg");
  EXPECT_EQ(attribute("mujoco/option", "gravity").unit, "m s^-2");
  EXPECT_EQ(attribute("mujoco/keyframe/key", "qpos").most, MjcfAttribute::kAnyLength);
  EXPECT_TRUE(attribute("mujoco/sensor/touch", "site").is_required);
  EXPECT_EQ(attribute("mujoco/sensor/contact", "data").most, 9);
  EXPECT_NE(attribute("mujoco/body/joint", "damping").text.find("Damping"), std::string::npos);
}

TEST(MjcfSchema, ValuesAreCheckedAndErrorsHelp) {
  const auto wrong = [](std::string_view path, std::string_view name, std::string_view value) {
    const Status status = check_mjcf_value(attribute(path, name), value);
    return status.ok() ? std::string("fine") : status.error().to_string();
  };
  EXPECT_EQ(wrong("mujoco/body/geom", "size", "1 2 3"), "fine");
  EXPECT_EQ(wrong("mujoco/body/geom", "size", " +.5\n 1e-3 "), "fine");
  EXPECT_EQ(wrong("mujoco/body/geom", "size", "1 2 3 4"),
            "size=\"1 2 3 4\" is too long; expected 1 to 3 numbers [m]");
  EXPECT_EQ(wrong("mujoco/body/geom", "group", "1.5"),
            "group=\"1.5\" contains '1.5', which is not a whole number; expected a whole number");
  EXPECT_EQ(wrong("mujoco/body/joint", "type", "hing"),
            "type=\"hing\" is not a valid keyword; expected one of free, ball, slide, hinge (did "
            "you mean 'hinge'?)");
  EXPECT_EQ(wrong("mujoco/body/camera", "output", "rgb depth"), "fine");
}

TEST(MjcfSchema, ElementsStandWhereMuJoCoReadsThem) {
  const MjcfSchema& schema = MjcfSchema::get();
  const MjcfElement& world = *schema.child(schema.root(), "worldbody");
  EXPECT_EQ(schema.child(schema.root(), "body"), nullptr);
  EXPECT_EQ(schema.child(world, "body"), &world);
  const MjcfElement& replicate = *schema.child(world, "replicate");
  EXPECT_EQ(schema.child(replicate, "replicate"), &replicate);
  EXPECT_EQ(schema.child(replicate, "geom"), schema.child(world, "geom"));
  EXPECT_EQ(schema.child(*schema.child(replicate, "frame"), "body"), &world);
  EXPECT_NE(schema.child(*schema.child(world, "geom"), "include"), nullptr);
  const MjcfElement& defaults = *schema.child(schema.root(), "default");
  EXPECT_EQ(schema.child(defaults, "default"), &defaults);
  EXPECT_EQ(schema.child(defaults, "body"), nullptr);
}

}  // namespace
}  // namespace gloam
