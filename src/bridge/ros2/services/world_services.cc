// Services of worlds: lists, loading, unloading.

#include <algorithm>

#include "bridge/ros2/services/simulation_services.h"
#include "bridge/ros2/services/simulation_values.h"
#include "bridge/ros2/services/typed_service.h"
#include "ros/messages/simulation_interfaces.h"
#include "ros/messages/simulation_interfaces_1.h"

namespace gloam::bridge {
namespace {

namespace si = simulation_interfaces;
namespace srv = simulation_interfaces::srv;
namespace srv1 = simulation_interfaces_1::srv;
using WorldCode = si::Result;

si::WorldResource world_message(const WorldFile& world) {
  si::WorldResource message;
  message.name = world.name;
  message.world_resource.uri = world.uri;
  message.description = world.description;
  return message;
}

int load_code(const Error& error) {
  using Response = srv::LoadWorld_Response;
  const auto says = [&](std::string_view words) {
    return error.message.find(words) != std::string::npos;
  };
  if (error.kind == ErrorKind::kUnsupported) return Response::UNSUPPORTED_ELEMENTS;
  if (says("there is no world") || says("there is no folder") || says("neither an address") ||
      says("outside of the folders that clients") || says("not a file address") ||
      says("not a supported address"))
    return Response::NO_RESOURCE;
  if (says("there is no file") || says("does not exist") || says("cannot be read") ||
      says("could not open"))
    return Response::MISSING_ASSETS;
  if (says("no decoder found")) return Response::UNSUPPORTED_ASSETS;
  if (error.kind == ErrorKind::kInput || error.kind == ErrorKind::kIo)
    return Response::RESOURCE_PARSE_ERROR;
  return WorldCode::RESULT_OPERATION_FAILED;
}

/// Formats of worlds that other simulators have.
bool is_foreign(const std::string& uri, const std::string& text) {
  const auto ends = [&](std::string_view end) { return uri.ends_with(end); };
  return ends(".sdf") || ends(".world") || ends(".usd") || ends(".usda") || ends(".usdc") ||
         text.starts_with("#usda") || text.find("<sdf") != std::string::npos;
}

srv::LoadWorld_Response load(Operator& op, const std::string& uri, const std::string& text) {
  srv::LoadWorld_Response response{.result = result_ok()};
  if (uri.empty() && text.empty()) {
    response.result = result_of(srv::LoadWorld_Response::NO_RESOURCE,
                                "the request contains neither an address nor a text");
    return response;
  }
  if (is_foreign(uri, uri.empty() ? text : "")) {
    response.result = result_of(srv::LoadWorld_Response::UNSUPPORTED_FORMAT,
                                "a world must be a TOML scene or an MJCF model (docs/scenes.md)");
    return response;
  }
  const Result<WorldFile> world = op.load_world(uri, uri.empty() ? text : "");
  if (world.ok()) {
    response.world = world_message(*world);
  } else {
    response.result = result_of(load_code(world.error()), world.error().to_string());
  }
  return response;
}

srv::GetCurrentWorld_Response current(const Operator& op) {
  srv::GetCurrentWorld_Response response{.result = result_ok()};
  const Result<WorldFile> world = op.current_world();
  if (world.ok()) {
    response.world = world_message(*world);
  } else {
    response.result =
        result_of(srv::GetCurrentWorld_Response::NO_WORLD_LOADED, world.error().to_string());
  }
  return response;
}

srv::GetAvailableWorlds_Response available(const Operator& op,
                                           const srv::GetAvailableWorlds_Request& request) {
  srv::GetAvailableWorlds_Response response{.result = result_ok()};
  if (!request.filter.tags.empty()) return response;  // no world has tags
  Result<std::vector<WorldFile>> worlds = op.worlds(request.additional_sources);
  if (!worlds.ok()) {
    response.result = result_of(worlds.error());
    if (!request.continue_on_error) return response;
    response.result = result_of(WorldCode::RESULT_OK, worlds.error().to_string());
    worlds = op.worlds();
    if (!worlds.ok()) return response;
  }
  for (const WorldFile& world : *worlds) response.worlds.push_back(world_message(world));
  return response;
}

}  // namespace

void add_world_services(ServiceTable* table) {
  Operator* const op = &table->operations;
  const std::string& ns = table->ns;
  const auto busy = result_of(WorldCode::RESULT_OPERATION_FAILED, "too many requests are waiting");
  const auto add = [table](Ros2Service service) { table->list.push_back(std::move(service)); };
  const auto& worker = table->worker;
  if (table->interfaces == 1) {
    add(make_slow_service<srv1::LoadWorld_Request, srv::LoadWorld_Response>(
        ns + "/load_world", worker, {busy, {}},
        [op](const srv1::LoadWorld_Request& r) { return load(*op, r.uri, r.resource_string); }));
  } else {
    add(make_slow_service<srv::LoadWorld_Request, srv::LoadWorld_Response>(
        ns + "/load_world", worker, {busy, {}}, [op](const srv::LoadWorld_Request& r) {
          return load(*op, r.world_resource.uri, r.world_resource.resource_string);
        }));
  }
  add(make_slow_service<srv::UnloadWorld_Request, srv::UnloadWorld_Response>(
      ns + "/unload_world", worker, {busy}, [op](const srv::UnloadWorld_Request&) {
        return srv::UnloadWorld_Response{
            result_of(op->unload_world(), srv::UnloadWorld_Response::NO_WORLD_LOADED)};
      }));
  add(make_service<srv::GetCurrentWorld_Request, srv::GetCurrentWorld_Response>(
      ns + "/get_current_world", [op](const auto&) { return current(*op); }));
  add(make_service<srv::GetAvailableWorlds_Request, srv::GetAvailableWorlds_Response>(
      ns + "/get_available_worlds",
      [op](const srv::GetAvailableWorlds_Request& r) { return available(*op, r); }));
}

}  // namespace gloam::bridge
