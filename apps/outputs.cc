#include "outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "gloam/outputs.h"
#include "gloam/program.h"
#include "print.h"

namespace gloam::cli {
namespace {

// Reason why nothing delivers `output`; "" when something does.
std::string why_void(const std::string& output, const Scene& scene, const World& world) {
  if (output == "lidar" && scene.lidars.empty()) return "the scene has no [[lidar]]";
  if (output == "sensors" && world.info().sensors.empty()) return "the model has no sensors";
  const auto* file = std::ranges::find(kCameraFiles, output, &CameraFile::output);
  if (file == kCameraFiles.end()) return {};
  const CameraChannel& channel = *find_camera_channel(file->channel);
  const bool any =
      channel.model.empty() || std::ranges::any_of(scene.cameras, [&](const CameraOptions& camera) {
        return channel.has_model(camera.sensing);
      });
  if (!any) return fmt::format("no [[camera]] has a table [camera.{}]", channel.model);
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
    if (!why.empty()) tell("gloam: warning: --output {} names nothing here: {}\n", output, why);
  }
}

}  // namespace gloam::cli
