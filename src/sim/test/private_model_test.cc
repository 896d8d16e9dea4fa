// A simulation's own copy of its World's model: which arrays are its own, and that the World's
// never change.

#include "sim/state/private_model.h"

#include <mujoco/mjxmacro.h>

#include <cstring>
#include <map>
#include <string>

#include "test_world.h"

namespace gloam {
namespace {

constexpr const char* kModel = R"(<mujoco>
  <asset><mesh name="wedge" vertex="0 0 0  .2 0 0  0 .2 0  0 0 .2"/>
    <hfield name="hills" nrow="3" ncol="3" size="1 1 .1 .1" elevation="0 0 0 0 1 0 0 0 0"/></asset>
  <worldbody>
    <geom type="hfield" hfield="hills"/>
    <body name="part" pos="0 0 1"><freejoint/><geom type="mesh" mesh="wedge"/><geom size=".1"/></body>
  </worldbody>
</mujoco>)";

struct Array {
  const void* at;
  std::string bytes;
};

std::map<std::string, Array> arrays_of(const mjModel& m) {
  std::map<std::string, Array> arrays;
#undef MJ_M
#define MJ_M(n) m.n
#define X(type, name, rows, columns)                       \
  arrays[#name] = {m.name,                                 \
                   {reinterpret_cast<const char*>(m.name), \
                    sizeof(type) * static_cast<size_t>(m.rows) * static_cast<size_t>(columns)}};
  MJMODEL_POINTERS
#undef X
  return arrays;
}

TEST(PrivateModel, HasTheWorldsNumbersAndOwnsWhatMayChange) {
  const auto world = world_from_mjcf(kModel);
  PrivateModel own(world);
  const auto before = arrays_of(*world->model), mine = arrays_of(own.model());
  for (const auto& [name, array] : mine) {
    EXPECT_EQ(array.bytes, before.at(name).bytes) << name;
    EXPECT_EQ(reinterpret_cast<uintptr_t>(array.at) % 64, 0u) << name;
  }
  EXPECT_EQ(own.model().mesh_vert, world->model->mesh_vert);
  EXPECT_EQ(own.model().bvh_aabb, world->model->bvh_aabb);
  for (const char* name : {"body_mass", "geom_friction", "hfield_data", "qpos0", "geom_rgba"})
    EXPECT_NE(mine.at(name).at, before.at(name).at) << name;
}

TEST(PrivateModel, TakesBackWhatChangedAndLeavesTheWorldAlone) {
  const auto world = world_from_mjcf(kModel);
  const auto before = arrays_of(*world->model);
  PrivateModel own(world);
  own.own_bounds();
  mjModel& m = own.model();
  EXPECT_NE(m.bvh_aabb, world->model->bvh_aabb);
  EXPECT_EQ(arrays_of(m).at("bvh_aabb").bytes, before.at("bvh_aabb").bytes);
  const DataPtr data(mj_makeData(&m));
  m.body_mass[1] = 7;
  m.geom_size[3] = 0.5;
  mj_setConst(&m, data.get());  // writes into every array that it derives from masses
  m.hfield_data[4] = 0.25f;
  m.bvh_aabb[0] += 1;
  const auto* const masses = m.body_mass;
  for (const auto& [name, array] : arrays_of(*world->model))
    EXPECT_EQ(array.bytes, before.at(name).bytes) << name;
  own.renew();
  EXPECT_EQ(m.body_mass, masses) << "arrays stay where they are";
  for (const auto& [name, array] : arrays_of(m))
    EXPECT_EQ(array.bytes, before.at(name).bytes) << name;
}

}  // namespace
}  // namespace gloam
