// Serves the page with a made-up simulation until stdin ends: prints the address.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>

#include "../fake_simulation.h"
#include "gloam/view.h"

int main(int argc, char** argv) {
  gloam::FakeSimulation simulation;
  const int port = argc > 1 ? std::atoi(argv[1]) : 0;
  auto server = gloam::ViewServer::start(simulation, {.port = port, .width = 640, .height = 480});
  if (!server.ok()) {
    std::cerr << server.error().to_string() << '\n';
    return server.error().exit_code();
  }
  simulation.resume();
  std::cout << (*server)->url() << std::endl;
  std::string line;
  while (std::getline(std::cin, line)) {
    // For looking at the banner.
    if (line == "fail")
      simulation.fail({.kind = gloam::ErrorKind::kDiverged,
                       .message = "the physics diverged at step 1234",
                       .hint = "reset, or use a smaller timestep"});
  }
  return 0;
}
