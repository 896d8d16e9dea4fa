#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/cache_writer.h"
#include "gloam/model_tools.h"
#include "gloam/world.h"
#include "scene/test/temp_folder.h"
#include "world/cache/model_cache.h"
#include "world/compile/level.h"
#include "world/compile/mesh_object.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kArm =
    "<mujoco><asset><mesh name='m' file='m.obj'/></asset><worldbody><body><joint/>"
    "<geom type='mesh' mesh='m'/></body></worldbody></mujoco>";

class CheckModel : public ::testing::Test {
 protected:
  CheckModel() {
    ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1);
    folder_.write("m.obj", tetrahedron_obj());
    file_ = folder_.write("m.xml", kArm);
  }
  ModelCheck check(const fs::path& file, const FileAccess& access = {}) const {
    return check_model(file, access, folder_.path() / "out");
  }
  TempFolder folder_;
  fs::path file_;
};

TEST_F(CheckModel, AModelIsStockAndComesBack) {
  const ModelCheck model = check(file_);
  EXPECT_TRUE(model.passed()) << model.status.error().to_string();
  EXPECT_EQ(model.stock_refusal, "");
  EXPECT_THAT(model.unlike_stock, IsEmpty());
  EXPECT_THAT(model.unlike_export, IsEmpty());
  EXPECT_EQ(model.bodies, 2);
  EXPECT_EQ(model.joints, 1);
  EXPECT_EQ(model.geoms, 1);
  EXPECT_GT(model.compared, 400);  // MuJoCo 4.0.1 has 614 sizes, options and arrays
  EXPECT_GT(model.export_bytes, fs::file_size(folder_.path() / "m.obj"));
}

TEST_F(CheckModel, AModelThatIsNotStockIsNamedByItsArrays) {
  // The cache is made to hold another model than the file's.
  const Scene scene = load_scene(file_).value();
  ModelFiles files;
  ASSERT_TRUE(add_scene_files(scene, &files).ok());
  auto world = std::make_shared<CompiledWorld>();
  world->scene = scene;
  world->model = std::move(build_level(scene, {}, {}, &files).value().model);
  world->model->geom_friction[0] *= 1 + 1e-15;
  world->model->opt.timestep = 0.003;
  store_cached_world(world, {});
  finish_cache_writes();
  const ModelCheck model = check(file_);
  EXPECT_FALSE(model.passed());
  EXPECT_THAT(model.unlike_stock, ElementsAre("opt.timestep", "geom_friction"));
}

TEST_F(CheckModel, AModelThatMjcfCannotSayDoesNotComeBack) {
  const ModelCheck model = check(folder_.write(
      "m.toml",
      "[mujoco]\n[mujoco.asset]\n[[mujoco.asset.mesh]]\nname = \"m\"\nfile = \"m.obj\"\nneedsdf = "
      "true\n[mujoco.worldbody]\n[[mujoco.worldbody.geom]]\ntype = \"mesh\"\nmesh = \"m\"\n"));
  EXPECT_TRUE(model.status.ok()) << model.status.error().to_string();
  EXPECT_FALSE(model.passed());
  EXPECT_FALSE(model.stock_refusal.has_value());  // it reads no TOML
  EXPECT_FALSE(model.unlike_export.empty());
}

TEST_F(CheckModel, OfARefusedFileItSaysWhetherStockLoadsIt) {
  const fs::path outside = folder_.write("model/m.xml",
                                         "<mujoco><asset><mesh name='m' file='../m.obj'/></asset>"
                                         "<worldbody><geom type='mesh' mesh='m'/></worldbody>"
                                         "</mujoco>");
  FileAccess access;
  access.strict = true;
  const ModelCheck refused = check(outside, access);
  EXPECT_FALSE(refused.passed());
  EXPECT_THAT(refused.status.error().to_string(), HasSubstr("outside"));
  EXPECT_EQ(refused.stock_refusal, "");

  const ModelCheck bad = check(folder_.write("bad.xml", "<mujoco><worldbdy/></mujoco>"));
  EXPECT_FALSE(bad.passed());
  EXPECT_THAT(*bad.stock_refusal, HasSubstr("worldbdy"));
  EXPECT_FALSE(check(folder_.path() / "none.xml").stock_refusal.has_value());
}

// MuJoCo's compiler would never end.
TEST_F(CheckModel, StockIsAskedForAsLongAsIsSaid) {
  const fs::path file = folder_.write(
      "e.xml",
      "<mujoco><worldbody><body><joint name='j' type='slide' armature='-1000' range='0 1'/>"
      "<geom size='.1'/></body></worldbody><actuator><muscle joint='j'/></actuator></mujoco>");
  const ModelCheck endless = check_model(file, {}, folder_.path() / "out", 3);
  EXPECT_FALSE(endless.status.ok());
  EXPECT_EQ(endless.stock_refusal, "it takes more than 3 s");
}

}  // namespace
}  // namespace gloam
