#pragma once
// The live page of a simulation, for commands that show one.

#include "command.h"
#include "gloam/view.h"
#include "interrupt.h"

namespace gloam::cli {

struct ViewCommand {
  int port = 8080;
  double speed = 1;
  bool loop = false;  ///< of a log: it begins again at its end

  /// Adds --port and --speed.
  void add_to(CLI::App& command);
};

/// Serves the page until Ctrl-C. `starting`: released when the page is there.
int show_page(Simulation& simulation, ViewOptions view, const ViewCommand& command,
              EndOnInterrupt& starting);

}  // namespace gloam::cli
