// A Command that changes how something looks is seen in the next picture, and the picture is then
// the one of a model that was written so from the start.

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <optional>

#include "gloam/run.h"
#include "runtime/live/live_simulation.h"
#include "scene/test/temp_folder.h"
#include "sim/commands/live_fields.h"

namespace gloam {
namespace {

// Nothing here moves but the pendulum. %s = attributes of the parts that the tests change.
struct Look {
  std::string paint = R"(rgba=".8 .2 .2 1")";
  std::string ball = R"(material="paint")";
  std::string lamp = R"(diffuse=".9 .9 .9")";
  std::string ground = "0 0 0 0  0 1 .2 0  0 0 0 0";
};

std::string model(const Look& look) {
  return R"(<mujoco><option gravity="0 0 0"/>
    <visual><headlight active="0" ambient=".1 .1 .1"/></visual>
    <asset><material name="paint" )" +
         look.paint + R"(/><material name="other" rgba=".3 .5 .3 1"/>
      <hfield name="hills" nrow="3" ncol="4" size="2 2 .8 .1" elevation=")" +
         look.ground + R"("/></asset>
    <worldbody>
      <geom name="hills" type="hfield" hfield="hills" material="other"/>
      <geom name="wall" type="box" size=".1 2 1" pos="-2 0 1" material="paint"/>
      <geom name="ball" type="sphere" size=".4" pos=".8 -1 .8" )" +
         look.ball + R"(/>
      <body pos=".5 1 1"><joint axis="1 0 0"/><geom type="capsule" fromto="0 0 0 0 0 .6" size=".1" material="paint"/></body>
      <light name="lamp" type="point" pos="1 0 3" ambient=".05 .05 .05" )" +
         look.lamp + R"(/><light name="sun" type="directional" dir="0 1 -2" diffuse=".3 .3 .3"/>
      <camera name="eye" pos="4 -1 3" xyaxes=".25 1 0 -.55 .14 1"/>
    </worldbody></mujoco>)";
}

World world_of(const TempFolder& folder, const Look& look) {
  auto scene = load_scene(folder.write("model.xml", model(look)));
  EXPECT_TRUE(scene.ok());
  auto world = World::compile(*scene);
  EXPECT_TRUE(world.ok()) << world.error().to_string();
  return *world;
}

struct Recording {
  std::vector<std::shared_ptr<const CameraFrame>> frames;  // at steps 0, 25, 50 …
  std::vector<LoggedCommand> log;
};

constexpr int kFrames = 4, kStepsPerFrame = 25;

CameraRequest request(RenderTier tier) {
  CameraRequest request;
  request.camera = "eye";
  request.width = 96;
  request.height = 72;
  request.outputs = {"radiance", "depth", "segmentation"};
  request.render = {.tier = tier, .spp = 2, .max_depth = 3, .denoise = false};
  request.required = true;
  return request;
}

Recording record(const World& world, const std::vector<Command>& commands,
                 RenderTier tier = RenderTier::kDirect) {
  Recording out;
  auto simulation = LiveSimulation::create(world, {});
  EXPECT_TRUE(simulation.ok());
  auto camera = (*simulation)->open_camera(request(tier), [&](auto frame) {
    out.frames.push_back(std::move(frame));
  });
  EXPECT_TRUE(camera.ok());
  for (const Command& command : commands) {
    const Status posted = (*simulation)->post(command);
    EXPECT_TRUE(posted.ok()) << posted.error().to_string();
  }
  EXPECT_TRUE((*simulation)->run_until((kFrames - 1) * kStepsPerFrame).ok());
  out.log = (*simulation)->simulator().take_command_log();
  (*simulation)->simulator().stop();
  camera->reset();
  EXPECT_EQ(out.frames.size(), size_t{kFrames});
  return out;
}

bool is_same(const CameraFrame& a, const CameraFrame& b) {
  return a.radiance == b.radiance && a.depth == b.depth && a.part == b.part;
}

struct Case {
  const char* name;
  LiveFieldId field;
  const char* first_of;  // geom, material or light whose first value is changed
  std::vector<double> values;
  Look before, after;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const std::vector<Case> kCases = {
    {"colour",
     LiveFieldId::kMaterialColor,
     "paint",
     {.1f, .3f, .9f, 1},
     {},
     {.paint = R"(rgba=".1 .3 .9 1")"}},
    {"opacity",
     LiveFieldId::kMaterialColor,
     "paint",
     {.8f, .2f, .2f, .4f},
     {},
     {.paint = R"(rgba=".8 .2 .2 .4")"}},
    {"emission",
     LiveFieldId::kMaterialEmission,
     "paint",
     {2},
     {},
     {.paint = R"(rgba=".8 .2 .2 1" emission="2")"}},
    {"emission_off",
     LiveFieldId::kMaterialEmission,
     "paint",
     {0},
     {.paint = R"(emission="2")"},
     {.paint = ""}},
    {"specular",
     LiveFieldId::kMaterialSpecular,
     "paint",
     {0},
     {},
     {.paint = R"(rgba=".8 .2 .2 1" specular="0")"}},
    {"shininess",
     LiveFieldId::kMaterialShininess,
     "paint",
     {.05f},
     {},
     {.paint = R"(rgba=".8 .2 .2 1" shininess=".05")"}},
    {"reflectance",
     LiveFieldId::kMaterialReflectance,
     "paint",
     {.6f},
     {},
     {.paint = R"(rgba=".8 .2 .2 1" reflectance=".6")"}},
    {"metallic",
     LiveFieldId::kMaterialMetallic,
     "paint",
     {1},
     {},
     {.paint = R"(rgba=".8 .2 .2 1" metallic="1")"}},
    {"roughness",
     LiveFieldId::kMaterialRoughness,
     "paint",
     {.9f},
     {},
     {.paint = R"(rgba=".8 .2 .2 1" roughness=".9")"}},
    {"geom",
     LiveFieldId::kGeomColor,
     "ball",
     {0, 1, 0, 1},
     {},
     {.ball = R"(material="paint" rgba="0 1 0 1")"}},
    {"geom_back",
     LiveFieldId::kGeomColor,
     "ball",
     {.5f, .5f, .5f, 1},
     {.ball = R"(material="paint" rgba="0 1 0 1")"},
     {}},
    {"geom_hidden",
     LiveFieldId::kGeomColor,
     "ball",
     {1, 1, 1, 0},
     {},
     {.ball = R"(rgba="1 1 1 0")"}},
    {"geom_shown",
     LiveFieldId::kGeomColor,
     "ball",
     {1, 1, 0, 1},
     {.ball = R"(rgba="1 1 0 0")"},
     {.ball = R"(rgba="1 1 0 1")"}},
    {"diffuse",
     LiveFieldId::kLightDiffuse,
     "lamp",
     {.2f, .2f, .9f},
     {},
     {.lamp = R"(diffuse=".2 .2 .9")"}},
    {"lit_from_dark",
     LiveFieldId::kLightDiffuse,
     "lamp",
     {.9f, .9f, .9f},
     {.lamp = R"(diffuse="0 0 0")"},
     {}},
    {"candela",
     LiveFieldId::kLightIntensity,
     "lamp",
     {900},
     {},
     {.lamp = R"(diffuse=".9 .9 .9" intensity="900")"}},
    {"active",
     LiveFieldId::kLightActive,
     "lamp",
     {0},
     {},
     {.lamp = R"(diffuse=".9 .9 .9" active="false")"}},
    {"terrain", LiveFieldId::kHeightField, "", {}, {}, {.ground = "0 1 1 0  0 0 0 0  0 .5 1 .2"}},
};

int first_value(const World& world, const Case& c) {
  const mjModel* m = world.compiled()->model.get();
  const auto width = static_cast<int>(c.values.size());
  if (c.field == LiveFieldId::kHeightField) return 0;
  const mjtObj type = c.field == LiveFieldId::kGeomColor       ? mjOBJ_GEOM
                      : c.field >= LiveFieldId::kMaterialColor ? mjOBJ_MATERIAL
                                                               : mjOBJ_LIGHT;
  return width * mj_name2id(m, type, c.first_of);
}

class LiveLook : public testing::TestWithParam<Case> {};

TEST_P(LiveLook, IsThatOfAModelWrittenSo) {
  const Case& c = GetParam();
  const TempFolder folder;
  const World before = world_of(folder, c.before), after = world_of(folder, c.after);
  SetLiveField change{c.field, first_value(before, c), c.values};
  // MuJoCo stores the rows of a height field in another order than they are written in.
  if (change.values.empty()) change.values = read_live_field(*after.compiled()->model, c.field);
  const Recording live = record(before, {{2 * kStepsPerFrame, change}});
  const Recording as_it_was = record(before, {}), as_it_shall_be = record(after, {});
  EXPECT_TRUE(is_same(*live.frames[1], *as_it_was.frames[1])) << "changed before its time";
  // The Command applies before the step after the picture at its own step.
  EXPECT_TRUE(is_same(*live.frames[2], *as_it_was.frames[2]));
  EXPECT_TRUE(is_same(*live.frames[3], *as_it_shall_be.frames[3]));
  EXPECT_FALSE(is_same(*live.frames[3], *as_it_was.frames[3])) << "the test changes nothing";
}

INSTANTIATE_TEST_SUITE_P(All, LiveLook, testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.name); });

// Two changes in different runs are both the first of their run.
TEST(LiveLookOverTime, AResetGivesTheModelsOwnLookBack) {
  const TempFolder folder;
  const World world = world_of(folder, {});
  auto simulation = LiveSimulation::create(world, {});
  ASSERT_TRUE(simulation.ok());
  std::mutex mutex;
  std::condition_variable arrived;
  std::shared_ptr<const CameraFrame> last;
  auto camera = (*simulation)->open_camera(request(RenderTier::kPath), [&](auto frame) {
    const std::lock_guard lock(mutex);
    last = std::move(frame);
    arrived.notify_all();
  });
  ASSERT_TRUE(camera.ok());
  // The picture at kStepsPerFrame of a run with these changes, which a reset ends.
  const auto picture = [&](std::optional<std::pair<float, float>> red_and_height) {
    if (red_and_height) {
      std::vector<double> ground(12, red_and_height->second);
      ground[5] = 1;
      const SetLiveField red{LiveFieldId::kMaterialColor, 0, {red_and_height->first}};
      EXPECT_TRUE((*simulation)->post({0, red}).ok());
      EXPECT_TRUE(
          (*simulation)->post({0, SetLiveField{LiveFieldId::kHeightField, 0, ground}}).ok());
    }
    EXPECT_TRUE((*simulation)->run_until(kStepsPerFrame).ok());
    std::unique_lock lock(mutex);
    EXPECT_TRUE(arrived.wait_for(lock, std::chrono::seconds(60),
                                 [&] { return last != nullptr && last->step == kStepsPerFrame; }));
    const auto frame = std::exchange(last, nullptr);
    lock.unlock();
    EXPECT_TRUE((*simulation)->post({.what = ResetSim{}}).ok());
    return frame;
  };
  const auto plain = picture({}), dark = picture({{0, .5f}}), bright = picture({{1, 0}});
  const auto dark_again = picture({{0, .5f}}), plain_again = picture({});
  (*simulation)->simulator().stop();
  camera->reset();
  EXPECT_TRUE(is_same(*plain, *plain_again)) << "after a reset";
  EXPECT_FALSE(is_same(*plain, *dark));
  EXPECT_FALSE(is_same(*dark, *bright)) << "another change of the same number";
  EXPECT_TRUE(is_same(*dark, *dark_again)) << "the same change again";
}

TEST(LiveLookOverTime, AReplayOfTheLogGivesTheSamePictures) {
  const TempFolder folder;
  const World world = world_of(folder, {});
  std::vector<Command> commands;
  for (int i = 0; i < 12; ++i) {
    const float x = static_cast<float>(i % 5) / 5;
    commands.push_back({Command::kNextStep, SetLiveField{LiveFieldId::kMaterialColor, 1, {x}}});
    commands.push_back({6 * i, SetLiveField{LiveFieldId::kMaterialEmission, i % 2, {x}}});
    commands.push_back({6 * i + 1, SetLiveField{LiveFieldId::kHeightField, i, {x}}});
    commands.push_back({5 * i, SetLiveField{LiveFieldId::kLightActive, 1, {x > .5f ? 1.f : 0.f}}});
  }
  const Recording first = record(world, commands, RenderTier::kPath);
  ASSERT_EQ(first.log.size(), commands.size());
  commands.clear();
  for (const LoggedCommand& logged : first.log) commands.push_back(logged.command);
  const Recording again = record(world, commands, RenderTier::kPath);
  for (size_t i = 0; i < kFrames; ++i)
    EXPECT_TRUE(is_same(*first.frames[i], *again.frames[i])) << "picture " << i;
}

}  // namespace
}  // namespace gloam
