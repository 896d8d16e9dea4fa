// Services of the ROS node without DDS: what every request of simulation_interfaces answers, in
// both shapes, and the parameters.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <set>

#include "bridge/ros2/services/parameter_services.h"
#include "bridge/ros2/services/parameter_values.h"
#include "bridge/ros2/services/simulation_services.h"
#include "bridge/test/lab.h"
#include "ros/codec.h"
#include "ros/message_types.h"
#include "ros/messages/rcl_interfaces.h"
#include "ros/messages/simulation_interfaces.h"
#include "ros/messages/simulation_interfaces_1.h"

namespace gloam::bridge {
namespace {

namespace si = simulation_interfaces;
namespace srv = simulation_interfaces::srv;
namespace srv1 = simulation_interfaces_1::srv;
using Code = si::Result;

class Ros2Services : public Lab {
 protected:
  void SetUp() override {
    Lab::SetUp();
    services_ = simulation_services(op(), 2, "/sim");
  }
  void TearDown() override {
    services_.clear();
    Lab::TearDown();
  }
  /// Asks a service, as a client would.
  template <Message Response, Message Request>
  Response ask(const std::string& name, const Request& request) {
    const auto found = std::ranges::find(services_, name, &Ros2Service::name);
    if (found == services_.end()) {
      ADD_FAILURE() << "no service " << name;
      return {};
    }
    EXPECT_EQ(found->type + "_Request", ros_type_name<Request>());
    EXPECT_EQ(found->type + "_Response", ros_type_name<Response>());
    std::vector<uint8_t> bytes;
    encode(request, &bytes);
    std::vector<uint8_t> answer;
    if (found->answer) {
      answer = found->answer(bytes).value();
    } else {
      const auto promise = std::make_shared<std::promise<std::vector<uint8_t>>>();
      found->answer_later(
          bytes, [promise](std::vector<uint8_t> reply) { promise->set_value(std::move(reply)); });
      answer = promise->get_future().get();
    }
    return decode<Response>(answer).value();
  }
  int set_state(uint8_t state) {
    return ask<srv::SetSimulationState_Response>("/sim/set_simulation_state",
                                                 srv::SetSimulationState_Request{{state}})
        .result.result;
  }
  int state() {
    return ask<srv::GetSimulationState_Response>("/sim/get_simulation_state",
                                                 srv::GetSimulationState_Request{})
        .state.state;
  }
  int step(uint64_t steps) {
    return ask<srv::StepSimulation_Response>("/sim/step_simulation",
                                             srv::StepSimulation_Request{steps})
        .result.result;
  }
  srv::SpawnEntity_Response spawn(const std::string& name, const std::string& uri,
                                  const std::string& text) {
    srv::SpawnEntity_Request request;
    request.name = name;
    request.entity_resource = {uri, text};
    return ask<srv::SpawnEntity_Response>("/sim/spawn_entity", request);
  }
  std::vector<std::string> entities(const si::EntityFilters& filters) {
    return ask<srv::GetEntities_Response>("/sim/get_entities", srv::GetEntities_Request{filters})
        .entities;
  }

  std::vector<Ros2Service> services_;
};

TEST_F(Ros2Services, AreThe22OfThePackage) {
  EXPECT_EQ(services_.size(), 22u);
  std::set<std::string> names, types;
  for (const Ros2Service& service : services_) {
    names.insert(service.name);
    types.insert(service.type);
    EXPECT_TRUE(service.name.starts_with("/sim/"));
    EXPECT_NE(find_message_type(service.type + "_Request"), nullptr) << service.type;
    EXPECT_NE(service.answer == nullptr, service.answer_later == nullptr) << service.name;
  }
  EXPECT_EQ(names.size(), 22u);
  EXPECT_EQ(types.size(), 22u);
  EXPECT_EQ(simulation_services(op(), 1).size(), 22u);
}

// As rosidl of Kilted describes the packages' own definitions.
TEST_F(Ros2Services, HaveTheHashesOfRos) {
  const auto hash_of = [&](const std::string& name) {
    return std::ranges::find(services_, name, &Ros2Service::name)->hash;
  };
  EXPECT_EQ(hash_of("/sim/spawn_entities"),
            "RIHS01_41703a359ee032bf4fc230f144f531705ba039a2e97edeae1f7997dd83b04857");
  EXPECT_EQ(hash_of("/sim/get_simulator_features"),
            "RIHS01_abb9439c8cf196722a469fb6c68b44b484f198c2a1356ac38849a29c2a20a794");
}

TEST_F(Ros2Services, DamagedRequestsHaveNoAnswer) {
  const std::vector<uint8_t> damaged = {0, 1, 0, 0, 255, 255, 255, 255};
  for (const Ros2Service& service : services_) {
    const bool is_empty = find_message_type(service.type + "_Request")->text.empty() ||
                          service.type.ends_with("Step");
    if (service.answer_later) {
      service.answer_later({}, [](const std::vector<uint8_t>&) { ADD_FAILURE(); });
    } else {
      EXPECT_FALSE(service.answer({}).ok()) << service.name;
      if (!is_empty) (void)service.answer(damaged);
    }
  }
}

TEST_F(Ros2Services, FeaturesAreThoseThatWork) {
  const auto response = ask<srv::GetSimulatorFeatures_Response>(
      "/sim/get_simulator_features", srv::GetSimulatorFeatures_Request{});
  const std::vector<uint16_t>& features = response.features.features;
  EXPECT_EQ(features.size(), 30u);
  EXPECT_EQ(std::ranges::count(features, si::SimulatorFeatures::ENTITY_BOUNDS_CONVEX), 0);
  EXPECT_EQ(std::ranges::count(response.features.spawn_formats, "urdf"), 1);
}

TEST_F(Ros2Services, StatesChangeAsTheirDocumentSays) {
  using State = si::SimulationState;
  using Response = srv::SetSimulationState_Response;
  EXPECT_EQ(state(), State::STATE_STOPPED);
  EXPECT_EQ(set_state(State::STATE_STOPPED), Response::ALREADY_IN_TARGET_STATE);
  EXPECT_EQ(set_state(State::STATE_PAUSED), Code::RESULT_OK);
  EXPECT_EQ(state(), State::STATE_PAUSED);
  EXPECT_EQ(step(7), Code::RESULT_OK);
  EXPECT_EQ(simulation_->latest().step(), 7);
  EXPECT_EQ(step(0), Code::RESULT_OPERATION_FAILED);
  EXPECT_EQ(step(~uint64_t{0}), Code::RESULT_OPERATION_FAILED);
  EXPECT_EQ(set_state(State::STATE_PLAYING), Code::RESULT_OK);
  EXPECT_EQ(state(), State::STATE_PLAYING);
  EXPECT_EQ(step(1), Code::RESULT_OPERATION_FAILED);
  EXPECT_EQ(set_state(State::STATE_STOPPED), Code::RESULT_OK);
  EXPECT_EQ(state(), State::STATE_STOPPED);
  EXPECT_EQ(set_state(State::STATE_LOADING_WORLD), Response::INCORRECT_TRANSITION);
  EXPECT_EQ(set_state(77), Response::INCORRECT_TRANSITION);
  EXPECT_EQ(set_state(State::STATE_QUITTING), Code::RESULT_OK);
  EXPECT_TRUE(op().end_asked());
  EXPECT_EQ(state(), State::STATE_QUITTING);
}

TEST_F(Ros2Services, ResetsTakeScopes) {
  using Request = srv::ResetSimulation_Request;
  const auto reset = [&](int scope) {
    return ask<srv::ResetSimulation_Response>("/sim/reset_simulation",
                                              Request{static_cast<uint8_t>(scope)})
        .result.result;
  };
  ASSERT_EQ(spawn("ball", "", kBall).result.result, Code::RESULT_OK);
  EXPECT_EQ(step(5), Code::RESULT_OK);
  EXPECT_EQ(reset(Request::SCOPE_TIME), Code::RESULT_FEATURE_UNSUPPORTED);
  EXPECT_EQ(reset(64), Code::RESULT_FEATURE_UNSUPPORTED);
  EXPECT_EQ(reset(Request::SCOPE_TIME | Request::SCOPE_STATE), Code::RESULT_OK);
  EXPECT_EQ(simulation_->latest().step(), 0);
  EXPECT_TRUE(op().find_entity("ball").ok());
  EXPECT_EQ(reset(Request::SCOPE_SPAWNED), Code::RESULT_OK);
  EXPECT_FALSE(op().find_entity("ball").ok());
  EXPECT_EQ(reset(Request::SCOPE_DEFAULT), Code::RESULT_OK);
}

TEST_F(Ros2Services, FiltersChooseEntities) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(entities({}).size(), 6u);
  EXPECT_EQ(entities({.filter = "^(crate|table)$"}), (Names{"crate", "table"}));
  EXPECT_EQ(entities({.filter = "ra"}), (Names{"crate"}));
  EXPECT_EQ(entities({.categories = {{si::EntityCategory::CATEGORY_ROBOT}}}), (Names{"arm"}));
  ASSERT_TRUE(op().set_info("door", "", {"wood", "tall"}, EntityKind::kObject).ok());
  EXPECT_EQ(entities({.tags = {{"wood", "none"}, si::TagsFilter::FILTER_MODE_ANY}}),
            (Names{"door"}));
  EXPECT_EQ(entities({.tags = {{"wood", "none"}, si::TagsFilter::FILTER_MODE_ALL}}), (Names{}));
  // The crate: 0.9 … 1.1, 1.8 … 2.2, 0 … 1.
  EXPECT_EQ(entities({.bounds = {si::Bounds::TYPE_BOX, {{1.2, 2.5, 3}, {1.05, 2.1, 0.9}}}}),
            (Names{"crate"}));
  EXPECT_EQ(entities({.bounds = {si::Bounds::TYPE_SPHERE, {{1.3, 2, 0.5}, {0.25, 0, 0}}}}),
            (Names{"crate"}));
  EXPECT_EQ(entities({.bounds = {si::Bounds::TYPE_SPHERE, {{1.3, 2, 0.5}, {0.15, 0, 0}}}}),
            (Names{}));
  const auto code = [&](const si::EntityFilters& filters) {
    const auto states = ask<srv::GetEntitiesStates_Response>(
        "/sim/get_entities_states", srv::GetEntitiesStates_Request{filters});
    EXPECT_EQ(states.entities.size(), states.states.size());
    return states.result.result;
  };
  EXPECT_EQ(code({}), Code::RESULT_OK);
  EXPECT_EQ(code({.filter = "("}), Code::RESULT_OPERATION_FAILED);
  EXPECT_EQ(code({.filter = std::string(5000, 'a')}), Code::RESULT_OPERATION_FAILED);
  EXPECT_EQ(code({.bounds = {si::Bounds::TYPE_CONVEX_HULL, {{}, {}, {}}}}),
            Code::RESULT_FEATURE_UNSUPPORTED);
  EXPECT_EQ(code({.bounds = {si::Bounds::TYPE_BOX, {{}}}}), Code::RESULT_OPERATION_FAILED);
}

TEST_F(Ros2Services, StatesAreSetByFlags) {
  srv::SetEntityState_Request request;
  request.entity = "crate";
  request.state.pose.position = {4, 4, 4};
  request.state.twist.linear = {0, 0, 1};
  request.set_twist = true;
  const auto set = [&] {
    return ask<srv::SetEntityState_Response>("/sim/set_entity_state", request).result.result;
  };
  const auto get = [&](const std::string& name) {
    return ask<srv::GetEntityState_Response>("/sim/get_entity_state",
                                             srv::GetEntityState_Request{name});
  };
  EXPECT_EQ(set(), Code::RESULT_OK);
  EXPECT_EQ(get("crate").state.pose.position.x, 1);  // the pose stays
  EXPECT_EQ(get("crate").state.twist.linear.z, 1);
  EXPECT_EQ(get("crate").state.header.frame_id, "world");
  request.set_pose = true;
  request.state.header.frame_id = "table";  // at 0, -1, 0.4
  EXPECT_EQ(set(), Code::RESULT_OK);
  EXPECT_NEAR(get("crate").state.pose.position.y, 3, 1e-9);
  request.state.header.frame_id = "nowhere";
  EXPECT_EQ(set(), Code::RESULT_OPERATION_FAILED);
  request.state.header.frame_id = "";
  request.state.pose.orientation.w = 7;
  EXPECT_EQ(set(), srv::SetEntityState_Response::INVALID_POSE);
  request.state.pose.orientation.w = 1;
  request.entity = "table";
  EXPECT_EQ(set(), Code::RESULT_OPERATION_FAILED);
  request.entity = "nobody";
  EXPECT_EQ(set(), Code::RESULT_NOT_FOUND);
  EXPECT_EQ(get("nobody").result.result, Code::RESULT_NOT_FOUND);
}

TEST_F(Ros2Services, InfoBoundsAndNamedPosesAreTold) {
  const auto info = [&](const std::string& name) {
    return ask<srv::GetEntityInfo_Response>("/sim/get_entity_info",
                                            srv::GetEntityInfo_Request{name});
  };
  EXPECT_EQ(info("hand").info.category.category, si::EntityCategory::CATEGORY_DYNAMIC_OBJECT);
  EXPECT_EQ(info("nobody").result.result, Code::RESULT_NOT_FOUND);
  const auto set = [&](const std::string& name, uint8_t category) {
    return ask<srv::SetEntityInfo_Response>(
               "/sim/set_entity_info",
               srv::SetEntityInfo_Request{name, {{category}, "mine", {"tag"}}})
        .result.result;
  };
  EXPECT_EQ(set("hand", si::EntityCategory::CATEGORY_HUMAN), Code::RESULT_OK);
  EXPECT_EQ(info("hand").info.category.category, si::EntityCategory::CATEGORY_HUMAN);
  EXPECT_EQ(info("hand").info.description, "mine");
  EXPECT_EQ(set("hand", 3), Code::RESULT_OPERATION_FAILED);
  EXPECT_EQ(set("nobody", 0), Code::RESULT_NOT_FOUND);

  const auto bounds = [&](const std::string& name) {
    return ask<srv::GetEntityBounds_Response>("/sim/get_entity_bounds",
                                              srv::GetEntityBounds_Request{name});
  };
  const si::Bounds crate = bounds("crate").bounds;
  ASSERT_EQ(crate.type, si::Bounds::TYPE_BOX);
  EXPECT_NEAR(crate.points[0].y, 0.2, 1e-9);
  EXPECT_NEAR(crate.points[1].z, -0.5, 1e-9);
  EXPECT_EQ(bounds("nobody").result.result, Code::RESULT_NOT_FOUND);

  const auto poses =
      ask<srv::GetNamedPoses_Response>("/sim/get_named_poses", srv::GetNamedPoses_Request{});
  ASSERT_EQ(poses.poses.size(), 1u);
  EXPECT_EQ(poses.poses[0].name, "arm_goal");
  const auto pose_bounds = [&](const std::string& name) {
    return ask<srv::GetNamedPoseBounds_Response>("/sim/get_named_pose_bounds",
                                                 srv::GetNamedPoseBounds_Request{name});
  };
  EXPECT_EQ(pose_bounds("arm_goal").bounds.type, si::Bounds::TYPE_SPHERE);
  EXPECT_EQ(pose_bounds("none").result.result, Code::RESULT_NOT_FOUND);
}

TEST_F(Ros2Services, SpawningHasItsCodes) {
  using Spawn = si::SpawnResult;
  EXPECT_EQ(spawn("ball", "", kBall).entity_name, "ball");
  EXPECT_EQ(spawn("ball", "", kBall).result.result, Spawn::NAME_NOT_UNIQUE);
  EXPECT_EQ(spawn("a b", "", kBall).result.result, Spawn::NAME_INVALID);
  EXPECT_EQ(spawn("c", "", "").result.result, Spawn::NO_RESOURCE);
  EXPECT_EQ(spawn("c", "", "<sdf/>").result.result, Spawn::UNSUPPORTED_FORMAT);
  EXPECT_EQ(spawn("c", "", "<mujoco><worldbody><body><geom/></body>").result.result,
            Spawn::RESOURCE_PARSE_ERROR);
  EXPECT_EQ(spawn("c", "ball.xml", "ignored").entity_name, "c");

  srv::SpawnEntities_Request all;
  all.spawn_requests.resize(2);
  all.spawn_requests[0].name = "d";
  all.spawn_requests[0].entity_resource.uri = "gloam://prop/chair";
  all.spawn_requests[1].name = "d";
  all.spawn_requests[1].entity_resource.uri = "ball.xml";
  auto response = ask<srv::SpawnEntities_Response>("/sim/spawn_entities", all);
  EXPECT_EQ(response.result.result, srv::SpawnEntities_Response::ENTITIES_SPAWN_FAILED);
  EXPECT_EQ(response.results[0].result.result, Code::RESULT_OK);
  EXPECT_EQ(response.results[1].result.result, Spawn::NAME_NOT_UNIQUE);
  all.spawn_requests[0].name = "e";
  all.spawn_requests[1].name = "f";
  response = ask<srv::SpawnEntities_Response>("/sim/spawn_entities", all);
  EXPECT_EQ(response.result.result, Code::RESULT_OK);

  const auto remove = [&](const std::string& name) {
    return ask<srv::DeleteEntity_Response>("/sim/delete_entity", srv::DeleteEntity_Request{name})
        .result.result;
  };
  EXPECT_EQ(remove("d"), Code::RESULT_OK);
  EXPECT_EQ(remove("d"), Code::RESULT_NOT_FOUND);
  EXPECT_EQ(remove("table"), Code::RESULT_FEATURE_UNSUPPORTED);

  const auto spawnables = ask<srv::GetSpawnables_Response>(
      "/sim/get_spawnables", srv::GetSpawnables_Request{{".", "/etc"}});
  EXPECT_EQ(spawnables.result.result, Code::RESULT_OK);
  EXPECT_NE(spawnables.result.error_message.find("/etc"), std::string::npos);
  EXPECT_GT(spawnables.spawnables.size(), 20u);
}

TEST_F(Ros2Services, WorldsAreLoadedAndUnloaded) {
  using Load = srv::LoadWorld_Response;
  const auto load = [&](const std::string& uri, const std::string& text) {
    return ask<Load>("/sim/load_world", srv::LoadWorld_Request{{uri, text}, false, false});
  };
  const auto worlds = ask<srv::GetAvailableWorlds_Response>("/sim/get_available_worlds",
                                                            srv::GetAvailableWorlds_Request{});
  EXPECT_GT(worlds.worlds.size(), 10u);
  srv::GetAvailableWorlds_Request bad{{"/etc"}, {}, false, false};
  EXPECT_EQ(ask<srv::GetAvailableWorlds_Response>("/sim/get_available_worlds", bad).result.result,
            Code::RESULT_NOT_FOUND);
  bad.continue_on_error = true;
  EXPECT_GT(ask<srv::GetAvailableWorlds_Response>("/sim/get_available_worlds", bad).worlds.size(),
            10u);
  const auto current = [&] {
    return ask<srv::GetCurrentWorld_Response>("/sim/get_current_world",
                                              srv::GetCurrentWorld_Request{});
  };
  EXPECT_EQ(current().world.name, "lab");
  EXPECT_EQ(load("", "").result.result, Load::NO_RESOURCE);
  EXPECT_EQ(load("nothing", "").result.result, Load::NO_RESOURCE);
  EXPECT_EQ(load("/etc/hosts.toml", "").result.result, Load::NO_RESOURCE);
  EXPECT_EQ(load("world.sdf", "").result.result, Load::UNSUPPORTED_FORMAT);
  EXPECT_EQ(load("", "not TOML at all [").result.result, Load::RESOURCE_PARSE_ERROR);
  EXPECT_EQ(load("", "[environment]\nfile = \"none.xml\"").result.result, Load::MISSING_ASSETS);
  EXPECT_EQ(load("other", "").result.result, Code::RESULT_OK);
  EXPECT_EQ(state(), si::SimulationState::STATE_STOPPED);
  const auto unload = [&] {
    return ask<srv::UnloadWorld_Response>("/sim/unload_world", srv::UnloadWorld_Request{})
        .result.result;
  };
  EXPECT_EQ(unload(), Code::RESULT_OK);
  EXPECT_EQ(unload(), srv::UnloadWorld_Response::NO_WORLD_LOADED);
  EXPECT_EQ(current().result.result, srv::GetCurrentWorld_Response::NO_WORLD_LOADED);
  EXPECT_EQ(state(), si::SimulationState::STATE_NO_WORLD);
  EXPECT_EQ(set_state(si::SimulationState::STATE_PLAYING),
            srv::SetSimulationState_Response::INCORRECT_TRANSITION);
  EXPECT_EQ(step(1), Code::RESULT_OPERATION_FAILED);
  EXPECT_EQ(load("lab", "").result.result, Code::RESULT_OK);
}

TEST_F(Ros2Services, OldShapesAreTakenToo) {
  services_ = simulation_services(op(), 1, "");
  srv1::SpawnEntity_Request request;
  request.name = "ball";
  request.uri = "ball.xml";
  EXPECT_EQ(ask<srv::SpawnEntity_Response>("/spawn_entity", request).entity_name, "ball");
  srv1::SetEntityState_Request set;
  set.entity = "hand";  // a mocap body: the pose alone
  set.state.pose.position = {1, 0, 1};
  EXPECT_EQ(ask<srv::SetEntityState_Response>("/set_entity_state", set).result.result,
            Code::RESULT_OK);
  EXPECT_GT(ask<srv1::GetSpawnables_Response>("/get_spawnables", srv::GetSpawnables_Request{})
                .spawnables.size(),
            20u);
  EXPECT_EQ(ask<srv::LoadWorld_Response>("/load_world", srv1::LoadWorld_Request{"other", "", 0, 0})
                .result.result,
            Code::RESULT_OK);
}

/// Parameters beside the services.
class Ros2Parameters : public Ros2Services {
 protected:
  void SetUp() override {
    Lab::SetUp();
    services_ = parameter_services(
        op(), "/sim/gloam", [this](const std::string& topic, std::span<const uint8_t> data) {
          EXPECT_EQ(topic, "/parameter_events");
          const std::lock_guard lock(mutex_);
          events_.push_back(decode<rcl_interfaces::ParameterEvent>(data).value());
        });
  }
  rcl_interfaces::ParameterValue get(const std::string& name) {
    return ask<rcl_interfaces::srv::GetParameters_Response>(
               "/sim/gloam/get_parameters", rcl_interfaces::srv::GetParameters_Request{{name}})
        .values.at(0);
  }
  bool set(const std::string& name, const rcl_interfaces::ParameterValue& value) {
    return ask<rcl_interfaces::srv::SetParameters_Response>(
               "/sim/gloam/set_parameters",
               rcl_interfaces::srv::SetParameters_Request{{{name, value}}})
        .results.at(0)
        .successful;
  }
  std::mutex mutex_;
  std::vector<rcl_interfaces::ParameterEvent> events_;
};

TEST_F(Ros2Parameters, AreReadAndSet) {
  EXPECT_TRUE(get("use_sim_time").bool_value);
  EXPECT_TRUE(get("paused").bool_value);
  EXPECT_TRUE(set("paused", bool_parameter(false)));
  EXPECT_EQ(op().state(), RunState::kPlaying);
  EXPECT_TRUE(set("paused", bool_parameter(true)));
  EXPECT_FALSE(set("paused", double_parameter(1)));
  EXPECT_TRUE(set("speed", double_parameter(3)));
  EXPECT_EQ(get("speed").double_value, 3);
  EXPECT_FALSE(set("speed", double_parameter(-3)));
  EXPECT_TRUE(set("pace", string_parameter("sensors")));
  EXPECT_EQ(get("pace").string_value, "sensors");
  EXPECT_EQ(simulation_->stats().pace, Pace::kSensors);
  EXPECT_FALSE(set("pace", string_parameter("sensor")));
  EXPECT_FALSE(set("pace", double_parameter(1)));
  EXPECT_TRUE(set("pace", string_parameter("realtime")));
  EXPECT_TRUE(set("use_sim_time", bool_parameter(true)));
  EXPECT_FALSE(set("use_sim_time", bool_parameter(false)));
  EXPECT_TRUE(set("live.gravity", doubles_parameter({0, 0, -1})));
  EXPECT_FALSE(set("live.gravity", doubles_parameter({0, 0})));
  EXPECT_FALSE(set("live.gravity", doubles_parameter({0, 0, std::nan("")})));
  ASSERT_TRUE(op().step(1).ok());
  EXPECT_EQ(get("live.gravity").double_array_value.at(2), -1);

  EXPECT_EQ(get("prop.seat.seed").integer_value, 0);
  rcl_interfaces::ParameterValue seed;
  seed.type = rcl_interfaces::ParameterType::PARAMETER_INTEGER;
  seed.integer_value = 5;
  EXPECT_TRUE(set("prop.seat.seed", seed));
  EXPECT_EQ(get("prop.seat.seed").integer_value, 5);
  EXPECT_TRUE(set("robot.arm.position", doubles_parameter({0, 2, 0})));
  EXPECT_NEAR(op().entity_state("arm").value().X_WE.p.y, 2, 1e-9);
  EXPECT_FALSE(set("live.none", doubles_parameter({1})));
  EXPECT_FALSE(set("sim.timestep", double_parameter(0.1)));
  EXPECT_FALSE(set("no.such.option", seed));
  EXPECT_EQ(get("no.such.option").type, rcl_interfaces::ParameterType::PARAMETER_NOT_SET);
  const std::lock_guard lock(mutex_);
  ASSERT_EQ(events_.size(), 9u);
  EXPECT_EQ(events_.back().node, "/sim/gloam");
  EXPECT_EQ(events_.back().changed_parameters.at(0).name, "robot.arm.position");
}

TEST_F(Ros2Parameters, AreSetAtomically) {
  namespace rs = rcl_interfaces::srv;
  rcl_interfaces::ParameterValue seed;
  seed.type = rcl_interfaces::ParameterType::PARAMETER_INTEGER;
  seed.integer_value = 9;
  const auto set = [&](std::vector<rcl_interfaces::Parameter> all) {
    return ask<rs::SetParametersAtomically_Response>(
               "/sim/gloam/set_parameters_atomically",
               rs::SetParametersAtomically_Request{std::move(all)})
        .result.successful;
  };
  EXPECT_FALSE(set({{"prop.seat.seed", seed}, {"speed", double_parameter(-1)}}));
  EXPECT_EQ(get("prop.seat.seed").integer_value, 0);
  EXPECT_TRUE(set({{"prop.seat.seed", seed}, {"speed", double_parameter(2)}}));
  EXPECT_EQ(get("prop.seat.seed").integer_value, 9);
}

TEST_F(Ros2Parameters, AreListedAndDescribed) {
  namespace rs = rcl_interfaces::srv;
  const auto list = [&](std::vector<std::string> prefixes, uint64_t depth) {
    return ask<rs::ListParameters_Response>("/sim/gloam/list_parameters",
                                            rs::ListParameters_Request{std::move(prefixes), depth})
        .result;
  };
  EXPECT_GT(list({}, 0).names.size(), 30u);
  EXPECT_EQ(list({}, 1).names.size(), 4u);
  EXPECT_GT(list({"live"}, 0).names.size(), 4u);
  for (const std::string& name : list({"prop.seat"}, 0).names)
    EXPECT_TRUE(name.starts_with("prop.seat.")) << name;
  EXPECT_GT(list({"prop.seat"}, 0).names.size(), 3u);
  const auto described = ask<rs::DescribeParameters_Response>(
      "/sim/gloam/describe_parameters",
      rs::DescribeParameters_Request{{"paused", "sim.seed", "robot.arm.controller.kp", "none"}});
  ASSERT_EQ(described.descriptors.size(), 4u);
  EXPECT_FALSE(described.descriptors[0].read_only);
  EXPECT_TRUE(described.descriptors[1].read_only);
  EXPECT_EQ(described.descriptors[2].name, "robot.arm.controller.kp");
  EXPECT_EQ(described.descriptors[3].type, 0);
  const auto types = ask<rs::GetParameterTypes_Response>(
      "/sim/gloam/get_parameter_types", rs::GetParameterTypes_Request{{"paused", "speed"}});
  EXPECT_EQ(types.types, (std::vector<uint8_t>{1, 3}));
}

TEST(ParameterValues, AreTomlAndBack) {
  using Type = rcl_interfaces::ParameterType;
  const std::pair<const char*, int> values[] = {
      {"true", Type::PARAMETER_BOOL},
      {"-7", Type::PARAMETER_INTEGER},
      {"0.25", Type::PARAMETER_DOUBLE},
      {"\"oak\"", Type::PARAMETER_STRING},
      {"[1, 2]", Type::PARAMETER_INTEGER_ARRAY},
      {"[1.5, 2.0]", Type::PARAMETER_DOUBLE_ARRAY},
      {"[\"a\", \"b, c\"]", Type::PARAMETER_STRING_ARRAY}};
  for (const auto& [toml, type] : values) {
    const rcl_interfaces::ParameterValue value = parameter_from_toml(toml);
    EXPECT_EQ(value.type, type) << toml;
    EXPECT_EQ(parameter_to_toml(value), toml);
  }
  EXPECT_EQ(parameter_from_toml("[1, 2.5]").double_array_value, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(parameter_from_toml("'a'").string_value, "a");
  EXPECT_EQ(parameter_from_toml("[[1, 2]]").string_value, "[[1, 2]]");
  EXPECT_EQ(parameter_from_toml("08:30:00").type, Type::PARAMETER_STRING);
  EXPECT_EQ(parameter_from_toml("").type, Type::PARAMETER_NOT_SET);
  rcl_interfaces::ParameterValue odd;
  odd.type = Type::PARAMETER_STRING;
  odd.string_value = "a\"\\\n";
  EXPECT_EQ(parameter_to_toml(odd), "\"a\\\"\\\\\\u000A\"");
}

}  // namespace
}  // namespace gloam::bridge
