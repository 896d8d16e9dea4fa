#pragma once
// Writers and readers of encoded messages on DDS. A part of dds_node.h.

#include <functional>
#include <memory>

#include "bridge/ros2/dds_node.h"

namespace eprosima::fastdds::dds {
class Publisher;
class Subscriber;
class Topic;
}  // namespace eprosima::fastdds::dds

namespace gloam::bridge {

/// Name of the participant's flow controller that large messages go through.
inline constexpr const char* kLargeMessageFlow = "gloam_large";

/// An endpoint begins to exist, and ends.
using EndpointEvent = std::function<void(const rtps::GUID_t&)>;
struct WriterEvents {
  EndpointEvent on_begin, on_end;
  std::function<void()> on_match;  ///< readers came or went; may be empty
};
struct ReaderEvents {
  EndpointEvent on_begin, on_end;
  std::function<void(const DdsSample&)> on_sample;
};

/// Errors: DDS rejects it.
Result<std::unique_ptr<DdsWriter>> open_writer(dds::Publisher& publisher, dds::Topic& topic,
                                               const DdsEndpoint& endpoint, WriterEvents events);
Result<std::unique_ptr<DdsReader>> open_reader(dds::Subscriber& subscriber, dds::Topic& topic,
                                               const DdsEndpoint& endpoint, ReaderEvents events);

}  // namespace gloam::bridge
