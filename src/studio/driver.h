#pragma once
// Carries out the controller's requests on the Simulation, in order, on a thread of its own: steps
// and picks may block, and the network must not wait for them.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "gloam/simulation.h"
#include "gloam/view.h"
#include "studio/grab.h"
#include "studio/history.h"
#include "studio/messages.h"
#include "studio/pose_edits.h"
#include "studio/publisher.h"
#include "studio/state_key.h"
#include "studio/view_camera.h"

namespace gloam::studio {

class Driver {
 public:
  /// Called on the driver's thread.
  struct Outputs {
    std::function<void(int64_t client, std::string text)> reply;  ///< to one client
    std::function<void()> changed;  ///< requests were carried out: clients wait for the state
  };

  Driver(Simulation& simulation, const ViewOptions& options, Publisher& publisher, Outputs outputs);
  ~Driver();

  /// Opens the first camera and starts the thread. Errors: as for open_camera.
  Status start();
  /// Queues a message of a client. False: the queue is full. Mouse moves that wait are merged.
  bool post(int64_t client, const ControlMessage& message);
  /// Lets go of the body that the client holds.
  void release(int64_t client);
  /// Without clients the camera is closed after a while: nobody pays for pictures nobody sees.
  void set_clients(int count);
  void stop();

  struct Report {
    ViewCamera::Report camera;
    double speed = 1;
    double history_start = 0;  ///< [s]
    int64_t returns = 0;       ///< to earlier instants, resets included
  };
  Report report() const;
  const std::vector<std::string>& cameras() const { return camera_.names(); }
  /// The instant that clients look at. Any thread.
  Snapshot shown() const { return edits_.shown(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct ControlRequest {
    int64_t client;
    ControlMessage message;
  };

  void run();
  void tick();
  void carry_out(const ControlRequest& request);
  void do_message(int64_t client, const PauseMessage&);
  void do_message(int64_t client, const ResumeMessage&);
  void do_message(int64_t client, const StepMessage& message);
  void do_message(int64_t client, const BackMessage& message);
  void do_message(int64_t client, const SpeedMessage& message);
  void do_message(int64_t client, const ResetMessage&);
  void do_message(int64_t client, const SeekMessage& message);
  void do_message(int64_t client, const SetJointMessage& message);
  void do_message(int64_t client, const SetControlMessage& message);
  void do_message(int64_t client, const ClearControlsMessage&);
  void do_message(int64_t client, const SetEqualityMessage& message);
  void do_message(int64_t client, const LoadKeyframeMessage& message);
  void do_message(int64_t client, const PasteStateMessage& message);
  void do_message(int64_t client, const DriveMessage& message);
  void do_message(int64_t client, const CameraMessage& message);
  void do_message(int64_t client, const OrbitMessage& message);
  void do_message(int64_t client, const PanMessage& message);
  void do_message(int64_t client, const ZoomMessage& message);
  void do_message(int64_t client, const LookAtMessage& message);
  void do_message(int64_t client, const TrackMessage& message);
  void do_message(int64_t client, const PickMessage& message);
  void do_message(int64_t client, const DragStartMessage& message);
  void do_message(int64_t client, const DragMoveMessage& message);
  void do_message(int64_t client, const DragEndMessage&);

  void seek_log(int64_t client, double time);
  void return_to(int64_t client, int64_t step);
  void set_state(int64_t client, const std::function<Result<StateKey>(const Instant&)>& make_key);
  void edit(int64_t client, std::vector<Command> commands);
  void follow_grab();
  void reply(int64_t client, std::string text) { outputs_.reply(client, std::move(text)); }
  void tell_failure(int64_t client, const Status& status);

  Simulation& simulation_;
  const ViewOptions options_;
  Publisher& publisher_;
  const Outputs outputs_;

  mutable std::mutex mutex_;  // guards these
  std::condition_variable wake_;
  std::deque<ControlRequest> requests_;
  int clients_ = 0;
  bool someone_came_ = false;
  Clock::time_point last_client_;
  Report report_;
  bool stopping_ = false;

  // The driver's thread only, once it runs.
  ViewCamera camera_;
  PoseEdits edits_;
  History history_;
  std::optional<Grab> grab_;
  double speed_ = 1;
  bool has_news_ = false;  // requests were carried out since reported_at_
  Clock::time_point reported_at_;

  std::thread thread_;
};

}  // namespace gloam::studio
