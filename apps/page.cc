#include "page.h"

#include <chrono>
#include <cstdio>
#include <thread>

#include "gloam/log_player.h"

namespace gloam::cli {

void ViewCommand::add_to(CLI::App& command) {
  command.add_option("--port", port, "Port of --view; 0 = any free one")
      ->check(CLI::Range(0, 65535));
  command.add_option("--speed", speed, "Simulated seconds per second, where it is paced")
      ->check(positive_number());
}

int show_page(Simulation& simulation, ViewOptions view, const ViewCommand& command,
              EndOnInterrupt& starting) {
  view.port = command.port;
  view.speed = command.speed;
  auto server = ViewServer::start(simulation, view);
  if (!server.ok()) return fail(server.error());
  starting.release();
  std::fprintf(stderr, "gloam: open %s  (Ctrl-C ends it)\n", (*server)->url().c_str());
  simulation.resume();
  while (!interrupted()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const bool is_over =
        view.player != nullptr && simulation.latest().time() >= view.player->end() - 1e-9;
    if (is_over && command.loop && !simulation.paused()) {
      if (const Status status = view.player->seek(0); !status.ok()) return fail(status.error());
    }
  }
  (*server)->stop();
  return 0;
}

}  // namespace gloam::cli
