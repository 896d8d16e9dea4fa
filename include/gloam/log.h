#pragma once
// Logs: runs as MCAP files that ROS 2 tools can open and that Gloam can replay bit for bit.

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
  bool overwrite = false;                ///< replace an existing file
  std::vector<std::string> topics = {};  ///< names, * matches any text; empty = the default set
  int width = 0, height = 0;             ///< of every camera's images [px]; 0 = the camera's own
  bool required = true;  ///< true: the simulation waits for the disk; false: messages may be lost
  bool durable = false;  ///< sync each chunk before the next is written
  bool embed = false;    ///< include all files that the scene reads
  Rational state_rate = {100, 1};  ///< states per second of simulation time [Hz]
};

/// A log that is being written. If it is destroyed before finish(), the file is readable but lacks
/// its index. Its simulation must live until then; afterwards the log may outlive it.
class LogStream {
 public:
  virtual ~LogStream() = default;
  virtual Status status() const = 0;    ///< reason if it no longer writes
  virtual int64_t dropped() const = 0;  ///< messages lost because the disk was slow
  /// Writes queued messages, the last state and the index; the simulation waits meanwhile.
  virtual Status finish() = 0;
};
/// Starts a log of a simulation, which waits during the call. A simulation has at most one log at a
/// time. Errors: the file exists, no such topic, called on the physics thread.
Result<std::unique_ptr<LogStream>> start_log(Simulation& simulation, const LogRequest& request);

struct LoggedTopic {
  std::string name, type;  ///< "/tf", "tf2_msgs/msg/TFMessage"
  int64_t messages = 0;
  double rate = 0;  ///< mean over the log [Hz]
};

/// Summary of a log of any writer, as in `gloam info`.
struct LogInfo {
  std::string profile, library;
  int64_t bytes = 0, messages = 0, chunks = 0;
  double start = 0, duration = 0;  ///< [s]
  std::vector<LoggedTopic> topics;
  double compression = 1;  ///< uncompressed bytes of all chunks over bytes in the file
  bool has_run = false;    ///< Gloam wrote the log and can step the run again
  std::string scene;       ///< scene file, if has_run
  std::string damage;      ///< first damage found; empty = none
};
/// Errors: not an MCAP log, disk errors.
Result<LogInfo> describe_log(const std::filesystem::path& file);

/// Outcome of a verification.
struct LogVerification {
  int64_t runs = 0, steps = 0;  ///< stepped again
  int64_t states = 0;           ///< compared by hash and numbers
  int64_t differing = 0;        ///< steps from the first different state onwards
  /// Location of the first difference: states are equal at `equal_step` and differ at `step`.
  int64_t run = 0, equal_step = 0, step = 0;
  std::string where;               ///< "joint 'go1/FL_hip': position differs by 1e-12"
  std::vector<std::string> notes;  ///< parts that could not be verified, with reasons
  bool is_equal() const { return differing == 0; }
};
/// Steps the runs of a log again, from its scene and Commands, and compares all states and hashes.
/// `folder`: folder of the scene's files, or one above it; empty = beside the log, or at their
/// original location on this machine (docs/logs.md). Errors: a log of another program, a scene that
/// no longer compiles, another version of Gloam, files or a model that have changed or cannot be
/// found (named in the message).
Result<LogVerification> verify_log(const std::filesystem::path& file,
                                   const std::filesystem::path& folder,
                                   const ProgressCallback& progress);

struct LogRecovery {
  bool is_whole = false;  ///< the log is not damaged
  int64_t messages = 0, messages_lost = 0, bytes_lost = 0;
  std::vector<std::string> damage;  ///< "byte N: cause"
};
/// Writes the intact messages of a truncated or damaged log to a new file.
Result<LogRecovery> recover_log(const std::filesystem::path& file, const std::filesystem::path& to);

}  // namespace gloam
