#include "sensors/event/event_track.h"

#include <chrono>

namespace gloam {

std::vector<Event> EventTrack::see(Frame frame, double time, const std::vector<Vec3f>& radiance,
                                   double top, bool leads) {
  // 64 MiB of events, of pictures without any as many as viewers fall behind while they draw one.
  // Streams that lose nothing are a full queue and the windows being made apart, at most.
  constexpr size_t kMostEvents = size_t{1} << 22, kMostFrames = 4096, kLeastFrames = 16;
  constexpr auto kWaitTimeout = std::chrono::seconds(10);
  std::unique_lock lock(mutex_);
  const auto may_go_on = [&] { return leads || leads_ == 0; };
  changed_.wait_for(lock, kWaitTimeout, [&] { return may_go_on() || frame <= last_; });
  if (const auto found = remembered_.find(frame); found != remembered_.end()) return found->second;
  if (frame <= last_ || !may_go_on()) return {};
  if (frame.run != last_.run) camera_.restart();
  last_ = frame;
  const std::vector<Event>& events = remembered_[frame] =
      camera_.see(radiance, top, time, frame.index);
  remembered_events_ += events.size();
  while (remembered_.size() > kMostFrames ||
         (remembered_events_ > kMostEvents && remembered_.size() > kLeastFrames)) {
    remembered_events_ -= remembered_.begin()->second.size();
    remembered_.erase(remembered_.begin());
  }
  changed_.notify_all();
  return events;
}

void EventTrack::count_leads(int more) {
  const std::lock_guard lock(mutex_);
  leads_ += more;
  changed_.notify_all();
}

std::shared_ptr<EventTrack> EventTracks::share(const std::string& pictures,
                                               std::shared_ptr<EventTrack> own) {
  const std::lock_guard lock(mutex_);
  std::erase_if(tracks_, [](const auto& track) { return track.second.expired(); });
  std::weak_ptr<EventTrack>& shared = tracks_[pictures];
  if (auto track = shared.lock()) return track;
  shared = own;
  return own;
}

}  // namespace gloam
