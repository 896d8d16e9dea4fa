// Running simulations.

#include "gloam/simulation.h"

#include "frames.h"
#include "gloam/controller.h"
#include "gloam/log.h"
#include "gloam/view.h"
#include "handles.h"
#include "memory.h"
#include "run.h"
#include "streams.h"

namespace gloam::python {
namespace {

std::shared_ptr<Run> create(const World& world, uint64_t seed, double timestep,
                            const std::string& pace, double speed, nb::object make_data) {
  SimulationOptions options;
  options.seed = seed;
  options.timestep = timestep;
  options.speed = speed;
  options.pace = take(enum_named<Pace>(pace));
  Run::Shared shared{std::move(make_data)};
  if (!shared.make_data.is_none()) options.make_data = data_maker(shared.make_data, shared.mirrors);
  options.keep_waiting = [signal = shared.signal] {
    const nb::gil_scoped_acquire acquired;
    if (PyErr_CheckSignals() == 0) return true;
    signal->keep(nb::python_error());
    return false;
  };
  auto made = without_gil([&] { return Simulation::create(world, options); });
  return {new Run(take(std::move(made)), std::move(shared)), [](Run* run) {
            destroy_when_safe(Kept::kRun, [run] {
              if (run->end()) delete run;
            });
          }};
}

// Posts for the holder of a lease, else for everybody.
void post(Run& run, decltype(Command::what) what, int64_t step, ControlLease* lease) {
  const Command command{step, std::move(what)};
  Simulation& simulation = run.simulation();
  run.note_command();
  check(without_gil(
      [&] { return lease != nullptr ? lease->post(command) : simulation.post(command); }));
}

LiveFieldId live_field(const std::string& name) {
  const Result<LiveFieldId> field = find_live_field(name);
  if (!field.ok()) raise("NotFoundError", field.error().message, field.error().hint);
  return *field;
}

void bind_joint_commands(nb::class_<Run>& c) {
  constexpr int64_t kNext = Command::kNextStep;
  const auto lease = nb::arg("lease").none() = nb::none();
  c.def(
      "set_joint_command",
      [](Run& run, Robot robot, std::vector<Joint> joints, const nb::dict& targets, int64_t step,
         ControlLease* l) {
        SetJointCommand command{robot, std::move(joints)};
        const auto take_field = [&](const char* name, std::vector<double>* field) {
          if (targets.contains(name)) *field = doubles(targets[name]);
        };
        take_field("position", &command.position);
        take_field("velocity", &command.velocity);
        take_field("effort", &command.effort);
        take_field("kp", &command.kp);
        take_field("kd", &command.kd);
        post(run, std::move(command), step, l);
      },
      nb::arg("robot"), nb::arg("joints"), nb::arg("targets"), nb::arg("step") = kNext, lease);
  c.def(
      "set_controller",
      [](Run& run, Robot robot, const std::string& toml, int64_t step, ControlLease* l) {
        post(run, SetController{robot, take(parse_controller(toml))}, step, l);
      },
      nb::arg("robot"), nb::arg("toml"), nb::arg("step") = kNext, lease);
  c.def(
      "follow",
      [](Run& run, Robot robot, std::vector<Joint> joints, const nb::list& points,
         const std::string& profile, nb::handle max_velocity, nb::handle max_acceleration,
         int64_t step, ControlLease* l) {
        FollowTrajectory command{robot, std::move(joints), {}};
        command.trajectory.profile = take(profile_named(profile));
        command.trajectory.max_velocity = doubles(max_velocity);
        command.trajectory.max_acceleration = doubles(max_acceleration);
        for (const nb::handle point : points) {
          const auto row = nb::cast<nb::tuple>(point);
          command.trajectory.points.push_back(
              {nb::cast<double>(row[0]), doubles(row[1]), doubles(row[2]), doubles(row[3])});
        }
        post(run, std::move(command), step, l);
      },
      nb::arg("robot"), nb::arg("joints"), nb::arg("points"), nb::arg("profile"),
      nb::arg("max_velocity"), nb::arg("max_acceleration"), nb::arg("step") = kNext, lease);
  c.def(
      "stop_trajectory",
      [](Run& run, Robot robot, int64_t step, ControlLease* l) {
        post(run, StopTrajectory{robot}, step, l);
      },
      nb::arg("robot"), nb::arg("step") = kNext, lease);
}

void bind_commands(nb::class_<Run>& c) {
  constexpr int64_t kNext = Command::kNextStep;
  const auto lease = nb::arg("lease").none() = nb::none();
  c.def(
      "set_control",
      [](Run& run, Actuator actuator, double value, int64_t step, ControlLease* l) {
        post(run, SetControl{actuator, value}, step, l);
      },
      nb::arg("actuator"), nb::arg("value"), nb::arg("step") = kNext, lease);
  c.def(
      "set_controls",
      [](Run& run, Robot robot, nb::handle values, int64_t step, ControlLease* l) {
        post(run, SetControls{robot, doubles(values)}, step, l);
      },
      nb::arg("robot"), nb::arg("values"), nb::arg("step") = kNext, lease);
  c.def(
      "set_velocity_goal",
      [](Run& run, Robot robot, nb::handle goal, int64_t step, ControlLease* l) {
        const std::vector<double> v = doubles(goal);
        if (v.size() != 4)
          throw nb::value_error("a velocity goal has four numbers: vx, vy, yaw rate, vz");
        post(run, SetVelocityGoal{robot, v[0], v[1], v[2], v[3]}, step, l);
      },
      nb::arg("robot"), nb::arg("goal"), nb::arg("step") = kNext, lease);
  c.def(
      "set_joint_goal",
      [](Run& run, Joint joint, double position, int64_t step, ControlLease* l) {
        post(run, SetJointGoal{joint, position}, step, l);
      },
      nb::arg("joint"), nb::arg("position"), nb::arg("step") = kNext, lease);
  c.def(
      "set_pose_goal",
      [](Run& run, Robot robot, nb::handle X_WF, int64_t step, ControlLease* l) {
        post(run, SetPoseGoal{robot, pose(X_WF)}, step, l);
      },
      nb::arg("robot"), nb::arg("pose"), nb::arg("step") = kNext, lease);
  c.def(
      "set_joint_state",
      [](Run& run, Joint joint, nb::object qpos, nb::object qvel, int64_t step) {
        SetJointState state{joint, {}, {}};
        if (!qpos.is_none()) state.qpos = doubles(qpos);
        if (!qvel.is_none()) state.qvel = doubles(qvel);
        post(run, std::move(state), step, nullptr);
      },
      nb::arg("joint"), nb::arg("qpos").none() = nb::none(), nb::arg("qvel").none() = nb::none(),
      nb::arg("step") = kNext);
  c.def(
      "set_mocap",
      [](Run& run, Body body, nb::handle X_WB, int64_t step) {
        post(run, SetMocapPose{body, pose(X_WB)}, step, nullptr);
      },
      nb::arg("body"), nb::arg("pose"), nb::arg("step") = kNext);
  c.def(
      "set_wrench",
      [](Run& run, Body body, nb::handle force, nb::handle torque, int64_t step) {
        post(run, SetWrench{body, vec3(force, "a force"), vec3(torque, "a torque")}, step, nullptr);
      },
      nb::arg("body"), nb::arg("force"), nb::arg("torque"), nb::arg("step") = kNext);
  c.def(
      "add_velocity",
      [](Run& run, Body body, nb::handle velocity, int64_t step) {
        post(run, AddVelocity{body, vec3(velocity, "a velocity")}, step, nullptr);
      },
      nb::arg("body"), nb::arg("velocity"), nb::arg("step") = kNext);
  c.def(
      "set_live_field",
      [](Run& run, const std::string& field, int first, nb::handle values, int64_t step) {
        post(run, SetLiveField{live_field(field), first, doubles(values)}, step, nullptr);
      },
      nb::arg("field"), nb::arg("first"), nb::arg("values"), nb::arg("step") = kNext);
}

nb::list sensor_dicts(const std::vector<SensorCost>& sensors) {
  nb::list list;
  for (const SensorCost& sensor : sensors) {
    nb::dict made;
    made["name"] = sensor.name;
    made["rate"] = sensor.rate;
    made["achieved"] = sensor.achieved;
    made["messages"] = sensor.messages;
    made["dropped"] = sensor.dropped;
    made["wall_ms"] = sensor.wall_ms;
    made["waited_ms"] = sensor.waited_ms;
    list.append(made);
  }
  return list;
}

nb::dict stats_dict(Run& run) {
  Simulation& simulation = run.simulation();
  const SimulationStats stats = without_gil([&] { return simulation.stats(); });
  nb::dict made;
  made["step"] = stats.step;
  made["time"] = stats.time;
  made["hash"] = stats.hash;
  made["realtime_factor"] = stats.realtime_factor;
  made["dropped_snapshots"] = stats.dropped_snapshots;
  made["commands_applied"] = stats.commands_applied;
  made["warnings"] = stats.warnings;
  made["pace"] = to_string(stats.pace);
  made["sensors"] = sensor_dicts(stats.sensors);
  return made;
}

// None: the robot has no actuator models.
nb::object actuator_readings(Run& run, Robot robot) {
  const Snapshot now = run.latest();
  const ActuatorOutputs* outputs = now.actuators(robot);
  if (outputs == nullptr) return nb::none();
  nb::dict made, temperatures, speeds;
  for (const DriveOutput& drive : outputs->drives) {
    temperatures[nb::int_(drive.actuator)] = drive.temperature;
    speeds[nb::int_(drive.actuator)] = drive.speed;
  }
  made["voltage"] = outputs->voltage;
  made["current"] = outputs->current;
  made["charge"] = outputs->charge;
  made["power"] = outputs->power;
  made["energy"] = outputs->energy;
  made["temperatures"] = temperatures;
  made["speeds"] = speeds;
  return made;
}

void bind_view(nb::module_& m) {
  nb::class_<ViewServer>(m, "ViewServer")
      .def_prop_ro("url", &ViewServer::url)
      .def_prop_ro("port", &ViewServer::port)
      .def("stop", &ViewServer::stop, nb::call_guard<nb::gil_scoped_release>());
  m.def(
      "start_view",
      [](Run& run, int port, const std::string& camera, const nb::dict& render) {
        ViewOptions options;
        options.port = port;
        options.camera = camera;
        Keywords keywords(render);
        RenderOptions scene = run.scene_render();
        scene.tier = options.render.tier;  // live, whatever the scene's images are for
        scene.error.reset();
        options.render = render_options(keywords, scene);
        keywords.refuse_others();
        return take(without_gil([&] { return ViewServer::start(run.simulation(), options); }));
      },
      nb::arg("run"), nb::arg("port") = 0, nb::arg("camera") = "free",
      nb::arg("render") = nb::dict(), nb::keep_alive<0, 1>());
}

}  // namespace

void bind_simulation(nb::module_& m) {
  bind_memory(m);
  nb::class_<Checkpoint>(m, "Checkpoint", "An instant to which a simulation can be restored.")
      .def_prop_ro("step", &Checkpoint::step)
      .def_prop_ro("time", &Checkpoint::time)
      .def_prop_ro("seed", &Checkpoint::seed)
      .def_prop_ro("hash", &Checkpoint::hash)
      .def_prop_ro("is_copied", &Checkpoint::is_copied);
  nb::class_<ControlLease>(m, "Lease").def_prop_ro("robot", &ControlLease::robot);
  nb::class_<Run> run(m, "Run", "A running simulation.", nb::type_slots(kept_slots<Run>()));
  run.def_static("create", &create, nb::arg("world"), nb::arg("seed"), nb::arg("timestep"),
                 nb::arg("pace"), nb::arg("speed"), nb::arg("make_data").none() = nb::none())
      .def("close", &Run::close)
      .def_prop_ro("is_closed", &Run::is_closed)
      .def("step", &Run::step, nb::arg("n") = 1)
      .def("run_until", &Run::run_until, nb::arg("step"))
      .def("step_until", &Run::step_until, nb::arg("stream"))
      .def("resume", &Run::resume)
      .def("pause", &Run::pause)
      .def("reset", &Run::reset)
      .def("recompile", &Run::recompile, nb::arg("world"))
      .def("restore", &Run::restore, nb::arg("checkpoint"))
      .def("checkpoint",
           [](Run& r) { return take(without_gil([&] { return r.simulation().checkpoint(); })); })
      .def("watch_model", &Run::watch_model)
      .def("set_hook", &Run::set_hook, nb::arg("hook").none())
      .def("set_pace",
           [](Run& r, const std::string& pace, double speed) {
             if (!(speed > 0)) raise("UsageError", "speed must be positive");
             const Pace wanted = take(enum_named<Pace>(pace));
             Simulation& simulation = r.simulation();
             without_gil([&] { simulation.set_pace(wanted, speed); });
           })
      .def_prop_ro("paused", [](Run& r) { return r.simulation().paused(); })
      .def_prop_ro("world",
                   [](Run& r) { return without_gil([&] { return r.simulation().world(); }); })
      .def_prop_ro("memory", [](Run& r) { return PhysicsMemory(r.memory()); })
      .def_prop_ro("generation", &Run::generation)
      .def_prop_ro("stats", &stats_dict)
      .def("actuator_readings", &actuator_readings)
      .def_prop_ro("latest", &Run::latest)
      .def_prop_ro("time", [](Run& r) { return r.latest().time(); })
      .def_prop_ro("step_count", [](Run& r) { return r.latest().step(); })
      .def_prop_ro("hash", [](Run& r) { return r.latest().hash(); })
      .def_prop_ro("step_rate",
                   [](Run& r) {
                     const Rational rate = r.simulation().step_rate();
                     return nb::make_tuple(rate.num, rate.den);
                   })
      .def(
          "claim",
          [](Run& r, Robot robot) {
            return take(without_gil([&] { return r.simulation().claim(robot); }));
          },
          nb::keep_alive<0, 1>())
      .def("topics",
           [](Run& r) {
             return topic_list(take(without_gil([&] { return r.simulation().topics(); })));
           })
      .def(
          "publish",
          [](Run& r, const std::string& topic, nb::bytes data) {
            const auto* begin = reinterpret_cast<const uint8_t*>(data.c_str());
            r.note_command();
            check(without_gil([&] { return r.simulation().publish(topic, {begin, data.size()}); }));
          })
      .def("labels", [](Run& r) {
        return label_rows(take(without_gil([&] { return r.simulation().labels(); })));
      });
  bind_commands(run);
  bind_joint_commands(run);
  bind_view(m);
}

}  // namespace gloam::python
