#pragma once
// Live runs: a simulation with a page for browsers, bridges to other programs and a log, for
// commands that keep one.

#include <functional>
#include <optional>
#include <set>
#include <string>

#include "command.h"
#include "gloam/bridge.h"
#include "gloam/drive/teleop.h"
#include "gloam/log.h"
#include "gloam/view.h"
#include "interrupt.h"

namespace gloam::cli {

struct LiveCommand {
  bool view = false;
  std::set<std::string> bridges = {};  ///< names of bridge_kinds()
  bool paused = false;                 ///< waits for a client to start it
  std::optional<int> port = {};        ///< of the page; without one, of Foxglove
  double speed = 1;
  std::string pace = {};  ///< fast | realtime | sensors; "" = the scene's, else the usual one
  bool loop = false;      ///< of a log: it begins again at its end

  /// Adds --view, --paused and add_servers_to().
  void add_to(CLI::App& command);
  /// Adds a flag for each bridge, --port, --speed and --pace.
  void add_servers_to(CLI::App& command);
  /// Whether anything keeps the run alive: a page or a bridge.
  bool any(const BridgeOptions& bridges) const { return view || options(bridges).any(); }
  /// Pace of the command line, else of the scene, else `usual`.
  Pace pace_of(const Scene& scene, Pace usual) const;
  /// Bridges of the scene and of the command line.
  BridgeOptions options(const BridgeOptions& scene) const;
};

/// Live images are in real time: of the interactive tier.
void show_interactively(Scene* scene);
/// View of a scene from its first camera: the free one may stand outside the walls.
ViewOptions view_of(const Scene& scene);

/// Parts of a live run.
struct LiveRun {
  Simulation& simulation;
  ViewOptions view = {};
  BridgeOptions bridges = {};
  Pace pace = Pace::kRealTime;
  std::optional<TeleopOptions> teleop = {};
  LogRequest log = {};                                        ///< no file = none
  std::optional<double> duration = {};                        ///< [s]; empty = until Ctrl-C
  std::function<void(const std::string& url)> on_ready = {};  ///< called when the page is there
};

/// Serves it until Ctrl-C, its duration or a client ends it. `starting`: released when all of it is
/// there. Returns the exit code.
int run_live(LiveRun run, const LiveCommand& command, EndOnInterrupt& starting);

}  // namespace gloam::cli
