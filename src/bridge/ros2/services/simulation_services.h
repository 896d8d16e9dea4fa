#pragma once
// The services of simulation_interfaces on an Operator (docs/ros2.md).

#include <memory>
#include <string>
#include <vector>

#include "base/threads/worker.h"
#include "bridge/operations/operator.h"
#include "bridge/ros2/ros2_service.h"

namespace gloam::bridge {

/// All 22 of them. `interfaces`: 2 = shapes of 2.1, 1 = those of 1.x; `ns`: before their names,
/// "/sim". What takes long is answered by a thread of their own.
std::vector<Ros2Service> simulation_services(Operator& operations, int interfaces,
                                             const std::string& ns = "");

/// Where they are added, for the files that make them.
struct ServiceTable {
  Operator& operations;
  int interfaces = 2;
  std::string ns;
  std::shared_ptr<Worker> worker;
  std::vector<Ros2Service> list = {};
};
void add_run_services(ServiceTable* table);
void add_world_services(ServiceTable* table);
void add_entity_services(ServiceTable* table);
void add_spawn_services(ServiceTable* table);

}  // namespace gloam::bridge
