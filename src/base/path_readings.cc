#include "base/path_readings.h"

#include <algorithm>
#include <charconv>

namespace gloam {

std::string decode_percent(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const char* digits = text.data() + i + 1;
    const bool is_escape = text[i] == '%' && i + 2 < text.size() &&
                           std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2;
    out += is_escape ? static_cast<char>(value) : text[i];
    if (is_escape) i += 2;
  }
  return out;
}

std::string with_slashes(std::string_view name) {
  std::string out(name);
  std::replace(out.begin(), out.end(), '\\', '/');
  return out;
}

std::string without_foreign_folder(std::string_view name) {
  std::string out = with_slashes(name);
  if (out.starts_with('/') || (out.size() > 2 && out[1] == ':' && out[2] == '/'))
    out = out.substr(out.rfind('/') + 1);
  return out;
}

std::vector<std::string> path_readings(std::string_view name) {
  std::vector<std::string> out;
  const auto add = [&](std::string reading) {
    if (std::find(out.begin(), out.end(), reading) == out.end()) out.push_back(std::move(reading));
  };
  add(std::string(name));
  add(with_slashes(name));
  add(decode_percent(name));
  add(with_slashes(decode_percent(name)));
  return out;
}

}  // namespace gloam
