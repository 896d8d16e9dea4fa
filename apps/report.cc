#include "report.h"

#include "json_text.h"
#include "print.h"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

namespace gloam::cli {

int run_and_report(const World& world, const RunRequest& request, const Globals& globals) {
  return tell_of(run_and_record(world, request, progress_display(globals)), globals);
}

int tell_of(const Result<RunReport>& report, const Globals& globals) {
  finish_progress();
  if (!report.ok()) return fail(report.error());
  for (const std::string& note : report->notes) tell("gloam: note: {}\n", note);
  const double factor = report->wall_time > 0 ? report->sim_time / report->wall_time : 0;
  if (globals.json) {
    nlohmann::ordered_json json = {
        {"out", report->out.string()},
        {"steps", report->steps},
        {"sim_time_s", report->sim_time},
        {"wall_time_s", report->wall_time},
        {"realtime_factor", factor},
        {"state_hash", fmt::format("{:016x}", report->hash)},
        {"frames", report->frames},
        {"written", report->written},
        {"notes", report->notes},
        {"error", report->status.ok() ? "" : report->status.error().to_string()}};
    put_json(json);
  } else {
    say("simulated {:.3f} s in {:.1f} s ({:.2f} x real time), {} steps, state hash {:016x}\n",
        report->sim_time, report->wall_time, factor, report->steps, report->hash);
    if (!report->out.empty()) {
      const std::string pictures =
          report->frames > 0 ? fmt::format(" ({} pictures)", report->frames) : std::string();
      say("results in {}{}:\n", report->out.string(), pictures);
      for (const std::string& file : report->written) say("  {}\n", file);
    }
  }
  return report->status.ok() ? 0 : fail(report->status.error());
}

}  // namespace gloam::cli
