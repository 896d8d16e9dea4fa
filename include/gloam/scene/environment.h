#pragma once
// Surroundings of a scene: [environment], a file or a generated place. Part of gloam/scene.h;
// docs/environments.md has examples.

#include <filesystem>
#include <optional>
#include <string>

#include "gloam/result.h"
#include "gloam/scene/place.h"
#include "gloam/types.h"

namespace gloam {

/// [environment]: everything that is not a robot.
struct EnvironmentOptions {
  /// MJCF, or a glTF, GLB, OBJ, STL or PLY file of a place; empty = only a floor if a TOML scene
  /// has robots, otherwise nothing
  std::filesystem::path file = {};
  /// Axis of a mesh file that points up: y | z; auto = y for glTF, else z.
  std::string up = "auto";
  double unit = 1;                 ///< length of one unit of a mesh file [m]
  std::string colliders = "auto";  ///< colliders of each node of a mesh file, as in [[object]]
  /// Nodes of a mesh file whose name is already used by another node or by the scene: "rename"
  /// makes the later one NAME_2 …, with a note; "refuse" is an error; "prefix" renames all nodes to
  /// FILE_STEM/NODE.
  std::string clash = "rename";
  // Instead of a file, one of the generators:
  std::optional<HouseOptions> house = {};
  std::optional<WarehouseOptions> warehouse = {};
  std::optional<OfficeOptions> office = {};
  std::optional<HallwayOptions> hallway = {};
  std::optional<BedroomOptions> bedroom = {};
  std::optional<TunnelOptions> tunnel = {};
  std::optional<MineOptions> mine = {};
  std::optional<TerrainOptions> terrain = {};
  SourceLoc loc = {};
};

/// A walkable floor.
struct Region {
  std::string name = {};     ///< "kitchen"
  std::string label = {};    ///< kind: room kinds, "aisle", "stairs"
  Vec3 low = {}, high = {};  ///< box above the floor, in the world [m]
};

}  // namespace gloam
