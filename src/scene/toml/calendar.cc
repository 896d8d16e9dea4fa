#include "scene/toml/calendar.h"

#include <charconv>
#include <string>

namespace gloam {
namespace {

/// Takes `digits` decimal digits off the front of `text`.
bool take_number(std::string_view* text, size_t digits, int* out) {
  if (text->size() < digits ||
      text->substr(0, digits).find_first_not_of("0123456789") != std::string_view::npos) {
    return false;
  }
  std::from_chars(text->data(), text->data() + digits, *out);
  text->remove_prefix(digits);
  return true;
}

bool take(std::string_view* text, char c) {
  if (!text->starts_with(c)) return false;
  text->remove_prefix(1);
  return true;
}

/// "15" or "15.5".
bool take_seconds(std::string_view* text, double* out) {
  int whole = 0;
  if (!take_number(text, 2, &whole)) return false;
  *out = whole;
  if (!take(text, '.')) return true;
  double digit = 0.1;
  const size_t before = text->size();
  for (; !text->empty() && text->front() >= '0' && text->front() <= '9'; digit /= 10) {
    *out += digit * (text->front() - '0');
    text->remove_prefix(1);
  }
  return text->size() < before;
}

}  // namespace

std::optional<CalendarDate> read_date(const toml::node& node) {
  if (const auto date = node.value_exact<toml::date>()) {
    return CalendarDate{date->year, date->month, date->day};
  }
  const auto written = node.value_exact<std::string>();
  if (!written) return std::nullopt;
  std::string_view text = *written;
  CalendarDate out;
  if (take_number(&text, 4, &out.year) && take(&text, '-') && take_number(&text, 2, &out.month) &&
      take(&text, '-') && take_number(&text, 2, &out.day) && text.empty()) {
    return out;
  }
  return std::nullopt;
}

std::optional<ClockTime> read_time(const toml::node& node) {
  if (const auto time = node.value_exact<toml::time>()) {
    return ClockTime{time->hour, time->minute, time->second + 1e-9 * time->nanosecond};
  }
  const auto written = node.value_exact<std::string>();
  if (!written) return std::nullopt;
  std::string_view text = *written;
  ClockTime out;
  if (!take_number(&text, 2, &out.hour) || !take(&text, ':') || !take_number(&text, 2, &out.minute))
    return std::nullopt;
  if (take(&text, ':') && !take_seconds(&text, &out.second)) return std::nullopt;
  if (!text.empty()) return std::nullopt;
  return out;
}

}  // namespace gloam
