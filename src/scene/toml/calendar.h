#pragma once
// Dates and times of day in a scene file: TOML's own local dates and times, or text.

#include <toml++/toml.h>

#include <optional>
#include <string_view>

#include "gloam/scene.h"

namespace gloam {

/// "2026-06-21", or a TOML date. Nothing when it is neither; the values are not checked.
std::optional<CalendarDate> read_date(const toml::node& node);
/// "14:30", "14:30:15.5", or a TOML time. Nothing when it is neither; the values are not checked.
std::optional<ClockTime> read_time(const toml::node& node);

}  // namespace gloam
