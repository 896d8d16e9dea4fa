// Compiled worlds: names, handles, lists.

#include "gloam/world.h"

#include "core.h"
#include "gloam/options.h"
#include "gloam/topics.h"
#include "handles.h"

namespace gloam::python {
namespace {

template <class H>
void bind_handle(nb::module_& m, const char* name) {
  nb::class_<H>(m, name).def_ro("id", &H::id).def("__eq__", [](const H& a, const H& b) {
    return a.id == b.id && a.world == b.world;
  });
}

std::vector<std::string> names_of(const std::vector<NamedElement>& elements) {
  std::vector<std::string> names;
  for (const NamedElement& element : elements) names.push_back(element.name);
  return names;
}

nb::dict info_dict(const World& world) {
  const WorldInfo info = without_gil([&] { return world.info(); });
  nb::dict made;
  const auto add = [&](const char* key, const std::vector<NamedElement>& list) {
    made[key] = names_of(list);
  };
  add("bodies", info.bodies);
  add("joints", info.joints);
  add("actuators", info.actuators);
  add("sensors", info.sensors);
  nb::list probes;
  for (const ProbeOptions& probe : world.scene().probes) probes.append(probe.name);
  made["probes"] = probes;
  add("cameras", info.cameras);
  add("geoms", info.geoms);
  add("sites", info.sites);
  add("tendons", info.tendons);
  add("lights", info.lights);
  add("materials", info.materials);
  add("keyframes", info.keyframes);
  made["nq"] = info.nq;
  made["nv"] = info.nv;
  made["nu"] = info.nu;
  made["timestep"] = info.timestep;
  made["mass"] = info.mass;
  made["model_bytes"] = info.model_bytes;
  made["triangles"] = info.triangles;
  nb::dict drawn;
  for (const DrawnOption& option : info.drawn) drawn[option.option.c_str()] = option.value;
  made["drawn"] = drawn;
  return made;
}

nb::list stream_list(const World& world) {
  nb::list list;
  for (const StreamInfo& stream : world.streams()) {
    nb::dict made;
    made["kind"] = to_string(stream.kind);
    made["name"] = stream.name;
    made["frame_id"] = stream.frame_id;
    made["rate"] = stream.rate.value();
    made["outputs"] = stream.outputs;
    made["unit"] = stream.unit;
    list.append(made);
  }
  return list;
}

nb::list input_list(const World& world) {
  nb::list list;
  for (const InputInfo& input : world.inputs()) {
    nb::dict made;
    made["kind"] = to_string(input.kind);
    made["name"] = input.name;
    made["elements"] = input.elements;
    made["count"] = input.count;
    made["low"] = input.low;
    made["high"] = input.high;
    made["unit"] = input.unit;
    list.append(made);
  }
  return list;
}

nb::list metric_list(const World& world) {
  nb::list list;
  for (const MetricInfo& metric : take(world.metrics())) {
    nb::dict made;
    made["name"] = metric.name;
    made["unit"] = metric.unit;
    made["robot"] = metric.robot;
    made["declared"] = metric.declared;
    list.append(made);
  }
  return list;
}

std::vector<std::string> texts(const std::vector<Error>& errors) {
  std::vector<std::string> list;
  for (const Error& error : errors) list.push_back(error.to_string());
  return list;
}

}  // namespace

nb::list topic_list(const std::vector<TopicInfo>& topics) {
  nb::list list;
  for (const TopicInfo& topic : topics) {
    nb::dict made;
    made["name"] = topic.name;
    made["type"] = topic.type;
    made["frame_id"] = topic.frame_id;
    made["rate"] = topic.rate.value();
    made["is_input"] = topic.is_input;
    made["is_logged"] = topic.is_logged;
    made["is_latched"] = topic.qos.is_latched;
    made["is_large"] = topic.is_large;
    made["source_kind"] = to_string(topic.source.kind);
    made["source_name"] = topic.source.name;
    list.append(made);
  }
  return list;
}

void bind_world(nb::module_& m) {
  bind_handle<Joint>(m, "JointHandle");
  bind_handle<Body>(m, "BodyHandle");
  bind_handle<Actuator>(m, "ActuatorHandle");
  bind_handle<SensorHandle>(m, "SensorHandle");
  bind_handle<Geom>(m, "GeomHandle");
  bind_handle<Tendon>(m, "TendonHandle");
  bind_handle<Robot>(m, "RobotHandle");
  nb::class_<RobotInfo>(m, "RobotInfo")
      .def_ro("name", &RobotInfo::name)
      .def_ro("robot", &RobotInfo::robot)
      .def_ro("root", &RobotInfo::root)
      .def_ro("joints", &RobotInfo::joints)
      .def_ro("actuators", &RobotInfo::actuators);
  nb::class_<World>(m, "World", "A compiled Scene; it never changes.")
      .def_static(
          "compile",
          [](const Scene& scene, nb::object progress, const std::string& keyframe) {
            return with_progress(std::move(progress), [&](const ProgressCallback& callback) {
              return keyframe.empty() ? World::compile(scene, callback)
                                      : World::compile_at(scene, keyframe, callback);
            });
          },
          nb::arg("scene"), nb::arg("progress").none() = nb::none(), nb::arg("keyframe") = "")
      .def("find_joint", [](const World& w, const std::string& n) { return take(w.find_joint(n)); })
      .def("find_body", [](const World& w, const std::string& n) { return take(w.find_body(n)); })
      .def("find_actuator",
           [](const World& w, const std::string& n) { return take(w.find_actuator(n)); })
      .def("find_sensor",
           [](const World& w, const std::string& n) { return take(w.find_sensor(n)); })
      .def("find_robot", [](const World& w, const std::string& n) { return take(w.find_robot(n)); })
      .def("info", &info_dict)
      .def("robots", &World::robots)
      .def("streams", &stream_list)
      .def("inputs", &input_list)
      .def("live_field",
           [](const World& world, const std::string& name) {
             std::vector<double> numbers = take(world.live_field(name));
             const size_t n = numbers.size();
             return new_array<double>(std::move(numbers), {n});
           })
      .def("metrics", &metric_list)
      .def("topics", [](const World& world) { return topic_list(take(list_topics(world))); })
      .def("notes", [](const World& w) { return texts(without_gil([&] { return w.notes(); })); })
      .def("unsupported", [](const World& w) { return texts(w.unsupported()); })
      .def("written_scene", [](const World& w) { return written_scene(w); })
      .def("export_mjcf", [](const World& world, const std::filesystem::path& folder) {
        std::vector<Error> left_out;
        check(without_gil([&] { return world.export_mjcf(folder, &left_out); }));
        return texts(left_out);
      });
  m.def("message_info", [](const std::string& type) {
    const MessageInfo info = take(message_info(type));
    return nb::make_tuple(info.dds_name, info.definition, info.hash);
  });
}

}  // namespace gloam::python
