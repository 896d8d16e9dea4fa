// Keeps Snapshots of a run and renders them afterwards, from the same view at two sizes.

#include <vector>

#include "example.h"
#include "gloam/render.h"

int main(int argc, char** argv) {
  const gloam::World world = world_of(argc, argv);
  const auto simulation = take(gloam::Simulation::create(world, {.pace = gloam::Pace::kLockstep}));
  std::vector<gloam::Snapshot> kept;
  for (int i = 0; i < 3; ++i) {
    kept.push_back(simulation->latest());
    check(simulation->step(50));
  }
  gloam::SceneRenderer renderer = take(gloam::SceneRenderer::create(world));
  gloam::CameraRequest request{.width = 64, .height = 48, .outputs = {"rgb", "depth"}};
  request.render.spp = 4;
  for (const gloam::Snapshot& snapshot : kept) {
    const auto frame = take(renderer.render({&snapshot, 1}, request));
    size_t hits = 0;
    for (const float depth : frame->depth) hits += depth < 1e9f;
    std::printf("t = %.3f s: %zu of %zu pixels show something\n", frame->time, hits,
                frame->depth.size());
  }
}
