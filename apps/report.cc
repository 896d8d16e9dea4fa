#include "report.h"

#include "json_text.h"
#include "print.h"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

namespace gloam::cli {

std::vector<std::string> sensor_table(const std::vector<SensorCost>& sensors) {
  if (sensors.empty()) return {};
  std::vector<std::string> lines = {fmt::format("  {:<32} {:>10} {:>11} {:>9} {:>8} {:>11} {:>11}",
                                                "stream", "target Hz", "achieved Hz", "messages",
                                                "dropped", "ms each", "ms waiting")};
  for (const SensorCost& s : sensors) {
    const std::string achieved = s.achieved > 0 ? fmt::format("{:.2f}", s.achieved) : "-";
    lines.push_back(fmt::format("  {:<32} {:>10.5g} {:>11} {:>9} {:>8} {:>11.3f} {:>11.3f}", s.name,
                                s.rate, achieved, s.messages, s.dropped, s.wall_ms, s.waited_ms));
  }
  return lines;
}

namespace {

nlohmann::ordered_json sensors_json(const std::vector<SensorCost>& sensors) {
  auto list = nlohmann::ordered_json::array();
  for (const SensorCost& s : sensors)
    list.push_back({{"name", s.name},
                    {"rate_hz", s.rate},
                    {"achieved_hz", s.achieved},
                    {"messages", s.messages},
                    {"dropped", s.dropped},
                    {"wall_ms", s.wall_ms},
                    {"waited_ms", s.waited_ms}});
  return list;
}

}  // namespace

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
        {"sensors", sensors_json(report->sensors)},
        {"error", report->status.ok() ? "" : report->status.error().to_string()}};
    put_json(json);
  } else {
    say("simulated {:.3f} s in {:.1f} s ({:.2f} x real time), {} steps, state hash {:016x}\n",
        report->sim_time, report->wall_time, factor, report->steps, report->hash);
    for (const std::string& line : sensor_table(report->sensors)) say("{}\n", line);
    if (!report->out.empty()) {
      const std::string pictures =
          report->frames > 0 ? fmt::format(" ({} images)", report->frames) : std::string();
      say("results in {}{}:\n", report->out.string(), pictures);
      for (const std::string& file : report->written) say("  {}\n", file);
    }
  }
  return report->status.ok() ? 0 : fail(report->status.error());
}

}  // namespace gloam::cli
