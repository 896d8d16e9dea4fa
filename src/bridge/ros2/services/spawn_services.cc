// Services that add and remove entities, in both shapes of simulation_interfaces.

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
using SpawnCode = si::Result;

constexpr size_t kMostAtOnce = 256;

// The three shapes of a request differ in where the resource lies.
template <class Request>
SpawnRequest spawn_request(const Request& from, const std::string& uri, const std::string& text) {
  return {.name = from.name,
          .allow_renaming = from.allow_renaming,
          .uri = uri,
          .text = uri.empty() ? text : std::string(),
          .ns = from.entity_namespace,
          .frame = from.initial_pose.header.frame_id,
          .X_FE = pose_from_ros(from.initial_pose.pose)};
}
template <class Request>
SpawnRequest spawn_request(const Request& from) {
  return spawn_request(from, from.entity_resource.uri, from.entity_resource.resource_string);
}
SpawnRequest spawn_request(const srv1::SpawnEntity_Request& from) {
  return spawn_request(from, from.uri, from.resource_string);
}

si::SpawnResult spawn_one(Operator& op, const SpawnRequest& request) {
  const SpawnResult spawned = op.spawn(request);
  si::SpawnResult result{.result = result_ok()};
  result.entity_name = spawned.name;
  if (!spawned.ok())
    result.result = result_of(spawn_code(spawned.failure), spawned.error.to_string());
  return result;
}

template <class Request>
srv::SpawnEntity_Response spawn(Operator& op, const Request& request) {
  const si::SpawnResult result = spawn_one(op, spawn_request(request));
  srv::SpawnEntity_Response response;
  response.result = result.result;
  response.entity_name = result.entity_name;
  return response;
}

srv::SpawnEntities_Response spawn_all(Operator& op, const srv::SpawnEntities_Request& request) {
  srv::SpawnEntities_Response response{.result = result_ok()};
  if (request.spawn_requests.size() > kMostAtOnce) {
    response.result = result_of(SpawnCode::RESULT_OPERATION_FAILED,
                                "at most 256 entities can be spawned at once");
    return response;
  }
  size_t failures = 0;
  for (const si::SpawnEntity& one : request.spawn_requests) {
    response.results.push_back(spawn_one(op, spawn_request(one)));
    if (response.results.back().result.result != SpawnCode::RESULT_OK) ++failures;
  }
  if (failures > 0)
    response.result = result_of(srv::SpawnEntities_Response::ENTITIES_SPAWN_FAILED,
                                std::to_string(failures) + " of " +
                                    std::to_string(request.spawn_requests.size()) +
                                    " entities could not be spawned");
  return response;
}

// Sources that cannot be listed are reported and skipped.
std::vector<Spawnable> list_spawnables(const Operator& op, const std::vector<std::string>& sources,
                                       si::Result* result) {
  std::vector<Spawnable> all;
  if (Result<std::vector<Spawnable>> own = op.spawnables(); own.ok()) all = std::move(*own);
  const size_t known = all.size();
  for (const std::string& source : sources) {
    const Result<std::vector<Spawnable>> found = op.spawnables({source});
    if (!found.ok()) {
      result->error_message += found.error().to_string() + "\n";
      continue;
    }
    all.insert(all.end(), found->begin() + static_cast<ptrdiff_t>(known), found->end());
  }
  return all;
}

// Around the origin, standing on the ground.
si::Bounds bounds_of(const Vec3& size) {
  if (size.x <= 0) return {};
  return box_message({{-size.x / 2, -size.y / 2, 0}, {size.x / 2, size.y / 2, size.z}});
}

srv::GetSpawnables_Response get_spawnables(const Operator& op,
                                           const std::vector<std::string>& sources) {
  srv::GetSpawnables_Response response{.result = result_ok()};
  for (const Spawnable& one : list_spawnables(op, sources, &response.result))
    response.spawnables.push_back({{one.uri, ""}, one.description, bounds_of(one.size)});
  return response;
}

srv1::GetSpawnables_Response get_spawnables_1(const Operator& op,
                                              const std::vector<std::string>& sources) {
  srv1::GetSpawnables_Response response{.result = result_ok()};
  for (const Spawnable& one : list_spawnables(op, sources, &response.result))
    response.spawnables.push_back({one.uri, one.description, bounds_of(one.size)});
  return response;
}

}  // namespace

void add_spawn_services(ServiceTable* table) {
  Operator* const op = &table->operations;
  const std::string& ns = table->ns;
  const auto busy = result_of(SpawnCode::RESULT_OPERATION_FAILED, "too many requests are waiting");
  const auto add = [table](Ros2Service service) { table->list.push_back(std::move(service)); };
  const auto& worker = table->worker;
  if (table->interfaces == 1) {
    add(make_slow_service<srv1::SpawnEntity_Request, srv::SpawnEntity_Response>(
        ns + "/spawn_entity", worker, {busy, ""},
        [op](const srv1::SpawnEntity_Request& r) { return spawn(*op, r); }));
    add(make_service<srv::GetSpawnables_Request, srv1::GetSpawnables_Response>(
        ns + "/get_spawnables",
        [op](const srv::GetSpawnables_Request& r) { return get_spawnables_1(*op, r.sources); }));
  } else {
    add(make_slow_service<srv::SpawnEntity_Request, srv::SpawnEntity_Response>(
        ns + "/spawn_entity", worker, {busy, ""},
        [op](const srv::SpawnEntity_Request& r) { return spawn(*op, r); }));
    add(make_service<srv::GetSpawnables_Request, srv::GetSpawnables_Response>(
        ns + "/get_spawnables",
        [op](const srv::GetSpawnables_Request& r) { return get_spawnables(*op, r.sources); }));
  }
  add(make_slow_service<srv::SpawnEntities_Request, srv::SpawnEntities_Response>(
      ns + "/spawn_entities", worker, {busy, {}},
      [op](const srv::SpawnEntities_Request& r) { return spawn_all(*op, r); }));
  add(make_slow_service<srv::DeleteEntity_Request, srv::DeleteEntity_Response>(
      ns + "/delete_entity", worker, {busy}, [op](const srv::DeleteEntity_Request& r) {
        return srv::DeleteEntity_Response{result_of(op->remove(r.entity))};
      }));
}

}  // namespace gloam::bridge
