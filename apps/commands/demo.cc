// gloam demo: the main job, a quadruped walking through a path-traced room.

#include "gloam/program.h"
#include "report.h"
#include "run_options.h"

namespace gloam::cli {
namespace {

int demo(bool quick, const std::string& out, const Globals& globals) {
  auto home = gloam_home();
  if (!home.ok()) return fail(home.error());
  auto scene = load_scene(*home / "examples" / "demo.toml");
  if (!scene.ok()) return fail(scene.error());
  RunRequest request;
  request.overwrite = true;  // the demo's own folder: a second run replaces the first
  request.out = out.empty() ? (quick ? "results/demo-quick" : "results/demo") : out;
  if (quick) {
    scene->sim.duration = 4;
    request.rate = {5, 1};
  }
  auto world = compile(*scene, globals);
  if (!world.ok()) return fail(world.error());
  request.simulation.seed = scene->sim.seed;
  return run_and_report(*world, request, globals);
}

}  // namespace

void add_demo(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub =
      app.add_subcommand("demo", "A quadruped walks 10 s through a furnished, path-traced room");
  auto quick = std::make_shared<bool>(false);
  auto out = std::make_shared<std::string>();
  sub->add_flag("--quick", *quick, "4 s at 5 pictures a second: under a minute");
  sub->add_option("--out", *out, "Results folder; default results/demo");
  sub->footer("Example:\n  gloam demo --quick");
  sub->callback([&globals, &action, quick, out] {
    action = [&globals, quick, out] { return demo(*quick, *out, globals); };
  });
}

}  // namespace gloam::cli
