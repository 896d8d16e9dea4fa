#pragma once
// Subscriptions: the texts by which clients name streams.

#include <optional>
#include <string>
#include <string_view>

#include "bridge/zmq/streams/topic_encoder.h"
#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam::bridge::zeromq {

/// A topic in one of its forms.
struct TopicInForm {
  std::string topic;
  StreamForm form;
};
/// None: the text names no topic.
std::optional<TopicInForm> parse_topic(std::string_view subscription);
/// The text of a topic's form.
std::string name_of(const std::string& topic, StreamForm form);

/// "state" or "state/RATE".
bool is_state(std::string_view subscription);
/// States per second of simulation time [Hz]; 0 = each step. Error: the rate is no number.
Result<Rational> parse_rate(std::string_view subscription);

}  // namespace gloam::bridge::zeromq
