#pragma once
// An event camera from rendered frames: a pixel reports each time its log light has changed by a
// threshold since its last report. Between two frames log light is linear in time, as in Rebecq,
// Gehrig and Scaramuzza 2018, "ESIM: an Open Event Camera Simulator"; thresholds differ between
// pixels, a pixel is deaf after a report, and some report without a change (Gallego et al. 2020,
// "Event-based Vision: A Survey").

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "gloam/scene/sensor.h"
#include "gloam/sensor.h"

namespace gloam {

class EventCamera {
 public:
  EventCamera(const EventOptions& options, int width, int height, uint64_t seed);

  /// Events since the frame before: none for the first one, and for one that is not later. Light
  /// [cd/m²], (height x width), as a fraction of `top`, the top of the scale. In order of time; of
  /// one time in order of pixels.
  std::vector<Event> see(const std::vector<Vec3f>& radiance, double top, double time,
                         int64_t frame);
  /// The next frame is the first one.
  void restart() { started_ = false; }

  /// Threshold of pixel i for brighter or darker light.
  double threshold(size_t i, bool brighter) const;

 private:
  void pixel_events(size_t i, double before, double now, double time, std::vector<Event>* events);

  EventOptions options_;
  int width_, height_;
  uint64_t seed_;
  bool started_ = false;
  double time_ = 0;                 // time of the last frame [s]
  std::vector<float> seen_;         // log light in the last frame
  std::vector<float> reference_;    // log light at the last event
  std::vector<double> last_event_;  // [s]
};

}  // namespace gloam
