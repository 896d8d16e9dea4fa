// The studio is seen by colour pictures alone.

#include <gtest/gtest.h>

#include "gloam/run.h"
#include "scenes.h"

namespace gloam {
namespace {

const char* const kUnlit = R"(<mujoco model="unlit"><worldbody>
  <camera name="side" pos="2 -2 1" xyaxes="0.7 0.7 0 -0.25 0.25 0.93"/>
  <body name="b" pos="0 0 0.4"><freejoint/><geom type="box" size="0.3 0.2 0.1"/></body>
</worldbody></mujoco>)";

World unlit(const TempFolder& folder, RenderLook look) {
  auto scene = load_scene(folder.write("unlit.xml", kUnlit));
  EXPECT_TRUE(scene.ok()) << scene.error().to_string();
  scene->render.look = look;
  auto world = World::compile(*scene);
  EXPECT_TRUE(world.ok()) << world.error().to_string();
  return std::move(*world);
}

CameraFrame picture(const World& world, RenderTier tier) {
  CameraRequest request{.camera = "side",
                        .width = 64,
                        .height = 48,
                        .outputs = {"rgb", "depth", "distance", "segmentation", "normal", "albedo",
                                    "motion", "scene_flow", "boxes"}};
  request.render = {.tier = tier, .spp = 1, .denoise = false};
  auto frames = render_stills(world, 0, {request}, {});
  EXPECT_TRUE(frames.ok()) << frames.error().to_string();
  return frames->front();
}

TEST(Look, ColourPicturesAloneShowTheStudio) {
  const TempFolder folder;
  for (const RenderTier value :
       {RenderTier::kPath, RenderTier::kDirect, RenderTier::kInteractive}) {
    const char* const tier = to_string(value);
    const CameraFrame studio = picture(unlit(folder, RenderLook::kAuto), value);
    const CameraFrame model = picture(unlit(folder, RenderLook::kModel), value);
    EXPECT_NE(studio.rgb, model.rgb) << tier;
    const size_t corner = 3 * (64 * 48 - 1);
    EXPECT_GT(studio.rgb[corner], 60) << tier << ": the floor";
    EXPECT_LT(model.rgb[corner], 20) << tier;
    EXPECT_EQ(studio.depth, model.depth) << tier;
    EXPECT_EQ(studio.distance, model.distance) << tier;
    EXPECT_EQ(studio.part, model.part) << tier;
    EXPECT_EQ(studio.instance, model.instance) << tier;
    EXPECT_EQ(studio.semantic, model.semantic) << tier;
    EXPECT_EQ(studio.normal, model.normal) << tier;
    EXPECT_EQ(studio.albedo, model.albedo) << tier;
    EXPECT_EQ(studio.motion, model.motion) << tier;
    EXPECT_EQ(studio.scene_flow, model.scene_flow) << tier;
    EXPECT_EQ(studio.objects.size(), model.objects.size()) << tier;
  }
}

TEST(Look, LabelsAndTheStateKnowNothingOfTheStudio) {
  const TempFolder folder;
  std::vector<size_t> labels;
  std::vector<uint64_t> hashes;
  for (const RenderLook look : {RenderLook::kStudio, RenderLook::kModel}) {
    auto simulation = Simulation::create(unlit(folder, look), {});
    ASSERT_TRUE(simulation.ok()) << simulation.error().to_string();
    auto rows = (*simulation)->labels();
    ASSERT_TRUE(rows.ok());
    labels.push_back(rows->size());
    ASSERT_TRUE((*simulation)->step(50).ok());
    hashes.push_back((*simulation)->latest().hash());
  }
  EXPECT_EQ(labels[0], labels[1]);
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace gloam
