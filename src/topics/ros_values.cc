#include "topics/ros_values.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace gloam {

builtin_interfaces::Time ros_time(double time) {
  constexpr int64_t kSecond = 1'000'000'000;
  const int64_t ns = std::llround(std::clamp(time, 0.0, 2147483647.0) * 1e9);
  return {static_cast<int32_t>(ns / kSecond), static_cast<uint32_t>(ns % kSecond)};
}

double from_ros(const builtin_interfaces::Time& time) { return time.sec + 1e-9 * time.nanosec; }

std_msgs::Header ros_header(double time, std::string_view frame_id) {
  return {ros_time(time), std::string(frame_id)};
}

std::string topic_token(std::string_view name) {
  constexpr size_t kLongest = 180;  // ROS 2 allows 247 characters of a whole name
  std::string token;
  for (const char c : name) {
    const bool begins = token.empty() || token.back() == '/';
    if (c == '/') {
      if (!begins) token += '/';
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    const bool fits = std::isalnum(byte) != 0 && byte < 0x80;
    if (begins && std::isdigit(byte) != 0) token += '_';
    if (fits)
      token += c;
    else if (begins || token.back() != '_')  // ROS 2 has no two underscores in a row
      token += '_';
  }
  token.resize(std::min(token.size(), kLongest));
  while (!token.empty() && token.back() == '/') token.pop_back();
  return token.empty() ? "_" : token;
}

}  // namespace gloam
