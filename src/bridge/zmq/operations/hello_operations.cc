// hello: identity and capabilities of a server; topics and message definitions.

#include <algorithm>
#include <set>

#include "bridge/zmq/address_file.h"
#include "bridge/zmq/operations/operation.h"
#include "gloam/log_player.h"
#include "gloam/program.h"
#include "gloam/topics.h"

namespace gloam::bridge::zeromq {
namespace {

using enum ArgumentType;
using enum OperationSpeed;

constexpr int kProtocol = 1;

void pack_schema(Packer& out) {
  const std::span<const Operation> table = all_operations();
  out.pack_map(static_cast<uint32_t>(table.size()));
  for (const Operation& operation : table) {
    out.pack(operation.name);
    out.pack_map(2);
    pack_pair(out, "about", operation.about);
    out.pack(std::string_view("args"));
    out.pack_map(static_cast<uint32_t>(operation.arguments.size()));
    for (const Argument& argument : operation.arguments) {
      out.pack(argument.name);
      out.pack_map(4);
      pack_pair(out, "type", to_string(argument.type));
      pack_pair(out, "required", argument.is_required);
      pack_pair(out, "unit", argument.unit);
      pack_pair(out, "about", argument.about);
    }
  }
}

void pack_topics(Packer& out, const std::vector<TopicInfo>& topics) {
  out.pack_array(static_cast<uint32_t>(topics.size()));
  for (const TopicInfo& topic : topics) {
    out.pack_map(7);
    pack_pair(out, "name", topic.name);
    pack_pair(out, "type", topic.type);
    pack_pair(out, "frame_id", topic.frame_id);
    pack_pair(out, "rate", topic.rate.value());
    pack_pair(out, "latched", topic.qos.is_latched);
    pack_pair(out, "input", topic.is_input);
    pack_pair(out, "source", to_string(topic.source));
  }
}

Status pack_types(Packer& out, const std::vector<TopicInfo>& topics) {
  std::set<std::string> types;
  for (const TopicInfo& topic : topics) types.insert(topic.type);
  out.pack_map(static_cast<uint32_t>(types.size()));
  for (const std::string& type : types) {
    GLOAM_TRY(const MessageInfo info, message_info(type));
    out.pack(type);
    out.pack_map(2);
    pack_pair(out, "ros2msg", info.definition);
    pack_pair(out, "hash", info.hash);
  }
  return {};
}

void pack_names(Packer& out, std::string_view key, const std::vector<NamedElement>& elements) {
  out.pack(key);
  out.pack_array(static_cast<uint32_t>(elements.size()));
  for (const NamedElement& element : elements) out.pack(element.name);
}

template <class Handle>
void pack_handles(Packer& out, std::string_view key, const std::vector<Handle>& handles,
                  const std::vector<NamedElement>& names) {
  out.pack(key);
  out.pack_array(static_cast<uint32_t>(handles.size()));
  for (const Handle handle : handles) out.pack(names[static_cast<size_t>(handle.id)].name);
}

void pack_robots(Packer& out, const World& world, const WorldInfo& info) {
  const std::vector<RobotInfo> robots = world.robots();
  out.pack_array(static_cast<uint32_t>(robots.size()));
  for (const RobotInfo& robot : robots) {
    out.pack_map(3);
    pack_pair(out, "name", robot.name);
    pack_handles(out, "joints", robot.joints, info.joints);
    pack_handles(out, "actuators", robot.actuators, info.actuators);
  }
}

void pack_live_fields(Packer& out, const World& world) {
  std::vector<InputInfo> fields = world.inputs();
  std::erase_if(fields, [](const InputInfo& input) { return input.kind != InputKind::kLiveField; });
  out.pack_map(static_cast<uint32_t>(fields.size()));
  for (const InputInfo& field : fields) {
    out.pack(field.name);
    out.pack_map(2);
    pack_pair(out, "count", field.count);
    pack_pair(out, "unit", field.unit);
  }
}

void pack_server(const Call& call, Packer& out) {
  const Services& services = call.services;
  pack_pair(out, "gloam", std::string_view(version()));
  pack_pair(out, "protocol", kProtocol);
  pack_pair(out, "scene", services.simulation().world().scene().name);
  pack_pair(out, "address", services.operations_address);
  pack_pair(out, "streams", services.streams_address);
  const std::string machine = call.arguments.text("machine");
  pack_pair(out, "shared_memory",
            services.shared_memory && !machine.empty() && machine == machine_id());
}
constexpr uint32_t kServerPairs = 6;

// Without a token: the information that a client needs to get one.
Status hello(const Call& call, Packer& out) {
  out.pack_map(kServerPairs + 1);
  pack_server(call, out);
  pack_pair(out, "token_needed", true);
  return {};
}

Status describe(const Call& call, Packer& out) {
  const Services& services = call.services;
  Simulation& simulation = services.simulation();
  const World world = simulation.world();
  GLOAM_TRY(const std::vector<TopicInfo> topics, simulation.topics());
  const WorldInfo info = world.info();
  const LogPlayer* const player = services.context.player;
  out.pack_map(kServerPairs + 12);
  pack_server(call, out);
  pack_pair(out, "step_rate", simulation.step_rate().value());
  pack_pair(out, "replay_end", player != nullptr ? player->end() : 0.0);
  out.pack(std::string_view("operations"));
  pack_schema(out);
  out.pack(std::string_view("topics"));
  pack_topics(out, topics);
  out.pack(std::string_view("types"));
  GLOAM_TRY_STATUS(pack_types(out, topics));
  out.pack(std::string_view("robots"));
  pack_robots(out, world, info);
  pack_names(out, "bodies", info.bodies);
  pack_names(out, "joints", info.joints);
  pack_names(out, "actuators", info.actuators);
  pack_names(out, "sensors", info.sensors);
  pack_pair(out, "cameras", simulation.camera_names());
  out.pack(std::string_view("live_fields"));
  pack_live_fields(out, world);
  return {};
}

Status topics(const Call& call, Packer& out) {
  GLOAM_TRY(const std::vector<TopicInfo> all, call.services.simulation().topics());
  pack_topics(out, all);
  return {};
}

}  // namespace

std::vector<Operation> hello_operations() {
  const Argument machine{"machine", kText, false, "",
                         "boot id:user id; determines whether shared memory can be used"};
  return {
      {"hello",
       "identifies the server, also without a token; with the token equivalent to describe",
       kAtOnce,
       {machine},
       hello},
      {"describe",
       "operations, topics with definitions, robots, joints, actuators, cameras, live fields",
       kQueued,
       {machine},
       describe},
      {"topics", "topics of the running World: [{name, type, …}]", kQueued, {}, topics},
  };
}

}  // namespace gloam::bridge::zeromq
