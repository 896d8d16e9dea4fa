#pragma once
// Navigation mesh for agents of one size, in tiles, made by Recast out of colliders and searched by
// Detour (Mononen; recastnavigation.org). One mesh is used by one thread at a time; tiles are built
// by any. Recast's axes stay in here.

#include <memory>
#include <span>
#include <vector>

#include "gloam/result.h"
#include "sim/agents/agent_math.h"
#include "sim/agents/collider_triangles.h"

namespace gloam {

struct NavSettings {
  double cell = 0.1;      ///< edge of voxels in the plane [m]; half of it is their height
  double headroom = 1.9;  ///< [m]
  double radius = 0.3;    ///< from walls [m]
  double climb = 0.22;    ///< [m]
  double slope = 40;      ///< [deg]
  NavBounds bounds;       ///< bounds of all geometry
  bool operator==(const NavSettings& o) const {
    return cell == o.cell && headroom == o.headroom && radius == o.radius && climb == o.climb &&
           slope == o.slope;
  }
};

/// A point on the mesh.
struct NavPoint {
  Vec3d p;           ///< [m]
  uint32_t ref = 0;  ///< Detour's polygon; 0 = none
};

/// One built tile; empty where nobody can stand.
struct NavTile {
  std::vector<unsigned char> data;
};

class NavMesh {
 public:
  /// Empty. Errors: too many tiles for Detour; this build has no Recast.
  static Result<std::unique_ptr<NavMesh>> create(const NavSettings& settings);
  ~NavMesh();

  /// Takes all tiles out, so that the same tiles set again make the same mesh, bit by bit. False:
  /// there is no memory.
  bool clear();
  int columns() const;
  int rows() const;
  /// Box that a tile depends on: its own and a border around it.
  NavBounds tile_reach(int column, int row) const;
  /// Builds a tile from the surfaces that meet its tile_reach.
  NavTile build_tile(int column, int row, std::span<const ColliderSurface* const> near) const;
  void set_tile(int column, int row, const NavTile& tile);
  /// To be called when tiles have been set: finds the parts that hang together.
  void find_parts();

  /// Area of the largest part [m²].
  double area() const;
  /// Nearest point of the mesh within `reach` in the plane and `up` above or below [m].
  NavPoint nearest(Vec3d p, double reach, double up) const;
  /// Nearest point wherever `p` is, about; what is outside of the bounds is first moved into them.
  NavPoint nearest(Vec3d p) const;
  /// Uniform over the part that `from` is on, if it is on none over the largest, of three numbers
  /// in [0, 1).
  NavPoint random_point(const NavPoint& from, double u, double v, double w) const;

  /// Area of the part that a point is on [m²].
  double area_around(const NavPoint& point) const;
  bool are_connected(const NavPoint& a, const NavPoint& b) const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  int part_of(const NavPoint& point) const;
  NavMesh();
  std::unique_ptr<Impl> impl_;
};

/// The way of one agent over a mesh: Detour's path corridor.
class NavPath {
 public:
  NavPath();
  NavPath(NavPath&&) noexcept;
  ~NavPath();

  /// Stands at a point, and goes nowhere.
  void reset(const NavPoint& at);
  /// Finds a way to a point of the mesh. False: there is none, and it goes as near as it can.
  bool find(const NavMesh& mesh, const NavPoint& goal);
  /// The end of the way.
  Vec3d end() const;
  /// Are the next polygons still there?
  bool is_valid(const NavMesh& mesh) const;
  /// The next corners of the way, at most `most`; the last may be its end.
  int corners(const NavMesh& mesh, Vec3d* out, int most);
  /// Moves along the surface towards p, as far as walls let it; the point that is reached.
  Vec3d move(const NavMesh& mesh, Vec3d p);
  NavPoint at() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Avoidance of collisions: the obstacles of an agent and the velocity that avoids them. Sampled
/// reciprocal velocity obstacles (van den Berg et al. 2008), from Detour.
class NavAvoidance {
 public:
  static constexpr int kMostCircles = 12, kMostWalls = 16;
  NavAvoidance();
  ~NavAvoidance();
  void clear();
  /// Someone else: where, how large, how fast, and how fast he means to be.
  void add_circle(Vec3d p, double radius, Vec3d velocity, Vec3d wanted);
  /// Walls of the mesh around a point.
  void add_walls(const NavMesh& mesh, const NavPoint& around, double reach);
  Vec3d choose(Vec3d p, double radius, double fastest, Vec3d velocity, Vec3d wanted);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gloam
