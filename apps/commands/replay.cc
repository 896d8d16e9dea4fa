// gloam replay: steps a log's run again, and says whether it came out the same.

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "command.h"
#include "gloam/log.h"
#include "json_text.h"

namespace gloam::cli {
namespace {

struct ReplayCommand {
  std::string log, folder;
  bool verify = false;
};

int replay(const ReplayCommand& command, const Globals& globals) {
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
  CLI::App* sub = app.add_subcommand("replay", "Step the run of a log again");
  auto command = std::make_shared<ReplayCommand>();
  sub->add_option("LOG", command->log, "Log that Gloam has written")->required();
  sub->add_flag("--verify", command->verify,
                "Compare every logged state and hash: 0 of N steps differ")
      ->required();
  sub->add_option("--folder", command->folder,
                  "Where the scene's files are; default: where they were");
  sub->footer(
      "Exit codes: 0 equal, 1 different, 3 a run could not be verified\nExample: gloam replay "
      "run.mcap --verify");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return replay(*command, globals); };
  });
}

}  // namespace gloam::cli
