// The JSON Schemas that editors check scenes and models with.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "base/files.h"
#include "base/test/source_dir.h"
#include "gloam/mjcf.h"
#include "gloam/scene.h"
#include "scene/mjcf/schema.h"
#include "scene/overrides.h"
#include "scene/test/schema_check.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using schema_test::Checker;
using schema_test::Json;
using ::testing::HasSubstr;

const Checker& scenes() {
  static const Checker checker(scene_schema());
  return checker;
}
const Checker& models() {
  static const Checker checker(mjcf::model_schema());
  return checker;
}

std::vector<std::string> toml_blocks(const std::string& page) {
  std::vector<std::string> blocks;
  const std::string fence = "```toml\n";
  for (size_t at = page.find(fence); at != std::string::npos; at = page.find(fence, at)) {
    at += fence.size();
    const size_t end = page.find("```", at);
    blocks.push_back(page.substr(at, end - at));
    at = end;
  }
  return blocks;
}

TEST(Schema, ExamplesAndTheManualAreValid) {
  int count = 0, model_count = 0;
  for (const auto& file : fs::directory_iterator(source_dir() / "examples")) {
    if (file.path().extension() != ".toml") continue;
    EXPECT_EQ(scenes().check_toml(read_text_file(file.path()).value()), "") << file.path();
    ++count;
  }
  for (const auto& file : fs::directory_iterator(source_dir() / "docs")) {
    if (file.path().extension() != ".md") continue;
    for (const std::string& text : toml_blocks(read_text_file(file.path()).value())) {
      const bool is_model = text.find("[mujoco") != std::string::npos;
      EXPECT_EQ((is_model ? models() : scenes()).check_toml(text), "") << file.path() << "\n"
                                                                       << text;
      ++(is_model ? model_count : count);
    }
  }
  EXPECT_GT(count, 20);
  EXPECT_GT(model_count, 0);
}

TEST(Schema, OfScenesRefusesWhatTheReaderRefuses) {
  const char* const kRobot = "[[robot]]\nname = \"a\"\nfile = \"a.xml\"\n";
  const auto with = [&](const std::string& more) { return scenes().check_toml(kRobot + more); };
  EXPECT_EQ(with(""), "");
  EXPECT_EQ(with("position = [0, 0.5, 1]\ncontroller.rate = \"30000/1001\"\n"), "");
  EXPECT_EQ(with("[sky]\ndate = 2026-06-21\ntime = 14:30:00\n"), "");
  EXPECT_EQ(with("[sky]\ndate = \"2026-06-21\"\ntime = \"14:30\"\n"), "");
  EXPECT_EQ(with("[[visual]]\nname = \"v\"\nfile = \"v.obj\"\nscale = 2\n"), "");
  EXPECT_EQ(with("[[visual]]\nname = \"v\"\nfile = \"v.obj\"\nscale = [1, 2, 3]\n"), "");
  for (const char* bad : {"postion = [0, 0, 0]",
                          "position = 1",
                          "position = [0, 0]",
                          "position = [0, 0, \"1\"]",
                          "position = [0, 0, 1e8]",
                          "keyframe = 3",
                          "controller.type = \"trott\"",
                          "controller.rate = 0",
                          "controller.rate = \"fast\"",
                          "controller.kp = -1",
                          "controller.goals = [{ vx = 1 }]",
                          "[robots]",
                          "[sim]\nseed = 1.5",
                          "[sim]\nseed = -1",
                          "[sim]\nduration = 0",
                          "[render]\nspp = 0",
                          "[render]\ndenoise = 1",
                          "[sim]\nduration = \"1\"",
                          "[camera]\nname = \"c\"",
                          "[[camera]]\nfovy = 60",
                          "[[camera]]\nname = \"\"",
                          "[[camera]]\nname = \"c\"\noutputs = [\"vdeo\"]",
                          "[record]\noutputs = \"png\"",
                          "[sky]\ndate = 2026",
                          "[[visual]]\nname = \"a/b\"\nfile = \"v.obj\"",
                          "[[visual]]\nname = \"v\"\nfile = \"v.obj\"\nscale = 1e9"})
    EXPECT_NE(with(bad), "") << bad;
  EXPECT_NE(scenes().check_toml("[[robot]]\nname = \"a\"\n"), "");
}

TEST(Schema, OfScenesOffersWhatAnOverrideMaySet) {
  const auto with = [&](const std::string& more) {
    return scenes().check_toml("[override.go1" + more);
  };
  for (const char* good :
       {".joint.\"FR_.*\"]\ndamping = 0.5", ".joint.knee]\nsolref = [0.02, 1]\nlimited = true",
        ".joint.knee]\nlimited = \"auto\"", ".actuator.\".*\"]\nkp = 3\ngear = [1, 0, 0]",
        ".position.hip]\nkp = 3", ".option]\ntimestep = 0.001\nflag.energy = \"enable\"",
        ".option.flag]\nenergy = true", ".visual.map]\nznear = 0.1", ".mesh.shell]\nneedsdf = true",
        ".body.\".*\"]\nchildclass = \"c\"", ".sensor.\".*\"]\nnoise = 0.1"})
    EXPECT_EQ(with(good), "") << good;
  for (const char* bad :
       {".joint.knee]\ndampng = 0.5", ".joint.knee]\ndamping = \"much\"",
        ".joint.knee]\ntype = \"hing\"", ".joint.knee]\nkp = 3", ".jont.knee]\ndamping = 1",
        ".joint]\nknee = 1", ".actuator.\".*\"]\ndamping_ratio = 3", ".motor.m]\nkp = 3",
        ".option]\ntimstep = 0.001", ".option.flag]\nenergie = true", ".visual.mop]\nznear = 1"})
    EXPECT_NE(with(bad), "") << bad;
}

// What the schema offers is what the reader takes: no name more, none less.
TEST(Schema, OfScenesOffersTheAttributesOfEveryTag) {
  const Json& definitions = scenes().root()["definitions"];
  int attributes = 0;
  for (const auto& [tag, table] : definitions["override"]["properties"].items()) {
    std::set<std::string> names, offered;
    const bool is_named =
        table.contains("additionalProperties") && table["additionalProperties"].contains("$ref");
    const Json& properties =
        is_named ? definitions["override." + tag]["properties"] : table["properties"];
    for (const auto& [name, schema] : properties.items()) {
      if (schema.contains("$ref") || schema.contains("anyOf")) offered.insert(name);
    }
    for (const MjcfElement* element : overridden_elements(tag)) {
      for (const MjcfAttribute& attribute : element->attributes) names.emplace(attribute.name);
    }
    EXPECT_EQ(offered, names) << tag;
    attributes += static_cast<int>(names.size());
  }
  EXPECT_GT(attributes, 1000);
  EXPECT_THAT(definitions["mujoco.body.joint.damping"]["description"].get<std::string>(),
              HasSubstr("number"));
  EXPECT_LT(scene_schema().size(), size_t{640} << 10) << "an editor fetches it at every start";
}

void expect_described(const Json& schema, const std::string& at) {
  if (schema.contains("items")) expect_described(schema["items"], at + "[]");
  if (!schema.contains("properties")) return;
  for (const auto& [key, value] : schema["properties"].items()) {
    const bool is_list = value.contains("items") && value["items"].contains("properties");
    EXPECT_TRUE((is_list ? value["items"] : value).contains("description"))
        << "the header says nothing of " << at << "." << key;
    expect_described(value, at + "." + key);
  }
}

TEST(Schema, OfScenesTellsOfEveryKey) {
  expect_described(scenes().root(), "");
  const Json& tables = scenes().root()["properties"];
  const Json& robot = tables["robot"]["items"]["properties"];
  EXPECT_EQ(robot["position"]["description"], "pose of its root frame in the world [m]");
  EXPECT_EQ(robot["controller"]["properties"]["kp"]["description"],
            "joint_*: stiffness, of joint_velocity the integral gain [N m/rad]");
  EXPECT_EQ(robot["controller"]["properties"]["kp"]["default"], 40);
  const Json& stereo = tables["stereo"]["items"]["properties"];
  EXPECT_EQ(stereo["fovy"]["description"], "vertical field of view [deg]");  // of its base
  EXPECT_EQ(stereo["fovy"]["exclusiveMaximum"], 180);
  EXPECT_THAT(stereo["imager"]["description"].get<std::string>(), HasSubstr("Bayer"));
  EXPECT_EQ(tables["render"]["properties"]["tier"]["enum"],
            Json({"path", "interactive", "direct"}));
  EXPECT_FALSE(tables["render"]["properties"]["spp"].contains("default"));
  const Json& kinds = tables["prop"]["items"]["properties"]["kind"]["enum"];
  EXPECT_EQ(kinds.size(), prop_kinds().size()) << "editors cannot offer every prop";
}

/// A value that the attribute takes, as a document holds it.
std::string value_for(const MjcfAttribute& attribute) {
  if (attribute.type == MjcfType::kString) return "text";
  if (attribute.type == MjcfType::kKeyword)
    return std::string(split_words(attribute.keywords).back());
  const int count = attribute.most == MjcfAttribute::kAnyLength ? 5 : attribute.most;
  std::string text;
  for (int i = 0; i < count; ++i) text += (i > 0 ? " " : "") + std::to_string(i);
  return text;
}

mjcf::Element place(const mjcf::Document& document, const MjcfElement& element) {
  std::vector<const MjcfElement*> line;
  for (const MjcfElement* e = &element; e->parent != nullptr; e = e->parent) line.push_back(e);
  mjcf::Element at = document.root();
  for (auto it = line.rbegin(); it != line.rend(); ++it) {
    at = at.add(MjcfSchema::tag(**it, *(*it)->parent)).value();
    for (const MjcfAttribute& attribute : (*it)->attributes)
      if (attribute.is_required) at.set(attribute.name, value_for(attribute)).ok();
  }
  return at;
}

TEST(Schema, OfModelsTakesEveryElementAndAttributeAsItIsWritten) {
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    const mjcf::Document document = mjcf::Document::make("m");
    mjcf::Element at = place(document, element);
    for (const MjcfAttribute& attribute : element.attributes)
      ASSERT_TRUE(at.set(attribute.name, value_for(attribute)).ok());
    ASSERT_EQ(models().check_toml(document.to_toml()), "") << document.to_toml();
  }
}

TEST(Schema, OfModelsRefusesWhatMjcfDoesNotHave) {
  const auto with = [&](const std::string& body) {
    return models().check_toml("[[mujoco.worldbody.body]]\n" + body);
  };
  EXPECT_EQ(with("pos = [0, 0, 1]"), "");
  EXPECT_EQ(with("joint = { type = \"hinge\", limited = true }"), "");
  EXPECT_EQ(with("[[mujoco.worldbody.body.body.frame.body.geom]]\nsize = 0.1"), "");
  EXPECT_EQ(models().check_toml("[mujoco.option.flag]\nenergy = true"), "");
  EXPECT_EQ(models().check_toml("[[mujoco.worldbody.camera]]\noutput = \"rgb depth\""), "");
  EXPECT_EQ(models().check_toml("[[mujoco.worldbody.camera]]\noutput = [\"rgb\", \"depth\"]"), "");
  EXPECT_EQ(models().check_toml("[[mujoco.custom.text]]\nname = \"a\"\ncontent = \"b\""), "");
  for (const char* bad :
       {"poss = [0, 0, 1]", "pos = 1", "pos = [0, 0]", "pos = [0, 0, 1, 2]", "pos = [0, 0, \"1\"]",
        "name = 3", "jiont = { }", "joint = 1", "joint = { type = \"hing\" }",
        "joint = { group = 1.5 }", "[[mujoco.worldbody.body.body.frame.body.geom]]\nsiz = 0.1",
        "[[mujoco.worldbody.camera]]\noutput = \"rgb dpth\"", "[mujoco.optoin]",
        "[mujoco.option]\ntimestep = \"1\"", "[robot]"})
    EXPECT_NE(with(bad), "") << bad;
  const Json& joint = models().root()["definitions"]["mujoco.body.joint"]["properties"];
  EXPECT_EQ(joint["axis"]["default"], Json({0, 0, 1}));
  EXPECT_THAT(joint["damping"]["description"].get<std::string>(), HasSubstr("["));  // the unit
}

}  // namespace
}  // namespace gloam
