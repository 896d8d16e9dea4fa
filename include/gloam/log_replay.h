#pragma once
// Logged runs looked at again: the same motion under another sky, with other cameras; variants of
// it; and going on from an instant of it.

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
  kStepped,  ///< stepped again to the bit; where version, machine or files are others, kPoses
  kPoses,    ///< the logged states, interpolated between; for effects of forces too few
  kNewRun,   ///< physics of the changed scene under the log's Commands: another run
};

struct LogReplay {
  std::filesystem::path log;
  std::filesystem::path folder = {};  ///< of the scene's files, as of verify_log
  int64_t run = 0;                    ///< place of the run in the log, from 0: a reset ends one
  ReplayMotion motion = ReplayMotion::kStepped;
  /// Scene files that change the scene (overlay_scene), in this order, before `settings`: cameras,
  /// LiDARs, lamps, weather … more.
  std::vector<std::filesystem::path> overlays = {};
  std::optional<uint64_t> draw_seed =
      {};  ///< seed of [[randomize]]s of overlays; empty = the run's
  /// Options to change, as set_option takes them: weather, lights, materials, sky, cameras, LiDARs,
  /// smoke. Bodies move as they did: an option that would move them otherwise, or that changes
  /// nothing in a replay (controllers, goals, seeds), is an error.
  std::vector<std::pair<std::string, std::string>> settings = {};
  std::vector<std::string> outputs = {};  ///< as of set_record_outputs; empty = the scene's
  RunRequest request = {};  ///< what is recorded, and where; a duration of 0 = the whole run
};

/// Records a run again as run_and_record() does. Errors: those of verify_log but for another
/// version or files, which are a note of the report; those of run_and_record; but for kNewRun a
/// setting that would change how bodies move, by its name, and a recompile on the way.
Result<RunReport> replay_log(const LogReplay& replay, const ProgressCallback& progress);

/// Replays that differ in what [[randomize]]s of one file draw.
struct VariantRequest {
  LogReplay replay;  ///< its request.out is the folder of all
  std::filesystem::path randomize;
  int64_t count = 1;
  uint64_t first_seed = 1;  ///< variant i draws by first_seed + i
};
struct ReplayVariant {
  uint64_t seed = 0;
  std::filesystem::path out;
  bool was_done = false;  ///< by an earlier call that was stopped
};
/// Records variants one after the other into OUT/0000, 0001 …, and lists them in OUT/variants.json.
/// Called again it goes on where it was stopped. Errors: those of replay_log; OUT holds variants of
/// another request and request.overwrite is false.
Result<std::vector<ReplayVariant>> replay_variants(const VariantRequest& request,
                                                   const ProgressCallback& progress);

/// The instant of a logged run at `time` [s], or at the last logged state before it: for
/// Simulation::restore and RunRequest::from. Errors: those of verify_log; no state so early.
Result<Checkpoint> log_checkpoint(const std::filesystem::path& log,
                                  const std::filesystem::path& folder, int64_t run, double time);

}  // namespace gloam
