#pragma once
// MuJoCo's colliders as closed faces between voxels: what a gas meets at an instant.

#include <memory>
#include <vector>

#include "sim/effects/bodies/collider_mesh.h"
#include "sim/effects/bodies/wall_runs.h"
#include "sim/effects/gas/gas_walls.h"
#include "sim/snapshots/snapshot.h"
#include "world/world.h"

namespace gloam {

/// Voxelises what of a World can be touched: what stands still once, what moves at every call.
/// A face is closed when the segment between its cells' centres meets a solid; a cell is solid when
/// its centre is inside. Meshes are their hulls, planes and height fields are solid below.
/// Used by one thread at a time; the same bits for any number of threads.
class GasObstacles {
 public:
  /// Gap of a shut door, 4 to 8 mm: a line through one would open it by a whole voxel.
  static constexpr double kSealedGap = 0.01;
  static constexpr double kTeleport = 20;  ///< [m/s]

  /// Geoms that count: those that can collide, by contype, conaffinity or a `<pair>`, but for
  /// blades of rotors; and beds of soil. `sealed_gap`
  /// [m]: narrower gaps between two are closed, as all surfaces are moved out by half of it, for
  /// faces, not for cells. Errors: a grid without cells, or of too many; MuJoCo's.
  static Result<std::unique_ptr<GasObstacles>> create(std::shared_ptr<const CompiledWorld> world,
                                                      const GasGrid& grid,
                                                      double sealed_gap = kSealedGap);

  /// Fills `walls` as of the Snapshot's own instant; where it is the object of the last call, as
  /// the last call left it, only what moved is written. Of several things that close a face, one
  /// that stands still wins, then the last geom by id. Mocap bodies move as they did since the call
  /// before, of an earlier instant of the same run; what moves faster than kTeleport has been put
  /// there. Allocates at the first call with an object, and when the ground changes. Error:
  /// MuJoCo's.
  Status solve(const Snapshot& snapshot, GasWalls* walls);

  /// Did the last call find anything else than the one before? True after the first.
  bool changed() const { return changed_; }
  /// The same of what is closed or solid, whatever its velocity.
  bool shape_changed() const { return shape_changed_; }

  /// Walls of static things, as of the last call; no velocities.
  const GasWalls& still() const { return still_; }

  /// Pose of a body at the instant of the last call.
  Affine3f X_WB(int body) const;

  /// Colliders that are not seen: geoms of type sdf, flexes.
  int left_out() const { return left_out_; }

 private:
  // A geom that moves, at an instant; its runs end at `end`.
  struct Mover {
    int geom = 0;
    size_t end = 0;
    RigidMotion motion;
    bool operator==(const Mover&) const = default;
  };

  GasObstacles(std::shared_ptr<const CompiledWorld> world, const GasGrid& grid, double sealed_gap);
  void sort_geoms();
  void voxelise_still();
  void voxelise_soil(const SoilDescription& soil);
  void voxelise_height_fields(const float* data);
  bool follow_height_fields(const LiveFields* live);
  void add_runs(int geom);
  void follow_mocap(const SnapshotData& in);
  RigidMotion motion_of(int body) const;
  void voxelise_movers();
  void write(bool anew, GasWalls* walls);

  std::shared_ptr<const CompiledWorld> world_;
  mjModel model_{};  // options of its own, the World's arrays
  DataPtr data_;
  GasGrid grid_;
  WallRuns lines_;
  GridSolid solid_;                             // scratch
  std::vector<std::vector<SolidPlane>> hulls_;  // hulls by mesh, where a collider is one
  std::vector<int> still_geoms_, height_geoms_, moving_geoms_;
  int left_out_ = 0;

  GasWalls still_;              // walls of static things; no velocities
  GasWalls fixed_;              // without height fields; empty where there are none
  uint64_t height_serial_ = 0;  // LiveFields'
  struct Mocap {
    mjtNum p[3], q[4];
    RigidMotion motion;
  };
  std::vector<Mocap> mocaps_;  // states by mocap id, at the last instant
  int64_t mocap_run_ = -1;     // run of that instant
  double mocap_time_ = 0;      // [s]
  std::vector<Mover> movers_, movers_before_;
  std::vector<WallRun> runs_, runs_before_;
  const GasWalls* filled_ = nullptr;  // walls filled by the last call
  bool changed_ = false, shape_changed_ = false;
};

}  // namespace gloam
