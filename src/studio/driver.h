#pragma once
// Carries out the controller's requests on the Simulation, in order, on a thread of its own: steps
// and picks may block, and the network must not wait for them. Owns the camera stream.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "gloam/simulation.h"
#include "gloam/view.h"
#include "studio/free_camera.h"
#include "studio/messages.h"
#include "studio/picture_scale.h"
#include "studio/publisher.h"

namespace gloam::studio {

class Driver {
 public:
  /// `reply` sends a text to one client; it is called on the driver's thread.
  using Reply = std::function<void(int64_t client, std::string text)>;

  Driver(Simulation& simulation, const ViewOptions& options, Publisher& publisher, Reply reply);
  ~Driver();

  /// Opens the first camera and starts the thread. Errors: what open_camera says.
  Status start();
  /// Queues a message of the controller. False: the queue is full. Mouse moves that wait are
  /// merged.
  bool post(int64_t client, const ControlMessage& message);
  /// Lets go of what the client drags.
  void release(int64_t client);
  /// Without clients the camera is closed after a while: nobody pays for pictures nobody sees.
  void set_clients(int count);
  void stop();

  struct CameraReport {
    std::string camera;
    double speed = 1;
    int64_t dropped = 0;
    std::string error;  ///< why there is no picture; empty = there is
  };
  CameraReport report() const;
  const std::vector<std::string>& cameras() const { return cameras_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct ControlRequest {
    int64_t client;
    ControlMessage message;
  };
  /// A body point held at a depth [m] as CameraFrame::depth, under (u, v) [px]: in the plane that
  /// faces the camera, with a fisheye on a sphere about it.
  struct Drag {
    int64_t client;
    Body body;
    Vec3 point_B;
    double depth;
    double u, v;
    Vec3 target_W;
  };

  void run();
  void carry_out(const ControlRequest& request);
  void do_message(int64_t client, const PauseMessage&);
  void do_message(int64_t client, const ResumeMessage&);
  void do_message(int64_t client, const StepMessage& message);
  void do_message(int64_t client, const SpeedMessage& message);
  void do_message(int64_t client, const ResetMessage&);
  void do_message(int64_t client, const SeekMessage& message);
  void do_message(int64_t client, const CameraMessage& message);
  void do_message(int64_t client, const OrbitMessage& message);
  void do_message(int64_t client, const PanMessage& message);
  void do_message(int64_t client, const ZoomMessage& message);
  void do_message(int64_t client, const PickMessage& message);
  void do_message(int64_t client, const DragStartMessage& message);
  void do_message(int64_t client, const DragMoveMessage& message);
  void do_message(int64_t client, const DragEndMessage&);

  Status open_camera(std::string name);
  void close_camera();
  void keep_camera();
  void follow_pictures();
  void refresh_when_due();
  Status open_stream(double scale);
  bool reopen(double scale);
  void measure_pictures(uint64_t pictures);
  void adapt_resolution();
  bool is_still() const;
  OrbitCamera* free_camera();
  void move_free_camera();
  void pull(bool active);
  void follow_drag();
  void tell_failure(int64_t client, const Status& status);

  Simulation& simulation_;
  const ViewOptions options_;
  Publisher& publisher_;
  const Reply reply_;
  std::vector<std::string> cameras_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<ControlRequest> requests_;
  int clients_ = 0;
  bool someone_came_ = false;
  Clock::time_point last_client_;
  CameraReport report_;
  bool stopping_ = false;

  // The driver's thread only, once it runs.
  std::string camera_;
  std::unique_ptr<CameraStream> stream_;
  std::optional<OrbitCamera> orbit_;
  std::optional<Pose> free_start_;  // where the free camera begins; none = it frames the model
  std::optional<Drag> drag_;
  double speed_ = 1;
  bool picture_is_old_ = false;
  std::optional<uint64_t> refreshed_at_;  // sequence of the newest frame when a refresh was asked
  uint64_t seen_sequence_ = 0;
  PictureScale scale_;                    // of pictures while something moves
  double opened_scale_ = 1;               // of the open stream
  bool is_preview_ = false;               // the open stream is the one before any picture
  uint64_t opened_at_ = 0;                // sequence of the newest frame when it was opened
  int full_width_ = 0, full_height_ = 0;  // [px]; 0 = not known before the first picture
  int added_ = 0;               // refreshes since anything changed: samples of a still picture
  int measured_ = 0;            // pictures since measured_from_
  int64_t dropped_before_ = 0;  // at measured_from_
  Clock::time_point measured_from_, last_moved_;
  Clock::time_point last_frame_, last_refresh_, last_attempt_;

  std::thread thread_;
};

}  // namespace gloam::studio
