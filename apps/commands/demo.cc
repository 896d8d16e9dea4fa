// gloam demo: the main job, a quadruped walking through a path-traced room; and what smoke, dust,
// the dark and people cost its sensors.

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "gloam/program.h"
#include "json_text.h"
#include "print.h"
#include "report.h"
#include "run_options.h"

namespace gloam::cli {
namespace {

struct DemoCommand {
  std::string which, out;
  bool quick = false;
};

int demo_walk(const DemoCommand& command, const Globals& globals) {
  auto home = gloam_home();
  if (!home.ok()) return fail(home.error());
  auto scene = load_scene(*home / "examples" / "demo.toml");
  if (!scene.ok()) return fail(scene.error());
  RunRequest request;
  request.overwrite = true;  // the demo's own folder: a second run replaces the first
  request.out =
      !command.out.empty() ? command.out : (command.quick ? "results/demo-quick" : "results/demo");
  if (command.quick) {
    scene->sim.duration = 4;
    request.rate = {5, 1};
  }
  auto world = compile(*scene, globals);
  if (!world.ok()) return fail(world.error());
  request.simulation.seed = scene->sim.seed;
  return run_and_report(*world, request, globals);
}

/// The scene under the levels of adversity. A place on fire burns by its level, too.
std::vector<ComparisonRequest::Row> by_level(const Scene& scene, bool quick) {
  std::vector<ComparisonRequest::Row> rows;
  for (const char* level : {"none", "minor", "major"}) {
    Scene& row = rows.emplace_back(ComparisonRequest::Row{level, scene}).scene;
    row.adversity.emplace().level = level;
    const double burns = row.adversity->level == "major" ? 1.0 : 0.3;
    for (FireOptions& fire : row.fires) fire.power *= burns;
    if (row.adversity->level == "none") {
      row.fires.clear();
      std::erase_if(row.temperatures, [](const TemperatureOptions& of) {
        return of.body.starts_with("people");  // nobody is there
      });
    }
    if (quick) row.sim.duration = 3;
  }
  return rows;
}

int demo_adversity(const DemoCommand& command, const Globals& globals) {
  auto home = gloam_home();
  if (!home.ok()) return fail(home.error());
  ComparisonRequest request;
  request.camera = "eye";
  request.lidar = "top";
  request.rate = {command.quick ? 1 : 4, 1};
  request.out = !command.out.empty() ? command.out : "results/adversity";
  std::error_code error;
  std::filesystem::create_directories(request.out, error);
  if (error) {
    return fail(Error{ErrorKind::kInput, fmt::format("cannot create folder {}: {}",
                                                     request.out.string(), error.message())});
  }
  nlohmann::json json = nlohmann::json::array();
  if (!globals.json)
    std::printf("place      level  visibility  illuminance  contrast  LiDAR returns  from media\n");
  for (const char* place : {"house", "warehouse"}) {
    auto scene = load_scene(*home / "examples" / fmt::format("adversity_{}.toml", place));
    if (!scene.ok()) return fail(scene.error());
    request.name = place;
    request.rows = by_level(*scene, command.quick);
    for (const char* ending : {".mp4", ".png"})  // the demo's own: a second run replaces the first
      std::filesystem::remove(request.out / (request.name + ending), error);
    auto results = compare_scenes(request, progress_display(globals));
    finish_progress();
    if (!results.ok()) return fail(results.error());
    for (const ComparisonResult& row : *results) {
      if (globals.json) {
        json.push_back({{"place", place},
                        {"level", row.name},
                        {"visibility_m", row.visibility},
                        {"illuminance_lx", row.illuminance},
                        {"contrast", row.contrast},
                        {"lidar_returns", row.lidar_returns},
                        {"media_returns", row.media_returns}});
        continue;
      }
      const std::string visibility =
          row.visibility >= 1e5 ? "clear" : fmt::format("{:.1f} m", row.visibility);
      std::printf("%-9s  %-5s  %10s  %8.0f lx  %8.2f  %13.2f  %10.2f\n", place, row.name.c_str(),
                  visibility.c_str(), row.illuminance, row.contrast, row.lidar_returns,
                  row.media_returns);
    }
  }
  if (globals.json) {
    put_json(json);
  } else {
    tell("gloam: videos of both places are in {}\n", request.out.string());
  }
  return 0;
}

}  // namespace

void add_demo(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand(
      "demo", "Run the demo: a quadruped walks through a furnished, path-traced room for 10 s");
  auto command = std::make_shared<DemoCommand>();
  sub->add_option("WHICH", command->which,
                  "adversity: a house on fire and a dusty warehouse, at each level of adversity")
      ->check(CLI::IsMember({"adversity"}));
  sub->add_flag("--quick", command->quick,
                "Simulate 4 s at 5 images per second, in under a minute; with adversity 3 s at one "
                "image per second, in two minutes");
  sub->add_option("--out", command->out,
                  "Results folder; default: results/demo or results/adversity");
  sub->footer("Examples:\n  gloam demo --quick\n  gloam demo adversity");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] {
      return command->which.empty() ? demo_walk(*command, globals)
                                    : demo_adversity(*command, globals);
    };
  });
}

}  // namespace gloam::cli
