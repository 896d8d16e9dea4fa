#pragma once
// Texts in Gloam's own topics of a log.

#include <string>

#include "mcap/mcap_reader.h"
#include "ros/codec.h"
#include "ros/messages/std_msgs.h"

namespace gloam {

/// Text of a message: a std_msgs/String, or of an older log bare JSON. Error:
/// a damaged message.
inline Result<std::string> logged_text(const McapReader& log, const McapMessage& message) {
  const auto channel = log.channels().find(message.channel);
  if (channel != log.channels().end() && channel->second.encoding == "json")
    return std::string(message.data.begin(), message.data.end());
  GLOAM_TRY(auto text, decode<std_msgs::String>(message.data));
  return std::move(text.data);
}

}  // namespace gloam
