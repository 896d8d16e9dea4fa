// gloam run: simulate a scene or a bare model, record it, or watch it in a browser.

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "gloam/view.h"
#include "interrupt.h"
#include "outputs.h"
#include "report.h"
#include "run_options.h"

namespace gloam::cli {
namespace {

struct RunCommand {
  std::string file, out;
  RunOptions options;
  bool overwrite = false, realtime = false, view = false, mcap = false;
  double speed = 1;
  int port = 8080;
};

int watch(const World& world, const SimulationOptions& options, const RunCommand& command,
          const Scene& scene) {
  EndOnInterrupt starting;
  auto simulation = Simulation::create(world, options);
  if (!simulation.ok()) return fail(simulation.error());
  ViewOptions view;
  view.port = command.port;
  // A live picture is a quick one unless the user asked for light on the command line.
  if (!command.options.tier.empty()) view.render = scene.render;
  view.render.ev100 = scene.render.ev100;
  if (!command.options.cameras.empty()) {
    view.camera = command.options.cameras.front();
  } else if (!scene.cameras.empty()) {
    view.camera = scene.cameras.front().name;  // the free camera may stand outside the walls
  }
  if (!command.options.resolution.empty()) {
    if (const Status status = parse_resolution(command.options.resolution, view.width, view.height);
        !status.ok()) {
      return fail(status.error());
    }
  }
  auto server = ViewServer::start(**simulation, view);
  if (!server.ok()) return fail(server.error());
  starting.release();
  std::fprintf(stderr, "gloam: open %s  (Ctrl-C ends it)\n", (*server)->url().c_str());
  (*simulation)->resume();
  while (!interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  (*server)->stop();
  return 0;
}

int run(const RunCommand& command_line, const Globals& globals) {
  RunCommand command = command_line;
  auto scene = command.options.load(command.file);
  if (!scene.ok()) return fail(scene.error());
  if (!command.options.outputs.empty()) set_record_outputs(command.options.outputs, &*scene);
  if (const Status status = check_outputs(command.options.outputs); !status.ok())
    return fail(status.error());
  scene->record.mcap |= command.mcap;
  auto world = compile(*scene, globals, command.options.keyframe);
  if (!world.ok()) return fail(world.error());
  tell_void_outputs(command.options.outputs, *scene, *world);

  RunRequest request;
  request.out = command.out;
  if (request.out.empty() && scene->bare_model.empty() && !command.view) {
    request.out = std::filesystem::path("results") / scene->name;
  }
  request.overwrite = command.overwrite;
  request.cameras = command.options.cameras;
  request.simulation.seed = scene->sim.seed;
  request.simulation.timestep = scene->sim.timestep.value_or(0);
  request.simulation.pace = command.realtime || command.view ? Pace::kRealTime : Pace::kFast;
  request.simulation.speed = command.speed;
  if (!command.options.resolution.empty()) {
    if (const Status status =
            parse_resolution(command.options.resolution, request.width, request.height);
        !status.ok()) {
      return fail(status.error());
    }
  }
  if (command.view) return watch(*world, request.simulation, command, *scene);
  return run_and_report(*world, request, globals);
}

}  // namespace

void add_run(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub =
      app.add_subcommand("run", "Simulate a scene (.toml) or any MJCF/URDF as it stands");
  auto command = std::make_shared<RunCommand>();
  sub->add_option("FILE", command->file, "Scene or model")->required();
  sub->add_option("--duration", command->options.duration, "Seconds of simulation time")
      ->check(positive_number());
  command->options.add_to(*sub);
  sub->add_option("--out", command->out, "Results folder; default for scenes: results/NAME");
  sub->add_flag("--mcap", command->mcap, "Write a log, too: run.mcap in the results folder");
  sub->add_flag("--overwrite", command->overwrite, "Replace an existing results folder");
  sub->add_flag("--realtime", command->realtime,
                "Pace by the wall clock; default: as fast as possible");
  sub->add_option("--speed", command->speed,
                  "Simulated seconds per second, with --realtime or --view")
      ->check(positive_number());
  sub->add_flag("--view", command->view, "Serve a live page on this machine instead of recording");
  sub->add_option("--port", command->port, "Port of --view; 0 = any free one")
      ->check(CLI::Range(0, 65535));
  sub->footer(
      "Examples:\n  gloam run examples/demo.toml --duration 3\n  gloam run robot.xml --out "
      "results/robot --camera front\n  gloam run examples/lidar.toml --duration 1 --output "
      "lidar,sensors,depth_exr\n  gloam run robot.urdf --view");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return run(*command, globals); };
  });
}

}  // namespace gloam::cli
