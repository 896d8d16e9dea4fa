// Services of the run: features, states, steps, resets.

#include "bridge/ros2/services/simulation_services.h"

#include <algorithm>
#include <limits>

#include "bridge/ros2/services/simulation_values.h"
#include "bridge/ros2/services/typed_service.h"
#include "gloam/program.h"
#include "ros/messages/simulation_interfaces.h"

namespace gloam::bridge {
namespace {

namespace si = simulation_interfaces;
namespace srv = simulation_interfaces::srv;
using ResultCode = si::Result;
using State = si::SimulationState;
using Features = si::SimulatorFeatures;

constexpr uint16_t kFeatures[] = {Features::SPAWNING,
                                  Features::DELETING,
                                  Features::NAMED_POSES,
                                  Features::POSE_BOUNDS,
                                  Features::ENTITY_TAGS,
                                  Features::ENTITY_BOUNDS,
                                  Features::ENTITY_BOUNDS_BOX,
                                  Features::ENTITY_CATEGORIES,
                                  Features::SPAWNING_RESOURCE_STRING,
                                  Features::ENTITY_STATE_GETTING,
                                  Features::ENTITY_STATE_SETTING,
                                  Features::ENTITY_INFO_GETTING,
                                  Features::ENTITY_INFO_SETTING,
                                  Features::SPAWNABLES,
                                  Features::SIMULATION_RESET,
                                  Features::SIMULATION_RESET_STATE,
                                  Features::SIMULATION_RESET_SPAWNED,
                                  Features::SIMULATION_STATE_GETTING,
                                  Features::SIMULATION_STATE_SETTING,
                                  Features::SIMULATION_STATE_PAUSE,
                                  Features::STEP_SIMULATION_SINGLE,
                                  Features::STEP_SIMULATION_MULTIPLE,
                                  Features::STEP_SIMULATION_ACTION,
                                  Features::WORLD_LOADING,
                                  Features::WORLD_RESOURCE_STRING,
                                  Features::WORLD_TAGS,
                                  Features::WORLD_UNLOADING,
                                  Features::WORLD_INFO_GETTING,
                                  Features::AVAILABLE_WORLDS,
                                  Features::SPAWNING_ENTITIES};

srv::GetSimulatorFeatures_Response features() {
  srv::GetSimulatorFeatures_Response response;
  response.features.features.assign(std::begin(kFeatures), std::end(kFeatures));
  response.features.spawn_formats = {"mjcf", "urdf", "gltf", "obj", "stl", "ply"};
  response.features.custom_info =
      std::string("Gloam ") + version() + "; props are gloam://prop/KIND";
  return response;
}

si::Result set_state(Operator& operations, uint8_t target) {
  using Response = srv::SetSimulationState_Response;
  const RunState now = operations.state();
  if (target == State::STATE_QUITTING) {
    if (now != RunState::kNoWorld && now != RunState::kLoading) (void)operations.pause();
    operations.ask_end();
    return result_ok();
  }
  if (target > State::STATE_PAUSED)
    return result_of(Response::INCORRECT_TRANSITION,
                     "use load_world and unload_world to load and unload worlds");
  if (now == RunState::kNoWorld || now == RunState::kLoading)
    return result_of(Response::INCORRECT_TRANSITION,
                     std::string("the simulation is in state '") + to_string(now) + "'");
  if (target == state_message(now) && now != RunState::kFailed)
    return result_of(Response::ALREADY_IN_TARGET_STATE,
                     std::string("the simulation is already ") + to_string(now));
  const Status status = target == State::STATE_PLAYING   ? operations.play()
                        : target == State::STATE_STOPPED ? operations.stop()
                                                         : operations.pause();
  return status.ok() ? result_ok()
                     : result_of(Response::STATE_TRANSITION_ERROR, status.error().to_string());
}

si::Result step(Operator& operations, uint64_t steps, const Worker& worker) {
  if (steps > static_cast<uint64_t>(std::numeric_limits<int64_t>::max() / 2))
    return result_of(ResultCode::RESULT_OPERATION_FAILED, "too many steps");
  const Status status = operations.step(static_cast<int64_t>(steps),
                                        [&](int64_t, int64_t) { return !worker.stopping(); });
  if (!status.ok() && status.error().kind == ErrorKind::kInput)
    return result_of(ResultCode::RESULT_OPERATION_FAILED, status.error().to_string());
  return result_of(status, ResultCode::RESULT_OPERATION_FAILED);
}

si::Result reset(Operator& operations, uint8_t scope) {
  using Request = srv::ResetSimulation_Request;
  if (scope == Request::SCOPE_DEFAULT) scope = Request::SCOPE_ALL;
  const bool time = (scope & Request::SCOPE_TIME) != 0;
  const bool state = (scope & Request::SCOPE_STATE) != 0;
  const bool spawned = (scope & Request::SCOPE_SPAWNED) != 0;
  if (time && !state)
    return result_of(ResultCode::RESULT_FEATURE_UNSUPPORTED,
                     "time cannot be reset without the state; request both with scope 3");
  if (!state && !spawned)
    return result_of(ResultCode::RESULT_FEATURE_UNSUPPORTED, "the scope does not exist");
  return result_of(operations.reset({.state = state, .spawned = spawned}));
}

}  // namespace

void add_run_services(ServiceTable* table) {
  Operator* const op = &table->operations;
  const std::string& ns = table->ns;
  const auto busy = result_of(ResultCode::RESULT_OPERATION_FAILED, "too many requests are waiting");
  const auto add = [table](Ros2Service service) { table->list.push_back(std::move(service)); };
  add(make_service<srv::GetSimulatorFeatures_Request, srv::GetSimulatorFeatures_Response>(
      ns + "/get_simulator_features", [](const auto&) { return features(); }));
  add(make_service<srv::GetSimulationState_Request, srv::GetSimulationState_Response>(
      ns + "/get_simulation_state", [op](const auto&) {
        srv::GetSimulationState_Response response{.result = result_ok()};
        response.state.state = state_message(op->state());
        if (op->end_asked()) response.state.state = State::STATE_QUITTING;
        return response;
      }));
  add(make_service<srv::SetSimulationState_Request, srv::SetSimulationState_Response>(
      ns + "/set_simulation_state", [op](const srv::SetSimulationState_Request& request) {
        return srv::SetSimulationState_Response{set_state(*op, request.state.state)};
      }));
  const Worker* const worker = table->worker.get();  // it outlives its jobs
  add(make_slow_service<srv::StepSimulation_Request, srv::StepSimulation_Response>(
      ns + "/step_simulation", table->worker, {busy},
      [op, worker](const srv::StepSimulation_Request& request) {
        return srv::StepSimulation_Response{step(*op, request.steps, *worker)};
      }));
  add(make_slow_service<srv::ResetSimulation_Request, srv::ResetSimulation_Response>(
      ns + "/reset_simulation", table->worker, {busy},
      [op](const srv::ResetSimulation_Request& request) {
        return srv::ResetSimulation_Response{reset(*op, request.scope)};
      }));
}

std::vector<Ros2Service> simulation_services(Operator& operations, int interfaces,
                                             const std::string& ns) {
  ServiceTable table{operations, interfaces, ns,
                     std::make_shared<Worker>(kMostSlowServices, Overflow::kReject)};
  add_run_services(&table);
  add_entity_services(&table);
  add_spawn_services(&table);
  add_world_services(&table);
  return std::move(table.list);
}

}  // namespace gloam::bridge
