// Messages of clients of the bridge to Foxglove, and JSON that becomes a ROS message.

#include "bridge/foxglove/client_messages.h"
#include "bridge/foxglove/json_message.h"
#include "ros/messages/sensor_msgs.h"
#include "web/client_json.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gloam;
  using namespace gloam::bridge::foxglove;
  static const MessageSchema schema = *MessageSchema::create(describe<sensor_msgs::JointState>());
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  (void)parse_text_message(text).ok();
  (void)parse_binary_message({data, size}).ok();
  const auto object = gloam::web::parse_client_json(text);
  if (const auto bytes = cdr_from_json(schema, object); bytes.ok())
    if (!json_from_cdr(schema, *bytes).ok()) __builtin_trap();
  (void)json_from_cdr(schema, {data, size}).ok();
  return 0;
}
