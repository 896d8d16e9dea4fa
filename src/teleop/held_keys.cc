#include "teleop/held_keys.h"

#include <algorithm>

namespace gloam::teleop {

void HeldKeys::hold(Axis* axis, double sign, Time now) {
  if (axis->sign != sign || now >= axis->end) *axis = {.sign = sign};
  // Three presses in a row are repeats, even of a keyboard with a short delay.
  const bool repeats =
      axis->presses >= 2 || (axis->presses == 1 && now - axis->last >= kShortestDelay);
  axis->presses += 1;
  axis->is_joined = false;
  axis->last = now;
  axis->end = now + (repeats ? kRepeatHold : kFirstHold);
}

void HeldKeys::press(const Deflection& move, Time now) {
  for (size_t i = 0; i < axes_.size(); ++i) {
    const double sign = move.*kAxes[i];
    if (sign == 0) continue;
    hold(&axes_[i], sign, now);
    for (size_t other = 0; other < axes_.size(); ++other) {
      Axis& axis = axes_[other];
      if (other == i || now >= axis.end) continue;
      axis.is_joined = axis.is_joined || now - axis.last <= kTogether;
      if (axis.is_joined) axis.end = std::max(axis.end, axes_[i].end);
    }
  }
}

bool HeldKeys::is_repeat(Request request, Time now) {
  const bool repeats = request == last_request_ && now - last_request_time_ < kFirstHold;
  last_request_ = request;
  last_request_time_ = now;
  const bool acts_once =
      request == Request::kGripper || request == Request::kSwitchGoal || request == Request::kHelp;
  return acts_once && repeats;
}

Deflection HeldKeys::at(Time now) const {
  Deflection total;
  for (size_t i = 0; i < axes_.size(); ++i)
    if (now < axes_[i].end) total.*kAxes[i] = axes_[i].sign;
  return total;
}

std::optional<Time> HeldKeys::next_end(Time now) const {
  std::optional<Time> next;
  for (const Axis& axis : axes_)
    if (now < axis.end && (!next || axis.end < *next)) next = axis.end;
  return next;
}

}  // namespace gloam::teleop
