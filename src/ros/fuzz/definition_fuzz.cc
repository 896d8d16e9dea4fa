// A stranger's definition, a zero byte, a message of it.

#include <algorithm>
#include <cstdlib>

#include "ros/definition_parser.h"
#include "ros/dynamic_message.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const uint8_t* zero = std::find(data, data + size, 0);
  const std::string_view text(reinterpret_cast<const char*>(data), size_t(zero - data));
  const auto schema = gloam::MessageSchema::parse(text, "fuzz_msgs/msg/Fuzz");
  if (!schema.ok()) {
    const std::string told = schema.error().to_string();
    if (told.find("fuzz_msgs/msg/Fuzz") != 0) std::abort();
    return 0;
  }
  const std::string once = gloam::ros2msg_text(schema->type());
  const auto again = gloam::parse_ros2msg(once, "fuzz_msgs/msg/Fuzz");
  if (!again.ok() || gloam::ros2msg_text(*again) != once) std::abort();
  if (zero == data + size) return 0;
  const auto message = gloam::DynamicMessage::open(*schema, {zero + 1, data + size});
  if (!message.ok()) return 0;
  for (const auto& field : schema->fields(0)) {
    (void)message->numbers(field.name).ok();
    (void)message->texts(field.name).ok();
    (void)message->bytes(field.name).ok();
  }
  return 0;
}
