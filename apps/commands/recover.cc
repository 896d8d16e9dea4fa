// gloam recover: repairs a truncated or damaged log.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command.h"
#include "gloam/log.h"
#include "json_text.h"
#include "print.h"

namespace gloam::cli {
namespace {

struct RecoverCommand {
  std::string log, out;
};

int recover(const RecoverCommand& command, const Globals& globals) {
  const std::filesystem::path from = command.log;
  const std::filesystem::path to =
      command.out.empty() ? from.parent_path() / (from.stem().string() + "_recovered.mcap")
                          : std::filesystem::path(command.out);
  const auto done = recover_log(from, to);
  if (!done.ok()) return fail(done.error());
  if (globals.json) {
    const nlohmann::ordered_json json = {{"out", to.string()},
                                         {"whole", done->is_whole},
                                         {"messages", done->messages},
                                         {"messages_lost", done->messages_lost},
                                         {"bytes_lost", done->bytes_lost},
                                         {"damage", done->damage}};
    put_json(json);
  } else {
    say("{}: {} messages recovered, {} known to be lost, {} bytes unreadable\n", to.string(),
        done->messages, done->messages_lost, done->bytes_lost);
    for (const std::string& damage : done->damage) say("  {}\n", damage);
  }
  return done->messages_lost > 0 || done->bytes_lost > 0 ? 3 : 0;
}

}  // namespace

void add_recover(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand("recover", "Repair a truncated or damaged log");
  auto command = std::make_shared<RecoverCommand>();
  sub->add_option("LOG", command->log, "MCAP log from any writer")->required();
  sub->add_option("-o,--out", command->out,
                  "Repaired log to write; default: LOG_recovered.mcap beside the log");
  sub->footer("Exit codes: 0 no data lost, 3 some data lost\nExample: gloam recover run.mcap");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return recover(*command, globals); };
  });
}

}  // namespace gloam::cli
