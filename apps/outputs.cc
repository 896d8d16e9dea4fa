#include "outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "gloam/output_names.h"
#include "gloam/program.h"
#include "print.h"

namespace gloam::cli {
namespace {

// Reason why nothing delivers `output`; "" when something does.
std::string why_void(const std::string& output, const Scene& scene, const World& world) {
  if (output == "lidar" && scene.lidars.empty()) return "the scene has no [[lidar]]";
  if (output == "sensors" && world.info().sensors.empty()) return "the model has no sensors";
  const CameraChannel* const found = find_output_channel(output);
  if (found == nullptr) return {};
  const CameraChannel& channel = *found;
  const bool any =
      channel.model.empty() || std::ranges::any_of(scene.cameras, [&](const CameraOptions& camera) {
        return channel.has_model(camera.sensing);
      });
  if (!any) return fmt::format("no [[camera]] has a table [camera.{}]", channel.model);
  return {};
}

}  // namespace

Status check_outputs(const std::vector<std::string>& outputs) {
  const std::vector<std::string> known(kOutputNames.begin(), kOutputNames.end());
  for (const std::string& output : outputs) {
    if (std::ranges::find(known, output) != known.end()) continue;
    std::string hint = suggest_name(output, known);
    return Error{ErrorKind::kUsage,
                 fmt::format("--output {}: unknown output", output),
                 {},
                 hint.empty() ? "gloam run --help lists all outputs" : hint};
  }
  return {};
}

Status check_still_outputs(const std::vector<std::string>& outputs) {
  GLOAM_TRY_STATUS(check_outputs(outputs));
  for (const std::string& output : outputs) {
    const bool has_still = std::ranges::any_of(kCameraFiles, [&](const CameraFile& file) {
      return file.is_of_each_frame() && (file.output == output || file.channel == output);
    });
    if (!has_still)
      return Error{ErrorKind::kUsage,
                   fmt::format("--output {}: not available for stills", output),
                   {},
                   "record it with gloam run --output " + output};
  }
  return {};
}

void tell_void_outputs(const std::vector<std::string>& outputs, const Scene& scene,
                       const World& world) {
  for (const std::string& output : outputs) {
    const std::string why = why_void(output, scene, world);
    if (!why.empty()) tell("gloam: warning: --output {} has no effect: {}\n", output, why);
  }
}

}  // namespace gloam::cli
