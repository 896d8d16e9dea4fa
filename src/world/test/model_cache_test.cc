#include "world/cache/model_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "base/cache.h"
#include "base/cache_writer.h"
#include "base/files.h"
#include "base/hash.h"
#include "gloam/world.h"
#include "scene/test/temp_folder.h"
#include "world/compile/level.h"
#include "world/compile/mesh_object.h"
#include "world/export/model_compare.h"
#include "world/render_description.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;

constexpr const char* kCachedModel =
    "<mujoco><asset><mesh name='m' file='m.obj'/></asset><worldbody><body><freejoint/>"
    "<geom type='mesh' mesh='m'/></body></worldbody></mujoco>";

class ModelCache : public ::testing::Test {
 protected:
  ModelCache() {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    folder_.write("m.obj", tetrahedron_obj());
    folder_.write("m.xml", kCachedModel);
    scene_ = load_scene(folder_.path() / "m.xml").value();
  }
  // Small models are not worth caching to World::compile: store this one by hand.
  std::shared_ptr<const CompiledWorld> store() {
    ModelFiles files;
    EXPECT_TRUE(add_scene_files(scene_, &files).ok());
    Level level = build_level(scene_, {}, {}, &files).value();
    auto world = std::make_shared<CompiledWorld>();
    world->scene = scene_;
    world->model = std::move(level.model);
    world->unsupported = {{ErrorKind::kUnsupported, "something", {"m.xml", 3, 0}, "hint"}};
    store_cached_world(world, files.dependencies());
    finish_cache_writes();
    return world;
  }
  fs::path entry() const {
    return folder_.path() / "cache" / "models" / (hash_to_hex(world_cache_key(scene_)) + ".world");
  }
  TempFolder folder_;
  Scene scene_;
};

TEST_F(ModelCache, GivesBackTheSameModel) {
  EXPECT_EQ(load_cached_world(scene_), nullptr);
  const auto stored = store();
  const auto loaded = load_cached_world(scene_);
  ASSERT_NE(loaded, nullptr);
  EXPECT_THAT(compare_models(stored->model.get(), loaded->model.get()), IsEmpty());
  ASSERT_EQ(loaded->unsupported.size(), 1u);
  EXPECT_EQ(loaded->unsupported[0].to_string(), "m.xml:3: something (hint)");
  const Result<World> world = World::compile(scene_);  // takes it, and can export without a spec
  ASSERT_TRUE(world.ok());
  EXPECT_EQ(world->info().unsupported.size(), 1u);
  EXPECT_TRUE(world->export_mjcf(folder_.path() / "out").ok());
}

TEST_F(ModelCache, NoticesEveryChange) {
  store();
  ASSERT_NE(load_cached_world(scene_), nullptr);
  Scene other = scene_;
  other.sim.timestep = 0.001;
  EXPECT_EQ(load_cached_world(other), nullptr);
  folder_.write("m.obj", tetrahedron_obj() + "# changed\n");
  EXPECT_EQ(load_cached_world(scene_), nullptr);
  folder_.write("m.obj", tetrahedron_obj());
  ASSERT_NE(load_cached_world(scene_), nullptr);
  fs::remove(folder_.path() / "m.obj");
  EXPECT_EQ(load_cached_world(scene_), nullptr);
}

// Lamps, skies and volumes are no part of the entry: they are described afresh.
TEST_F(ModelCache, TablesOfLightAreThoseOfTheSceneAtHand) {
  store();
  const auto describe = [&](double lux) {
    scene_.lights = {{.name = "sun", .type = LightType::kDirectional, .illuminance = lux}};
    const auto loaded = load_cached_world(scene_);
    return loaded != nullptr ? describe_for_rendering(*loaded)->lights.back().intensity.x : -1;
  };
  EXPECT_FLOAT_EQ(describe(10), 10);
  EXPECT_FLOAT_EQ(describe(20), 20);
}

TEST_F(ModelCache, DamagedEntriesAreAsGoodAsNone) {
  store();
  const std::string good = read_text_file(entry()).value();
  const auto damage = [&](const std::string& bytes) {
    EXPECT_TRUE(write_text_file_atomic(entry(), bytes).ok());
    EXPECT_EQ(load_cached_world(scene_), nullptr);
    EXPECT_TRUE(World::compile(scene_).ok());
  };
  damage("");
  damage("GLOAM");
  damage(good.substr(0, good.size() / 2));
  damage(good + "x");
  for (const size_t at : {size_t{0}, size_t{9}, size_t{20}, good.size() / 2, good.size() - 1}) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x40);
    damage(bad);
  }
  // A right checksum over wrong content: counts that reach past the end.
  const std::string bad = good.substr(0, 16) + std::string(64, '\xff');
  std::vector<uint8_t> sealed(bad.begin(), bad.end());
  uint64_t magic = 0;
  std::memcpy(&magic, sealed.data(), sizeof(magic));
  seal_cache_entry(magic, &sealed);
  damage(std::string(sealed.begin(), sealed.end()));
}

TEST_F(ModelCache, AFolderThatCannotBeWrittenIsNoError) {
  folder_.write("file", "not a folder");
  ::setenv("GLOAM_CACHE", (folder_.path() / "file").c_str(), 1);
  store();
  EXPECT_EQ(load_cached_world(scene_), nullptr);
  EXPECT_TRUE(World::compile(scene_).ok());
}

}  // namespace
}  // namespace gloam
