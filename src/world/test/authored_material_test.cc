// [[material]] tables on the model's materials.

#include "world/materials/authored_material.h"
#include "world/test/visual_test_model.h"

namespace gloam {
namespace {

constexpr const char* kPaintedModel = R"(<mujoco><asset>
  <material name="go/glass" roughness="0"/><material name="go/shell"/></asset><worldbody>
  <geom size="1" material="go/glass"/><geom size="1" material="go/shell"/></worldbody></mujoco>)";

const MaterialDescription& named(const RenderDescription& d, const std::string& name) {
  for (const MaterialDescription& m : d.materials) {
    if (m.name == name) return m;
  }
  ADD_FAILURE() << "no material " << name;
  return d.materials.front();
}

MaterialOptions options(const std::string& name, double coat) {
  MaterialOptions o;
  o.name = name;
  o.coat_weight = coat;
  return o;
}

TEST(AuthoredMaterial, ExactNamesBeatPatternsAndLaterTablesEarlierOnes) {
  CompiledWorld world = visual_test::compile(kPaintedModel);
  world.scene.materials = {options("go/shell", 0.25), options("go/*", 0.5), options("*", 0.75)};
  const RenderDescription d = visual_test::describe(world);
  EXPECT_EQ(named(d, "go/shell").coat_weight, 0.25f);
  EXPECT_EQ(named(d, "go/glass").coat_weight, 0.75f);
}

TEST(AuthoredMaterial, TakesGlassAndPatternsWithTheKindsOwnLook) {
  CompiledWorld world = visual_test::compile(kPaintedModel);
  MaterialOptions glass = options("go/glass", 0);
  glass.ior = 1.33;
  glass.transmission_weight = 1;
  glass.thin_walled = true;
  MaterialOptions shell = options("go/shell", 0);
  shell.pattern = PatternOptions{.kind = "brick", .gap = 0.02, .bond = "english"};
  world.scene.materials = {glass, shell};
  const RenderDescription d = visual_test::describe(world);
  EXPECT_EQ(named(d, "go/glass").ior, 1.33f);
  EXPECT_TRUE(named(d, "go/glass").thin_walled);
  ASSERT_EQ(named(d, "go/shell").pattern, 0);
  EXPECT_EQ(named(d, "go/glass").pattern, -1);
  const ProceduralDescription& brick = d.procedurals.at(0);
  EXPECT_EQ(brick.kind, ProceduralKind::kBrick);
  EXPECT_EQ(brick.bond, BrickBond::kEnglish);
  EXPECT_EQ(brick.gap, 0.02f);
  EXPECT_EQ(brick.size_u, default_procedural(ProceduralKind::kBrick).size_u);
}

TEST(AuthoredMaterial, NamesWhatIsNotThere) {
  CompiledWorld world = visual_test::compile(kPaintedModel);
  world.scene.materials = {options("go/glas", 1)};
  world.scene.materials[0].loc = {"scene.toml", 7, 1};
  const auto result = describe_for_rendering(world);
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message.find("go/glas"), std::string::npos);
  EXPECT_EQ(result.error().loc.line, 7);
  EXPECT_NE(result.error().hint.find("go/glass"), std::string::npos);
}

}  // namespace
}  // namespace gloam
