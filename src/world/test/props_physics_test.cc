// Props of the catalogue in a World: what is loose stands still where it is put, what opens does so
// without touching its neighbours, and all can be drawn.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "gloam/world.h"
#include "places/catalogue.h"
#include "scene/test/temp_folder.h"
#include "world/render_description.h"
#include "world/world.h"

namespace gloam {
namespace {

class PropsPhysics : public ::testing::Test {
 protected:
  PropsPhysics() { ::setenv("GLOAM_CACHE", (folder_.path() / "cache").c_str(), 1); }

  // Kinds for which wanted(prop) in a row on the floor, three variants of each.
  template <class Wanted>
  Result<World> compile(const Wanted& wanted, bool loose) {
    std::string text = "[scene]\nname = 'props'\n";
    int row = 0;
    for (const PropKind& kind : prop_catalogue()) {
      for (uint64_t seed = 0; seed < 3; ++seed) {
        MaterialSet materials;
        GLOAM_TRY(const Prop prop, make_prop({kind.name, seed}, {}, &materials));
        if (!wanted(prop)) continue;
        const bool is_hung = prop.bounds().low.z < -0.01f;
        names_.push_back(fmt::format("{}_{}", kind.name, seed));
        text += fmt::format(
            "[[prop]]\nname = '{}'\nkind = '{}'\nseed = {}\nposition = [{}, {}, {}]\nloose = {}\n",
            names_.back(), kind.name, seed, 6.0 * (row % 12), 6.0 * (row / 12), is_hung ? 3 : 0,
            loose);
        ++row;
      }
    }
    GLOAM_TRY(const Scene scene, load_scene(folder_.write("scene.toml", text)));
    return World::compile(scene);
  }

  static std::string geoms_of(const mjModel* model, const mjContact& contact) {
    const auto name = [&](int geom) {
      const char* text = mj_id2name(model, mjOBJ_GEOM, geom);
      return std::string(text != nullptr ? text : "a geom");
    };
    return name(contact.geom[0]) + " and " + name(contact.geom[1]);
  }

  TempFolder folder_;
  std::vector<std::string> names_;
};

TEST_F(PropsPhysics, LooseOnesStandStillWhereTheyArePut) {
  const Result<World> world = compile([](const Prop& prop) { return prop.loose; }, true);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel* model = world->compiled()->model.get();
  const DataPtr data(mj_makeData(model));
  mj_forward(model, data.get());
  const std::vector<double> start(data->xpos, data->xpos + 3 * model->nbody);
  const std::vector<double> facing(data->xquat, data->xquat + 4 * model->nbody);
  std::map<std::string, double> deep;
  while (data->time < 2) {
    mj_step(model, data.get());
    for (int i = 0; i < data->ncon; ++i) {
      if (data->contact[i].dist > -0.002) continue;
      double& most = deep[geoms_of(model, data->contact[i])];
      most = std::min(most, data->contact[i].dist);
    }
  }
  for (const auto& [pair, distance] : deep) ADD_FAILURE() << pair << " overlap by " << -distance;
  for (const std::string& name : names_) {
    const int body = mj_name2id(model, mjOBJ_BODY, name.c_str());
    ASSERT_GE(body, 0) << name;
    double moved = 0;
    for (int k = 0; k < 3; ++k)
      moved = std::hypot(moved, data->xpos[3 * body + k] - start[size_t(3 * body + k)]);
    EXPECT_LT(moved, 0.005) << name;
  }
  for (int body = 1; body < model->nbody; ++body) {  // lids and drawers, too
    double turn[3];
    mju_subQuat(turn, data->xquat + 4 * body, &facing[size_t(4 * body)]);
    EXPECT_LT(mju_norm3(turn) * 180 / M_PI, 1.5) << mj_id2name(model, mjOBJ_BODY, body);
  }
}

TEST_F(PropsPhysics, LeavesMoveFreelyOverTheirWholeTravel) {
  const Result<World> world =
      compile([](const Prop& prop) { return prop.parts.size() > 1; }, false);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const mjModel* model = world->compiled()->model.get();
  const DataPtr data(mj_makeData(model));
  // All alike, then every other one, from shut to open.
  for (int pattern = 0; pattern < 3; ++pattern) {
    for (int step = 0; step <= 8; ++step) {
      for (int j = 0; j < model->njnt; ++j) {
        const double share = pattern > 0 && j % 2 == pattern - 1 ? 0 : step / 8.0;
        const double* range = model->jnt_range + 2 * j;
        data->qpos[model->jnt_qposadr[j]] = range[0] + share * (range[1] - range[0]);
      }
      mj_forward(model, data.get());
      for (int i = 0; i < data->ncon; ++i)
        EXPECT_GT(data->contact[i].dist, -1e-4)
            << geoms_of(model, data->contact[i]) << ", pattern " << pattern << ", step " << step;
    }
  }
}

TEST_F(PropsPhysics, AllCanBeDrawn) {
  const Result<World> world = compile([](const Prop&) { return true; }, false);
  ASSERT_TRUE(world.ok()) << world.error().to_string();
  const Result<RenderDescription> drawn = describe_for_rendering(*world->compiled());
  EXPECT_TRUE(drawn.ok()) << drawn.error().to_string();
}

}  // namespace
}  // namespace gloam
