// gloam::start_log: a log that begins and ends while its simulation goes on.

#include "gloam/log.h"
#include "runtime/live/live_simulation.h"
#include "runtime/log/log_recorder.h"

namespace gloam {
namespace {

/// Lets the simulation rest for as long as it lives.
class Rest {
 public:
  explicit Rest(LiveSimulation& simulation)
      : simulation_(simulation), was_paused_(simulation.paused()) {
    simulation_.pause();
    static_cast<void>(simulation_.simulator().wait());  // status() reports its failure
  }
  ~Rest() {
    if (!was_paused_) simulation_.resume();
  }
  Rest(const Rest&) = delete;
  Rest& operator=(const Rest&) = delete;

 private:
  LiveSimulation& simulation_;
  const bool was_paused_;
};

class LiveLog final : public LogStream {
 public:
  LiveLog(LiveSimulation& simulation, std::unique_ptr<LogRecorder> recorder)
      : simulation_(simulation), recorder_(std::move(recorder)) {}
  Status status() const override { return recorder_ ? recorder_->status() : finished_; }
  int64_t dropped() const override { return recorder_ ? recorder_->dropped() : dropped_; }
  Status finish() override {
    if (!recorder_) return {};
    const Rest rest(simulation_);
    finished_ = recorder_->finish(simulation_.latest());
    dropped_ = recorder_->dropped();
    recorder_.reset();  // a finished log may outlive its simulation
    return finished_;
  }

 private:
  LiveSimulation& simulation_;
  std::unique_ptr<LogRecorder> recorder_;  // until finish()
  Status finished_;
  int64_t dropped_ = 0;
};

}  // namespace

Result<std::unique_ptr<LogStream>> start_log(Simulation& simulation, const LogRequest& request) {
  auto* live = dynamic_cast<LiveSimulation*>(&simulation);
  if (live == nullptr)
    return Error{ErrorKind::kUsage,
                 "a log can be recorded from a simulation, but not from a replay"};
  if (live->simulator().is_on_sim_thread())
    return Error{ErrorKind::kUsage, "a step hook cannot start a log"};
  const Rest rest(*live);
  GLOAM_TRY(auto recorder, LogRecorder::start(*live, request));
  return std::unique_ptr<LogStream>(std::make_unique<LiveLog>(*live, std::move(recorder)));
}

}  // namespace gloam
