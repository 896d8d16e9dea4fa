#pragma once
// The events of one camera, shared by all who watch it: what its pixels remember goes on from frame
// to frame, and the events of a frame are found once and are the same for every stream.

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "sensors/event/event_camera.h"

namespace gloam {

class EventTrack {
 public:
  /// A frame of the schedule.
  struct Frame {
    int64_t run = 0;  ///< resets before it
    int64_t index = 0;
    auto operator<=>(const Frame&) const = default;
  };

  explicit EventTrack(EventCamera camera) : camera_(std::move(camera)) {}

  /// Events of `frame`, of which this is a picture at `time` [s], since the last frame seen:
  /// remembered ones, else by EventCamera::see. Streams that `lead` lose no frames, so while there
  /// are any it is their pictures that count, and the others wait for them. Empty also of a frame
  /// that others have left behind, and where a leader takes longer than 10 s.
  std::vector<Event> see(Frame frame, double time, const std::vector<Vec3f>& radiance, double top,
                         bool leads);

 private:
  friend class EventLead;
  void count_leads(int more);

  std::mutex mutex_;
  std::condition_variable changed_;
  EventCamera camera_;
  Frame last_{-1, -1};
  std::map<Frame, std::vector<Event>> remembered_;  // the last ones
  size_t remembered_events_ = 0;
  int leads_ = 0;
};

/// Held by a stream as long as it leads.
class EventLead {
 public:
  explicit EventLead(std::shared_ptr<EventTrack> track) : track_(std::move(track)) {
    track_->count_leads(1);
  }
  ~EventLead() { track_->count_leads(-1); }
  EventLead(const EventLead&) = delete;
  EventLead& operator=(const EventLead&) = delete;

 private:
  std::shared_ptr<EventTrack> track_;
};

/// The tracks of a simulation.
class EventTracks {
 public:
  /// The track that streams of `pictures` share while one of them holds it; `own` if there is none.
  std::shared_ptr<EventTrack> share(const std::string& pictures, std::shared_ptr<EventTrack> own);

 private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<EventTrack>> tracks_;
};

}  // namespace gloam
