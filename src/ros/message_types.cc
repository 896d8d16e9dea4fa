#include "ros/message_types.h"

#include "ros/messages/all_messages.h"

namespace gloam {
namespace {

std::vector<MessageType> all_message_types() {
  std::vector<MessageType> types;
  AllMessages::for_each(
      [&]<class T>(std::type_identity<T>) { types.push_back(message_type<T>()); });
  return types;
}

FieldDescription part_field(std::string name, std::string message) {
  return {.name = std::move(name), .type = {.message = std::move(message)}};
}

void add_missing(const TypeDescription& from, TypeDescription* type) {
  for (const MessageDescription& message : from.messages) {
    if (type->find(message.name) == nullptr) type->messages.push_back(message);
  }
}

}  // namespace

MessageType make_message_type(const TypeDescription& type) {
  const std::string& name = type.messages.front().name;
  return {name, dds_type_name(name), ros2msg_text(type), rihs01_hash(type)};
}

std::span<const MessageType> message_types() {
  static const std::vector<MessageType> types = all_message_types();
  return types;
}

const MessageType* find_message_type(std::string_view name) {
  for (const MessageType& type : message_types()) {
    if (type.name == name) return &type;
  }
  return nullptr;
}

std::string service_hash(std::string_view name, const TypeDescription& request,
                         const TypeDescription& response) {
  // rosidl describes a service as a message of three, the last of which tells of calls (REP 2012).
  const std::string service(name), info = "service_msgs/msg/ServiceEventInfo";
  const auto at_most_one = [&](const char* field, const char* part) {
    FieldDescription at_most = part_field(field, service + part);
    at_most.type.array = ArrayKind::kBounded;
    at_most.type.array_size = 1;
    return at_most;
  };
  TypeDescription type;
  type.messages = {
      {.name = service,
       .fields = {part_field("request_message", service + "_Request"),
                  part_field("response_message", service + "_Response"),
                  part_field("event_message", service + "_Event")}},
      {.name = service + "_Event",
       .fields = {part_field("info", info), at_most_one("request", "_Request"),
                  at_most_one("response", "_Response")}},
      {.name = info,
       .fields = {
           {.name = "event_type", .type = {.kind = FieldKind::kUint8}},
           part_field("stamp", "builtin_interfaces/msg/Time"),
           {.name = "client_gid",
            .type = {.kind = FieldKind::kChar, .array = ArrayKind::kFixed, .array_size = 16}},
           {.name = "sequence_number", .type = {.kind = FieldKind::kInt64}}}}};
  add_missing(describe<builtin_interfaces::Time>(), &type);
  add_missing(request, &type);
  add_missing(response, &type);
  return rihs01_hash(type);
}

}  // namespace gloam
