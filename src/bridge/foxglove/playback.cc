#include "bridge/foxglove/playback.h"

#include <algorithm>
#include <string>

namespace gloam::bridge::foxglove {
namespace {

constexpr float kSlowestPlay = 0.001f, kFastestPlay = 1000;  // simulated seconds per second

}  // namespace

PlaybackState Playback::state() const {
  const Simulation& simulation = player_.simulation();
  PlaybackState state;
  state.time = simulation.latest().time();
  state.speed = static_cast<float>(operations_.speed().value_or(kFastestPlay));
  state.status = simulation.paused() ? PlaybackStatus::kPaused : PlaybackStatus::kPlaying;
  if (state.time >= player_.end() - 1e-9) state.status = PlaybackStatus::kEnded;
  return state;
}

Result<PlaybackState> Playback::control(const PlaybackMessage& message) {
  if (!(message.speed >= kSlowestPlay && message.speed <= kFastestPlay))
    return Error{ErrorKind::kInput,
                 "the playback speed must be 0.001 to 1000, got " + std::to_string(message.speed)};
  Simulation& simulation = player_.simulation();
  if (message.speed != state().speed) GLOAM_TRY_STATUS(operations_.set_speed(message.speed));
  if (!message.play) simulation.pause();
  bool did_seek = false;
  if (message.seek) {
    GLOAM_TRY_STATUS(player_.seek(1e-9 * static_cast<double>(*message.seek)));
    did_seek = true;
  } else if (message.play && state().status == PlaybackStatus::kEnded) {
    GLOAM_TRY_STATUS(player_.seek(0));  // played again
    did_seek = true;
  }
  if (message.play) simulation.resume();
  PlaybackState now = state();
  now.did_seek = did_seek;
  now.request = message.request;
  told_ = now.status;
  told_speed_ = now.speed;
  return now;
}

std::optional<PlaybackState> Playback::change() {
  const PlaybackState now = state();
  if (now.status == told_ && now.speed == told_speed_) return {};
  told_ = now.status;
  told_speed_ = now.speed;
  return now;
}

}  // namespace gloam::bridge::foxglove
