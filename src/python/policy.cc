// Policies: gloam.policy.

#include "gloam/joints/policy.h"

#include "core.h"
#include "gloam/controller.h"
#include "run.h"

namespace gloam::python {
namespace {

nb::object list_of(const std::vector<double>& values) {
  return new_array<double>(values, {values.size()});
}

nb::tuple range_of(const std::array<double, 2>& range) {
  return nb::make_tuple(range[0], range[1]);
}

nb::dict ports_of(const std::vector<NetworkPort>& ports) {
  nb::dict made;
  for (const NetworkPort& port : ports) made[port.name.c_str()] = port.size;
  return made;
}

nb::dict part_of(const PolicyPartInfo& part) {
  nb::dict made;
  made["name"] = part.term;
  made["size"] = part.size;
  made["scale"] = nb::tuple(nb::cast(part.scale));
  made["clip"] = range_of(part.clip);
  made["history"] = part.history;
  made["sensor"] = part.sensor;
  made["input"] = part.input;
  made["source"] = part.from;
  return made;
}

nb::dict network_of(const PolicyNetworkInfo& network) {
  nb::dict made;
  nb::list parts;
  for (const PolicyPartInfo& part : network.parts) parts.append(part_of(part));
  made["name"] = network.name;
  made["every"] = network.every;
  made["history"] = network.history;
  made["terms"] = parts;
  made["inputs"] = ports_of(network.inputs);
  made["outputs"] = ports_of(network.outputs);
  return made;
}

nb::dict info_of(const LoadedPolicy& policy) {
  const PolicyInfo& info = policy.info();
  nb::dict made, renamed, ranges;
  for (const auto& [name, model_name] : info.model_joints) renamed[name.c_str()] = model_name;
  ranges["vx"] = range_of(info.command_ranges[0]);
  ranges["vy"] = range_of(info.command_ranges[1]);
  ranges["yaw_rate"] = range_of(info.command_ranges[2]);
  nb::list networks;
  for (const PolicyNetworkInfo& network : info.networks) networks.append(network_of(network));
  made["rate"] = info.rate;
  made["joints"] = nb::tuple(nb::cast(info.joints));
  made["model_joints"] = renamed;
  made["kp"] = list_of(info.kp);
  made["kd"] = list_of(info.kd);
  made["default_positions"] = list_of(info.default_positions);
  made["action_scale"] = list_of(info.action_scale);
  made["torque_limit"] = list_of(info.torque_limit);
  made["action_clip"] = range_of(info.action_clip);
  made["history_start"] = info.starts_with_zeros ? "zeros" : "repeat";
  made["gait_period"] = info.gait_period;
  made["command_ranges"] = ranges;
  made["velocity_feedback"] = info.velocity_feedback;
  made["networks"] = networks;
  return made;
}

nb::list terms_list() {
  nb::list list;
  for (const PolicyTermInfo& term : policy_terms()) {
    nb::dict made;
    made["name"] = term.name;
    made["fixed"] = term.fixed;
    made["per_joint"] = term.per_joint;
    made["unit"] = term.unit;
    made["doc"] = term.doc;
    made["aliases"] = nb::tuple(nb::cast(term.aliases));
    list.append(made);
  }
  return list;
}

void post_all(Run& run, std::span<const Command> commands, ControlLease* lease) {
  Simulation& simulation = run.simulation();
  run.note_command();
  check(without_gil(
      [&] { return lease != nullptr ? lease->post(commands) : simulation.post(commands); }));
}

ControllerOptions controller_of_scene(Run& run, Robot robot) {
  Simulation& simulation = run.simulation();
  const World world = without_gil([&] { return simulation.world(); });
  return take(scene_controller(world, robot));
}

// From the beginning: a policy of the same shape would take over the past of the one before it.
void start(const LoadedPolicy& policy, Run& run, Robot robot, ControlLease* lease) {
  ControllerOptions none;
  none.rate = controller_of_scene(run, robot).rate;  // of the robot's parts, too
  const Command commands[] = {{.what = SetController{robot, std::move(none)}},
                              {.what = SetController{robot, policy.controller()}}};
  post_all(run, commands, lease);
}

void give_back(Run& run, Robot robot, ControlLease* lease) {
  const Command command{.what = SetController{robot, controller_of_scene(run, robot)}};
  post_all(run, std::span(&command, 1), lease);
}

// None: the robot's controller is not a policy.
nb::object state_of(Run& run, Robot robot) {
  Simulation& simulation = run.simulation();
  const auto state = take(without_gil([&] { return policy_state(simulation, robot); }));
  if (!state) return nb::none();
  nb::list observations;
  for (const auto& network : state->observations) {
    nb::list inputs;
    for (const std::vector<float>& input : network)
      inputs.append(new_array<float>(input, {input.size()}));
    observations.append(inputs);
  }
  nb::dict made;
  made["network"] = state->network;
  made["settings"] = state->settings;
  made["action"] = list_of(state->action);
  made["targets"] = list_of(state->targets);
  made["observations"] = observations;
  made["is_servo"] = state->is_servo;
  made["fault"] = state->fault;
  return made;
}

nb::object infer(const LoadedPolicy& policy, nb::handle observation) {
  const std::vector<double> numbers = doubles(observation);
  return list_of(take(policy.infer(std::vector<float>(numbers.begin(), numbers.end()))));
}

}  // namespace

void bind_policy(nb::module_& m) {
  const auto lease = nb::arg("lease").none() = nb::none();
  nb::class_<LoadedPolicy>(m, "LoadedPolicy")
      .def_static("load",
                  [](const std::filesystem::path& network, const std::filesystem::path& settings) {
                    return take(without_gil([&] { return LoadedPolicy::load(network, settings); }));
                  })
      .def_prop_ro("network", &LoadedPolicy::network)
      .def_prop_ro("settings", &LoadedPolicy::settings)
      .def_prop_ro("info", &info_of)
      .def("infer", &infer)
      .def("start", &start, nb::arg("run"), nb::arg("robot"), lease);
  m.def("restore_scene_controller", &give_back, nb::arg("run"), nb::arg("robot"), lease);
  m.def("policy_state", &state_of, nb::arg("run"), nb::arg("robot"));
  m.def("policy_terms", &terms_list);
  m.def("policy_metadata", [](const std::filesystem::path& network) {
    return take(without_gil([&] { return policy_metadata(network); }));
  });
}

}  // namespace gloam::python
