// Snapshots: instants of a World, numbers that are computed from them, and images of them.

#include "gloam/snapshot.h"

#include <mutex>

#include "core.h"
#include "frames.h"
#include "gloam/render.h"
#include "streams.h"

namespace gloam::python {
namespace {

nb::object three(const Vec3& v) { return new_array<double>({v.x, v.y, v.z}, {3}); }

/// Poses, velocities, forces and contacts of Snapshots.
class Solver {
 public:
  const Instant& at(const Snapshot& now) {
    check(instant_.solve(now));
    return instant_;
  }

 private:
  Instant instant_;
};

/// A renderer of one World that Python keeps, for images of instants. Threads take turns.
class Painter {
 public:
  explicit Painter(const World& world)
      : renderer_(take(without_gil([&] { return SceneRenderer::create(world); }))) {}
  Frame paint(const Snapshot& now, const nb::dict& options, int64_t index) {
    const CameraRequest request = camera_request(options, now.world().scene().render);
    return {take(without_gil([&] {
      const std::lock_guard lock(mutex_);
      return renderer_.render({&now, 1}, request, index);
    }))};
  }

 private:
  std::mutex mutex_;
  SceneRenderer renderer_;
};

nb::list contact_list(const Instant& instant) {
  nb::list list;
  for (const ContactState& contact : instant.contacts()) {
    nb::dict made;
    made["geoms"] = nb::make_tuple(contact.geoms[0].id, contact.geoms[1].id);
    made["position"] = three(contact.position);
    made["normal"] = three(contact.normal);
    made["distance"] = contact.distance;
    made["force"] = three(contact.force);
    made["torque"] = three(contact.torque);
    list.append(made);
  }
  return list;
}

Snapshot at_rest(const World& world, nb::handle qpos, double time, const std::vector<Pose>& mocap) {
  const std::vector<double> numbers = doubles(qpos);
  return take(without_gil([&] { return world.snapshot(numbers, time, mocap); }));
}

void bind_solver(nb::module_& m) {
  nb::class_<Solver>(m, "Solver")
      .def(nb::init<>())
      .def("body",
           [](Solver& solver, const Snapshot& now, Body body) {
             const BodyState state = take(solver.at(now).body(body));
             return nb::make_tuple(pose_tuple(state.X_WB), three(state.velocity),
                                   three(state.angular_velocity));
           })
      .def("force", [](Solver& solver, const Snapshot& now,
                       Actuator a) { return take(solver.at(now).force(a)); })
      .def("contacts",
           [](Solver& solver, const Snapshot& now) { return contact_list(solver.at(now)); })
      .def(
          "value",
          [](Solver& solver, const Snapshot& now, const std::string& field,
             const std::string& element) {
            std::vector<double> numbers = take(solver.at(now).value(field, element));
            const size_t n = numbers.size();
            return new_array<double>(std::move(numbers), {n});
          },
          nb::arg("snapshot"), nb::arg("field"), nb::arg("element") = "");
}

}  // namespace

void bind_snapshots(nb::module_& m) {
  nb::class_<Snapshot>(m, "Snapshot", "One instant of a World; it never changes.")
      .def_prop_ro("step", &Snapshot::step)
      .def_prop_ro("time", &Snapshot::time)
      .def_prop_ro("hash", &Snapshot::hash)
      .def(
          "posed",
          [](const Snapshot& now, nb::handle qpos) {
            return at_rest(now.world(), qpos, now.time(), now.mocap_poses());
          },
          nb::arg("qpos"),
          "At rest in another configuration, with the time and the mocap bodies of this one.");
  m.def(
      "snapshot_at_rest",
      [](const World& world, nb::handle qpos, double time, const nb::object& mocap) {
        std::vector<Pose> poses;
        if (!mocap.is_none())
          for (const nb::handle X_WB : mocap) poses.push_back(pose(X_WB));
        return at_rest(world, qpos, time, poses);
      },
      nb::arg("world"), nb::arg("qpos"), nb::arg("time") = 0.0,
      nb::arg("mocap").none() = nb::none());
  bind_solver(m);
  nb::class_<Painter>(m, "Painter")
      .def(nb::init<const World&>())
      .def("paint", &Painter::paint, nb::arg("snapshot"), nb::arg("options"), nb::arg("index") = 0);
}

}  // namespace gloam::python
