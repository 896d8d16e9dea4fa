#include "teleop/gamepad_events.h"

#include <linux/joystick.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace gloam::teleop {
namespace {

static_assert(sizeof(js_event) == 8);
constexpr double kLargestValue = 32767;
constexpr double kDeadZone = 0.1;      // of a stick's travel
constexpr double kTriggerPoint = 0.5;  // value of a trigger, -1 … 1, at which it acts
constexpr size_t kMostRequests = 64;   // that wait

// Axes: left stick, left trigger, right stick, right trigger, directional pad; down and right are
// positive.
enum Axis : unsigned {
  kLeftX,
  kLeftY,
  kLeftTrigger,
  kRightX,
  kRightY,
  kRightTrigger,
  kPadX,
  kPadY
};

struct ButtonRequest {
  unsigned button;
  Request request;
};
constexpr ButtonRequest kButtons[] = {
    {0, Request::kGripper},     // A
    {1, Request::kStop},        // B
    {3, Request::kSwitchGoal},  // Y
    {4, Request::kSlower},      // left bumper
    {5, Request::kFaster},      // right bumper
};

double without_dead_zone(double value) {
  const double size = std::abs(value);
  return size <= kDeadZone ? 0 : std::copysign((size - kDeadZone) / (1 - kDeadZone), value);
}

}  // namespace

void GamepadEvents::feed(std::span<const unsigned char> bytes) {
  for (const unsigned char byte : bytes) {
    event_[filled_++] = byte;
    if (filled_ < event_.size()) continue;
    filled_ = 0;
    take_event();
  }
}

void GamepadEvents::take_event() {
  js_event event;
  std::memcpy(&event, event_.data(), sizeof event);
  const bool is_initial = (event.type & JS_EVENT_INIT) != 0;
  const unsigned type = event.type & ~static_cast<unsigned>(JS_EVENT_INIT);
  if (type != JS_EVENT_AXIS && type != JS_EVENT_BUTTON) return;
  is_alive_ = true;
  if (type == JS_EVENT_AXIS)
    set_axis(event.number, std::clamp(event.value / kLargestValue, -1.0, 1.0));
  else if (event.value == 1 && !is_initial)
    press(event.number);
}

void GamepadEvents::set_axis(unsigned axis, double value) {
  if (axis >= kAxisCount) return;
  const double before = std::exchange(axes_[axis], value);
  const bool is_pulled = before < kTriggerPoint && value >= kTriggerPoint;
  if (requests_.size() < kMostRequests && is_pulled) {
    if (axis == kLeftTrigger) requests_.push_back(Request::kGripperOpen);
    if (axis == kRightTrigger) requests_.push_back(Request::kGripperClose);
  }
  if (sticks().is_zero()) is_stopped_ = false;
}

void GamepadEvents::press(unsigned button) {
  for (const ButtonRequest& row : kButtons) {
    if (row.button != button || requests_.size() >= kMostRequests) continue;
    requests_.push_back(row.request);
    if (row.request == Request::kStop) is_stopped_ = !sticks().is_zero();
  }
}

Deflection GamepadEvents::sticks() const {
  const auto along = [&](Axis axis) { return without_dead_zone(-axes_[axis]); };
  Deflection sum{.forward = along(kLeftY),
                 .left = along(kLeftX),
                 .up = along(kRightY),
                 .turn = along(kRightX),
                 .roll = -along(kPadX),
                 .pitch = -along(kPadY)};
  return sum;
}

Deflection GamepadEvents::deflection() const { return is_stopped_ ? Deflection{} : sticks(); }

std::vector<Request> GamepadEvents::take_requests() { return std::exchange(requests_, {}); }

}  // namespace gloam::teleop
