// What a house has, seed by seed, before MuJoCo knows of it.

#include <gtest/gtest.h>

#include <set>

#include "places/generators.h"

namespace gloam {
namespace {

constexpr uint64_t kSeeds = 12;

Place house_of(uint64_t seed) {
  HouseOptions options;
  options.seed = seed;
  return make_house(options).value();
}

std::string room_of(const Placement& placement) {
  return placement.name.substr(0, placement.name.find('/'));
}

TEST(House, NothingInARoomReachesThroughItsFloorOrCeiling) {
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Place house = house_of(seed);
    const std::set<std::string> shell = {"floor", "ceiling", "wall", "window"};
    for (const Placement& placement : house.placements()) {
      const Prop& prop = house.prop(placement.prop);
      if (placement.name.find('/') == std::string::npos || shell.count(prop.label)) continue;
      const Prop::Box box = prop.bounds();
      EXPECT_LE(placement.X_WP.p.z + box.high.z, HouseOptions{}.ceiling + 0.001)
          << placement.name << " of house " << seed;
      EXPECT_GE(placement.X_WP.p.z + box.low.z, -0.001) << placement.name << " of house " << seed;
    }
  }
}

TEST(House, EveryRoomHasASocketAndASwitchBesideItsDoor) {
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Place house = house_of(seed);
    std::set<std::string> switches, sockets;
    for (const Placement& placement : house.placements()) {
      const std::string& label = house.prop(placement.prop).label;
      if (label == "light_switch") switches.insert(room_of(placement));
      if (label == "wall_socket") sockets.insert(room_of(placement));
    }
    for (const Region& room : house.regions) {
      EXPECT_EQ(sockets.count(room.name), 1u) << room.name << " of house " << seed;
      if (room.label == "living") continue;  // it may have an archway alone
      EXPECT_EQ(switches.count(room.name), 1u) << room.name << " of house " << seed;
    }
  }
}

TEST(House, KitchensHaveTilesBehindTheWorktopAndSomeASecondRow) {
  int corners = 0, facing = 0, rows = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Place house = house_of(seed);
    bool tiles = false, is_kitchen = false, corner = false;
    std::set<double> turns;  // of cupboards and cooker: which way they look
    for (const Placement& placement : house.placements()) {
      const std::string& label = house.prop(placement.prop).label;
      is_kitchen |= label == "cooker";
      tiles |= label == "tiles";
      corner |= label == "corner_cabinet";
      if (label == "cooker" || label == "kitchen_cabinet")
        turns.insert(std::round(placement.X_WP.q.z * 100));
    }
    EXPECT_EQ(tiles, is_kitchen) << "house " << seed;
    rows += is_kitchen;
    corners += corner;
    facing += turns.size() > 1 && !corner;
  }
  EXPECT_GE(corners + facing, rows / 4) << "of " << rows;
}

}  // namespace
}  // namespace gloam
