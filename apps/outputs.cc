#include "outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "gloam/program.h"

namespace gloam::cli {
namespace {

template <class Has>
bool any_camera(const Scene& scene, Has&& has) {
  return std::ranges::any_of(scene.cameras,
                             [&](const CameraOptions& camera) { return has(camera.sensing); });
}

// Reason why nothing delivers `output`; "" when something does.
std::string why_void(const std::string& output, const Scene& scene, const World& world) {
  if (output == "lidar" && scene.lidars.empty()) return "the scene has no [[lidar]]";
  if (output == "sensors" && world.info().sensors.empty()) return "the model has no sensors";
  if (output.starts_with("raw") &&
      !any_camera(scene, [](const CameraSensing& s) { return s.imager.has_value(); }))
    return "no [[camera]] has an [camera.imager]";
  if (output.starts_with("sensor_depth") &&
      !any_camera(scene, [](const CameraSensing& s) { return s.stereo_depth.has_value(); }))
    return "no [[camera]] measures depth";
  if (output == "events" &&
      !any_camera(scene, [](const CameraSensing& s) { return s.events.has_value(); }))
    return "no [[camera]] has [camera.events]";
  if (output.starts_with("thermal") &&
      !any_camera(scene, [](const CameraSensing& s) { return s.thermal.has_value(); }))
    return "no [[camera]] has [camera.thermal]";
  return {};
}

}  // namespace

Status check_outputs(const std::vector<std::string>& outputs) {
  const std::vector<std::string> known(kRecordOutputs.begin(), kRecordOutputs.end());
  for (const std::string& output : outputs) {
    if (std::ranges::find(known, output) != known.end()) continue;
    std::string hint = suggest_name(output, known);
    return Error{ErrorKind::kUsage,
                 fmt::format("--output {}: there is no such output", output),
                 {},
                 hint.empty() ? "gloam run --help lists them" : hint};
  }
  return {};
}

void tell_void_outputs(const std::vector<std::string>& outputs, const Scene& scene,
                       const World& world) {
  for (const std::string& output : outputs) {
    const std::string why = why_void(output, scene, world);
    if (!why.empty())
      std::fprintf(stderr, "gloam: warning: --output %s names nothing here: %s\n", output.c_str(),
                   why.c_str());
  }
}

}  // namespace gloam::cli
