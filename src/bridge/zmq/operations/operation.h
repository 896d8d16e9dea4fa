#pragma once
// Operations that clients may ask for: one table of names, arguments and functions, from which the
// schema of hello is made, too.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridge/bridge_list.h"
#include "bridge/zmq/operations/arguments.h"
#include "bridge/zmq/outbox.h"
#include "bridge/zmq/sessions.h"
#include "bridge/zmq/streams/state_pack.h"

namespace gloam::bridge::zeromq {

/// Parts of a bridge that operations work with.
struct Services {
  const BridgeContext& context;
  Sessions& sessions;
  StateLayouts& layouts;
  std::string operations_address, streams_address;
  bool shared_memory = true;
  const std::atomic<bool>& is_stopping;

  Simulation& simulation() const { return context.simulation; }
  Operator& operations() const { return context.operations; }
};

/// One request, checked.
struct Call {
  Services& services;
  const Envelope& from;
  const Arguments& arguments;
};

/// Thread that runs an operation.
enum class OperationSpeed : uint8_t {
  kAtOnce,  ///< the server's: takes no longer than a physics step
  kQueued,  ///< the worker's: one after the other
};

struct Operation {
  std::string_view name;
  std::string_view about;
  OperationSpeed speed = OperationSpeed::kAtOnce;
  std::vector<Argument> arguments = {};
  /// Packs the result, one value; after an Error what it has packed is thrown away.
  Status (*run)(const Call& call, Packer& out) = nullptr;
};

/// Rows by subject; each in its own file.
std::vector<Operation> run_operations();
std::vector<Operation> command_operations();
std::vector<Operation> claim_operations();
std::vector<Operation> option_operations();
std::vector<Operation> world_operations();
std::vector<Operation> record_operations();
std::vector<Operation> hello_operations();
std::vector<Operation> joint_operations();

/// All of them, by name.
std::span<const Operation> all_operations();
/// Error: there is none of this name; the remedy has the nearest.
Result<const Operation*> find_operation(std::string_view name);

/// {}: the result of what only succeeds.
inline void pack_nothing(Packer& out) { out.pack_map(0); }
/// The robot that argument "robot" names, without it the only one.
Result<RobotInfo> robot_of(const Call& call, const World& world);
/// {step, time, hash, qpos, qvel, ctrl} of the latest instant.
Status pack_latest(const Call& call, Packer& out);

}  // namespace gloam::bridge::zeromq
