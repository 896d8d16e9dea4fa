// gloam studio: opens a scene, a model or a log in the browser.

#include <spawn.h>

#include <cstdlib>

#include "gloam/log_player.h"
#include "live.h"
#include "log_report.h"
#include "run_options.h"

extern char** environ;

namespace gloam::cli {
namespace {

/// `live.paused`: as for `gloam run --paused`, but by default.
struct StudioCommand {
  std::string file, resolution, camera;
  SceneOptions scene;
  RenderFlags render;
  LiveCommand live{.view = true};
  bool no_browser = false;
};

// A desktop has a browser; a machine without a display has none to open.
void open_browser(const std::string& url) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  std::string program = "xdg-open", address = url;
  char* const arguments[] = {program.data(), address.data(), nullptr};
  pid_t child = 0;
  static_cast<void>(posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ));
}

int serve(const StudioCommand& command, LiveRun run, EndOnInterrupt& starting) {
  if (!command.resolution.empty())
    if (const Status status = parse_resolution(command.resolution, run.view.width, run.view.height);
        !status.ok())
      return fail(status.error());
  if (!command.camera.empty()) run.view.camera = command.camera;
  if (!command.no_browser) run.on_ready = open_browser;
  return run_live(std::move(run), command.live, starting);
}

int play_log(const StudioCommand& command) {
  EndOnInterrupt starting;
  auto player = LogPlayer::open({.log = command.file});
  if (!player.ok()) return fail(player.error());
  LiveRun run{(*player)->simulation()};
  run.view.player = player->get();
  command.render.apply_to(&run.view.render);
  run.bridges = command.live.options({});
  run.pace = command.live.pace_of({}, Pace::kRealTime);
  return serve(command, std::move(run), starting);
}

int open(StudioCommand command, const Globals& globals) {
  if (is_log(command.file)) return play_log(command);
  auto scene = command.scene.load(command.file);
  if (!scene.ok()) return fail(scene.error());
  show_interactively(&*scene);
  command.render.apply_to(&scene->render);
  auto world = compile(*scene, globals, command.scene.keyframe);
  if (!world.ok()) return fail(world.error());
  EndOnInterrupt starting;
  SimulationOptions options{.seed = scene->sim.seed};
  options.timestep = scene->sim.timestep.value_or(0);
  options.pace = command.live.pace_of(*scene, Pace::kRealTime);
  auto simulation = Simulation::create(*world, options);
  if (!simulation.ok()) return fail(simulation.error());
  LiveRun run{.simulation = **simulation, .view = view_of(*scene)};
  run.bridges = command.live.options(scene->bridge);
  run.pace = options.pace;
  return serve(command, std::move(run), starting);
}

}  // namespace

void add_studio(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand(
      "studio", "Open a scene, a model or a log in the browser: watch, drive, pose and measure it");
  auto command = std::make_shared<StudioCommand>();
  sub->add_option("FILE", command->file, "Scene (.toml), model (.xml, .urdf …) or log (.mcap)")
      ->required();
  sub->add_option("--camera", command->camera, "Camera that is shown first");
  sub->add_option("--resolution", command->resolution,
                  "Size of the image in pixels, as WIDTHxHEIGHT");
  sub->add_flag("--no-browser", command->no_browser, "Print the address only");
  command->scene.add_to(*sub);
  command->scene.add_keyframe_to(*sub);
  command->render.add_to(*sub);
  command->live.add_servers_to(*sub);
  command->live.paused = true;
  sub->add_flag("!--play", command->live.paused, "Start the simulation at once");
  sub->footer(
      "The studio starts paused. Its address contains a token and is a secret.\nExamples:\n  gloam "
      "studio examples/house.toml\n  gloam studio robot.xml "
      "--no-browser --port 0\n  gloam studio run.mcap");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return open(*command, globals); };
  });
}

}  // namespace gloam::cli
