// gloam record: records a run to a log for ROS 2 tools and `gloam replay`.

#include <filesystem>

#include "report.h"
#include "run_options.h"

namespace gloam::cli {
namespace {

struct RecordCommand {
  std::string file, log;
  RunOptions options;
  std::vector<std::string> topics;
  bool overwrite = false, realtime = false, durable = false, embed = false;
  double speed = 1;
};

int record(const RecordCommand& command_line, const Globals& globals) {
  RecordCommand command = command_line;
  auto scene = command.options.load(command.file);
  if (!scene.ok()) return fail(scene.error());
  RunRequest request;
  request.log.file = command.log;
  request.log.overwrite = command.overwrite;
  request.log.topics = command.topics;
  request.log.durable = command.durable;
  request.log.embed = command.embed;
  request.simulation.seed = scene->sim.seed;
  request.simulation.timestep = scene->sim.timestep.value_or(0);
  request.simulation.pace = command.realtime ? Pace::kRealTime : Pace::kFast;
  request.simulation.speed = command.speed;
  if (!command.options.resolution.empty()) {
    if (const Status status =
            parse_resolution(command.options.resolution, request.width, request.height);
        !status.ok()) {
      return fail(status.error());
    }
  }
  std::error_code code;
  if (std::filesystem::exists(command.log, code) && !command.overwrite)
    return fail({ErrorKind::kUsage,
                 "file '" + command.log + "' already exists",
                 {},
                 "choose another name, or replace it with --overwrite"});
  auto world = compile(*scene, globals, command.options.keyframe);
  if (!world.ok()) return fail(world.error());
  return run_and_report(*world, request, globals);
}

}  // namespace

void add_record(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand("record", "Simulate a scene or model into a log (MCAP)");
  auto command = std::make_shared<RecordCommand>();
  sub->add_option("FILE", command->file, "Scene or model")->required();
  sub->add_option("-o,--log", command->log, "Log file to write")->required();
  sub->add_option("--topics", command->topics,
                  "Topics to record, where * matches any text; default: all except raw images, "
                  "depth and ids")
      ->delimiter(',');
  sub->add_option("--duration", command->options.duration,
                  "Duration in seconds of simulation time; default: the scene's")
      ->check(positive_number());
  command->options.add_to(*sub);
  sub->add_flag("--overwrite", command->overwrite, "Replace an existing log");
  sub->add_flag("--durable", command->durable,
                "Sync each chunk to the disk, so that it survives a power failure");
  sub->add_flag("--embed", command->embed,
                "Embed all files of the scene in the log, to replay it on any machine");
  sub->add_flag("--realtime", command->realtime,
                "Run in real time; messages are lost if the disk is too slow");
  sub->add_option("--speed", command->speed,
                  "Simulated seconds per second of real time, with --realtime; default: 1")
      ->check(positive_number());
  sub->footer(
      "Examples:\n  gloam record examples/house_fire.toml -o fire.mcap --duration 3\n  gloam "
      "record "
      "robot.xml -o run.mcap --topics '/tf*,/*/joint_states'\n  gloam info run.mcap\n  gloam "
      "replay "
      "run.mcap --verify");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return record(*command, globals); };
  });
}

}  // namespace gloam::cli
