#pragma once
// Replays of logged runs: the same motion with another sky or other cameras, variants of a replay,
// and continuation from an instant of a log.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gloam/checkpoint.h"
#include "gloam/result.h"
#include "gloam/run.h"

namespace gloam {

/// Source of the motion of bodies in a replay.
enum class ReplayMotion : uint8_t {
  kStepped,  ///< stepped again bit for bit; kPoses if the version, machine or files differ
  kPoses,    ///< interpolated logged states; not enough for effects that depend on forces
  kNewRun,   ///< physics of the changed scene with the log's Commands: a different run
};

struct LogReplay {
  std::filesystem::path log;
  std::filesystem::path folder = {};  ///< of the scene's files, as for verify_log
  int64_t run = 0;                    ///< index of the run in the log, from 0; a reset ends a run
  ReplayMotion motion = ReplayMotion::kStepped;
  /// Scene files that change the scene (overlay_scene), in this order, before `settings`:
  /// additional cameras, LiDARs, lamps, weather and so on.
  std::vector<std::filesystem::path> overlays = {};
  std::optional<uint64_t> draw_seed =
      {};  ///< seed of the overlays' [[randomize]] tables; empty = the run's seed
  /// Options to change, as in set_option: weather, lights, materials, sky, cameras, LiDARs, smoke.
  /// The motion of bodies stays the same: an option that would change it, or that has no effect in
  /// a replay (controllers, goals, seeds), is an error.
  std::vector<std::pair<std::string, std::string>> settings = {};
  std::vector<std::string> outputs = {};  ///< as for set_record_outputs; empty = the scene's
  RunRequest request = {};  ///< outputs and their location; a duration of 0 = the whole run
};

/// Records a run again, like run_and_record(). Errors: as for verify_log, except that another
/// version or other files only add a note to the report; as for run_and_record; and, except with
/// kNewRun, a setting that would change the motion (named in the message) or a recompile during the
/// run.
Result<RunReport> replay_log(const LogReplay& replay, const ProgressCallback& progress);

/// Replays that differ in the values drawn by the [[randomize]] tables of one file.
struct VariantRequest {
  LogReplay replay;  ///< its request.out is the folder of all variants
  std::filesystem::path randomize;
  int64_t count = 1;
  uint64_t first_seed = 1;  ///< variant i uses the seed first_seed + i
};
struct ReplayVariant {
  uint64_t seed = 0;
  std::filesystem::path out;
  bool was_done = false;  ///< by an earlier call that was cancelled
};
/// Records variants one after the other into OUT/0000, 0001 …, and lists them in OUT/variants.json.
/// Another call resumes a cancelled one. Errors: as for replay_log; OUT contains variants of
/// another request and request.overwrite is false.
Result<std::vector<ReplayVariant>> replay_variants(const VariantRequest& request,
                                                   const ProgressCallback& progress);

/// Returns the instant of a logged run at `time` [s], or at the last logged state before it, for
/// Simulation::restore and RunRequest::from. Errors: as for verify_log; no state so early.
Result<Checkpoint> log_checkpoint(const std::filesystem::path& log,
                                  const std::filesystem::path& folder, int64_t run, double time);

}  // namespace gloam
