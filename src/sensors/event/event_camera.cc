#include "sensors/event/event_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "sensors/signal/draw.h"

namespace gloam {

EventCamera::EventCamera(const EventOptions& options, int width, int height, uint64_t seed)
    : options_(options), width_(width), height_(height), seed_(seed ^ options.seed) {}

double EventCamera::threshold(size_t i, bool brighter) const {
  if (options_.mismatch <= 0) return options_.threshold;
  constexpr double kMinThreshold = 0.01;
  const RandomStream stream{seed_, stream_id("events.mismatch")};
  const auto [up, down] = normal_pair(stream.draw(0, static_cast<uint32_t>(i)));
  return std::max(kMinThreshold, options_.threshold + options_.mismatch * (brighter ? up : down));
}

void EventCamera::pixel_events(size_t i, double before, double now, double time,
                               std::vector<Event>* events) {
  if (before == now) return;
  const bool brighter = now > before;
  const double step = (brighter ? 1 : -1) * threshold(i, brighter);
  const double rate = (time - time_) / (now - before);
  for (double level = double{reference_[i]} + step; brighter ? level <= now : level >= now;
       level += step) {
    const double t = time_ + std::max(0.0, (level - before) * rate);
    reference_[i] = static_cast<float>(level);
    if (t - last_event_[i] < options_.refractory) continue;  // deaf: the reference moves on
    last_event_[i] = t;
    const auto w = static_cast<size_t>(width_);
    events->push_back({static_cast<uint16_t>(i % w), static_cast<uint16_t>(i / w), brighter, t});
  }
}

std::vector<Event> EventCamera::see(const std::vector<Vec3f>& radiance, double top, double time,
                                    int64_t frame) {
  const size_t n = radiance.size();
  std::vector<float> now(n);
  for (size_t i = 0; i < n; ++i) {
    const double light = std::max(0.0, double{luminance(radiance[i])} / top);
    now[i] = static_cast<float>(std::log(std::min(light, 1e6) + options_.dark));
  }
  std::vector<Event> events;
  if (!started_ || time <= time_) {
    reference_ = now;
    last_event_.assign(n, -std::numeric_limits<double>::infinity());
  } else {
    std::vector<std::vector<Event>> rows(static_cast<size_t>(height_));
    parallel_for("events", height_, [&](int64_t y) {
      auto& row = rows[static_cast<size_t>(y)];
      const RandomStream noise{seed_, stream_id("events.noise")};
      for (int x = 0; x < width_; ++x) {
        const size_t i =
            static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
        pixel_events(i, double{seen_[i]}, double{now[i]}, time, &row);
        if (options_.noise_rate <= 0) continue;
        const auto key = static_cast<uint32_t>(i);
        const auto counter = static_cast<uint64_t>(frame);
        const double count =
            draw_poisson(noise, counter, key, options_.noise_rate * (time - time_));
        const RandomStream when{seed_, stream_id("events.noise_time")};
        for (int j = 0; j < static_cast<int>(count); ++j) {
          const Philox4 bits = when.draw(counter | static_cast<uint64_t>(j) << 40, key);
          const double share = uniform_double(bits.v[0], bits.v[1]);
          row.push_back({static_cast<uint16_t>(x), static_cast<uint16_t>(y), (bits.v[2] & 1) != 0,
                         time_ + share * (time - time_)});
        }
      }
    });
    for (const std::vector<Event>& row : rows) events.insert(events.end(), row.begin(), row.end());
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& a, const Event& b) { return a.time < b.time; });
  }
  started_ = true;
  time_ = time;
  seen_ = std::move(now);
  return events;
}

}  // namespace gloam
