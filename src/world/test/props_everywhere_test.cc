// Every kind of the catalogue beside every environment, whose materials, meshes and geoms may have
// the same names.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/test/source_dir.h"
#include "gloam/world.h"
#include "places/catalogue.h"
#include "scene/test/temp_folder.h"
#include "world/model_names.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

class PropsEverywhere : public ::testing::Test {
 protected:
  PropsEverywhere() { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }

  Result<World> compile(const std::string& text) {
    GLOAM_TRY(const Scene scene,
              load_scene(folder_.write("scene.toml", text), {.root = fs::path("/")}));
    return World::compile(scene);
  }

  static std::string every_kind() {
    std::string text;
    int row = 0;
    for (const PropKind& kind : prop_catalogue()) {
      text += fmt::format("[[prop]]\nname = 'added_{0}'\nkind = '{0}'\nposition = [{1}, {2}, 30]\n",
                          kind.name, 6.0 * (row % 12), 6.0 * (row / 12));
      ++row;
    }
    return text;
  }

  void expect_sound(const std::string& environment) {
    const Result<World> world = compile(environment + every_kind());
    ASSERT_TRUE(world.ok()) << world.error().to_string();
    const mjModel& model = *world->compiled()->model;
    for (const PropKind& kind : prop_catalogue())
      EXPECT_GE(mj_name2id(&model, mjOBJ_BODY, ("added_" + std::string(kind.name)).c_str()), 0)
          << kind.name;
    const Result<RenderDescription> drawn = describe_for_rendering(*world->compiled());
    EXPECT_TRUE(drawn.ok()) << drawn.error().to_string();
  }

  TempFolder folder_;
};

TEST_F(PropsEverywhere, StandInEveryModelOfTheRepository) {
  const fs::path places = source_dir() / "assets/environments";
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(places)) {
    const fs::path file = entry.path() / (entry.path().filename().string() + ".xml");
    if (!fs::exists(file)) continue;
    SCOPED_TRACE(file.filename().string());
    expect_sound(fmt::format("[environment]\nfile = '{}'\n", file.string()));
    ++count;
  }
  EXPECT_GE(count, 7);
}

TEST_F(PropsEverywhere, StandInEveryGeneratedPlace) {
  for (const char* text :
       {"[environment.house]\nrooms = 3\nfurnished = false\n", "[environment.bedroom]\n",
        "[environment.office]\n", "[environment.warehouse]\n", "[environment.hallway]\n",
        "[environment.tunnel]\n", "[environment.terrain]\n"}) {
    SCOPED_TRACE(text);
    expect_sound(text);
  }
}

// An environment whose materials, textures, meshes and geoms are called as those of the prop are.
std::string environment_with_names_of(const mjModel& model) {
  std::string assets, geoms;
  for (int i = 0; i < model.nmat; ++i)
    assets +=
        fmt::format("<material name='{}' rgba='1 0 0 1'/>", name_of(model, mjOBJ_MATERIAL, i));
  for (int i = 0; i < model.ntex; ++i)
    assets += fmt::format("<texture name='{}' type='2d' builtin='flat' width='8' height='8'/>",
                          name_of(model, mjOBJ_TEXTURE, i));
  for (int i = 0; i < model.nmesh; ++i)
    assets += fmt::format("<mesh name='{}' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/>",
                          name_of(model, mjOBJ_MESH, i));
  const std::string first = name_of(model, mjOBJ_MATERIAL, 0);
  for (int i = 0; i < model.ngeom; ++i)
    if (const std::string name = name_of(model, mjOBJ_GEOM, i); !name.empty())
      geoms += fmt::format("<geom name='{}' pos='0 0 -{}' size='.1' material='{}'/>", name, i + 1,
                           name_of(model, mjOBJ_MATERIAL, i % model.nmat));
  return fmt::format("<mujoco><asset>{}</asset><worldbody>{}</worldbody></mujoco>", assets, geoms);
}

std::set<std::string> colors_of(const mjModel& model, const std::string& body) {
  std::set<std::string> colors;
  const int id = mj_name2id(&model, mjOBJ_BODY, body.c_str());
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const int material = model.geom_matid[geom];
    if (model.geom_bodyid[geom] != id || material < 0) continue;
    const float* c = model.mat_rgba + 4 * material;
    colors.insert(fmt::format("{} {} {}", c[0], c[1], c[2]));
  }
  return colors;
}

TEST_F(PropsEverywhere, KeepTheirLooksBesideOthersOfTheSameNames) {
  const std::string props =
      "[[prop]]\nname = 'seat'\nkind = 'armchair'\n[[prop]]\nname = 'lamp'\nkind = 'desk_lamp'\n"
      "position = [3, 0, 0]\n";
  const Result<World> alone = compile(props);
  ASSERT_TRUE(alone.ok()) << alone.error().to_string();
  const mjModel& before = *alone->compiled()->model;
  folder_.write("place.xml", environment_with_names_of(before));
  const Result<RenderDescription> drawn_alone = describe_for_rendering(*alone->compiled());
  ASSERT_TRUE(drawn_alone.ok());

  for (const char* way : {"compiled", "from the cache"}) {
    SCOPED_TRACE(way);
    const Result<World> world = compile("[environment]\nfile = 'place.xml'\n" + props);
    ASSERT_TRUE(world.ok()) << world.error().to_string();
    const mjModel& model = *world->compiled()->model;
    for (const char* body : {"seat", "lamp"})
      EXPECT_EQ(colors_of(model, body), colors_of(before, body)) << body;
    EXPECT_EQ(colors_of(model, "world"), std::set<std::string>{"1 0 0"});
    const Result<RenderDescription> drawn = describe_for_rendering(*world->compiled());
    ASSERT_TRUE(drawn.ok()) << drawn.error().to_string();
    // Each look's options beyond MJCF went to the prop's material, not to the environment's.
    for (const MaterialDescription& m : drawn_alone->materials) {
      const auto named = [&](const std::string& name) {
        return std::find_if(drawn->materials.begin(), drawn->materials.end(),
                            [&](const MaterialDescription& other) { return other.name == name; });
      };
      const auto ours = named("props/" + m.name);
      if (m.name.empty() || ours == drawn->materials.end()) continue;
      EXPECT_EQ(ours->roughness, m.roughness) << m.name;
      EXPECT_EQ(ours->fuzz_weight, m.fuzz_weight) << m.name;
    }
  }
}

// An environment's <default> is for its own elements.
TEST_F(PropsEverywhere, AreThemselvesWhateverTheEnvironmentsDefaults) {
  folder_.write("place.xml",
                "<mujoco><default><geom type='mesh' mesh='m' contype='0' conaffinity='0' "
                "material='w' solref='.1 3' margin='.5'/><mesh scale='.001 .001 .001'/>"
                "<joint stiffness='70' armature='3'/><material emission='1' rgba='1 0 0 1'/>"
                "<texture type='cube'/></default><asset><material name='w'/><mesh name='m' "
                "vertex='0 0 0 1000 0 0 0 1000 0 0 0 1000'/></asset><worldbody><geom/></worldbody>"
                "</mujoco>");
  const std::string props =
      "[[prop]]\nname = 'p'\nkind = 'wardrobe'\n[[prop]]\nname = 'q'\nkind = 'armchair'\n"
      "position = [3, 0, 0]\n";
  const Result<World> alone = compile(props);
  const Result<World> world = compile("[environment]\nfile = 'place.xml'\n" + props);
  ASSERT_TRUE(alone.ok()) << alone.error().to_string();
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel &a = *alone->compiled()->model, &b = *world->compiled()->model;
  int count = 0;
  for (int i = 0; i < b.ngeom; ++i) {
    const std::string name = name_of(b, mjOBJ_GEOM, i);
    if (!name.starts_with("p/") && !name.starts_with("q/")) continue;
    const int k = mj_name2id(&a, mjOBJ_GEOM, name.c_str());
    ASSERT_GE(k, 0) << name;
    EXPECT_EQ(a.geom_type[k], b.geom_type[i]) << name;
    EXPECT_EQ(a.geom_contype[k], b.geom_contype[i]) << name;
    EXPECT_EQ(a.geom_margin[k], b.geom_margin[i]) << name;
    EXPECT_FLOAT_EQ(static_cast<float>(a.geom_rbound[k]), static_cast<float>(b.geom_rbound[i]));
    ++count;
  }
  EXPECT_GT(count, 10);
  for (int i = 0; i < b.njnt; ++i) EXPECT_EQ(b.jnt_stiffness[i], 0);
}

TEST_F(PropsEverywhere, RefuseABodyOrJointWhoseNameIsTaken) {
  folder_.write("place.xml",
                "<mujoco><worldbody><body name='a'><joint name='ball'/><geom size='.1'/></body>"
                "<body name='box/lid'><geom size='.1'/></body></worldbody></mujoco>");
  const std::string place = "[environment]\nfile = 'place.xml'\n";
  const Result<World> joint =
      compile(place + "[[prop]]\nname = 'ball'\nkind = 'toy_ball'\nloose = true\n");
  ASSERT_FALSE(joint.ok());
  EXPECT_NE(joint.error().message.find("already has a joint 'ball'"), std::string::npos)
      << joint.error().to_string();
  const Result<World> body = compile(place + "[[prop]]\nname = 'a'\nkind = 'toy_ball'\n");
  ASSERT_FALSE(body.ok());
  EXPECT_NE(body.error().message.find("already has a body 'a'"), std::string::npos);
}

}  // namespace
}  // namespace gloam
