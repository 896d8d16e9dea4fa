// Every generator makes something of any options within the ranges that the manual and the reader
// of scene files give them.

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "places/dice.h"
#include "scene/options/environment_fields.h"
#include "world/test/generated_place.h"

namespace gloam {
namespace {

// A visitor that draws every option from its whole range, ends and default included. Large places
// are rarer: most of what can go wrong is a matter of proportion, and they take seconds.
class RangeDice {
 public:
  explicit RangeDice(uint64_t seed) : dice_(seed, "ranges") {}

  template <class T>
  void operator()(std::string_view key, T& member, const FieldRule& rule) {
    draw(key, member, rule);
    text += fmt::format("{} = {}\n", key, member);
  }

  std::string text;  ///< as in a scene file

 private:
  void draw(std::string_view, uint64_t& seed, const FieldRule&) {
    seed = static_cast<uint64_t>(dice_.integer(0, 999));
  }
  void draw(std::string_view, bool& flag, const FieldRule&) { flag = dice_.chance(0.5); }
  void draw(std::string_view, std::string& word, const FieldRule& rule) {
    word = dice_.pick(rule.choices);
  }
  void draw(std::string_view, int& number, const FieldRule& rule) {
    number = dice_.integer(static_cast<int>(rule.min), static_cast<int>(rule.max));
  }
  void draw(std::string_view key, double& number, const FieldRule& rule) {
    const bool is_extent = key == "length" || key == "width";
    const double end = dice_.uniform(), share = dice_.uniform();
    if (end < 0.15) return;
    number = end < 0.3 ? rule.min
             : end < 0.4 && !is_extent
                 ? rule.max
                 : rule.min + (rule.max - rule.min) * (is_extent ? share * share * share : share);
  }

  Dice dice_;
};

class GeneratorRanges : public GeneratedPlace {
 protected:
  template <class Options>
  static Options drawn(uint64_t number, std::string* text) {
    RangeDice dice(number);
    Options options;
    visit_fields(dice, options);
    *text = fmt::format("\nnumber {}\n{}", number, dice.text);
    return options;
  }
  template <class Options>
  void expect_made(uint64_t first, uint64_t last) {
    for (uint64_t number = first; number <= last; ++number) {
      std::string text;
      const Scene scene = scene_of(drawn<Options>(number, &text));
      const Result<World> world = World::compile(scene);
      EXPECT_TRUE(world.ok()) << world.error().to_string() << text;
    }
  }
  template <class Options>
  void expect_sound_numbers(uint64_t first, uint64_t last, double cell) {
    for (uint64_t number = first; number <= last; ++number) {
      std::string text;
      Options options = drawn<Options>(number, &text);
      options.roof = true;
      expect_sound(options, cell, text);
    }
  }
};

TEST_F(GeneratorRanges, HousesAreMade) { expect_made<HouseOptions>(1, 24); }
TEST_F(GeneratorRanges, WarehousesAreMade) { expect_made<WarehouseOptions>(1, 12); }
TEST_F(GeneratorRanges, OfficesAreMade) { expect_made<OfficeOptions>(1, 24); }
TEST_F(GeneratorRanges, HallwaysAreMade) { expect_made<HallwayOptions>(1, 48); }
TEST_F(GeneratorRanges, BedroomsAreMade) { expect_made<BedroomOptions>(1, 48); }
TEST_F(GeneratorRanges, TunnelsAreMade) { expect_made<TunnelOptions>(1, 16); }
TEST_F(GeneratorRanges, MinesAreMade) { expect_made<MineOptions>(1, 16); }
TEST_F(GeneratorRanges, TerrainsAreMade) { expect_made<TerrainOptions>(1, 12); }

TEST_F(GeneratorRanges, DISABLED_SweepHouses) { expect_made<HouseOptions>(101, 500); }
TEST_F(GeneratorRanges, DISABLED_SweepWarehouses) { expect_made<WarehouseOptions>(101, 400); }
TEST_F(GeneratorRanges, DISABLED_SweepOffices) { expect_made<OfficeOptions>(101, 500); }
TEST_F(GeneratorRanges, DISABLED_SweepHallways) { expect_made<HallwayOptions>(101, 700); }
TEST_F(GeneratorRanges, DISABLED_SweepBedrooms) { expect_made<BedroomOptions>(101, 700); }
TEST_F(GeneratorRanges, DISABLED_SweepTunnels) { expect_made<TunnelOptions>(101, 400); }
TEST_F(GeneratorRanges, DISABLED_SweepMines) { expect_made<MineOptions>(101, 400); }
TEST_F(GeneratorRanges, DISABLED_SweepTerrains) { expect_made<TerrainOptions>(101, 400); }

TEST_F(GeneratorRanges, AreSoundInside) {
  expect_sound_numbers<HouseOptions>(3, 4, kFine);
  expect_sound_numbers<OfficeOptions>(1, 2, kFine);
  expect_sound_numbers<HallwayOptions>(1, 4, kFine);
  expect_sound_numbers<BedroomOptions>(1, 4, kFine);
}
TEST_F(GeneratorRanges, DISABLED_SweepHousesAreSound) {
  expect_sound_numbers<HouseOptions>(101, 160, kFine);
}
TEST_F(GeneratorRanges, DISABLED_SweepOfficesAreSound) {
  expect_sound_numbers<OfficeOptions>(101, 160, kFine);
}
TEST_F(GeneratorRanges, DISABLED_SweepHallwaysAreSound) {
  expect_sound_numbers<HallwayOptions>(101, 200, kFine);
}
TEST_F(GeneratorRanges, DISABLED_SweepBedroomsAreSound) {
  expect_sound_numbers<BedroomOptions>(101, 200, kFine);
}

}  // namespace
}  // namespace gloam
