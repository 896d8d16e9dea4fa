// Frames of cameras, scans of LiDARs, samples of sensors.

#include "frames.h"

#include <cstring>

#include "gloam/run.h"

namespace gloam::python {
namespace {

using C = CameraFrame;

size_t side(int n) { return static_cast<size_t>(n); }

// A channel as an array over the frame's memory; None where it was not asked for.
template <auto kPlane, size_t kValues>
nb::object channel(nb::handle self) {
  const CameraFrame& frame = *nb::cast<Frame&>(self).data;
  const auto& plane = frame.*kPlane;
  const size_t rows = side(frame.intrinsics.height), columns = side(frame.intrinsics.width);
  if (plane.empty()) return nb::none();
  if constexpr (kValues == 1) {
    return array_over(plane.data(), {rows, columns}, self);
  } else {
    return array_over(plane.data(), {rows, columns, kValues}, self);
  }
}

// Behind a mosaic one number a pixel, else three.
nb::object raw_channel(nb::handle self) {
  const CameraFrame& frame = *nb::cast<Frame&>(self).data;
  const size_t pixels = side(frame.intrinsics.height) * side(frame.intrinsics.width);
  return frame.raw.size() == pixels ? channel<&C::raw, 1>(self) : channel<&C::raw, 3>(self);
}

nb::object matrix_k(const CameraFrame& frame) {
  const Intrinsics& k = frame.intrinsics;
  return new_array<double>({k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1}, {3, 3});
}

nb::list events_of(const CameraFrame& frame) {
  nb::list list;
  for (const Event& event : frame.events)
    list.append(nb::make_tuple(event.x, event.y, event.brighter, event.time));
  return list;
}

nb::list objects_of(const CameraFrame& frame) {
  nb::list list;
  for (const ObjectView& object : frame.objects) {
    nb::dict made;
    made["instance"] = object.instance;
    made["name"] = object.name;
    made["semantic"] = object.semantic;
    made["pixels"] = object.seen.pixels;
    made["box"] = nb::make_tuple(object.seen.u0, object.seen.v0, object.seen.u1, object.seen.v1);
    made["whole_box"] = nb::make_tuple(object.all.u0, object.all.v0, object.all.u1, object.all.v1);
    made["visibility"] = object.visibility();
    made["pose"] = pose_tuple(object.X_WO);
    made["center"] = nb::make_tuple(object.center.x, object.center.y, object.center.z);
    made["size"] = nb::make_tuple(object.size.x, object.size.y, object.size.z);
    list.append(made);
  }
  return list;
}

void bind_frame(nb::module_& m) {
  const auto of = [](auto member) {
    return [member](const Frame& frame) { return (*frame.data).*member; };
  };
  nb::class_<Frame>(m, "Frame", "One frame of one camera; all channels use the same rays.")
      .def_prop_ro("camera", of(&C::camera))
      .def_prop_ro("index", of(&C::index))
      .def_prop_ro("step", of(&C::step))
      .def_prop_ro("stamp", of(&C::time))
      .def_prop_ro("delivery", of(&C::delivery))
      .def_prop_ro("warmup", of(&C::warmup))
      .def_prop_ro("ev100", of(&C::ev100))
      .def_prop_ro("exposure_time", of(&C::exposure_time))
      .def_prop_ro("readout_time", of(&C::readout_time))
      .def_prop_ro("width", [](const Frame& f) { return f.data->intrinsics.width; })
      .def_prop_ro("height", [](const Frame& f) { return f.data->intrinsics.height; })
      .def_prop_ro("pose", [](const Frame& f) { return pose_tuple(f.data->X_WC); })
      .def_prop_ro("K", [](const Frame& f) { return matrix_k(*f.data); })
      .def_prop_ro("info",
                   [](const Frame& f) {
                     const CameraInfo info = camera_info(f.data->camera, f.data->intrinsics);
                     nb::dict made;
                     made["frame_id"] = info.frame_id;
                     made["distortion_model"] = info.distortion_model;
                     made["d"] = info.d;
                     return made;
                   })
      .def_prop_ro("rgb", &channel<&C::rgb, 3>)
      .def_prop_ro("radiance", &channel<&C::radiance, 3>)
      .def_prop_ro("depth", &channel<&C::depth, 1>)
      .def_prop_ro("distance", &channel<&C::distance, 1>)
      .def_prop_ro("part", &channel<&C::part, 1>)
      .def_prop_ro("instance", &channel<&C::instance, 1>)
      .def_prop_ro("semantic", &channel<&C::semantic, 1>)
      .def_prop_ro("normal", &channel<&C::normal, 3>)
      .def_prop_ro("albedo", &channel<&C::albedo, 3>)
      .def_prop_ro("samples", &channel<&C::samples, 1>)
      .def_prop_ro("motion", &channel<&C::motion, 2>)
      .def_prop_ro("raw", &raw_channel)
      .def_prop_ro("sensor_depth", &channel<&C::sensor_depth, 1>)
      .def_prop_ro("thermal", &channel<&C::thermal, 1>)
      .def_prop_ro("scene_flow", &channel<&C::scene_flow, 3>)
      .def_prop_ro("events", [](const Frame& f) { return events_of(*f.data); })
      .def_prop_ro("objects", [](const Frame& f) { return objects_of(*f.data); })
      .def(
          "write",
          [](const Frame& f, const std::filesystem::path& folder, const std::string& name) {
            return take(without_gil([&] { return write_frame(*f.data, folder, name); }));
          },
          nb::arg("folder"), nb::arg("name"));
}

template <auto kMember>
nb::object returns(nb::handle self) {
  const LidarScan& scan = *nb::cast<Scan&>(self).data;
  const auto& values = scan.*kMember;
  return array_over(values.data(), {values.size()}, self);
}

using L = LidarScan;

nb::object points_of(const Scan& scan) {
  const LidarScan& s = *scan.data;
  std::vector<float> points(3 * s.size());
  for (size_t i = 0; i < s.size(); ++i) {
    points[3 * i] = s.x[i];
    points[3 * i + 1] = s.y[i];
    points[3 * i + 2] = s.z[i];
  }
  return new_array<float>(std::move(points), {s.size(), 3});
}

void bind_scan(nb::module_& m) {
  const auto of = [](auto member) {
    return [member](const Scan& scan) { return (*scan.data).*member; };
  };
  nb::class_<Scan>(m, "Scan", "One scan of a LiDAR, with returns in firing order.")
      .def_prop_ro("lidar", of(&L::lidar))
      .def_prop_ro("index", of(&L::index))
      .def_prop_ro("step", of(&L::step))
      .def_prop_ro("start", of(&L::start))
      .def_prop_ro("stamp", of(&L::end))
      .def_prop_ro("rings", of(&L::rings))
      .def_prop_ro("columns", of(&L::columns))
      .def_prop_ro("beams", of(&L::beams))
      .def_prop_ro("deskewed", of(&L::deskewed))
      .def_prop_ro("pose_start", [](const Scan& s) { return pose_tuple(s.data->X_WL_start); })
      .def_prop_ro("pose", [](const Scan& s) { return pose_tuple(s.data->X_WL_end); })
      .def_prop_ro("points", &points_of)
      .def_prop_ro("x", &returns<&L::x>)
      .def_prop_ro("y", &returns<&L::y>)
      .def_prop_ro("z", &returns<&L::z>)
      .def_prop_ro("intensity", &returns<&L::intensity>)
      .def_prop_ro("range", &returns<&L::range>)
      .def_prop_ro("time", &returns<&L::time>)
      .def_prop_ro("ring", &returns<&L::ring>)
      .def_prop_ro("column", &returns<&L::column>)
      .def_prop_ro("return_number", &returns<&L::return_number>)
      .def_prop_ro("part", &returns<&L::part>)
      .def_prop_ro("instance", &returns<&L::instance>)
      .def_prop_ro("semantic", &returns<&L::semantic>)
      .def("__len__", [](const Scan& s) { return s.data->size(); });
}

}  // namespace

nb::list label_rows(const std::vector<LabelRow>& rows) {
  nb::list list;
  for (const LabelRow& row : rows) {
    nb::dict made;
    made["part"] = row.part;
    made["geom"] = row.geom;
    made["body"] = row.body;
    made["material"] = row.material;
    made["instance"] = row.instance;
    made["instance_name"] = row.instance_name;
    made["semantic"] = row.semantic;
    made["semantic_name"] = row.semantic_name;
    list.append(made);
  }
  return list;
}

void bind_frames(nb::module_& m) {
  bind_frame(m);
  bind_scan(m);
  nb::class_<SensorMessage>(m, "Sample", "One sample of one sensor.")
      .def_ro("sensor", &SensorMessage::sensor)
      .def_ro("index", &SensorMessage::index)
      .def_ro("step", &SensorMessage::step)
      .def_ro("stamp", &SensorMessage::time)
      .def_ro("delivery", &SensorMessage::delivery)
      .def_prop_ro("values", [](nb::handle self) {
        const auto& values = nb::cast<SensorMessage&>(self).values;
        return array_over(values.data(), {values.size()}, self);
      });
}

}  // namespace gloam::python
