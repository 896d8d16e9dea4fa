#include "bridge/zmq/streams/subscription.h"

#include <fmt/format.h>

#include <charconv>

namespace gloam::bridge::zeromq {
namespace {

constexpr std::string_view kStateStream = "state", kStatePrefix = "state/";
constexpr int64_t kStateRate = 100;  // [Hz], of "state"

}  // namespace

std::optional<TopicInForm> parse_topic(std::string_view subscription) {
  for (const StreamForm form : {StreamForm::kShared, StreamForm::kDecoded, StreamForm::kCdr}) {
    const std::string_view prefix = prefix_of(form);
    if (subscription.starts_with(prefix) && subscription.substr(prefix.size()).starts_with('/'))
      return TopicInForm{std::string(subscription.substr(prefix.size())), form};
  }
  return std::nullopt;
}

std::string name_of(const std::string& topic, StreamForm form) {
  return std::string(prefix_of(form)) + topic;
}

bool is_state(std::string_view subscription) {
  return subscription == kStateStream || subscription.starts_with(kStatePrefix);
}

Result<Rational> parse_rate(std::string_view subscription) {
  if (subscription == kStateStream) return Rational{kStateRate, 1};
  const std::string_view digits = subscription.substr(kStatePrefix.size());
  int64_t rate = -1;
  const auto end = digits.data() + digits.size();
  const auto read = std::from_chars(digits.data(), end, rate);
  if (read.ec != std::errc() || read.ptr != end || rate < 0 || rate > 1000000)
    return Error{
        ErrorKind::kUsage,
        fmt::format("'{}' is not a state rate", digits),
        {},
        "use state/500 for 500 states per second of simulation time, state/0 for every step"};
  return Rational{rate, 1};
}

}  // namespace gloam::bridge::zeromq
