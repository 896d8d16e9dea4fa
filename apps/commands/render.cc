// gloam render: stills.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "gloam/outputs.h"
#include "json_text.h"
#include "outputs.h"
#include "print.h"
#include "run_options.h"

namespace gloam::cli {
namespace {

constexpr int kStillSamples = 64;  // the scene's number is for videos

struct RenderCommand {
  std::string file, out = ".";
  RunOptions options;
  double time = 0;
};

// Channels that a still can have: all except channels of all frames together.
std::string channel_help() {
  std::string plain = "Channels:", modelled;
  for (const CameraChannel& channel : kCameraChannels) {
    const bool has_still = std::ranges::any_of(kCameraFiles, [&](const CameraFile& file) {
      return file.channel == channel.name && file.is_of_each_frame();
    });
    if (has_still) (channel.model.empty() ? plain : modelled) += fmt::format(" {}", channel.name);
  }
  return fmt::format(
      "{};{} of cameras with these models. A channel selects all its files; a file name as in "
      "gloam run selects one, such as depth_exr",
      plain, modelled);
}

int render(const RenderCommand& command_line, const Globals& globals) {
  RenderCommand command = command_line;
  if (const Status status = check_still_outputs(command.options.outputs); !status.ok())
    return fail(status.error());
  auto scene = command.options.load(command.file);
  if (!scene.ok()) return fail(scene.error());
  if (!command.options.spp && !scene->render.error) scene->render.spp = kStillSamples;
  auto world = compile(*scene, globals, command.options.keyframe);
  if (!world.ok()) return fail(world.error());

  std::vector<std::string> cameras = command.options.cameras;
  if (cameras.empty()) {
    for (const NamedElement& camera : world->info().cameras) cameras.push_back(camera.name);
  }
  if (cameras.empty()) cameras = {"free"};
  std::vector<CameraRequest> requests;
  for (const std::string& camera : cameras) {
    CameraRequest request;
    request.camera = camera;
    request.render = scene->render;
    for (const CameraOptions& options : scene->cameras)
      if (options.name == camera) request.rate = options.rate;
    request.outputs =
        command.options.outputs.empty() ? std::vector<std::string>{"rgb"} : command.options.outputs;
    if (!command.options.resolution.empty()) {
      if (const Status status =
              parse_resolution(command.options.resolution, request.width, request.height);
          !status.ok()) {
        return fail(status.error());
      }
    }
    requests.push_back(request);
  }
  auto frames = render_stills(*world, command.time, requests, progress_display(globals));
  finish_progress();
  if (!frames.ok()) return fail(frames.error());

  auto json = nlohmann::ordered_json::array();
  auto stills = write_stills(*world, *frames, command.out, command.options.outputs);
  if (!stills.ok()) return fail(stills.error());
  for (const StillFiles& still : *stills) {
    for (const auto& file : still.files) {
      if (globals.json)
        json.push_back({{"camera", still.camera}, {"file", file.string()}});
      else
        say("{}\n", file.string());
    }
  }
  if (globals.json) put_json(json);
  return 0;
}

}  // namespace

void add_render(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand("render", "Render stills of a scene or model");
  auto command = std::make_shared<RenderCommand>();
  sub->add_option("FILE", command->file, "Scene or model")->required();
  command->options.add_to(*sub);
  sub->get_option("--output")->description(channel_help());
  sub->get_option("--spp")->description(
      fmt::format("Samples per pixel, or the maximum if --error is given; default: {}, regardless "
                  "of the scene; with --error: 4096",
                  kStillSamples));
  sub->add_option("--time", command->time, "Simulation time of the image in seconds; default: 0")
      ->check(non_negative_number());
  sub->add_option("--out", command->out, "Folder for the images; default: the current folder");
  sub->footer(
      "Examples:\n  gloam render robot.xml --camera free --spp 256 --resolution 1280x720\n"
      "  gloam render room.toml --error 0.02 --no-denoise --output rgb,radiance,samples\n"
      "  gloam render examples/two_robots.toml --time 1 --output depth,segmentation,boxes");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return render(*command, globals); };
  });
}

}  // namespace gloam::cli
