// Damaged scene files and models: what is wrong is told in one line, and nothing else happens.

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "base/files.h"
#include "base/test/mutator.h"
#include "base/test/source_dir.h"
#include "scene/files/urdf_text.h"
#include "scene/files/xml_scan.h"
#include "scene/robots/robot_models.h"
#include "scene/test/temp_folder.h"
#include "scene/toml/toml_reader.h"
#include "scene/validate/validate.h"

namespace gloam {
namespace {

/// Mutations of `seeds` in turns; `read` tells whether one was fine. `file` begins its errors.
void expect_answers(const std::vector<std::string>& seeds,
                    const std::function<Status(const std::string&)>& read,
                    const std::string& file = "damaged") {
  for (const std::string& seed : seeds) {
    const Status status = read(seed);
    ASSERT_TRUE(status.ok()) << "not fine to begin with: " << status.error().to_string();
  }
  const size_t count = mutation_count();
  size_t refused = 0;
  for (size_t i = 0; i < count; ++i) {
    const std::string text = Mutator(i).mutate(seeds[i % seeds.size()]);
    const Status status = read(text);
    if (status.ok()) continue;
    ++refused;
    const std::string told = status.error().to_string();
    ASSERT_TRUE(told.starts_with(file) && told.find('\n') == std::string::npos)
        << "file " << i << ": " << told << "\n"
        << text;
  }
  EXPECT_GT(refused, count / 10) << "no harm is done";
  EXPECT_LT(refused, count) << "hardly a file is read to its end";
}

TEST(Mutations, SceneFilesDoNoHarm) {
  std::vector<std::string> seeds;
  const std::filesystem::path folder = source_dir() / "tests/fuzz/scene_toml_fuzz";
  for (const char* name : {"light.toml", "sensors.toml"})
    seeds.push_back(read_text_file(folder / name).value());
  expect_answers(seeds, [](const std::string& text) -> Status {
    Scene scene;
    GLOAM_TRY_STATUS(read_scene_toml(text, "damaged.toml", &scene));
    return validate_scene(scene);
  });
}

TEST(Mutations, RobotsOfACatalogueDoNoHarm) {
  TempFolder folder;
  folder.write("damaged/cart.xml", "<mujoco/>");
  const std::filesystem::path file = folder.path() / "damaged/robot.toml";
  const auto read = [&file](const std::string& text) -> Status {
    GLOAM_TRY(RobotEntry entry, parse_robot_entry(text, file, {}));
    toml::array sensors, robots;
    for (const SensorTemplate& sensor : entry.sensors) sensors.push_back(sensor.name);
    robots.push_back(toml::table{{"model", "toy"}, {"sensors", std::move(sensors)}});
    toml::table scene{{"robot", std::move(robots)}};
    toml::table* robot = scene["robot"][0].as_table();
    GLOAM_TRY_STATUS(merge_robot_entry(std::move(entry), file.string(), robot, &scene));
    Scene out;
    GLOAM_TRY_STATUS(read_scene_toml(scene, file.string(), &out));
    return validate_scene(out);
  };
  expect_answers({read_text_file(source_dir() / "tests/fuzz/robot_entry_fuzz/cart.toml").value()},
                 read, (folder.path() / "damaged").string());
}

TEST(Mutations, ModelsDoNoHarm) {
  const std::vector<std::string> seeds = {
      R"(<mujoco model="a"><compiler meshdir="meshes"/><include file="b.xml"/>
<asset><mesh name="m" file="m.stl"/><texture name="t" builtin="checker" width="64" height="64"/></asset>
<worldbody><replicate count="3"><geom type="mesh" mesh="m"/></replicate></worldbody></mujoco>)",
      R"(<robot name="b"><link name="base"><visual><geometry><mesh filename="meshes/a.stl"/></geometry></visual>
<collision><geometry><box size="1 2 3"/></geometry></collision></link>
<link name="tip"/><joint name="j" type="revolute"><parent link="base"/><child link="tip"/></joint></robot>)"};
  expect_answers(seeds, [](const std::string& text) -> Status {
    GLOAM_TRY(const XmlScan scan, scan_model_xml(text, "damaged.xml"));
    for (const FileReference& reference : scan.references)
      EXPECT_TRUE(has_element_at(text, reference.element, reference.line));
    if (scan.root == "robot")
      GLOAM_TRY_STATUS(prepare_urdf(text, "damaged.urdf", {}, [](const auto&) { return true; }));
    return {};
  });
}

}  // namespace
}  // namespace gloam
