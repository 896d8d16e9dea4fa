#pragma once
// Errors of trajectories: association by time, alignment, absolute and relative pose errors.
// Definitions and results equal those in evo (github.com/MichaelGrupp/evo).

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
  int64_t stamp = 0;  ///< stamp of the message's header [ns]
  Pose X_AB;          ///< pose in the message's frame
};

/// Rotation matrix R_AB, row by row.
using RotationRows = std::array<double, 9>;

/// Poses of a frame B in a frame A. Rotations are stored as matrices: matrices of KITTI files are
/// orthonormal only within the precision of their digits, and errors are computed from the file's
/// numbers, as in evo. Matrices with errors above 0.001 (three decimals or fewer) are replaced by
/// the nearest rotation.
struct Trajectory {
  std::string name;                     ///< file or topic, for messages
  std::vector<int64_t> stamps;          ///< [ns], never decreasing; empty = none, as in KITTI files
  std::vector<Vec3> positions;          ///< [m]
  std::vector<RotationRows> rotations;  ///< one per position
  std::vector<std::string> notes = {};  ///< corrections made to the file's numbers

  size_t size() const { return positions.size(); }
  /// Length of the path [m].
  double path_length() const;
};

/// A TUM ("t x y z qx qy qz qw"), KITTI (12 numbers of a 3x4 matrix) or EuRoC (CSV: ns, x, y, z,
/// qw, qx, qy, qz, …) file; the first line determines the format. Lines that begin with # are
/// comments. Errors, with the line: another number of fields, a number that is not finite, a
/// quaternion or matrix that is not a rotation even after allowing for two decimals, decreasing
/// time.
Result<Trajectory> read_trajectory_file(const std::filesystem::path& file);
Result<Trajectory> parse_trajectory(std::string_view text, const std::string& name);
/// Errors: as for files; no pose.
Result<Trajectory> make_trajectory(std::span<const StampedPose> poses, const std::string& name);

struct AssociationOptions {
  double max_difference = 0.01;  ///< largest difference of stamps [s]
  double offset = 0;             ///< added to the estimate's stamps [s]
};
/// Two trajectories with the same number of poses: pose i of one belongs to the time of pose i of
/// the other.
struct TrajectoryPair {
  Trajectory reference, estimate;
};
/// Assigns to each pose of the shorter trajectory the nearest pose of the other in time. If one has
/// no stamps, both must have the same number of poses. Errors: no common times.
Result<TrajectoryPair> associate(const Trajectory& reference, const Trajectory& estimate,
                                 const AssociationOptions& options = {});

enum class Alignment : uint8_t {
  kNone,
  kOrigin,  ///< makes the first poses equal
  kSe3,     ///< rotation and translation, least squares (Umeyama 1991)
  kSim3,    ///< rotation, translation and scale
  kScale,   ///< only the scale of Umeyama's method
};
/// Similarity p_A = scale * R_AB p_B + p_AB.
struct Similarity {
  RotationRows R_AB = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  Vec3 p_AB = {};
  double scale = 1;
  /// Positions are on one line, within a thousandth of its length: the rotation about it is
  /// undetermined, and so are the angle and full parts of absolute errors.
  bool is_turn_open = false;
};
/// Aligns the pair's estimate with its reference and returns the transformation. Warns if positions
/// are on one line; on an exact line it uses the smallest rotation. Errors: all positions in one
/// point.
Result<Similarity> align(Alignment alignment, TrajectoryPair* pair);

/// Part of the relative pose E between poses of the two trajectories.
enum class ErrorPart : uint8_t {
  kTranslation,  ///< length of its translation [m]
  kAngle,        ///< angle of its rotation [rad], 0 … pi
  kFull,         ///< Frobenius norm of E - 1, as 4x4 matrices
};

struct ErrorStatistics {
  double rmse = 0, mean = 0, median = 0;
  double std = 0;  ///< population standard deviation
  double min = 0, max = 0;
  double sse = 0;  ///< sum of squares
};
struct PoseErrors {
  std::vector<double> values;
  std::vector<size_t> poses;  ///< index of the pose; for relative errors, of the later one
  ErrorStatistics statistics;
};
/// ATE, called APE in evo: a value for each pose. Errors: numbers beyond the range of doubles.
Result<PoseErrors> absolute_errors(const TrajectoryPair& pair, ErrorPart part);

enum class DeltaUnit : uint8_t { kFrames, kMeters, kSeconds, kRadians };
struct RelativeOptions {
  double delta =
      1;  ///< from the first pose of a pair to the second, > 0; a whole number for frames
  DeltaUnit unit = DeltaUnit::kFrames;
  /// false: each pair begins at the end of the previous one, and delta is measured along the path.
  /// true: pairs begin at every pose, within `tolerance` of delta; angles are measured between the
  /// two poses.
  bool all_pairs = false;
  double tolerance = 0.1;  ///< fraction of delta, with all_pairs; not for frames
  bool from_reference =
      false;  ///< measure lengths and angles in the reference instead of the estimate
};
/// RPE of Sturm et al. 2012. The unit seconds is an extension of Gloam. Errors: no such pair, no
/// stamps for seconds, more than 30,000 poses for all pairs by angle.
Result<PoseErrors> relative_errors(const TrajectoryPair& pair, ErrorPart part,
                                   const RelativeOptions& options = {});

/// Errors: none; `values` must not be empty.
ErrorStatistics statistics_of(std::vector<double> values);

}  // namespace gloam
