// [[hfield]]: ground of mesh files as MuJoCo feels it.

#include "world/compile/sampled_ground.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "base/rng.h"
#include "scene/test/temp_folder.h"
#include "world/cache/model_cache.h"
#include "world/compile/mesh_object.h"
#include "world/export/model_compare.h"
#include "world/render_description.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;

double bumps(double x, double y) { return 0.4 * std::sin(1.3 * x) * std::cos(0.9 * y) + 0.1 * x; }

/// OBJ text of bumps() over [-half, half]², `unit` [m] to the unit.
std::string bumps_obj(double half, int quads, double unit = 1) {
  std::string text;
  for (int r = 0; r <= quads; ++r) {
    for (int c = 0; c <= quads; ++c) {
      const double x = half * (2.0 * c / quads - 1), y = half * (2.0 * r / quads - 1);
      text += fmt::format("v {} {} {}\n", x / unit, y / unit, bumps(x, y) / unit);
    }
  }
  for (int r = 0; r < quads; ++r) {
    for (int c = 0; c < quads; ++c) {
      const int i = r * (quads + 1) + c + 1, w = quads + 1;
      text += fmt::format("f {} {} {} {}\n", i, i + 1, i + w + 1, i + w);
    }
  }
  return text;
}

/// Closed boxes, each low and high.
std::string boxes_obj(const std::vector<std::array<Vec3, 2>>& boxes) {
  std::string text;
  int first = 1;
  for (const auto& [low, high] : boxes) {
    for (int k = 0; k < 8; ++k)
      text += fmt::format("v {} {} {}\n", k & 1 ? high.x : low.x, k & 2 ? high.y : low.y,
                          k & 4 ? high.z : low.z);
    for (const std::array<int, 4>& f : std::vector<std::array<int, 4>>{
             {4, 5, 7, 6}, {0, 2, 3, 1}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
      text +=
          fmt::format("f {} {} {} {}\n", first + f[0], first + f[1], first + f[2], first + f[3]);
    first += 8;
  }
  return text;
}

constexpr const char* kBall =
    "<mujoco><worldbody><body name='ball' pos='{} {} {}'><freejoint/><geom type='sphere' size='{}' "
    "friction='1 0.1 0.1' condim='6'/></body></worldbody></mujoco>";

class SampledGrounds : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }
  Result<Scene> scene(const std::string& text) {
    folder_.write("scene.toml", text);
    return load_scene(folder_.path() / "scene.toml");
  }
  Result<World> compile(const std::string& text) {
    GLOAM_TRY(const Scene loaded, scene(text));
    return World::compile(loaded);
  }
  const World& make(const std::string& text) {
    Result<World> world = compile(text);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    world_.emplace(std::move(world).value());
    return *world_;
  }
  std::string complaint(const std::string& text) {
    const Result<World> world = compile(text);
    return world.ok() ? "fine" : world.error().to_string();
  }
  /// Where a ball comes to rest that is let go at (x, y, z).
  Vec3 rest(const std::string& ground, double x, double y, double z, double radius) {
    folder_.write("ball.xml", fmt::format(fmt::runtime(kBall), x, y, z, radius));
    const World& world = make("[environment]\nfile = \"ball.xml\"\n" + ground);
    const mjModel& m = *world.compiled()->model;
    const DataPtr data(mj_makeData(&m));
    while (data->time < 6) mj_step(&m, data.get());
    EXPECT_LT(mju_norm3(data->qvel), 0.01);
    return {data->qpos[0], data->qpos[1], data->qpos[2]};
  }
  TempFolder folder_;
  std::optional<World> world_;
};

/// Height that a ray straight down meets.
double ray_down(const mjModel& m, double x, double y, double from = 50) {
  const DataPtr data(mj_makeData(&m));
  mj_forward(&m, data.get());
  const mjtNum start[3] = {x, y, from}, down[3] = {0, 0, -1};
  int geom = -1;
  const double distance = mj_ray(&m, data.get(), start, down, nullptr, 1, -1, &geom, nullptr);
  return distance < 0 ? NAN : from - distance;
}

constexpr const char* kGround =
    "[[hfield]]\nname = \"ground\"\nfile = \"g.obj\"\nresolution = 0.1\n";

TEST_F(SampledGrounds, LieWhereTheMeshIs) {
  folder_.write("g.obj", bumps_obj(5, 100));
  const World& world = make(kGround);
  const mjModel& m = *world.compiled()->model;
  const int geom = mj_name2id(&m, mjOBJ_GEOM, "ground");
  ASSERT_GE(geom, 0);
  EXPECT_EQ(m.geom_group[geom], 3);
  const RandomStream random{7, 1};
  for (uint32_t i = 0; i < 200; ++i) {
    const double x = 9.8 * random.uniform(i, 0) - 4.9, y = 9.8 * random.uniform(i, 1) - 4.9;
    EXPECT_NEAR(ray_down(m, x, y), bumps(x, y), 0.002) << x << ' ' << y;  // h² f'' / 8
  }
}

TEST_F(SampledGrounds, AreTheFloorOfRobots) {
  folder_.write("g.obj", bumps_obj(5, 10));
  folder_.write("ball.xml", fmt::format(fmt::runtime(kBall), 0, 0, 1, 0.1));
  const World& world =
      make(std::string(kGround) + "[[robot]]\nname = \"ball\"\nfile = \"ball.xml\"\n");
  const mjModel& m = *world.compiled()->model;
  EXPECT_GE(mj_name2id(&m, mjOBJ_GEOM, "ground"), 0);
  EXPECT_EQ(mj_name2id(&m, mjOBJ_GEOM, "floor"), -1);
}

TEST_F(SampledGrounds, AreTurnedScaledAndMoved) {
  folder_.write("g.obj", bumps_obj(5, 100, 0.001));
  const World& world = make(std::string(kGround) +
                            "unit = 0.001\nposition = [10, 20, 3]\norientation = "
                            "[0.9659258262890683, 0, 0, 0.25881904510252074]\n"
                            "low = [8, 18]\nhigh = [12, 22.5]\n");
  const mjModel& m = *world.compiled()->model;
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  for (const double x : {8.03, 9.5, 11.97}) {
    for (const double y : {18.01, 20.2, 22.47}) {
      const double fx = c * (x - 10) + s * (y - 20), fy = -s * (x - 10) + c * (y - 20);
      EXPECT_NEAR(ray_down(m, x, y), 3 + bumps(fx, fy), 0.002) << x << ' ' << y;
    }
  }
  EXPECT_TRUE(std::isnan(ray_down(m, 7.9, 20)));
  EXPECT_TRUE(std::isnan(ray_down(m, 10, 22.6)));
}

// Which way MuJoCo cuts its cells, for rays and for contacts alike: height_error() believes it.
TEST_F(SampledGrounds, AreCutAsMuJoCoCutsThem) {
  folder_.write("g.obj", bumps_obj(5, 20));
  const char* coarse = "[[hfield]]\nname = \"g\"\nfile = \"g.obj\"\nresolution = 1.3\n";
  const Scene loaded = scene(coarse).value();
  ModelFiles files;
  ASSERT_TRUE(admit_ground_files(loaded, &files).ok());
  std::vector<Error> notes;
  const auto grounds = sample_grounds(loaded, &files, &notes).value();
  const HeightField& field = grounds[0].fields[0];
  for (const auto& [u, v] : {std::pair(0.2, 0.7), std::pair(0.7, 0.2), std::pair(0.5, 0.51)}) {
    const double x = field.grid.low[0] + (3 + u) * field.grid.step[0];
    const double y = field.grid.low[1] + (5 + v) * field.grid.step[1];
    const double z = field.height(3, 5, u, v);
    folder_.write("ball.xml", fmt::format(fmt::runtime(kBall), x, y, z + 0.009, 0.01));
    const World& world = make("[environment]\nfile = \"ball.xml\"\n" + std::string(coarse));
    const mjModel& m = *world.compiled()->model;
    EXPECT_NEAR(ray_down(m, x, y, z + 0.005), z, 1e-6);
    const DataPtr data(mj_makeData(&m));
    mj_forward(&m, data.get());
    ASSERT_EQ(data->ncon, 1);
    // The ball's middle is 9 mm above the ground, less across a slope.
    const mjContact& contact = data->contact[0];
    EXPECT_NEAR(contact.dist, 0.009 * std::abs(contact.frame[2]) - 0.01, 1e-5);
  }
}

TEST_F(SampledGrounds, CarryABall) {
  folder_.write("g.obj", bumps_obj(5, 100));
  const Vec3 at = rest(kGround, -1.1, 0.3, 1, 0.1);
  // In a hollow a ball touches where it is lowest, within the steps of the grid.
  EXPECT_NEAR(at.z - 0.1, bumps(at.x, at.y), 0.006);
  EXPECT_LT(at.z, 0);
}

TEST_F(SampledGrounds, OfFloorsAboveLeaveTheAirBetweenFree) {
  // A floor at 3 m with a hole of 4 x 2 m, over ground.
  folder_.write("g.obj", boxes_obj({{{{0, 0, -0.5}, {10, 10, 0}}},
                                    {{{0, 0, 2.8}, {3, 10, 3}}},
                                    {{{7, 0, 2.8}, {10, 10, 3}}},
                                    {{{3, 0, 2.8}, {7, 4, 3}}},
                                    {{{3, 6, 2.8}, {7, 10, 3}}}}));
  const std::string ground = std::string(kGround) + "layers = 2\n";
  EXPECT_NEAR(rest(ground, 1, 1, 4, 0.2).z, 3.2, 0.005);
  EXPECT_NEAR(rest(ground, 5, 5, 4, 0.2).z, 0.2, 0.005);
  EXPECT_NEAR(rest(ground, 1, 1, 2, 0.2).z, 0.2, 0.005);
  const mjModel& m = *world_->compiled()->model;
  EXPECT_GE(mj_name2id(&m, mjOBJ_GEOM, "ground_2"), 0);
  EXPECT_EQ(m.nhfield, 5);
  // From above alone the roof is the ground, and its hole is as deep as the floor.
  EXPECT_NEAR(rest(kGround, 1, 1, 4, 0.2).z, 3.2, 0.005);
}

TEST_F(SampledGrounds, AreDrawnAsTheFileOrAsTheyAre) {
  folder_.write("g.obj", bumps_obj(5, 10));
  const auto shown = [&](const std::string& text) {
    std::vector<std::string> names;
    const RenderDescription description = describe_for_rendering(*make(text).compiled()).value();
    for (const InstanceDescription& instance : description.instances)
      if (instance.shown && !instance.color_only) names.push_back(instance.label.instance_name);
    return names;
  };
  EXPECT_THAT(shown(kGround), ::testing::ElementsAre("ground"));
  EXPECT_EQ(world_->info().triangles, 200);
  const World again =
      World::compile(world_->compiled()->scene).value();  // a compiled scene has the visual
  EXPECT_EQ(again.compiled()->scene.visuals.size(), 1u);
  shown(std::string(kGround) + "drawn = false\n");
  EXPECT_EQ(world_->info().triangles, 2 * 100 * 100);
  const mjModel& m = *world_->compiled()->model;
  EXPECT_EQ(m.geom_group[mj_name2id(&m, mjOBJ_GEOM, "ground")], 0);
  EXPECT_TRUE(world_->compiled()->scene.visuals.empty());
}

TEST_F(SampledGrounds, TakeFrictionAndOverrides) {
  folder_.write("g.obj", bumps_obj(5, 10));
  const World& world = make(std::string(kGround) +
                            "friction = [0.4, 0.01, 0.001]\n"
                            "[override.environment.geom.\"ground.*\"]\ncondim = 6\n");
  const mjModel& m = *world.compiled()->model;
  EXPECT_EQ(m.geom_friction[0], 0.4);
  EXPECT_EQ(m.geom_condim[0], 6);
}

TEST_F(SampledGrounds, AreExportedBitForBit) {
  folder_.write("g.obj", bumps_obj(5, 30));
  const World& world = make(kGround);
  const Status exported = world.export_mjcf(folder_.path() / "out");
  ASSERT_TRUE(exported.ok()) << exported.error().to_string();
  EXPECT_LT(std::filesystem::file_size(folder_.path() / "out" / "scene.xml"), 2000u);
  EXPECT_EQ(std::filesystem::file_size(folder_.path() / "out" / "assets" / "ground.hfield"),
            8u + 4u * 101 * 101);
}

TEST_F(SampledGrounds, AreCachedByTheContentOfTheirFile) {
  folder_.write("g.obj", bumps_obj(5, 30));
  const Scene loaded = scene(kGround).value();
  ModelFiles files;
  ASSERT_TRUE(add_scene_files(loaded, &files).ok());
  auto world = std::make_shared<CompiledWorld>();
  world->scene = loaded;
  world->model = std::move(build_level(loaded, {}, {}, &files)->model);
  store_cached_world(world, files.dependencies());
  finish_cache_writes();
  const auto cached = load_cached_world(loaded);
  ASSERT_NE(cached, nullptr);
  EXPECT_THAT(compare_models(world->model.get(), cached->model.get()), ::testing::IsEmpty());
  Scene other = loaded;
  other.hfields[0].resolution = 0.2;
  EXPECT_EQ(load_cached_world(other), nullptr);
  other = loaded;
  other.hfields[0].low = {{-1, -1}};
  EXPECT_EQ(load_cached_world(other), nullptr);
  folder_.write("g.obj", bumps_obj(5, 29));
  EXPECT_EQ(load_cached_world(loaded), nullptr);
}

TEST_F(SampledGrounds, ComplainOfWhatCannotBeSampled) {
  const auto with = [&](const std::string& more) { return complaint(kGround + more); };
  EXPECT_THAT(with(""), HasSubstr("g.obj"));  // is not there
  folder_.write("g.obj", bumps_obj(5, 10));
  EXPECT_THAT(with("low = [20, 20]\nhigh = [30, 30]\n"),
              HasSubstr("scene.toml:1:1: hfield 'ground': no sample of the region has a surface "
                        "below it (the mesh extends over x -5 … 5 m, y -5 … 5 m"));
  EXPECT_THAT(with("low = [2, 2]\nhigh = [1, 4]\n"),
              HasSubstr("hfield 'ground': the region is empty: x from 2 to 1 m"));
  EXPECT_THAT(with("high = [-7, -7]\n"), HasSubstr("the region is empty"));
  EXPECT_THAT(with("low = [nan, 0]\n"), HasSubstr("'low[0]' is nan"));
  EXPECT_THAT(
      complaint("[[hfield]]\nname = \"g\"\nfile = \"g.obj\"\nresolution = 0.0001\n"),
      HasSubstr("100001 x 100001 samples in 1 layer exceed the limit of 16777216 (use a coarser "
                "'resolution' or a smaller region)"));
  EXPECT_THAT(complaint(std::string(kGround) + kGround), HasSubstr("two hfields named 'ground'"));
  EXPECT_THAT(with("[[visual]]\nname = \"ground\"\nfile = \"scene.toml\"\n"),
              HasSubstr("visual 'ground' have the same name"));
  folder_.write("e.xml", "<mujoco><worldbody><geom name='ground' size='1'/></worldbody></mujoco>");
  EXPECT_THAT(with("[environment]\nfile = \"e.xml\"\n"),
              HasSubstr("the environment already has a geom 'ground'"));

  folder_.write("g.obj", bumps_obj(5, 10, 0.001));  // forgot the unit
  EXPECT_THAT(with(""), HasSubstr("unit = 0.001"));
  const World& large = make("[[hfield]]\nname = \"g\"\nfile = \"g.obj\"\nresolution = 50\n");
  ASSERT_EQ(large.info().notes.size(), 1u);
  EXPECT_THAT(
      large.info().notes[0].to_string(),
      HasSubstr("the mesh is 10000 m wide (if the file is in millimetres, set unit = 0.001)"));

  folder_.write("g.obj", bumps_obj(1, 10));  // of a region that is much larger
  const World& missed = make(std::string(kGround) + "low = [-10, -10]\nhigh = [10, 10]\n");
  ASSERT_EQ(missed.notes().size(), 1u);
  EXPECT_THAT(missed.notes()[0].to_string(), AllOf(HasSubstr("of 40401 samples missed the mesh"),
                                                   HasSubstr("extends over x -1 … 1")));
  EXPECT_EQ(make(std::string(kGround) + "low = [-1, -1]\nhigh = [1, 1.5]\n").notes().size(), 0u);

  folder_.write("g.obj", "v 1.05 0 0\nv 1.05 3 0\nv 1.05 3 2\nv 3 1.05 0\nf 1 2 3\n");
  EXPECT_THAT(with("low = [0, 0]\nhigh = [3.3, 3.3]\n"),
              HasSubstr("vertical walls are not ground"));
  folder_.write("g.obj", "v 1 0 0\nv 1 3 0\nv 1 3 nan\nf 1 2 3\n");
  EXPECT_THAT(with(""), HasSubstr("hfield 'ground'"));
  folder_.write("g.obj", "v 1 0 0\nv 1 3 0\nv 1 3 1\n");
  EXPECT_NE(with(""), "fine");
}

}  // namespace
}  // namespace gloam
