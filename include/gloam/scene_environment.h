#pragma once
// Places and things that Gloam makes itself: generated environments and the catalogue of props.
// Part of gloam/scene.h; docs/environments.md has pictures.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [environment.house]: a furnished home. The world's origin is on free floor in its hall, and a
/// disc of `passage` / 2 can reach every room from there when all doors are open.
struct HouseOptions {
  uint64_t seed = 1;           ///< which house
  int rooms = 6;               ///< hall included, 3 … 12; on two storeys 4 at least
  int storeys = 1;             ///< 1 or 2
  double ceiling = 2.5;        ///< clear height of a storey [m], 2.2 … 4
  double passage = 0.7;        ///< what stays free between things [m], 0.4 … 1.2
  double clutter = 0.5;        ///< 0 bare … 1: small things lying about
  std::string doors = "open";  ///< inner ones at the start: open ajar closed
  double loose = 0.1;          ///< share of what could be pushed that can be, 0 … 1
  bool furnished = true;       ///< false: bare rooms
  bool openable = true;        ///< doors and drawers of furniture; each costs physics time
  bool roof = true;            ///< false: no roof and no ceilings, to look in from above
  SourceLoc loc = {};
};

/// [environment.warehouse]: racks of goods on pallets, lanes for forklifts, dock doors. The world's
/// origin is on free floor in the cross aisle.
struct WarehouseOptions {
  uint64_t seed = 1;     ///< which warehouse
  double length = 30;    ///< along x [m], 12 … 120
  double width = 20;     ///< along y [m], 10 … 80
  double height = 7;     ///< clear height [m], 4 … 14
  double aisle = 2.8;    ///< width of the aisles between racks [m], 1.2 … 6
  int levels = 3;        ///< shelves of a rack above the floor, 1 … 6
  double fill = 0.8;     ///< share of the pallet places in use, 0 … 1
  double clutter = 0.5;  ///< 0 bare … 1: things standing about on the floor
  double loose = 0.05;   ///< share of the goods that can move, 0 … 1
  int dock_doors = 3;    ///< 0 … 12
  SourceLoc loc = {};
};

/// [environment.office]: a floor of offices on both sides of a corridor along x. The world's origin
/// is on free floor in the corridor.
struct OfficeOptions {
  uint64_t seed = 1;           ///< which office
  double length = 20;          ///< along x [m], 10 … 60
  double width = 13;           ///< along y [m], 9 … 24
  double ceiling = 2.8;        ///< clear height [m], 2.4 … 4
  double passage = 0.8;        ///< what stays free between things [m], 0.4 … 1.2
  double clutter = 0.5;        ///< 0 bare … 1: small things on desks and floors
  std::string doors = "open";  ///< at the start: open ajar closed
  double loose = 0.1;          ///< share of what could be pushed that can be, 0 … 1
  bool furnished = true;       ///< false: bare rooms
  bool openable = false;       ///< doors and drawers of furniture; each costs physics time
  bool roof = true;            ///< false: no ceilings, to look in from above
  SourceLoc loc = {};
};

/// [environment.hallway]: a corridor of a public building, straight or with turns, its doors
/// locked. The world's origin is at its western end.
struct HallwayOptions {
  uint64_t seed = 1;     ///< which hallway
  double length = 30;    ///< of all its legs [m], 8 … 200; more if corners need it: docs
  double width = 2.4;    ///< [m], 1.6 … 6
  double ceiling = 2.7;  ///< clear height [m], 2.3 … 5
  int turns = 1;         ///< right angles, 0 … 3
  double passage = 0.9;  ///< what stays free between things [m], 0.4 … 1.2
  double clutter = 0.5;  ///< 0 bare … 1: things standing about
  double loose = 0.1;    ///< share of what could be pushed that can be, 0 … 1
  bool roof = true;      ///< false: no ceilings, to look in from above
  SourceLoc loc = {};
};

/// [environment.bedroom]: one furnished bedroom and a piece of hall before its door, where the
/// world's origin is.
struct BedroomOptions {
  uint64_t seed = 1;           ///< which bedroom
  double width = 4.2;          ///< along x [m], 3 … 8
  double depth = 3.8;          ///< along y [m], 3 … 8
  double ceiling = 2.5;        ///< clear height [m], 2.2 … 4
  double passage = 0.7;        ///< what stays free between things [m], 0.4 … 1.2
  double clutter = 0.5;        ///< 0 bare … 1: small things lying about
  std::string doors = "open";  ///< at the start: open ajar closed
  double loose = 0.1;          ///< share of what could be pushed that can be, 0 … 1
  bool openable = true;        ///< doors and drawers of furniture; each costs physics time
  bool roof = true;            ///< false: no ceiling, to look in from above
  SourceLoc loc = {};
};

/// [environment.tunnel]: a road tunnel under an arch, along x and gently curved. The world's origin
/// is on its road, a quarter of its length from the western portal.
struct TunnelOptions {
  uint64_t seed = 1;     ///< which tunnel
  double length = 80;    ///< [m], 20 … 400
  double width = 7;      ///< of the road [m], 3 … 12
  double height = 5.2;   ///< of the arch above the road [m], 2.6 … 9
  double curve = 300;    ///< least radius of its bends [m], 60 … 5000
  double lamps = 12;     ///< between lamps [m], 4 … 60
  double failed = 0.1;   ///< share of lamps that are out, 0 … 1
  double clutter = 0.5;  ///< 0 bare … 1: cones, barriers, goods left standing
  double loose = 0.1;    ///< share of what could be pushed that can be, 0 … 1
  SourceLoc loc = {};
};

/// [environment.terrain]: open country under the sky, a rectangle about the world's origin, which
/// is on level free ground at z = 0: on the road, which leads along x, where there is one.
struct TerrainOptions {
  uint64_t seed = 1;        ///< which terrain
  double length = 60;       ///< along x [m], 20 … 200
  double width = 60;        ///< along y [m], 20 … 200
  double relief = 4;        ///< about, of its highest point over its lowest [m], 0 … 20
  double resolution = 0.2;  ///< between samples of the ground [m], 0.05 … 1
  double road = 3.5;        ///< width of the gravel track [m], 2 … 8; 0 = none
  bool water = true;        ///< a pond, at one edge
  double grass = 0.6;       ///< 0 mown … 1: how dense and high it stands
  double rocks = 0.5;       ///< 0 none … 1
  double trees = 0.5;       ///< trees and bushes, 0 none … 1
  int buildings = 1;        ///< weathered barns, 0 … 3, as far as there is room
  double loose = 0.1;       ///< share of the smaller rocks that can be pushed, 0 … 1
  SourceLoc loc = {};
};

/// [[prop]]: one thing of the catalogue (`gloam props` lists it), in any scene.
struct PropOptions {
  std::string name = {};                 ///< unique; of its body
  std::string kind = {};                 ///< of the catalogue: gloam props
  uint64_t seed = 0;                     ///< which variant
  Vec3 position = {};                    ///< of the floor below its middle, in the world [m]
  std::optional<Quat> orientation = {};  ///< its front is +x
  std::optional<Vec3> size = {};   ///< depth, width, height, as far as the kind can have them [m]
  std::optional<Vec3> color = {};  ///< linear Rec. 709, 0 … 1, of what is coloured about it
  std::optional<bool> loose = {};  ///< it can be pushed and falls; empty = as its kind usually is
  SourceLoc loc = {};
};

/// [[object]]: a glTF, GLB, OBJ, STL or PLY file, or one of its nodes, made a body that collides.
struct ObjectOptions {
  std::string name = {};            ///< unique; of its body
  std::filesystem::path file = {};  ///< relative to the scene file
  std::string node =
      {};          ///< name of a node of the file, the second of a name is NAME_2; empty = all
  Pose X_WO = {};  ///< where the file's origin is in the world
  Vec3 scale = {1, 1, 1};   ///< after `up`; not 0, < 0 mirrors; one number for all three
  std::string up = "auto";  ///< y | z: axis of the file that points up; auto = y of glTF, else z
  double unit = 1;          ///< [m] of one unit of the file
  std::string motion = "dynamic";   ///< static | dynamic | mocap
  double density = 1000;            ///< of its volume, unless `mass` is given [kg/m³]
  std::optional<double> mass = {};  ///< [kg]
  /// box sphere capsule: the smallest around it; hull: convex; hulls: convex parts (CoACD); none;
  /// auto: box, sphere or capsule where it is one, a hull where it is convex, else hulls.
  std::string colliders = "auto";
  double concavity = 0.05;            ///< hulls: how far a part may be from its hull, 0.01 … 1
  int max_hulls = 32;                 ///< hulls: at most, 1 … 256
  std::optional<Vec3> friction = {};  ///< sliding, torsional [m], rolling [m]
  SourceLoc loc = {};
};

/// [[hfield]]: ground sampled from a mesh file, felt as a height field of MuJoCo.
struct HeightFieldOptions {
  std::string name = {};            ///< unique; of its geom
  std::filesystem::path file = {};  ///< glTF, GLB, OBJ, STL or PLY, relative to the scene file
  Pose X_WF = {};                   ///< where the file's origin is in the world
  Vec3 scale = {1, 1, 1};           ///< after `up`; not 0, < 0 mirrors; one number for all three
  std::string up = "auto";  ///< y | z: axis of the file that points up; auto = y of glTF, else z
  double unit = 1;          ///< [m] of one unit of the file
  /// Corners x, y of what is sampled, in the world [m]; empty = all of it.
  std::optional<std::array<double, 2>> low = {}, high = {};
  double resolution = 0.1;  ///< between samples [m]
  int layers = 1;           ///< 1: seen from above; more: also the floors below, as many, 1 … 8
  std::optional<Vec3> friction = {};  ///< sliding, torsional [m], rolling [m]
  bool drawn = true;                  ///< the file is drawn; false: the height field is
  SourceLoc loc = {};
};

/// One kind of the catalogue, as its variant 0 is.
struct PropInfo {
  std::string kind = {};
  std::string text = {};  ///< what it is
  Vec3 size = {};         ///< of its bounding box: depth, width, height [m]
  double mass = 0;        ///< [kg]
  bool loose = false;     ///< usually not fixed
};
/// The catalogue of [[prop]]s.
std::vector<PropInfo> prop_kinds();

/// A floor that can be walked on.
struct Region {
  std::string name = {};     ///< "kitchen"
  std::string label = {};    ///< what it is: room kinds, "aisle", "stairs"
  Vec3 low = {}, high = {};  ///< box above the floor, in the world [m]
};

}  // namespace gloam
