// Cost of effects: CPU time of the stepping thread, and of pictures of the interactive tier, for a
// scene with its gases, fires, smokes, rotors, dust, weather, waters and soils, relative to the
// same scene without them. Both scenes keep their people, which have a requirement of their own.
//
//   effects_cost SCENE CAMERA [--at S] [--blocks N] [--pictures N] [--size WxH] [--each] [--json]
//
// Steps both to the time S [s], in turn through N blocks of half a second from there, and then
// takes N pictures of each, a tenth of a second of the scene apart. Prints the median of the
// ratios. --each: steps the scene with one kind of effect at a time, too.

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "bench/command_line.h"
#include "bench/median.h"
#include "gloam/scene.h"
#include "runtime/live/live_simulation.h"
#include "sim/loop/simulator.h"

namespace gloam {
namespace {

struct Options {
  std::string scene, camera;
  int at = 20;  ///< [s]
  int blocks = 10, pictures = 8, width = 640, height = 480;
  bool each = false, json = false;
};

/// Kinds of effects that a scene can keep, as bits.
enum Kept : unsigned { kNothing = 0, kGas = 1, kWeather = 2, kWater = 4, kSoil = 8, kAll = 15 };
constexpr struct {
  const char* name;
  Kept kept;
} kEach[] = {{"gas", kGas}, {"weather", kWeather}, {"water", kWater}, {"soil", kSoil}};

Scene with_only(Scene scene, Kept kept) {
  if (!(kept & kGas)) {
    scene.gases.clear(), scene.fires.clear(), scene.smokes.clear();
    scene.rotors.clear(), scene.dusts.clear();
  }
  if (!(kept & kWeather)) scene.weather.reset(), scene.adversity.reset();
  if (!(kept & kWater)) scene.waters.clear();
  if (!(kept & kSoil)) scene.soils.clear();
  return scene;
}

constexpr int kWarmUp = 4;  ///< pictures until the interactive tier's caches are full

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int64_t steps_in(double time, Rational rate) {
  return static_cast<int64_t>(time * double(rate.num) / double(rate.den) + 0.5);
}

/// CPU seconds of the stepping thread in blocks of half a second of the scene.
struct Stepping {
  std::unique_ptr<LiveSimulation> simulation;
  double wall = 0;

  static Result<Stepping> create(const World& world, double at) {
    Stepping out;
    GLOAM_TRY(out.simulation, LiveSimulation::create(world, {.pace = Pace::kLockstep}));
    GLOAM_TRY([[maybe_unused]] const double warm_up, out.advance(at));
    return out;
  }

  Result<double> advance(double time) {
    const double before = simulation->simulator().cpu_time(), begin = seconds();
    GLOAM_TRY_STATUS(simulation->step(steps_in(time, simulation->step_rate())));
    wall += seconds() - begin;
    return simulation->simulator().cpu_time() - before;
  }
};

/// A simulation and a camera that takes pictures of it.
struct Filming {
  std::unique_ptr<LiveSimulation> simulation;
  std::unique_ptr<PoseSolver> solver;
  std::unique_ptr<CameraSensor> sensor;
  PoseFrame now, before;
  int frame = 0;

  static Result<Filming> create(const World& world, const Options& options, const Scene& scene) {
    Filming out;
    GLOAM_TRY(out.simulation, LiveSimulation::create(world, {.pace = Pace::kLockstep}));
    GLOAM_TRY_STATUS(out.simulation->step(steps_in(options.at, out.simulation->step_rate())));
    GLOAM_TRY(out.solver, PoseSolver::create(world.compiled()));
    GLOAM_TRY(const auto shared, out.simulation->renderer());
    CameraRequest request;
    request.camera = options.camera;
    request.width = options.width, request.height = options.height;
    request.outputs = {"rgb"};
    request.render = scene.render;
    request.render.tier = RenderTier::kInteractive;
    GLOAM_TRY(out.sensor, CameraSensor::create(shared->description, request, 1));
    return out;
  }

  /// Wall seconds of the next picture.
  Result<double> shoot() {
    GLOAM_TRY_STATUS(simulation->step(steps_in(0.1, simulation->step_rate())));
    GLOAM_TRY_STATUS(solver->solve(simulation->latest(), now));
    // The air of the next tick is being solved for: pictures are timed alone.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    GLOAM_TRY(const auto shared, simulation->renderer());
    const double begin = seconds();
    sensor->capture(*shared->renderer, shared->turns, now, frame == 0 ? now : before, frame);
    const double took = seconds() - begin;
    ++frame;
    std::swap(now, before);
    return took;
  }
};

Status run(const Options& options) {
  GLOAM_TRY(const Scene with, load_scene(options.scene));
  const Scene without = with_only(with, kNothing);
  World worlds[2];
  GLOAM_TRY(worlds[0], World::compile(with));
  GLOAM_TRY(worlds[1], World::compile(without));

  std::vector<Stepping> stepping(2);
  for (size_t i = 0; i < 2; ++i) {
    GLOAM_TRY(stepping[i], Stepping::create(worlds[i], options.at));
  }
  if (options.each) {
    for (const auto& [name, kept] : kEach) {
      GLOAM_TRY(const World world, World::compile(with_only(with, kept)));
      GLOAM_TRY(Stepping one, Stepping::create(world, options.at));
      stepping.push_back(std::move(one));
    }
  }
  const double real_time = options.at / stepping[0].wall;
  std::vector<std::vector<double>> steps(stepping.size());
  std::vector<double> step_ratios;
  for (int n = 0; n < options.blocks; ++n) {
    for (size_t i = 0; i < stepping.size(); ++i) {
      GLOAM_TRY(const double took, stepping[i].advance(0.5));
      steps[i].push_back(took);
    }
    step_ratios.push_back(steps[0].back() / steps[1].back());
  }

  std::vector<double> pictures[2], picture_ratios;
  if (options.pictures > 0) {
    GLOAM_TRY(Filming smoky, Filming::create(worlds[0], options, with));
    GLOAM_TRY(Filming clear, Filming::create(worlds[1], options, without));
    for (int n = -kWarmUp; n < options.pictures; ++n) {
      GLOAM_TRY(const double a, smoky.shoot());
      GLOAM_TRY(const double b, clear.shoot());
      if (n < 0) continue;
      pictures[0].push_back(a), pictures[1].push_back(b);
      picture_ratios.push_back(a / b);
    }
  }
  const double per_block = double(steps_in(0.5, stepping[0].simulation->step_rate()));
  std::string each;
  for (size_t i = 2; i < stepping.size(); ++i) {
    each += fmt::format("{}\"{}\": {:.2f}", i > 2 ? ", " : "", kEach[i - 2].name,
                        1e6 * median(steps[i]) / per_block);
  }
  const char* text =
      options.json
          ? "{{\"name\": \"effects_cost\", \"step_ratio\": {:.3f}, \"step_us\": {:.2f}, "
            "\"bare_us\": {:.2f}, \"picture_ratio\": {:.3f}, \"picture_ms\": {:.1f}, "
            "\"clear_ms\": {:.1f}, \"real_time\": {:.2f}, \"each_us\": {{{}}}}}\n"
          : "stepping: {:.3f} times the CPU time without effects ({:.2f} us a step, {:.2f} "
            "without); pictures of the interactive tier: {:.3f} times the time ({:.1f} ms, {:.1f} "
            "ms "
            "without); {:.2f} times real time in all; one kind alone, us a step: {}\n";
  fmt::print(fmt::runtime(text), median(step_ratios), 1e6 * median(steps[0]) / per_block,
             1e6 * median(steps[1]) / per_block, median(picture_ratios), 1e3 * median(pictures[0]),
             1e3 * median(pictures[1]), real_time, each);
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::Options options;
  gloam::CommandLine line(argc, argv);
  options.json = line.flag("--json");
  options.each = line.flag("--each");
  line.size(&options.width, &options.height);
  line.value("--at", &options.at);
  line.value("--blocks", &options.blocks);
  line.value("--pictures", &options.pictures, 0);
  if (line.words().size() != 2) {
    fmt::print(stderr,
               "usage: effects_cost SCENE CAMERA [--at S] [--blocks N] [--pictures N] [--size WxH] "
               "[--each] [--json]\n");
    return 2;
  }
  options.scene = line.words()[0], options.camera = line.words()[1];
  return gloam::exit_code(gloam::run(options));
}
