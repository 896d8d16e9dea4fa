// Lists what a simulation says, then counts what comes over half a second of it.

#include <atomic>
#include <chrono>
#include <thread>

#include "example.h"

int main(int argc, char** argv) {
  const gloam::World world = world_of(argc, argv);
  for (const gloam::StreamInfo& stream : world.streams())
    std::printf("%s %s (%s)\n", to_string(stream.kind), stream.name.c_str(),
                stream.frame_id.c_str());
  const auto simulation = take(gloam::Simulation::create(world, {.pace = gloam::Pace::kLockstep}));
  std::atomic<int> snapshots = 0, frames = 0;
  {
    const auto states = take(simulation->open_snapshots(
        {.rate = {50, 1}, .required = true}, [&](const gloam::Snapshot&) { ++snapshots; }));
    gloam::CameraRequest request{.width = 64, .height = 48, .required = true};
    request.render.spp = 1;
    const auto camera = take(simulation->open_camera(
        request, [&](std::shared_ptr<const gloam::CameraFrame>) { ++frames; }));
    const gloam::Rational rate = simulation->step_rate();
    check(simulation->step(rate.num / rate.den / 2));
    while (snapshots < 26 || frames < 11) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::printf("%d snapshots, %d frames\n", snapshots.load(), frames.load());
}
