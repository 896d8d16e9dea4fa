// gloam report: results folders as one HTML file, for people.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "command.h"
#include "gloam/report.h"
#include "json_text.h"
#include "print.h"

namespace gloam::cli {
namespace {

struct ReportCommand {
  std::vector<std::string> runs;
  std::string out = "report.html";
  ReportRequest request;
};

int write_page(const ReportCommand& command, const Globals& globals) {
  ReportRequest request = command.request;
  request.runs.assign(command.runs.begin(), command.runs.end());
  request.out = command.out;
  const auto outcome = write_report(request);
  if (!outcome.ok()) return fail(outcome.error());
  for (const Error& error : outcome->left_out) tell("gloam: omitted: {}\n", error.to_string());
  if (globals.json) {
    nlohmann::ordered_json json = {{"out", request.out.string()},
                                   {"runs", outcome->runs},
                                   {"pictures", outcome->pictures},
                                   {"bytes", outcome->bytes},
                                   {"left_out", nlohmann::ordered_json::array()}};
    for (const Error& error : outcome->left_out) json["left_out"].push_back(error.to_string());
    put_json(json);
  } else {
    say("{}: {} run{}, {} images, {:.1f} MB\n", request.out.string(), outcome->runs,
        outcome->runs == 1 ? "" : "s", outcome->pictures,
        1e-6 * static_cast<double>(outcome->bytes));
  }
  return outcome->left_out.empty() ? 0 : Error{ErrorKind::kPartial, ""}.exit_code();
}

}  // namespace

void add_report(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand("report", "Create one HTML report from results folders");
  auto command = std::make_shared<ReportCommand>();
  sub->add_option("RUN", command->runs, "Results folders of gloam run or gloam replay")->required();
  sub->add_option("-o,--out", command->out, "HTML file to write; default: report.html");
  sub->add_flag("--overwrite", command->request.overwrite, "Replace an existing file");
  sub->add_option("--title", command->request.title, "Heading; default: the scenes' names");
  sub->add_option("--instants", command->request.instants,
                  "Number of images per camera and run; default: 6")
      ->check(CLI::Range(1, 24));
  sub->footer(
      "Exit code 3: some results could not be read; the page lists them\nExamples:\n  gloam report "
      "results/clear results/smoky results/night -o weather.html\n  gloam report results/walk-* -o "
      "walk.html");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return write_page(*command, globals); };
  });
}

}  // namespace gloam::cli
