// gloam run: simulate a scene or a bare model, record it, or watch it in a browser.

#include <fmt/format.h>

#include <optional>

#include "gloam/log_replay.h"
#include "live.h"
#include "outputs.h"
#include "report.h"
#include "run_options.h"

namespace gloam::cli {
namespace {

struct RunCommand {
  std::string file, out;
  RunOptions options;
  bool overwrite = false, realtime = false, mcap = false;
  std::optional<double> at;  ///< [s]
  LiveCommand live;
  CLI::Option* teleop = nullptr;  ///< --teleop
  TeleopOptions teleop_options;

  bool is_live(const BridgeOptions& bridges) const {
    return live.any(bridges) || teleop->count() > 0;
  }
};

int keep_live(const World& world, const RunRequest& request, const RunCommand& command) {
  const Scene& scene = world.scene();
  EndOnInterrupt starting;
  auto simulation = Simulation::create(world, request.simulation);
  if (!simulation.ok()) return fail(simulation.error());
  if (request.from) {
    if (const Status status = (*simulation)->restore(*request.from); !status.ok())
      return fail(status.error());
  }
  LiveRun run{.simulation = **simulation, .view = view_of(scene)};
  run.view.width = request.width;
  run.view.height = request.height;
  if (!request.cameras.empty()) run.view.camera = request.cameras.front();
  run.bridges = command.live.options(scene.bridge);
  run.pace = request.simulation.pace;
  run.log = request.log;
  if (command.teleop->count() > 0) run.teleop = command.teleop_options;
  run.duration = command.options.duration;
  return run_live(std::move(run), command.live, starting);
}

// The log of a live run, in its folder.
Status place_log(RunRequest* request) {
  if (request->out.empty()) return {};
  std::error_code code;
  std::filesystem::create_directories(request->out, code);
  if (code)
    return Error{ErrorKind::kIo,
                 "cannot create folder " + request->out.string() + ": " + code.message()};
  request->log.file = request->out / kRunLogName;
  request->log.overwrite = request->overwrite;
  return {};
}

int run_world(const World& world, RunRequest request, const RunCommand& command,
              const Globals& globals) {
  const Scene& scene = world.scene();
  request.out = command.out;
  const bool is_live = command.is_live(scene.bridge);
  if (request.out.empty() && (is_live ? command.mcap : scene.bare_model.empty()))
    request.out = std::filesystem::path("results") / scene.name;
  // The World of a log has the [record] table of that run; otherwise the flag is in the scene.
  if (request.from && command.mcap && !request.out.empty())
    request.log.file = request.out / "run.mcap";
  request.overwrite = command.overwrite;
  request.cameras = command.options.cameras;
  request.simulation.pace =
      command.live.pace_of(scene, command.realtime || is_live ? Pace::kRealTime : Pace::kFast);
  request.simulation.speed = command.live.speed;
  if (!command.options.resolution.empty()) {
    if (const Status status =
            parse_resolution(command.options.resolution, request.width, request.height);
        !status.ok()) {
      return fail(status.error());
    }
  }
  if (!is_live) return run_and_report(world, request, globals);
  if (command.mcap) {
    if (const Status status = place_log(&request); !status.ok()) return fail(status.error());
  }
  return keep_live(world, request, command);
}

// Resumes from an instant of a log, in its World.
int run_on(const RunCommand& command, const Globals& globals) {
  const RunOptions& o = command.options;
  if (!o.settings.empty() || !o.outputs.empty() || o.seed || o.timestep || o.tier)
    return fail(
        {ErrorKind::kUsage,
         "`--at` cannot change the scene of a log",
         {},
         "to run a changed scene with the log's Commands, use gloam replay LOG --restep --set …"});
  auto from = log_checkpoint(command.file, {}, 0, *command.at);
  if (!from.ok()) return fail(from.error());
  RunRequest request;
  request.simulation.seed = from->seed();
  request.simulation.timestep = from->world().scene().sim.timestep.value_or(0);
  request.from = *from;
  request.duration = o.duration.value_or(0);
  return run_world(from->world(), request, command, globals);
}

int run(const RunCommand& command_line, const Globals& globals) {
  RunCommand command = command_line;
  if (command.teleop->count() > 0)
    if (const Status status = check_teleop(command.teleop_options); !status.ok())
      return fail(status.error());
  if (command.at) return run_on(command, globals);
  auto scene = command.options.load(command.file);
  if (!scene.ok()) return fail(scene.error());
  if (!command.options.outputs.empty()) set_record_outputs(command.options.outputs, &*scene);
  if (const Status status = check_outputs(command.options.outputs); !status.ok())
    return fail(status.error());
  scene->record.mcap |= command.mcap;
  if (command.is_live(scene->bridge) && !command.options.tier) show_interactively(&*scene);
  auto world = compile(*scene, globals, command.options.keyframe);
  if (!world.ok()) return fail(world.error());
  tell_void_outputs(command.options.outputs, *scene, *world);
  RunRequest request;
  request.simulation.seed = scene->sim.seed;
  request.simulation.timestep = scene->sim.timestep.value_or(0);
  return run_world(*world, request, command, globals);
}

}  // namespace

void add_run(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub =
      app.add_subcommand("run", "Simulate a scene (.toml) or any unmodified MJCF or URDF");
  auto command = std::make_shared<RunCommand>();
  sub->add_option("FILE", command->file, "Scene or model")->required();
  sub->add_option(
         "--duration", command->options.duration,
         "Duration in seconds of simulation time; default: the scene's; live runs: unlimited")
      ->check(positive_number());
  command->options.add_to(*sub);
  sub->add_option("--out", command->out, "Results folder; default for scenes: results/NAME");
  sub->add_flag("--mcap", command->mcap, "Also write a log: run.mcap in the results folder");
  sub->add_flag("--overwrite", command->overwrite, "Replace an existing results folder");
  sub->add_flag("--realtime", command->realtime,
                "Short for --pace realtime; default without a live view: as fast as possible");
  command->live.add_to(*sub);
  command->teleop =
      sub->add_option("--teleop", command->teleop_options.robot,
                      "Drive a robot with the keyboard or a gamepad (docs/controllers.md); without "
                      "its name, the first robot that accepts velocity or pose goals")
          ->option_text("[ROBOT]")
          ->expected(0, 1);
  sub->add_option("--gamepad", command->teleop_options.gamepad,
                  "Gamepad of --teleop; default: the first of /dev/input/js*")
      ->option_text("DEVICE")
      ->needs(command->teleop);
  sub->add_option("--at", command->at,
                  "Resume the log FILE at this time in seconds, for --duration more seconds")
      ->check(non_negative_number());
  sub->footer(
      "Examples:\n  gloam run examples/demo.toml --duration 3\n  gloam run robot.xml --out "
      "results/robot --camera front\n  gloam run examples/lidar.toml --duration 1 --output "
      "lidar,sensors,depth_exr\n  gloam run robot.urdf --view\n  gloam run examples/demo.toml "
      "--ros2 --view\n  gloam run examples/quadrotor_gusts.toml --teleop --view\n  gloam run "
      "examples/demo.toml --zmq --pace sensors\n  gloam run run.mcap "
      "--at 2.5 "
      "--duration 3 --out results/branch");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return run(*command, globals); };
  });
}

}  // namespace gloam::cli
