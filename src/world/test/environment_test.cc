// Generated environments as part of a scene: what is refused, what the scene may change, export.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "base/files.h"
#include "base/test/source_dir.h"
#include "places/generators.h"
#include "places/writer/place_writer.h"
#include "scene/test/temp_folder.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {
namespace {

class GeneratedEnvironment : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }
  Result<World> compile(const std::string& text) {
    const auto file = folder_.path() / "scene.toml";
    EXPECT_TRUE(write_text_file_atomic(file, text).ok());
    GLOAM_TRY(const Scene scene, load_scene(file, {.root = "/"}));
    return World::compile(scene);
  }
  std::string complaint(const std::string& text) {
    const Result<World> world = compile(text);
    if (world.ok()) return "fine";
    Error error = world.error();
    error.loc.file = std::filesystem::path(error.loc.file).filename();
    return error.to_string();
  }
  TempFolder folder_;
};

constexpr const char* kBareHouse = "[environment.house]\nrooms = 3\nfurnished = false\n";

TEST_F(GeneratedEnvironment, RefusesWhatItCannotMake) {
  EXPECT_EQ(complaint("[environment.house]\nrooms = 40\n").substr(0, 48),
            "scene.toml:2:9: 'rooms' is 40; it must be from 3");
  EXPECT_NE(complaint("[[prop]]\nname = \"a\"\nkind = \"chiar\"\n").find("did you mean 'chair'"),
            std::string::npos);
  EXPECT_NE(complaint("[[prop]]\nname = \"a\"\nkind = \"chair\"\n[[prop]]\nname = \"a\"\nkind = "
                      "\"sofa\"\n")
                .find("two props named 'a'"),
            std::string::npos);
  EXPECT_NE(complaint("[environment.house]\n[environment.warehouse]\n").find("one generator"),
            std::string::npos);
  EXPECT_NE(complaint("[environment.warehouse]\nwidth = 10\naisle = 6\nlength = 12\n[[prop]]\nname "
                      "= \"steel_frame_1\"\nkind = \"chair\"\n")
                .find("already has a body 'steel_frame_1'"),
            std::string::npos);
}

TEST_F(GeneratedEnvironment, IsMadeAsTheManualShowsIt) {
  const std::filesystem::path& source = source_dir();
  std::string manual = read_text_file(source / "docs/environments.md").value();
  const std::string here = "\"../assets/";
  for (size_t at = manual.find(here); at != std::string::npos; at = manual.find(here))
    manual.replace(at, here.size(), "\"" + (source / "assets").string() + "/");
  const std::string fence = "```toml\n";
  int blocks = 0;
  for (size_t at = manual.find(fence); at != std::string::npos; at = manual.find(fence, at)) {
    at += fence.size();
    const std::string text = manual.substr(at, manual.find("```", at) - at);
    EXPECT_EQ(complaint(text), "fine") << text;
    ++blocks;
  }
  EXPECT_GE(blocks, 9);
}

TEST_F(GeneratedEnvironment, TellsThatTwoStoreysHaveFourRoomsAtLeast) {
  const auto said = [&](int rooms, int storeys) {
    HouseOptions house;
    house.rooms = rooms;
    house.storeys = storeys;
    house.furnished = false;
    ::testing::internal::CaptureStderr();
    EXPECT_TRUE(make_house(house).ok());
    return ::testing::internal::GetCapturedStderr();
  };
  EXPECT_NE(said(3, 2).find("4 rooms"), std::string::npos);
  EXPECT_EQ(said(4, 2), "");
  EXPECT_EQ(said(3, 1), "");
}

TEST_F(GeneratedEnvironment, IsNamedLabelledAndOfOneModel) {
  const Result<World> world =
      compile(std::string(kBareHouse) +
              "[[prop]]\nname = \"cone\"\nkind = \"traffic_cone\"\nposition "
              "= [0.5, 0, 0]\nloose = true\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel& m = *world->compiled()->model;
  for (const char* body : {"hall/wall_1", "living/floor_1", "hall/door_1/leaf", "cone"})
    EXPECT_GE(mj_name2id(&m, mjOBJ_BODY, body), 0) << body;
  EXPECT_GE(mj_name2id(&m, mjOBJ_JOINT, "hall/door_1/leaf"), 0);
  EXPECT_EQ(m.nq - m.nv, 1);  // one free joint: the cone's
  const Result<RenderDescription> description = describe_for_rendering(*world->compiled());
  ASSERT_TRUE(description.ok());
  std::set<std::string> classes;
  for (const InstanceDescription& instance : description->instances)
    if (instance.shown) classes.insert(instance.label.semantic_name);
  for (const char* label : {"wall", "floor", "ceiling", "door", "window", "cone", "lawn"})
    EXPECT_TRUE(classes.contains(label)) << label;
  EXPECT_EQ(world->info().regions.size(), 3u);
}

TEST_F(GeneratedEnvironment, IsDrawnByTheSeedWithItsLampsAndMaterials) {
  const auto text = [](int seed) {
    return fmt::format(
        "[sim]\nseed = {}\n[environment.house]\nrooms = 3\nfurnished = true\nclutter = 0\n"
        "[[randomize]]\noption = 'environment.house.ceiling'\nuniform = [2.3, 3.5]\n"
        "[[randomize]]\noption = 'light.*.flux'\noperation = 'scale'\nlog_uniform = [0.1, 10]\n"
        "[[randomize]]\noption = 'material.plaster*.pattern.roughness'\nuniform = [0.1, 0.9]\n",
        seed);
  };
  const Result<World> world = compile(text(1)), again = compile(text(1)), other = compile(text(2));
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  ASSERT_TRUE(again.ok() && other.ok());
  const auto values = [](const Result<World>& w) {
    std::map<std::string, std::string> map;
    for (const DrawnOption& d : w->info().drawn) map[d.option] = d.value;
    return map;
  };
  EXPECT_EQ(values(world), values(again)) << "also from the cache";
  EXPECT_NE(values(world), values(other));
  int lamps = 0;
  std::set<std::string> fluxes;
  for (const auto& [option, value] : values(world)) {
    if (option.find(".flux") == std::string::npos) continue;
    ++lamps;
    fluxes.insert(value);
  }
  EXPECT_GE(lamps, 3) << "the house's own";
  EXPECT_EQ(fluxes.size(), static_cast<size_t>(lamps)) << "each has its own draw";
  const Scene& scene = world->compiled()->scene;
  EXPECT_TRUE(scene.randomize.empty());
  EXPECT_EQ(std::to_string(scene.environment.house->ceiling).substr(0, 6),
            values(world)["environment.house.ceiling"].substr(0, 6));
  EXPECT_EQ(compile(kBareHouse)->info().drawn.size(), 0u);
}

TEST_F(GeneratedEnvironment, FurnitureOpensOnlyIfAsked) {
  const auto joints = [&](const char* openable) {
    const Result<World> world = compile(
        fmt::format("[environment.bedroom]\nseed = 1\nloose = 0\nopenable = {}\n[[prop]]\nname = "
                    "\"mine\"\nkind = \"filing_cabinet\"\nposition = [0, 9, 0]\n",
                    openable));
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    std::set<std::string> names;
    for (const NamedElement& joint : world->info().joints) names.insert(joint.name);
    return names;
  };
  const std::set<std::string> all = joints("true"), few = joints("false");
  EXPECT_GT(all.size(), few.size() + 2);
  EXPECT_TRUE(few.contains("hall/door_1/leaf")) << "the room's own door";
  EXPECT_TRUE(few.contains("mine/drawer_1")) << "a [[prop]] is as its kind";
  for (const std::string& name : few) EXPECT_TRUE(all.contains(name)) << name;
}

TEST_F(GeneratedEnvironment, GivesWayToWhatTheSceneSays) {
  const Result<World> world = compile(
      std::string(kBareHouse) +
      "[[material]]\nname = \"window_glass\"\ntransmission_weight = 0.5\n"
      "[sky]\nluminance = 100\n[override.environment.joint.\"hall/door_.*\"]\ndamping = 7\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel& m = *world->compiled()->model;
  const int joint = mj_name2id(&m, mjOBJ_JOINT, "hall/door_1/leaf");
  ASSERT_GE(joint, 0);
  EXPECT_EQ(m.dof_damping[m.jnt_dofadr[joint]], 7);
  const RenderDescription description = describe_for_rendering(*world->compiled()).value();
  for (const MaterialDescription& material : description.materials) {
    if (material.name == "window_glass") {
      EXPECT_EQ(material.transmission_weight, 0.5f);
    }
  }
}

TEST_F(GeneratedEnvironment, ExportsToWhatStockMuJoCoLoadsBitForBit) {
  const Result<World> world =
      compile(std::string(kBareHouse) +
              "[[prop]]\nname = \"picture\"\nkind = \"picture\"\nposition = [0, 0, 1.5]\n"
              "[[prop]]\nname = \"shelf\"\nkind = \"bookshelf\"\nposition = [0.3, 0, 0]\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const Status exported = world->export_mjcf(folder_.path() / "out");
  EXPECT_TRUE(exported.ok()) << exported.error().to_string();
}

TEST_F(GeneratedEnvironment, OfOneSeedIsOneHashAndPatternsKeepTheFrameTheyWereDrawnIn) {
  Scene scene;
  scene.environment.house = HouseOptions{};
  const uint64_t hash = make_place(scene).value()->hash();
  EXPECT_EQ(make_place(scene).value()->hash(), hash);
  scene.environment.house->clutter = 0;
  EXPECT_NE(make_place(scene).value()->hash(), hash);

  // A table's top is a slab about z = its height, in its own frame: MuJoCo would have moved it.
  const Result<World> world = compile("[[prop]]\nname = \"t\"\nkind = \"dining_table\"\n");
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const RenderDescription description = describe_for_rendering(*world->compiled()).value();
  for (const InstanceDescription& instance : description.instances) {
    if (instance.label.geom != "t/top") continue;
    EXPECT_NEAR(instance.X_BG.p.z, 0, 1e-5);
    EXPECT_NEAR(instance.X_BG.x.x, 1, 1e-6);
    const TriangleMesh& mesh = description.meshes[static_cast<size_t>(instance.mesh)];
    for (const Vec3f& p : mesh.positions) EXPECT_GT(p.z, 0.6f);
    return;
  }
  FAIL() << "the table has no top";
}

}  // namespace
}  // namespace gloam
