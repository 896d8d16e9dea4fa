#pragma once
// Generated places: [environment.house] and others. Part of gloam/scene.h; docs/environments.md has
// images.

#include <cstdint>
#include <string>

#include "gloam/result.h"

namespace gloam {

/// [environment.house]: a furnished home. The world's origin is on free floor in its hall, and a
/// disc of `passage` / 2 can reach every room from there when all doors are open.
struct HouseOptions {
  uint64_t seed = 1;           ///< seed of the house
  int rooms = 6;               ///< including the hall, 3 … 12; at least 4 on two storeys
  int storeys = 1;             ///< 1 or 2
  double ceiling = 2.5;        ///< clear height of a storey [m], 2.2 … 4
  double passage = 0.7;        ///< free width between objects [m], 0.4 … 1.2
  double clutter = 0.5;        ///< 0 bare … 1: scattered small objects
  std::string doors = "open";  ///< initial state of inner doors: open ajar closed
  double loose = 0.1;          ///< fraction of movable objects that are loose, 0 … 1
  bool furnished = true;       ///< false: bare rooms
  bool openable = true;        ///< doors and drawers of furniture; each costs physics time
  bool roof = true;            ///< false: no roof and no ceilings, for views from above
  SourceLoc loc = {};
};

/// [environment.warehouse]: racks with goods on pallets, lanes for forklifts, dock doors. The
/// world's origin is on free floor in the cross aisle.
struct WarehouseOptions {
  uint64_t seed = 1;     ///< seed of the warehouse
  double length = 30;    ///< along x [m], 12 … 120
  double width = 20;     ///< along y [m], 10 … 80
  double height = 7;     ///< clear height [m], 4 … 14
  double aisle = 2.8;    ///< width of the aisles between racks [m], 1.2 … 6
  int levels = 3;        ///< shelves of a rack above the floor, 1 … 6
  double fill = 0.8;     ///< fraction of the pallet places in use, 0 … 1
  double clutter = 0.5;  ///< 0 bare … 1: objects standing on the floor
  double loose = 0.05;   ///< fraction of the goods that can move, 0 … 1
  int dock_doors = 3;    ///< 0 … 12
  SourceLoc loc = {};
};

/// [environment.office]: a floor of offices on both sides of a corridor along x. The world's origin
/// is on free floor in the corridor.
struct OfficeOptions {
  uint64_t seed = 1;           ///< seed of the office
  double length = 20;          ///< along x [m], 10 … 60
  double width = 13;           ///< along y [m], 9 … 24
  double ceiling = 2.8;        ///< clear height [m], 2.4 … 4
  double passage = 0.8;        ///< free width between objects [m], 0.4 … 1.2
  double clutter = 0.5;        ///< 0 bare … 1: small objects on desks and floors
  std::string doors = "open";  ///< at the start: open ajar closed
  double loose = 0.1;          ///< fraction of movable objects that are loose, 0 … 1
  bool furnished = true;       ///< false: bare rooms
  bool openable = false;       ///< doors and drawers of furniture; each costs physics time
  bool roof = true;            ///< false: no ceilings, for views from above
  SourceLoc loc = {};
};

/// [environment.hallway]: a corridor of a public building, straight or with turns, with locked
/// doors. The world's origin is at its western end.
struct HallwayOptions {
  uint64_t seed = 1;  ///< seed of the hallway
  double length =
      30;  ///< total length of all legs [m], 8 … 200; longer if corners require it (docs)
  double width = 2.4;    ///< [m], 1.6 … 6
  double ceiling = 2.7;  ///< clear height [m], 2.3 … 5
  int turns = 1;         ///< right angles, 0 … 3
  double passage = 0.9;  ///< free width between objects [m], 0.4 … 1.2
  double clutter = 0.5;  ///< 0 bare … 1: objects standing around
  double loose = 0.1;    ///< fraction of movable objects that are loose, 0 … 1
  bool roof = true;      ///< false: no ceilings, for views from above
  SourceLoc loc = {};
};

/// [environment.bedroom]: one furnished bedroom and a part of the hall in front of its door, which
/// contains the world's origin.
struct BedroomOptions {
  uint64_t seed = 1;           ///< seed of the bedroom
  double width = 4.2;          ///< along x [m], 3 … 8
  double depth = 3.8;          ///< along y [m], 3 … 8
  double ceiling = 2.5;        ///< clear height [m], 2.2 … 4
  double passage = 0.7;        ///< free width between objects [m], 0.4 … 1.2
  double clutter = 0.5;        ///< 0 bare … 1: scattered small objects
  std::string doors = "open";  ///< at the start: open ajar closed
  double loose = 0.1;          ///< fraction of movable objects that are loose, 0 … 1
  bool openable = true;        ///< doors and drawers of furniture; each costs physics time
  bool roof = true;            ///< false: no ceiling, for views from above
  SourceLoc loc = {};
};

/// [environment.tunnel]: a road tunnel with an arched ceiling, along x and gently curved. The
/// world's origin is on the road, a quarter of the length from the western portal.
struct TunnelOptions {
  uint64_t seed = 1;     ///< seed of the tunnel
  double length = 80;    ///< [m], 20 … 400
  double width = 7;      ///< width of the road [m], 3 … 12
  double height = 5.2;   ///< height of the arch above the road [m], 2.6 … 9
  double curve = 300;    ///< minimum radius of curvature [m], 60 … 5000
  double lamps = 12;     ///< distance between lamps [m], 4 … 60
  double failed = 0.1;   ///< fraction of lamps that do not work, 0 … 1
  double clutter = 0.5;  ///< 0 bare … 1: cones, barriers, goods left behind
  double loose = 0.1;    ///< fraction of movable objects that are loose, 0 … 1
  SourceLoc loc = {};
};

/// [environment.mine]: a drift of a mine, blasted through rock, along x and gently curved, with
/// niches on both sides. No daylight enters it. The world's origin is on the floor, a quarter of
/// the length from the western face.
struct MineOptions {
  uint64_t seed = 1;     ///< seed of the mine
  double length = 80;    ///< [m], 20 … 400
  double width = 5;      ///< mean width of the drift [m], 3 … 10
  double height = 4;     ///< mean height of its crown above the floor [m], 2.6 … 8
  double curve = 150;    ///< minimum radius of curvature [m], 40 … 5000
  double relief = 0.25;  ///< of the rock about the mean [m], 0.05 … 0.5
  double supports = 8;   ///< distance between steel arches [m], 1 … 50; 0 = none
  double niches = 25;    ///< mean distance between niches [m], 12 … 200; 0 = none
  double lamps = 10;     ///< distance between lamps [m], 4 … 60
  double failed = 0.1;   ///< fraction of lamps that do not work, 0 … 1
  double clutter = 0.5;  ///< 0 bare … 1: rocks and goods along one wall
  double loose = 0.1;    ///< fraction of movable objects that are loose, 0 … 1
  SourceLoc loc = {};
};

/// [environment.terrain]: open terrain under the sky, a rectangle around the world's origin. The
/// origin is on level free ground at z = 0, on the road along x if there is one.
struct TerrainOptions {
  uint64_t seed = 1;        ///< seed of the terrain
  double length = 60;       ///< along x [m], 20 … 200
  double width = 60;        ///< along y [m], 20 … 200
  double relief = 4;        ///< approximate height of its highest point over its lowest [m], 0 … 20
  double resolution = 0.2;  ///< distance between samples of the ground [m], 0.05 … 1
  double road = 3.5;        ///< width of the gravel track [m], 2 … 8; 0 = none
  bool water = true;        ///< a pond at one edge
  double grass = 0.6;       ///< density and height of grass, 0 mown … 1
  double rocks = 0.5;       ///< 0 none … 1
  double trees = 0.5;       ///< trees and bushes, 0 none … 1
  int buildings = 1;        ///< weathered barns, 0 … 3, if there is room
  double loose = 0.1;       ///< fraction of the smaller rocks that are loose, 0 … 1
  SourceLoc loc = {};
};

}  // namespace gloam
