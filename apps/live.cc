#include "live.h"

#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "gloam/log_player.h"
#include "print.h"
#include "report.h"
#include "status_line.h"

namespace gloam::cli {
namespace {

// A log that plays begins again at its end.
Status play_again(const LiveRun& run, const LiveCommand& command) {
  LogPlayer* const player = run.view.player;
  if (player == nullptr || !command.loop || run.simulation.paused()) return {};
  if (run.simulation.latest().time() < player->end() - 1e-9) return {};
  return player->seek(0);
}

/// Servers of a live run; null = not requested.
struct LiveParts {
  std::unique_ptr<ViewServer> page;
  std::unique_ptr<LogStream> log;
  std::unique_ptr<Bridges> bridges;
  std::unique_ptr<Teleop> teleop;
};

void tell_help(const Teleop& teleop) {
  for (const std::string& line : teleop.help()) tell("{}\n", line);
}

void show_teleop(Teleop& teleop, const Simulation& simulation, StatusLine* line) {
  const std::vector<std::string> notices = teleop.take_notices();
  const bool shows_help = teleop.take_help_request();
  if (shows_help || !notices.empty()) line->clear();
  if (shows_help) tell_help(teleop);
  for (const std::string& notice : notices) tell("gloam: {}\n", notice);
  line->show(fmt::format("{}  {:.2f}x real time{}", teleop.status(),
                         simulation.stats().realtime_factor,
                         simulation.paused() ? "  paused" : ""));
}

Status keep_running(const LiveRun& run, const LiveCommand& command, const LiveParts& parts) {
  const Bridges* const bridges = parts.bridges.get();
  const LogStream* const log = parts.log.get();
  StatusLine line;
  while (!interrupted()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (parts.teleop != nullptr) {
      show_teleop(*parts.teleop, run.simulation, &line);
      if (parts.teleop->end_asked()) break;
    }
    GLOAM_TRY_STATUS(play_again(run, command));
    GLOAM_TRY_STATUS(run.simulation.status());
    if (log != nullptr) GLOAM_TRY_STATUS(log->status());
    if (run.duration && run.simulation.latest().time() >= *run.duration - 1e-9) break;
    if (bridges == nullptr) continue;
    if (bridges->end_asked()) break;
    for (const auto& bridge : bridges->list()) GLOAM_TRY_STATUS(bridge->status());
  }
  return {};
}

// A run of a given length rests at its end.
void begin(const LiveRun& run, const LiveCommand& command) {
  if (!command.paused) run.simulation.resume();
  std::fprintf(stderr, "gloam: %s; Ctrl-C ends it\n",
               command.paused ? "paused until a client starts it" : "running");
}

}  // namespace

void show_interactively(Scene* scene) {
  scene->render.tier = RenderTier::kInteractive;
  scene->render.error.reset();
}

ViewOptions view_of(const Scene& scene) {
  ViewOptions view{.render = scene.render};
  if (!scene.cameras.empty()) view.camera = scene.cameras.front().name;
  return view;
}

void LiveCommand::add_to(CLI::App& app) {
  app.add_flag("--view", view, "Serve the studio on this machine instead of recording");
  app.add_flag("--paused", paused, "Live runs: start paused, until a client starts the simulation");
  add_servers_to(app);
}

void LiveCommand::add_servers_to(CLI::App& app) {
  for (const BridgeKind& kind : bridge_kinds())
    app.add_flag_callback(
        "--" + kind.name, [this, name = kind.name] { bridges.insert(name); }, kind.help);
  app.add_option("--port", port,
                 "Port of the studio, or without --view of the Foxglove server; default: 8080 "
                 "or 8765; 0: any free port")
      ->check(CLI::Range(0, 65535));
  app.add_option("--speed", speed,
                 "Simulated seconds per second of real time, unless the pace is fast; default: 1")
      ->check(positive_number());
  app.add_option("--pace", pace,
                 "fast: as fast as possible; realtime: in real time, slow sensors lose messages; "
                 "sensors: at most in real time, waits for all subscribed sensors")
      ->check(CLI::IsMember({"fast", "realtime", "sensors"}));
}

Pace LiveCommand::pace_of(const Scene& scene, Pace usual) const {
  const std::string& name = pace.empty() ? scene.sim.pace : pace;
  const Result<Pace> named = enum_named<Pace>(name);
  return named.ok() ? *named : usual;
}

BridgeOptions LiveCommand::options(const BridgeOptions& scene) const {
  BridgeOptions options = scene;
  for (const BridgeKind& kind : bridge_kinds())
    if (bridges.contains(kind.name)) kind.request(&options);
  if (!view && port && options.foxglove) options.foxglove->port = *port;
  return options;
}

namespace {

Result<LiveParts> start_parts(LiveRun& run, const LiveCommand& command) {
  Simulation& simulation = run.simulation;
  LiveParts parts;
  if (command.view) {
    if (command.port) run.view.port = *command.port;
    run.view.speed = command.speed;
    run.view.pace = run.pace;
    GLOAM_TRY(parts.page, ViewServer::start(simulation, run.view));
    std::fprintf(stderr, "gloam: open %s\n", parts.page->url().c_str());
    if (run.on_ready) run.on_ready(parts.page->url());
  }
  if (!run.log.file.empty()) {
    run.log.required = false;
    GLOAM_TRY(parts.log, start_log(simulation, run.log));
  }
  if (run.bridges.any()) {
    GLOAM_TRY(parts.bridges, Bridges::start(simulation, run.bridges, run.view.player));
    for (const auto& bridge : parts.bridges->list())
      tell("gloam: {}: {}\n", bridge->name(), bridge->address());
  }
  if (run.teleop) {
    GLOAM_TRY(parts.teleop, Teleop::start(simulation, *run.teleop));
    tell_help(*parts.teleop);
  }
  return parts;
}

}  // namespace

int run_live(LiveRun run, const LiveCommand& command, EndOnInterrupt& starting) {
  Simulation& simulation = run.simulation;
  simulation.set_pace(run.pace, command.speed);
  auto started = start_parts(run, command);
  if (!started.ok()) return fail(started.error());
  LiveParts& parts = *started;
  stop_on_interrupt();
  starting.release();
  begin(run, command);
  const Status status = keep_running(run, command, parts);
  if (parts.log != nullptr) finish_on_interrupt();
  parts.teleop.reset();   // the robot stops
  parts.bridges.reset();  // no client changes the end of the log
  if (parts.page != nullptr) parts.page->stop();
  int code = status.ok() ? 0 : fail(status.error());
  const SimulationStats stats = simulation.stats();
  for (const std::string& line : sensor_table(stats.sensors)) tell("{}\n", line);
  if (parts.log != nullptr) {
    if (const Status finished = parts.log->finish(); !finished.ok()) code = fail(finished.error());
    tell("gloam: {}\n", run.log.file.string());
  }
  return code;
}

}  // namespace gloam::cli
