// The gas's state: the same for any number of threads, saved and restored exactly; what create()
// refuses.

#include "base/memory.h"
#include "base/parallel.h"
#include "gas_room.h"

namespace gloam {
namespace {

const GasGrid kGrid{37, 30, 26, 0.1f, {-1, 2, 0}};

GasWalls walls_at(int n) {
  GasWalls walls(kGrid);
  add_sheet(&walls, 20, [](int j, int k) { return j > 10 && j < 20 && k < 18; });
  const int i = 22 + n / 4;
  add_solid(&walls, {i, 5, 3}, {i + 4, 12, 9}, {0.25f, 0, 0});
  return walls;
}

void advance(GasSolver* gas, int from, int to) {
  GasSource sources[2] = {ball({0, 3.4f, 0.4f}, 0.3f), ball({1.8f, 4.5f, 1}, 0.2f)};
  sources[0].fuel = 0.01f;
  sources[1].blows = true;
  sources[1].velocity = {-1, 0.5f, 0.2f};
  for (int n = from; n < to; ++n) {
    gas->set_walls(walls_at(n));
    gas->step(n % 5 == 4 ? 0.07f : 0.1f, sources, {0.5f, 0, 0});
  }
}

std::unique_ptr<GasSolver> make() {
  GasProperties p;
  p.open[4] = false;
  p.vorticity = 0.3f;
  return make_gas(kGrid, p);
}

TEST(GasState, IsTheSameForAnyNumberOfThreads) {
  uint64_t first = 0;
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    auto gas = make();
    advance(gas.get(), 0, 20);
    if (threads == 1) first = gas->hash();
    EXPECT_EQ(gas->hash(), first) << "with " << threads << " threads";
  }
  set_thread_count(0);
}

TEST(GasState, GoesOnBitForBitAfterSaveAndRestore) {
  auto gas = make();
  advance(gas.get(), 0, 12);
  std::vector<std::byte> bytes;
  gas->save(&bytes);
  const uint64_t at_save = gas->hash();
  advance(gas.get(), 12, 24);
  auto other = make();
  advance(other.get(), 3, 5);  // what it did before does not matter
  ASSERT_TRUE(other->restore(bytes).ok());
  EXPECT_EQ(other->hash(), at_save);
  EXPECT_EQ(other->budget().fuel_added > 0, true);
  advance(other.get(), 12, 24);
  EXPECT_EQ(other->hash(), gas->hash()) << "12 steps after restore()";
}

TEST(GasState, RefusesWhatItDidNotSave) {
  auto gas = make();
  advance(gas.get(), 0, 2);
  const uint64_t hash = gas->hash();
  std::vector<std::byte> bytes;
  gas->save(&bytes);
  EXPECT_FALSE(gas->restore({}).ok());
  EXPECT_FALSE(gas->restore(std::span(bytes).first(bytes.size() - 1)).ok());
  bytes[0] ^= std::byte{1};
  EXPECT_FALSE(gas->restore(bytes).ok());
  GasGrid smaller = kGrid;
  --smaller.nx;
  make_gas(smaller, GasProperties())->save(&bytes);
  EXPECT_FALSE(gas->restore(bytes).ok());
  EXPECT_EQ(gas->hash(), hash) << "what is refused changes nothing";
}

TEST(GasState, CreateRefusesWhatItCanNotDo) {
  const auto message = [](GasGrid grid, const std::function<void(GasProperties*)>& change) {
    GasProperties p;
    if (change) change(&p);
    const auto made = GasSolver::create(grid, p);
    return made.ok() ? std::string() : made.error().to_string();
  };
  using testing::HasSubstr;
  EXPECT_EQ(message(kGrid, nullptr), "");
  EXPECT_THAT(message({3, 30, 30, 0.1f, {}}, nullptr), HasSubstr("3 x 30 x 30"));
  EXPECT_THAT(message({2000, 30, 30, 0.1f, {}}, nullptr), HasSubstr("2000"));
  EXPECT_THAT(message({1024, 1024, 1024, 0.1f, {}}, nullptr), HasSubstr("the limit is 134217728"));
  if (memory_room().bytes < uint64_t(16) << 30) {  // else it would be made
    EXPECT_THAT(message({512, 512, 512, 0.1f, {}}, nullptr), HasSubstr("memory"));
  }
  EXPECT_THAT(message({30, 30, 30, 0, {}}, nullptr), HasSubstr("got 0 m"));
  EXPECT_THAT(message({30, 30, 30, 0.1f, {NAN, 0, 0}}, nullptr), HasSubstr("not finite"));
  EXPECT_THAT(message(kGrid, [](auto* p) { p->mixing_time = 0; }), HasSubstr("mixing_time"));
  EXPECT_THAT(message(kGrid, [](auto* p) { p->radiated = 1.5f; }), HasSubstr("radiated"));
  EXPECT_THAT(message(kGrid, [](auto* p) { p->vorticity = -1; }), HasSubstr("vorticity"));
  EXPECT_THAT(message(kGrid, [](auto* p) { p->cooling = NAN; }), HasSubstr("cooling"));
}

TEST(GasState, SourcesInWallsAndOutsideAreCounted) {
  auto gas = make();
  GasWalls walls(kGrid);
  add_solid(&walls, {0, 0, 0}, {8, 30, 26});
  gas->set_walls(walls);
  GasSource sources[3] = {ball({-0.7f, 3, 1}, 0.2f), ball({-0.2f, 3, 1}, 0.3f),
                          ball({50, 3, 1}, 0.2f)};
  for (GasSource& s : sources) s.smoke = 0.001f;
  const GasStep step = gas->step(0.3f, sources, {});
  EXPECT_EQ(step.sources_blocked, 2) << "one in the wall, one far outside";
  EXPECT_GT(step.source_cells_blocked, 10) << "of the one in the wall, and of half the other";
  EXPECT_NEAR(gas->budget().smoke_added, 0.0003, 1e-9) << "kg: only one gives any";
  EXPECT_NEAR(gas->smoke_mass(), 0.0003, 1e-9) << "kg: all of it";
}

}  // namespace
}  // namespace gloam
