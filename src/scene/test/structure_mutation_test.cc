// Scenes and models whose keys, values and elements are damaged, but not their TOML or XML: damage
// behind the parser.

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "base/files.h"
#include "base/test/source_dir.h"
#include "gloam/mjcf.h"
#include "scene/files/urdf_text.h"
#include "scene/files/xml_scan.h"
#include "scene/randomize/randomize.h"
#include "scene/test/toml_mutator.h"
#include "scene/test/xml_mutator.h"
#include "scene/toml/toml_reader.h"
#include "scene/validate/validate.h"

namespace gloam {
namespace {

using Mutate = std::string (*)(const std::string&, uint64_t);
using Read = std::function<Status(const std::string&)>;

/// `parse` tells whether the text is well-formed, `read` whether it is fine.
void expect_answers(const std::vector<std::string>& seeds, Mutate mutate, const Read& parse,
                    const Read& read) {
  for (const std::string& seed : seeds)
    ASSERT_TRUE(read(seed).ok()) << "not fine to begin with: " << read(seed).error().to_string();
  const size_t count = mutation_count();
  size_t unparsed = 0, refused = 0;
  for (size_t i = 0; i < count; ++i) {
    const std::string text = mutate(seeds[i % seeds.size()], i);
    unparsed += parse(text).ok() ? 0 : 1;
    const Status status = read(text);
    if (status.ok()) continue;
    ++refused;
    const std::string told = status.error().to_string();
    ASSERT_TRUE(!told.empty() && told.find('\n') == std::string::npos)
        << "file " << i << ": " << told << "\n"
        << text;
  }
  testing::Test::RecordProperty("past the parser", std::to_string(count - unparsed));
  testing::Test::RecordProperty("read to the end", std::to_string(count - refused));
  EXPECT_LT(unparsed, count / 20) << "the mutants are not parsed any more";
  EXPECT_GT(refused, 0u) << "no harm is done";
  EXPECT_LT(refused, count * 95 / 100) << "hardly a file is read to its end";
}

std::vector<std::string> files(const char* folder, std::vector<const char*> names) {
  std::vector<std::string> texts;
  for (const char* name : names)
    texts.push_back(read_text_file(source_dir() / folder / name).value());
  return texts;
}

TEST(StructureMutations, ScenesDoNoHarm) {
  const auto parse = [](const std::string& text) -> Status {
    return parse_toml(text, "damaged.toml").ok() ? Status() : Error{};
  };
  const auto read = [](const std::string& text) -> Status {
    Scene scene;
    GLOAM_TRY_STATUS(read_scene_toml(text, "damaged.toml", &scene));
    GLOAM_TRY_STATUS(validate_scene(scene));
    std::vector<DrawnOption> drawn;
    GLOAM_TRY_STATUS(draw_options(DrawStage::kPlace, &scene, &drawn));
    return draw_options(DrawStage::kRest, &scene, &drawn);
  };
  expect_answers(files("tests/fuzz/scene_toml_fuzz", {"light.toml", "sensors.toml"}), mutate_toml,
                 parse, read);
}

Status parse_any_xml(const std::string& text) {
  pugi::xml_document document;
  return document.load_buffer(text.data(), text.size()) ? Status() : Error{};
}

TEST(StructureMutations, ModelsDoNoHarm) {
  std::vector<std::string> seeds = files("src/world/test/urdf", {"gripper.urdf"});
  seeds.push_back(files("assets/robots/quadruped", {"quadruped.xml"})[0]);
  expect_answers(seeds, mutate_xml, parse_any_xml, [](const std::string& text) -> Status {
    GLOAM_TRY(const XmlScan scan, scan_model_xml(text, "damaged.xml"));
    for (const FileReference& reference : scan.references)
      EXPECT_TRUE(has_element_at(text, reference.element, reference.line));
    if (scan.root == "robot")
      GLOAM_TRY_STATUS(prepare_urdf(text, "/m/damaged.urdf", {}, [](const auto&) { return true; }));
    return {};
  });
}

TEST(StructureMutations, MjcfDocumentsDoNoHarm) {
  expect_answers(files("assets/robots/quadruped", {"quadruped.xml"}), mutate_xml, parse_any_xml,
                 [](const std::string& text) -> Status {
                   GLOAM_TRY(const mjcf::Document document,
                             mjcf::Document::from_xml(text, "damaged.xml"));
                   const std::string xml = document.to_xml();
                   const Result<mjcf::Document> again = mjcf::Document::from_xml(xml, "again.xml");
                   EXPECT_TRUE(again.ok() && again->to_xml() == xml);
                   return document.check();
                 });
}

}  // namespace
}  // namespace gloam
