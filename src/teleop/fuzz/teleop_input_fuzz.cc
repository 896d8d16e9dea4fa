// Whatever a terminal or a device sends: keys and deflections stay within their ranges.
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "teleop/gamepad_events.h"
#include "teleop/held_keys.h"
#include "teleop/key_parser.h"

namespace {

bool is_deflection(const gloam::teleop::Deflection& move) {
  for (const auto axis : gloam::teleop::kAxes)
    if (!(move.*axis >= -1 && move.*axis <= 1)) return false;
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gloam::teleop;
  KeyParser parser;
  HeldKeys held;
  Time now = Time() + std::chrono::hours(1);
  for (size_t i = 0; i < size; i += 3) {
    now += std::chrono::milliseconds(data[i]);
    for (const Key& key : parser.feed({data + i, std::min<size_t>(3, size - i)}, now)) {
      if (key.speed < 0 || key.speed > kFastest || !is_deflection(key.move)) std::abort();
      held.press(key.move, now);
    }
    (void)parser.check_escape(now);
    if (!is_deflection(held.at(now))) std::abort();
  }
  GamepadEvents pad;
  pad.feed({data, size});
  if (!is_deflection(pad.deflection())) std::abort();
  return 0;
}
