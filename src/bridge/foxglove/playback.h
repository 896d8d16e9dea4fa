#pragma once
// Playback: a log that is played, as Foxglove's time line controls it.

#include <optional>

#include "bridge/foxglove/client_messages.h"
#include "bridge/foxglove/server_messages.h"
#include "bridge/operations/operator.h"
#include "gloam/log_player.h"

namespace gloam::bridge::foxglove {

/// One thread's alone: seeking takes as long as effects are solved again.
class Playback {
 public:
  Playback(LogPlayer& player, Operator& operations) : player_(player), operations_(operations) {}

  /// Does what a client asks; the state then, as an answer to it. Errors: a time beyond the log, a
  /// speed out of range, those of seeking.
  Result<PlaybackState> control(const PlaybackMessage& message);
  PlaybackState state() const;
  /// The state, if it is another kind than at the last call.
  std::optional<PlaybackState> change();

 private:
  LogPlayer& player_;
  Operator& operations_;
  PlaybackStatus told_ = PlaybackStatus::kBuffering;
  float told_speed_ = 1;
};

}  // namespace gloam::bridge::foxglove
