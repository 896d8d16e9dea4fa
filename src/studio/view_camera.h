#pragma once
// The camera stream behind the page's image: coarser while something moves and the renderer is
// slow, refined while nothing does. Used by the driver's thread, but for report().

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gloam/simulation.h"
#include "gloam/view.h"
#include "studio/free_camera.h"
#include "studio/picture_scale.h"
#include "studio/publisher.h"

namespace gloam::studio {

inline constexpr const char* kFreeCamera = "free";

class ViewCamera {
 public:
  struct Report {
    std::string camera;
    int64_t dropped = 0;
    std::string error;  ///< why there is no picture; empty = there is
  };

  ViewCamera(Simulation& simulation, const ViewOptions& options, Publisher& publisher);

  /// Cameras of the simulation, the free one first.
  const std::vector<std::string>& names() const { return names_; }
  /// Switches to a camera. Errors: as for open_camera.
  Status open(std::string name);
  void close();
  bool is_open_at(const std::string& name) const { return stream_ != nullptr && name == camera_; }

  /// The free camera, to be moved before moved(). Null: another camera is shown.
  OrbitCamera* free_camera();
  void moved();
  /// The pivot of the free camera follows a body; -1 = none.
  void track(Body body) { tracked_ = body; }

  /// Something changed that pictures do not show yet. `moves`: it may go on changing.
  void invalidate(bool moves);
  /// To be called periodically. `is_wanted`: somebody looks. `shown`: an instant to be rendered
  /// instead of the present one; empty = none.
  struct Situation {
    bool is_wanted = false, is_grabbed = false;
    double speed = 1;
    Snapshot shown = {};
  };
  /// True when a new picture has come since the last call.
  bool tick(const Situation& situation);
  Report report() const;  ///< any thread

 private:
  using Clock = std::chrono::steady_clock;

  Status open_stream(double scale);
  void keep_open(bool is_wanted);
  void follow_tracked();
  bool follow_pictures();
  void measure_pictures(uint64_t pictures);
  void adapt_resolution();
  void reopen(double scale);
  void refresh_when_due();
  bool is_still() const;

  Simulation& simulation_;
  const ViewOptions options_;
  Publisher& publisher_;
  std::vector<std::string> names_;
  mutable std::mutex mutex_;  // guards report_
  Report report_;

  Situation now_;
  std::string camera_;
  std::unique_ptr<CameraStream> stream_;
  std::optional<OrbitCamera> orbit_;
  std::optional<Pose> free_start_;  // where the free camera begins; none = it frames the model
  Body tracked_;
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
};

}  // namespace gloam::studio
