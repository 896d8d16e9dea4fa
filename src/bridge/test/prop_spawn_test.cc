// Props that clients add to the README's room, whose materials have names of their own.

#include <gtest/gtest.h>

#include "base/test/source_dir.h"
#include "bridge/test/lab.h"

namespace gloam::bridge {
namespace {

class PropSpawn : public Lab {
 protected:
  void SetUp() override {
    Lab::SetUp();
    const auto room = source_dir() / "assets/environments/room/room.xml";
    write("readme.toml", ("[environment]\nfile = '" + room.string() + "'\n").c_str());
    const Result<Scene> scene = load_scene(folder_ / "readme.toml", {.root = "/"});
    ASSERT_TRUE(scene.ok()) << scene.error().to_string();
    const Result<World> world = World::compile(*scene);
    ASSERT_TRUE(world.ok()) << world.error().to_string();
    op_.reset();
    simulation_ = std::move(*Simulation::create(*world, {}));
    op_ = std::make_unique<Operator>(*simulation_);
  }
  void expect_spawned(const std::string& uri) {
    const SpawnResult spawned = op().spawn({.name = "added", .uri = uri, .X_FE = {{0, 0, 1}, {}}});
    ASSERT_TRUE(spawned.ok()) << uri << ": " << spawned.error.to_string();
    ASSERT_TRUE(op().step(2).ok()) << uri;
    ASSERT_TRUE(op().remove("added").ok()) << uri;
  }
};

TEST_F(PropSpawn, StandInTheReadmesRoom) {
  for (const char* kind : {"armchair", "desk_lamp", "bookshelf", "potted_plant"})
    expect_spawned(std::string("gloam://prop/") + kind);
}

TEST_F(PropSpawn, DISABLED_SweepOfEveryKind) {
  size_t count = 0;
  for (const Spawnable& spawnable : op().spawnables().value()) {
    if (!spawnable.uri.starts_with("gloam://prop/")) continue;
    expect_spawned(spawnable.uri);
    ++count;
  }
  EXPECT_GT(count, 150u);
}

}  // namespace
}  // namespace gloam::bridge
