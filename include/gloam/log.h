#pragma once
// Logs: a run as an MCAP file that ROS 2's tools open and that can be stepped again to the bit.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"
#include "gloam/world.h"

namespace gloam {

class Simulation;

/// Name of a run's log in its results folder.
inline constexpr const char* kRunLogName = "run.mcap";

struct LogRequest {
  std::filesystem::path file = {};       ///< new file; empty = no log
  bool overwrite = false;                ///< a file of this name is replaced
  std::vector<std::string> topics = {};  ///< names, * stands for any text; empty = the usual ones
  int width = 0, height = 0;             ///< of every camera's pictures [px]; 0 = the camera's own
  bool required = true;            ///< the simulation waits for the disk; else messages are lost
  bool durable = false;            ///< each chunk is synced before the next is written
  bool embed = false;              ///< with all files that the scene reads
  Rational state_rate = {100, 1};  ///< states per second of simulation time [Hz]
};

/// A log that is being written. Destroyed unfinished, it is readable but lacks its index.
class LogStream {
 public:
  virtual ~LogStream() = default;
  virtual Status status() const = 0;    ///< why it writes no more, if so
  virtual int64_t dropped() const = 0;  ///< messages lost because the disk was slow
  /// Writes what waits, the last state and the index; the simulation rests meanwhile.
  virtual Status finish() = 0;
};
/// Writes the log of a simulation from now on, which rests while it is begun; one log of a
/// simulation at a time. Errors: the file exists, no such topic, called on the physics thread.
Result<std::unique_ptr<LogStream>> start_log(Simulation& simulation, const LogRequest& request);

struct LoggedTopic {
  std::string name, type;  ///< "/tf", "tf2_msgs/msg/TFMessage"
  int64_t messages = 0;
  double rate = 0;  ///< mean over the log [Hz]
};

/// A log of any writer, as `gloam info` tells of it.
struct LogInfo {
  std::string profile, library;
  int64_t bytes = 0, messages = 0, chunks = 0;
  double start = 0, duration = 0;  ///< [s]
  std::vector<LoggedTopic> topics;
  double compression = 1;  ///< bytes in chunks over those in the file
  bool has_run = false;    ///< can be stepped again: Gloam's own, not only read
  std::string scene;       ///< its file, where has_run
  std::string damage;      ///< first damage met; empty = none
};
/// Errors: no MCAP log, the disk.
Result<LogInfo> describe_log(const std::filesystem::path& file);

/// Outcome of a verification.
struct LogVerification {
  int64_t runs = 0, steps = 0;  ///< that were stepped again
  int64_t states = 0;           ///< whose hash and numbers were compared
  int64_t differing = 0;        ///< steps from the first different state on
  /// Place of the first difference: states are equal at `equal_step` and no longer at `step`.
  int64_t run = 0, equal_step = 0, step = 0;
  std::string where;               ///< "joint 'go1/FL_hip': position differs by 1e-12"
  std::vector<std::string> notes;  ///< what could not be verified, and why
  bool is_equal() const { return differing == 0; }
};
/// Steps the runs of a log again, from its scene and Commands, and compares all states and hashes.
/// `folder`: the scene's or one above it; empty = beside the log, or where they were on this
/// machine (docs/logs.md). Errors: a stranger's log, a scene that no longer compiles, files or a
/// model that have changed (which) or are not to be found, another version.
Result<LogVerification> verify_log(const std::filesystem::path& file,
                                   const std::filesystem::path& folder,
                                   const ProgressCallback& progress);

struct LogRecovery {
  bool is_whole = false;  ///< nothing was damaged
  int64_t messages = 0, messages_lost = 0, bytes_lost = 0;
  std::vector<std::string> damage;  ///< "byte N: cause"
};
/// Writes what is whole in a log that is cut or damaged into a new file.
Result<LogRecovery> recover_log(const std::filesystem::path& file, const std::filesystem::path& to);

}  // namespace gloam
