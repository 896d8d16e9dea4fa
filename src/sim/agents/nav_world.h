#pragma once
// Ground and obstacles of agents while the simulation goes on. Colliders that stand still and
// movable things at rest are part of the navigation meshes; moving things are avoided.

#include <array>
#include <memory>
#include <vector>

#include "sim/agents/nav_mesh.h"
#include "world/world.h"

namespace gloam {

/// Something that moves and is not an agent: a circle in the plane.
struct NavObstacle {
  Vec3d p;            ///< place of its middle [m]
  double radius = 0;  ///< [m]
  Vec3d velocity;     ///< [m/s]
  bool is_robot = false;
  bool is_in_mesh = false;  ///< at rest: ways lead around it
};

class NavWorld {
 public:
  /// Builds a mesh for each size of agent. `data`: poses of the initial state. Errors: too large
  /// for `cell`; there is nowhere to go; this build has no Recast.
  static Result<std::unique_ptr<NavWorld>> create(const CompiledWorld& world, const mjModel& model,
                                                  const mjData& data);

  /// Mesh for the agent in that row of CompiledWorld::agents.
  const NavMesh& mesh_of(size_t agent) const { return *meshes_[mesh_of_agent_[agent]].mesh; }
  /// Height of the highest surface that is at most `up` above p and `down` below it; p's own where
  /// there is none [m].
  double ground_below(Vec3d p, double up, double down) const;

  /// A place for an agent, of three numbers in [0, 1): in a room of a generated place, else
  /// anywhere on its mesh; where `from` is on the mesh, one that a way leads to from there. May be
  /// none.
  NavPoint random_place(size_t agent, const NavPoint& from, double u, double v, double w) const;

  /// Follows what moves, `dt` after the last time [s]; at most one tile of each mesh is built anew.
  /// True: some was, and ways have to be looked at. Allocates when something comes to rest or
  /// leaves where it lay.
  bool follow(const mjModel& model, const mjData& data, double dt);
  /// Back to how it was at first.
  void reset(const mjModel& model, const mjData& data);

  const std::vector<NavObstacle>& obstacles() const { return obstacles_; }
  /// Obstacle of the robot in that row of CompiledWorld::robots; -1 = it has no bodies.
  int obstacle_of_robot(size_t robot) const { return obstacle_of_robot_[robot]; }
  /// Digest of what is where in the meshes.
  uint64_t hash(uint64_t seed) const;

 private:
  struct Mesh {
    std::unique_ptr<NavMesh> mesh;
    std::vector<bool> dirty;  // by tile
    size_t dirty_count = 0;
    std::vector<NavTile> initial;  // tiles of the initial state
    bool is_initial = false;
  };
  // Bodies that move as one thing, or a robot.
  struct Movable {
    int body = 0;
    std::vector<int> geoms;
    bool is_robot = false;
    Vec3d p, p_in_mesh;    // place of its body, at the last time and when it came into the meshes
    double rest_time = 0;  // [s]
    bool is_in_mesh = false;
    std::vector<ColliderSurface> surfaces;  // in the meshes
  };

  NavWorld() = default;
  void find_bounds(const CompiledWorld& world, const mjModel& m, const mjData& d);
  void sort_geoms(const CompiledWorld& world, const mjModel& m, const mjData& d);
  void add_still(ColliderSurface surface);
  Status make_meshes(const CompiledWorld& world);
  void put_into_mesh(const mjModel& m, const mjData& d, Movable* movable);
  void take_out_of_mesh(Movable* movable);
  void mark(const ColliderSurface& surface);
  void build_initial(Mesh* mesh) const;
  void rebuild(Mesh* mesh, size_t tile) const;
  void collect(const NavBounds& reach, std::vector<const ColliderSurface*>* near) const;
  bool rebuild_marked();
  void bound(const mjModel& m, const mjData& d, const Movable& movable, NavBounds* box) const;

  NavBounds bounds_;
  std::vector<Region> rooms_;
  std::vector<double> room_areas_;  // up to each [m²]
  std::vector<ColliderSurface> still_;
  std::vector<Movable> movables_;
  std::vector<NavObstacle> obstacles_;  // by movable
  std::vector<int> obstacle_of_robot_;
  std::vector<Mesh> meshes_;
  std::vector<NavSettings> settings_;  // by mesh
  std::vector<size_t> mesh_of_agent_;
  // Surfaces that stand still over each square of the plane.
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<int>> squares_;
};

/// A leaf of a door: a body that turns about the vertical on one hinge and is as high as a person.
bool is_door_leaf(const mjModel& model, const mjData& data, int body);

}  // namespace gloam
