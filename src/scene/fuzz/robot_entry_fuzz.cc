// Any bytes as a robot.toml: an Error or the settings of a robot, never a crash. Errors are one
// line with a place.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/test/custom_mutator.h"
#include "scene/files/model_path.h"
#include "scene/robots/robot_models.h"
#include "scene/test/toml_mutator.h"
#include "scene/toml/toml_reader.h"
#include "scene/validate/validate.h"

namespace {

gloam::Status read(const std::string& text) {
  // Beside a model, so that `file` may be found.
  const std::filesystem::path file = gloam::catalogue_folder() / "cart" / "robot.toml";
  GLOAM_TRY(gloam::RobotEntry entry, gloam::parse_robot_entry(text, file, {}));
  toml::array sensors, robots;
  for (const gloam::SensorTemplate& sensor : entry.sensors) sensors.push_back(sensor.name);
  robots.push_back(toml::table{{"model", "fuzz"}, {"sensors", std::move(sensors)}});
  toml::table scene{{"robot", std::move(robots)}};
  toml::table* robot = scene["robot"][0].as_table();
  GLOAM_TRY_STATUS(gloam::merge_robot_entry(std::move(entry), "scene", robot, &scene));
  gloam::Scene out;
  GLOAM_TRY_STATUS(gloam::read_scene_toml(scene, "scene", &out));
  return gloam::validate_scene(out);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const gloam::Status status = read(std::string(reinterpret_cast<const char*>(data), size));
  if (!status.ok() && (status.error().message.empty() ||
                       status.error().to_string().find('\n') != std::string::npos))
    std::abort();
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned seed) {
  return gloam::mutate_structure(data, size, max_size, seed, gloam::mutate_toml);
}
