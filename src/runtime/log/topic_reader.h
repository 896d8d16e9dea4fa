#pragma once
// TopicReader: one topic of a log of any writer, read field by field.

#include <functional>
#include <string>

#include "mcap/mcap_reader.h"
#include "ros/dynamic_message.h"

namespace gloam {

/// Error: the log has no messages.
Status refuse_empty_log(const McapReader& log);

struct TopicReader {
  std::string name;
  MessageSchema schema;

  /// Errors: no such topic, messages that are not CDR by a ros2msg definition.
  static Result<TopicReader> find(const McapReader& log, const std::string& name);
  /// Calls f for each message in the order of the log; its Error ends it.
  Status for_each(const McapReader& log,
                  const std::function<Status(const DynamicMessage&)>& f) const;
};

}  // namespace gloam
