// gloam replay: replays the run of a log, to verify it or to record it with another appearance.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "gloam/log.h"
#include "gloam/log_player.h"
#include "gloam/log_replay.h"
#include "gloam/program.h"
#include "json_text.h"
#include "live.h"
#include "outputs.h"
#include "print.h"
#include "replay_flags.h"
#include "report.h"
#include "run_options.h"

namespace gloam::cli {
namespace {

struct ReplayCommand {
  std::string log, folder, out, to_log, resolution, adversity, randomize;
  std::vector<std::string> settings, overlays, cameras, outputs;
  std::optional<uint64_t> seed;
  int64_t run = 0, variants = 0;
  double duration = 0;
  bool verify = false, poses = false, restep = false, overwrite = false;
  RenderFlags render;
  LiveCommand live;
};

Result<LogReplay> replay_of(const ReplayCommand& command) {
  LogReplay replay{.log = command.log, .folder = command.folder, .run = command.run};
  if (command.poses) replay.motion = ReplayMotion::kPoses;
  if (command.restep) replay.motion = ReplayMotion::kNewRun;
  replay.overlays.assign(command.overlays.begin(), command.overlays.end());
  replay.draw_seed = command.seed;
  if (!command.adversity.empty())
    replay.settings.emplace_back("adversity.level", command.adversity);
  for (const std::string& setting : command.settings) {
    GLOAM_TRY(auto split, split_setting(setting));
    replay.settings.push_back(std::move(split));
  }
  for (auto& setting : command.render.as_settings()) replay.settings.push_back(std::move(setting));
  GLOAM_TRY_STATUS(check_outputs(command.outputs));
  replay.outputs = command.outputs;
  replay.request.out = command.out;
  replay.request.log.file = command.to_log;
  replay.request.overwrite = command.overwrite;
  replay.request.cameras = command.cameras;
  replay.request.duration = command.duration;
  if (!command.resolution.empty())
    GLOAM_TRY_STATUS(
        parse_resolution(command.resolution, replay.request.width, replay.request.height));
  return replay;
}

int record_variants(const ReplayCommand& command, LogReplay replay, const Globals& globals) {
  if (command.randomize.empty())
    return fail({ErrorKind::kUsage,
                 "--variants requires --randomize",
                 {},
                 "give a file with [[randomize]] tables"});
  const VariantRequest request{.replay = std::move(replay),
                               .randomize = command.randomize,
                               .count = command.variants,
                               .first_seed = command.seed.value_or(1)};
  const auto variants = replay_variants(request, progress_display(globals));
  finish_progress();
  if (!variants.ok()) return fail(variants.error());
  if (globals.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const ReplayVariant& v : *variants)
      json.push_back({{"seed", v.seed}, {"out", v.out.string()}, {"was_done", v.was_done}});
    put_json(json);
  } else {
    for (const ReplayVariant& v : *variants)
      say("{}  seed {}{}\n", v.out.string(), v.seed, v.was_done ? "  (already done)" : "");
  }
  return 0;
}

int play(const ReplayCommand& command, const LogReplay& replay) {
  EndOnInterrupt starting;
  auto player = LogPlayer::open(replay);
  if (!player.ok()) return fail(player.error());
  LiveRun run{(*player)->simulation()};
  run.view.width = replay.request.width;
  run.view.height = replay.request.height;
  if (!replay.request.cameras.empty()) run.view.camera = replay.request.cameras.front();
  run.view.player = player->get();
  command.render.apply_to(&run.view.render);
  if (replay.request.duration > 0)
    run.duration = std::min(replay.request.duration, (*player)->end());
  run.bridges = command.live.options({});
  run.pace = command.live.pace_of({}, Pace::kRealTime);
  return run_live(std::move(run), command.live, starting);
}

int look_again(const ReplayCommand& command, const Globals& globals) {
  if (command.out.empty() && command.to_log.empty() && !command.live.any({}))
    return fail({ErrorKind::kUsage,
                 "no action given",
                 {},
                 "use --verify to compare the run, --out FOLDER or --log FILE to record it again, "
                 "or --view to show it"});
  auto replay = replay_of(command);
  if (!replay.ok()) return fail(replay.error());
  if (command.live.any({})) return play(command, *replay);
  if (command.variants > 0) return record_variants(command, *std::move(replay), globals);
  return tell_of(replay_log(*replay, progress_display(globals)), globals);
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
    put_json(json);
  } else {
    say("{} of {} steps differ ({} states compared in {} run{})\n", found->differing, found->steps,
        found->states, found->runs, found->runs == 1 ? "" : "s");
    if (!found->is_equal())
      say("run {}: equal up to step {}, different at step {}: {}\n", found->run, found->equal_step,
          found->step, found->where);
    for (const std::string& note : found->notes) say("note: {}\n", note);
  }
  return found->is_equal() && found->notes.empty() ? 0 : found->is_equal() ? 3 : 1;
}

}  // namespace

void add_replay(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub =
      app.add_subcommand("replay", "Replay a log: verify it, or record it with another appearance");
  auto command = std::make_shared<ReplayCommand>();
  sub->add_option("LOG", command->log, "Log written by Gloam")->required();
  sub->add_flag("--verify", command->verify,
                "Step all runs again and compare every logged state and hash");
  sub->add_option("--folder", command->folder,
                  "Folder of the scene's files, or one above it; default: beside the log, or the "
                  "original place on this machine");
  sub->add_option("--run", command->run,
                  "Run of the log, counted from 0; each reset starts a new run");
  sub->add_flag("--poses", command->poses,
                "Move bodies by the logged states instead of stepping the run again");
  sub->add_flag("--restep", command->restep,
                "Let changes affect the motion: a new run with the log's Commands")
      ->excludes("--poses");
  sub->add_option(
      "--overlay", command->overlays,
      "Scene file whose tables are applied on top of the scene: cameras, lamps … (repeatable)");
  sub->add_option("--adversity", command->adversity, "Level of adversity: none, minor or major");
  sub->add_option("--variants", command->variants,
                  "Number of variants to record, into OUT/0000, 0001 …")
      ->check(CLI::Range(1, 1000000));
  sub->add_option("--randomize", command->randomize,
                  "Scene file with the [[randomize]] tables of the variants")
      ->check(CLI::ExistingFile);
  sub->add_option("--seed", command->seed,
                  "Seed of the [[randomize]] tables of overlays, or of the first variant");
  sub->add_option("--set", command->settings,
                  "Change a setting of the appearance, such as weather.visibility=8 (repeatable)");
  command->render.add_to(*sub);
  sub->add_option("--out", command->out, "Results folder of the replay");
  sub->add_option("--log", command->to_log, "Log file of the replay");
  sub->add_flag("--overwrite", command->overwrite, "Replace an existing results folder");
  sub->add_option("--camera", command->cameras,
                  "Name of a camera to record (repeatable); default: the scene's cameras")
      ->delimiter(',');
  sub->add_option("--output", command->outputs, "Outputs to record, as in `gloam run`")
      ->delimiter(',');
  sub->add_option("--resolution", command->resolution,
                  "Image size of every camera in pixels, as WIDTHxHEIGHT");
  sub->add_option("--duration", command->duration,
                  "Duration in seconds of simulation time; default: the whole run")
      ->check(positive_number());
  sub->add_flag("--loop", command->live.loop, "Live replays: start again at the end");
  command->live.add_to(*sub);
  sub->footer(
      "Exit codes of --verify: 0 equal, 1 different, 3 a run could not be verified\nExamples:\n  "
      "gloam replay run.mcap --verify\n  gloam replay run.mcap --set weather.visibility=8 --set "
      "sky.sun_elevation=4 --tier direct --out results/foggy\n  gloam replay run.mcap --variants 8 "
      "--randomize "
      "skies.toml --out results/skies\n  gloam replay run.mcap --view");
  sub->callback([&globals, &action, command, sub] {
    action = [&globals, command, sub] {
      if (const Status status = refuse_void_flags(*sub); !status.ok()) return fail(status.error());
      set_thread_count(command->render.threads);
      return replay(*command, globals);
    };
  });
}

}  // namespace gloam::cli
