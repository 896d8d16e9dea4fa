#include "bridge/ros2/services/parameter_services.h"

#include "bridge/ros2/services/node_parameters.h"
#include "bridge/ros2/services/typed_service.h"

namespace gloam::bridge {
namespace {

namespace rsrv = rcl_interfaces::srv;

}  // namespace

std::vector<Ros2Service> parameter_services(Operator& operations, const std::string& node,
                                            Ros2Publish publish) {
  const auto all = std::make_shared<NodeParameters>(operations, node, std::move(publish));
  const auto worker = std::make_shared<Worker>(kMostSlowServices, Overflow::kReject);
  const std::string base = node + "/";
  std::vector<Ros2Service> list;
  list.push_back(make_service<rsrv::GetParameters_Request, rsrv::GetParameters_Response>(
      base + "get_parameters", [all](const auto& r) { return all->get(r); }));
  list.push_back(make_service<rsrv::GetParameterTypes_Request, rsrv::GetParameterTypes_Response>(
      base + "get_parameter_types", [all](const auto& r) { return all->types(r); }));
  list.push_back(make_service<rsrv::ListParameters_Request, rsrv::ListParameters_Response>(
      base + "list_parameters", [all](const auto& r) { return all->list(r); }));
  list.push_back(make_service<rsrv::DescribeParameters_Request, rsrv::DescribeParameters_Response>(
      base + "describe_parameters", [all](const auto& r) { return all->describe(r); }));
  list.push_back(make_slow_service<rsrv::SetParameters_Request, rsrv::SetParameters_Response>(
      base + "set_parameters", worker, {}, [all](const auto& r) { return all->set(r); }));
  list.push_back(make_slow_service<rsrv::SetParametersAtomically_Request,
                                   rsrv::SetParametersAtomically_Response>(
      base + "set_parameters_atomically", worker, {{false, "too many requests are waiting"}},
      [all](const auto& r) { return all->set_atomically(r); }));
  return list;
}

}  // namespace gloam::bridge
