// gloam::log_checkpoint: an instant of a logged run from which it can be resumed.

#include <fmt/format.h>

#include "gloam/log_replay.h"
#include "ros/codec.h"
#include "ros/messages/gloam_msgs.h"
#include "runtime/log/logged_runs.h"
#include "runtime/log/run_text.h"
#include "sim/loop/checkpoint.h"

namespace gloam {
namespace {

/// Step and hash of the last state of a run up to `time` [s].
Result<gloam_msgs::State> last_state(const McapReader& log, int64_t run, double time) {
  std::optional<gloam_msgs::State> last;
  McapMessages messages = log.messages({.topics = {kStateTopic}});
  for (;;) {
    GLOAM_TRY(const McapMessage* message, messages.next());
    if (message == nullptr) break;
    GLOAM_TRY(auto state, decode<gloam_msgs::State>(message->data));
    const double at = state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec;
    if (state.run > run || (state.run == run && at > time + 1e-9)) break;
    if (state.run == run) last = std::move(state);
  }
  if (last) return *std::move(last);
  return Error{ErrorKind::kUsage,
               fmt::format("the log has no state of run {} up to {} s", run, time)};
}

}  // namespace

Result<Checkpoint> log_checkpoint(const std::filesystem::path& file,
                                  const std::filesystem::path& folder, int64_t place, double time) {
  GLOAM_TRY(const McapReader log, McapReader::open(file));
  GLOAM_TRY(const LoggedRuns runs, LoggedRuns::read(log, folder));
  GLOAM_TRY(const LoggedRuns::Run* run, runs.find(place));
  GLOAM_TRY_STATUS(run->same_bits);
  if (!run->has_beginning)
    return Error{
        ErrorKind::kUnsupported,
        "cannot resume from this log: the run's Commands are not logged from its beginning"};
  GLOAM_TRY(const gloam_msgs::State state, last_state(log, run->number, time));
  auto data = std::make_shared<CheckpointData>();
  data->record = run->record;
  data->record.step = state.step;
  data->record.hash = state.hash;
  std::erase_if(data->record.commands, [&](const Command& c) { return c.step >= state.step; });
  std::erase_if(data->record.inputs, [&](const StepInput& i) { return i.step >= state.step; });
  std::erase_if(data->record.chapters, [&](const RunRecord::Chapter& chapter) {
    return chapter.from > 0 && chapter.from >= state.step;
  });
  data->time = state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec;
  return Checkpoint(std::move(data));
}

}  // namespace gloam
