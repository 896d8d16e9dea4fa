// [[soil]] in scene files.

#include "world/effects/soil_description.h"

#include <gmock/gmock.h>

#include <cmath>

#include "scene/options/weather_fields.h"
#include "scene/test/temp_folder.h"
#include "world/effects/visual_soil.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Soil : public ::testing::Test {
 protected:
  Soil() {
    folder_.write("ground.xml", R"(<mujoco><asset>
      <hfield name="hill" nrow="3" ncol="3" size="3 3 1 .1" elevation="0 0 0  0 1 0  0 0 0"/></asset>
      <worldbody><geom type="plane" size="9 9 .1"/>
      <geom type="hfield" hfield="hill" pos="10 0 0"/>
      <geom type="box" size="9 9 .1" pos="0 0 5"/>
      <geom type="box" size="1 1 .1" pos="0 0 .5" contype="0" conaffinity="0"/>
      <body pos="0 0 1"><freejoint/><geom type="box" size="1 1 .1"/></body>
      </worldbody></mujoco>)");
  }
  Result<World> compile(const std::string& text) {
    GLOAM_TRY(const Scene scene,
              load_scene(folder_.write("s.toml", "environment.file = \"ground.xml\"\n" + text)));
    return World::compile(scene);
  }
  std::string error_of(const std::string& text) {
    const Result<World> world = compile(text);
    return world.ok() ? "" : world.error().to_string();
  }
  TempFolder folder_;
};

TEST_F(Soil, IsWhatItsTableSays) {
  const Result<World> world = compile(R"(
[[soil]]
name = "yard"
position = [1, 2, 0.15]
size = [3, 2]
depth = 0.15
cell = 0.05
kind = "snow"
n = 1.3
friction = 45
)");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const SoilDescription& soil = world->compiled()->soils.at(0);
  EXPECT_EQ(soil.name, "yard");
  EXPECT_DOUBLE_EQ(soil.low_x(), -0.5);
  EXPECT_DOUBLE_EQ(soil.low_y(), 1);
  EXPECT_DOUBLE_EQ(soil.level, 0.15);
  EXPECT_EQ(soil.nx, 60);
  EXPECT_EQ(soil.ny, 40);
  EXPECT_DOUBLE_EQ(soil.strength.n, 1.3) << "given";
  EXPECT_NEAR(soil.strength.tan_friction, 1, 1e-12) << "given";
  EXPECT_DOUBLE_EQ(soil.strength.k_phi, 196.72e3) << "of snow";
  const Result<RenderDescription> seen = describe_for_rendering(*world->compiled());
  ASSERT_TRUE(seen.ok());
  ASSERT_EQ(seen->deformables.size(), 1u);
  const TriangleMesh& mesh = seen->deformables[0].rest;
  EXPECT_EQ(mesh.positions.size(), static_cast<size_t>(soil_vertices(soil)));
  Vec3f low{9, 9, 9}, high{-9, -9, -9};
  for (const Vec3f& p : mesh.positions) {
    low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
    high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
  }
  EXPECT_NEAR(low.x, -0.5, 1e-6);
  EXPECT_NEAR(high.y, 3, 1e-6);
  EXPECT_NEAR(low.z, 0, 1e-6) << "its sides go down to the ground";
  EXPECT_NEAR(high.z, 0.15, 1e-6);
  const auto& pattern = seen->procedurals.at(static_cast<size_t>(
      seen->materials[static_cast<size_t>(seen->instances.back().material)].pattern));
  EXPECT_NEAR(pattern.color_a.y, 0.9, 1e-6) << "snow's albedo";
}

TEST_F(Soil, SinksWhereItsCellsDo) {
  const Result<World> world =
      compile("[[soil]]\nname = \"yard\"\nsize = [0.4, 0.4]\ncell = 0.1\nposition = [0, 0, 0.2]\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const SoilDescription& soil = world->compiled()->soils.at(0);
  std::vector<float> change(soil.cells());
  change[5] = -0.07f;  // the second of the second row
  std::vector<float> out;
  append_soil_vertices(soil, change, 0, &out);
  ASSERT_EQ(out.size(), static_cast<size_t>(3 * soil_vertices(soil)));
  const float* p = out.data() + 3 * (2 * 6 + 2);  // one more all around
  EXPECT_NEAR(p[0], -0.05, 1e-6);
  EXPECT_NEAR(p[1], -0.05, 1e-6);
  EXPECT_NEAR(p[2], 0.13, 1e-6);
}

TEST_F(Soil, HasEveryKind) {
  for (const std::string_view kind : kSoilKinds) {
    const SoilStrength s = soil_strength(std::string(kind));
    EXPECT_GT(s.k_phi, 0) << kind;
    EXPECT_GT(s.n, 0) << kind;
    EXPECT_GT(s.shear, 0) << kind;
    EXPECT_EQ(
        error_of("[[soil]]\nname = \"a\"\nsize = [1, 1]\nkind = \"" + std::string(kind) + "\"\n"),
        "");
  }
}

TEST_F(Soil, LiesOverGround) {
  const Result<World> flat =
      compile("[[soil]]\nname = \"a\"\nover_ground = true\nposition = [0, 0, 3]\nsize = [2, 2]\n");
  ASSERT_TRUE(flat.ok()) << flat.error().to_string();
  const SoilDescription& yard = flat->compiled()->soils.at(0);
  const size_t middle = yard.cells() / 2 + static_cast<size_t>(yard.nx) / 2;
  EXPECT_NEAR(yard.rest_of(middle), 0.15, 1e-5)
      << "on the plane: not on the roof, on what moves or on what cannot be touched";
  EXPECT_LT(yard.rest_of(0), 0.02) << "it thins out to its edges";

  const Result<World> hill =
      compile("[[soil]]\nname = \"a\"\nover_ground = true\nposition = [10, 0, 3]\nsize = [2, 2]\n");
  ASSERT_TRUE(hill.ok()) << hill.error().to_string();
  const SoilDescription& slope = hill->compiled()->soils.at(0);
  EXPECT_NEAR(slope.rest_of(slope.cells() / 2 + static_cast<size_t>(slope.nx) / 2), 1.15, 0.03);
  EXPECT_NEAR(slope.rest_of(slope.cells() / 2 + static_cast<size_t>(slope.nx) * 3 / 4),
              1.15 - 0.5 / 3, 0.03);
  EXPECT_NEAR(slope.level, 1.15, 0.03) << "of its highest cell";
}

TEST_F(Soil, RefusesWhatCannotBe) {
  const auto with = [this](const std::string& line) {
    return error_of("[[soil]]\nname = \"yard\"\n" + line + "\n");
  };
  EXPECT_THAT(error_of("[[soil]]\nsize = [1, 1]\n"), HasSubstr("name"));
  EXPECT_THAT(error_of("[[soil]]\nname = \"a\"\n[[soil]]\nname = \"a\"\nposition = [9, 0, 0]\n"),
              HasSubstr("two soils named 'a'"));
  EXPECT_THAT(with("position = [0, 0]"), HasSubstr("position"));
  EXPECT_THAT(with("size = [4, 0.01]"), HasSubstr("'size["));
  EXPECT_THAT(with("size = [400, 1]"), HasSubstr("'size["));
  EXPECT_THAT(with("depth = 0"), AllOf(HasSubstr("s.toml:4"), HasSubstr("'depth' is 0")));
  EXPECT_THAT(with("depth = 6"), HasSubstr("'depth'"));
  EXPECT_THAT(with("over_ground = 1"), HasSubstr("over_ground"));
  EXPECT_THAT(with("cell = 0"), HasSubstr("'cell'"));
  EXPECT_THAT(with("cell = 0.9"), HasSubstr("'cell'"));
  EXPECT_THAT(with("kind = \"dry_snad\""), HasSubstr("dry_sand"));
  for (const char* key : {"n", "k_c", "k_phi", "cohesion", "friction", "shear", "k_0", "a_u"}) {
    EXPECT_THAT(with(std::string(key) + " = -1"), HasSubstr(key)) << key;
    EXPECT_THAT(with(std::string(key) + " = 1e13"), HasSubstr(key)) << key;
    EXPECT_THAT(with(std::string(key) + " = \"much\""), HasSubstr(key)) << key;
    EXPECT_THAT(with(std::string(key) + " = nan"), HasSubstr(key)) << key;
  }
  EXPECT_THAT(with("friction = 61"), HasSubstr("friction"));
  EXPECT_THAT(with("kphi = 1e6"), HasSubstr("k_phi")) << "the nearest key";
  EXPECT_THAT(with("k_c = 0\nk_phi = 0"), HasSubstr("both 0"));
  EXPECT_THAT(with("size = [100, 100]\ncell = 0.01"),
              AllOf(HasSubstr("10000 x 10000 cells"), HasSubstr("'cell' of 0.143 m")));
  EXPECT_EQ(with("size = [100, 100]"), "") << "coarser by itself";
  EXPECT_THAT(error_of("[[soil]]\nname = \"a\"\n[[soil]]\nname = \"b\"\nposition = [3, 0, 0]\n"),
              AllOf(HasSubstr("'b'"), HasSubstr("overlaps soil 'a'")));
  EXPECT_EQ(error_of("[[soil]]\nname = \"a\"\n[[soil]]\nname = \"b\"\nposition = [4, 0, 0]\n"), "");
  EXPECT_THAT(with("over_ground = true\nposition = [0, 0, -1]"), HasSubstr("no ground below"));
}

}  // namespace
}  // namespace gloam
