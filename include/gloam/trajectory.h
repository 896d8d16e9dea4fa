#pragma once
// Errors of trajectories: association by time, alignment, absolute and relative pose errors, as evo
// (github.com/MichaelGrupp/evo) defines them, whose numbers they equal.

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// A pose at an instant.
struct StampedPose {
  int64_t stamp = 0;  ///< of the message's header [ns]
  Pose X_AB;          ///< in the message's frame
};

/// Rotation matrix R_AB, row by row.
using RotationRows = std::array<double, 9>;

/// Poses of a frame B in a frame A. Rotations are kept as matrices: those of KITTI files are
/// orthonormal to their digits only, and errors are computed from the file's numbers, as evo does.
/// Matrices that are off by more than 0.001 (three decimals and fewer) are replaced by the nearest
/// rotation.
struct Trajectory {
  std::string name;                     ///< file or topic, for messages
  std::vector<int64_t> stamps;          ///< [ns], never falling; empty = none, as in KITTI files
  std::vector<Vec3> positions;          ///< [m]
  std::vector<RotationRows> rotations;  ///< (as many)
  std::vector<std::string> notes = {};  ///< corrections made to the file's numbers

  size_t size() const { return positions.size(); }
  /// Length of the way [m].
  double path_length() const;
};

/// A TUM ("t x y z qx qy qz qw"), KITTI (12 numbers of a 3x4 matrix) or EuRoC (CSV: ns, x, y, z,
/// qw, qx, qy, qz, …) file; which one is seen from its first line. Lines that begin with # are
/// comments. Errors, by line: another number of fields, no finite number, a quaternion or matrix
/// that is no rotation nor one rounded to two decimals, time that goes back.
Result<Trajectory> read_trajectory_file(const std::filesystem::path& file);
Result<Trajectory> parse_trajectory(std::string_view text, const std::string& name);
/// Errors: as of files; no pose.
Result<Trajectory> make_trajectory(std::span<const StampedPose> poses, const std::string& name);

struct AssociationOptions {
  double max_difference = 0.01;  ///< largest difference of stamps [s]
  double offset = 0;             ///< added to the estimate's stamps [s]
};
/// Two trajectories of as many poses: pose i of one was at the time of pose i of the other.
struct TrajectoryPair {
  Trajectory reference, estimate;
};
/// Gives each pose of the shorter trajectory the nearest one of the other in time. Where one has no
/// stamps, both must have as many poses. Errors: no common times.
Result<TrajectoryPair> associate(const Trajectory& reference, const Trajectory& estimate,
                                 const AssociationOptions& options = {});

enum class Alignment : uint8_t {
  kNone,
  kOrigin,  ///< first poses are made equal
  kSe3,     ///< rotation and translation, least squares (Umeyama 1991)
  kSim3,    ///< and scale
  kScale,   ///< scale of Umeyama's alone
};
/// Similarity p_A = scale * R_AB p_B + p_AB.
struct Similarity {
  RotationRows R_AB = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  Vec3 p_AB = {};
  double scale = 1;
  /// Positions lie on one line, within a thousandth of its length: the turn about it is
  /// undetermined, and so are the angle and full parts of absolute errors.
  bool is_turn_open = false;
};
/// Moves the pair's estimate onto its reference; returns by what. Warns where positions lie on one
/// line; on an exact one the smallest rotation is taken. Errors: positions in one point.
Result<Similarity> align(Alignment alignment, TrajectoryPair* pair);

/// Part of the pose E that leads from one trajectory's pose to the other's.
enum class ErrorPart : uint8_t {
  kTranslation,  ///< length of its translation [m]
  kAngle,        ///< angle of its rotation [rad], 0 … pi
  kFull,         ///< Frobenius norm of E - 1, as 4x4 matrices
};

struct ErrorStatistics {
  double rmse = 0, mean = 0, median = 0;
  double std = 0;  ///< over all values, not corrected for a sample
  double min = 0, max = 0;
  double sse = 0;  ///< sum of squares
};
struct PoseErrors {
  std::vector<double> values;
  std::vector<size_t> poses;  ///< index of the pose, of relative errors of the later one
  ErrorStatistics statistics;
};
/// ATE, evo's APE: a value for each pose. Errors: numbers beyond doubles.
Result<PoseErrors> absolute_errors(const TrajectoryPair& pair, ErrorPart part);

enum class DeltaUnit : uint8_t { kFrames, kMeters, kSeconds, kRadians };
struct RelativeOptions {
  double delta = 1;  ///< from the first pose of a pair to the second, > 0; frames: whole
  DeltaUnit unit = DeltaUnit::kFrames;
  /// false: each pair begins where the one before ends, delta is along the way. true: pairs begin
  /// at every pose; within `tolerance` of delta, angles are those between the two poses.
  bool all_pairs = false;
  double tolerance = 0.1;       ///< of delta, with all_pairs, not of frames
  bool from_reference = false;  ///< lengths and angles are the reference's, not the estimate's
};
/// RPE of Sturm et al. 2012. Seconds are Gloam's own. Errors: no such pair, no stamps for seconds,
/// more than 30,000 poses for all pairs by angle.
Result<PoseErrors> relative_errors(const TrajectoryPair& pair, ErrorPart part,
                                   const RelativeOptions& options = {});

/// Errors: none; `values` must not be empty.
ErrorStatistics statistics_of(std::vector<double> values);

}  // namespace gloam
