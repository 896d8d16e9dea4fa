// gloam replay: steps a log's run again, to say whether it comes out the same, or to look at it
// under another sky.

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "gloam/log.h"
#include "gloam/log_replay.h"
#include "json_text.h"
#include "outputs.h"
#include "report.h"
#include "run_options.h"

namespace gloam::cli {
namespace {

struct ReplayCommand {
  std::string log, folder, out, to_log, resolution;
  std::vector<std::string> settings, cameras, outputs;
  double duration = 0;
  bool verify = false, overwrite = false;
};

int look_again(const ReplayCommand& command, const Globals& globals) {
  if (command.out.empty() && command.to_log.empty())
    return fail({ErrorKind::kUsage,
                 "nothing is asked for",
                 {},
                 "--verify compares; --out FOLDER or --log FILE records the run again"});
  LogReplay replay{.log = command.log, .folder = command.folder};
  for (const std::string& setting : command.settings) {
    auto split = split_setting(setting);
    if (!split.ok()) return fail(split.error());
    replay.settings.push_back(std::move(*split));
  }
  if (const Status known = check_outputs(command.outputs); !known.ok()) return fail(known.error());
  replay.outputs = command.outputs;
  replay.request.out = command.out;
  replay.request.log.file = command.to_log;
  replay.request.overwrite = command.overwrite;
  replay.request.cameras = command.cameras;
  replay.request.duration = command.duration;
  if (!command.resolution.empty()) {
    if (const Status size =
            parse_resolution(command.resolution, replay.request.width, replay.request.height);
        !size.ok())
      return fail(size.error());
  }
  return tell_of(replay_log(replay, progress_display(globals)), globals);
}

int replay(const ReplayCommand& command, const Globals& globals) {
  if (!command.verify) return look_again(command, globals);
  const auto found = verify_log(command.log, command.folder, progress_display(globals));
  finish_progress();
  if (!found.ok()) return fail(found.error());
  if (globals.json) {
    const nlohmann::ordered_json json = {
        {"runs", found->runs},           {"steps", found->steps}, {"states", found->states},
        {"differing", found->differing}, {"run", found->run},     {"equal_step", found->equal_step},
        {"step", found->step},           {"where", found->where}, {"notes", found->notes}};
    std::printf("%s\n", json_text(json).c_str());
  } else {
    fmt::print("{} of {} steps differ ({} states compared in {} run{})\n", found->differing,
               found->steps, found->states, found->runs, found->runs == 1 ? "" : "s");
    if (!found->is_equal())
      fmt::print("run {}: equal up to step {}, not at step {}: {}\n", found->run, found->equal_step,
                 found->step, found->where);
    for (const std::string& note : found->notes) fmt::print("note: {}\n", note);
  }
  return found->is_equal() && found->notes.empty() ? 0 : found->is_equal() ? 3 : 1;
}

}  // namespace

void add_replay(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand(
      "replay", "Step the run of a log again: compare it, or record it under another sky");
  auto command = std::make_shared<ReplayCommand>();
  sub->add_option("LOG", command->log, "Log that Gloam has written")->required();
  sub->add_flag("--verify", command->verify,
                "Compare every logged state and hash: 0 of N steps differ");
  sub->add_option("--folder", command->folder,
                  "Where the scene's files are; default: where they were");
  sub->add_option("--set", command->settings,
                  "Change what is seen, as weather.visibility=8 (repeatable)");
  sub->add_option("--out", command->out, "Results folder of the run as it is seen now");
  sub->add_option("--log", command->to_log, "New log of it");
  sub->add_flag("--overwrite", command->overwrite, "Replace an existing results folder");
  sub->add_option("--camera", command->cameras, "Cameras to record; default: the scene's")
      ->delimiter(',');
  sub->add_option("--output", command->outputs, "What to record, as of `gloam run`")
      ->delimiter(',');
  sub->add_option("--resolution", command->resolution, "WIDTHxHEIGHT of every camera");
  sub->add_option("--duration", command->duration, "Seconds of it; default: all")
      ->check(positive_number());
  sub->footer(
      "Exit codes of --verify: 0 equal, 1 different, 3 a run could not be verified\nExamples:\n  "
      "gloam replay run.mcap --verify\n  gloam replay run.mcap --set weather.visibility=8 --set "
      "render.tier=direct --out results/foggy");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return replay(*command, globals); };
  });
}

}  // namespace gloam::cli
