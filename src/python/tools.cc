// Questions about files: meshes, models, trajectories, reports of runs.

#include <numbers>

#include "core.h"
#include "gloam/log_export.h"
#include "gloam/model_tools.h"
#include "gloam/report.h"
#include "gloam/scene.h"
#include "gloam/trajectory.h"
#include "gloam/view.h"

namespace gloam::python {
namespace {

nb::dict convert(const std::filesystem::path& mesh, nb::object progress,
                 const std::filesystem::path& root, bool strict) {
  ObjectOptions object;
  object.name = "object";
  object.file = mesh;
  const FileAccess access{.root = root, .strict = strict};
  const ObjectReport report = with_progress(
      std::move(progress),
      [&](const ProgressCallback& callback) { return convert_object(object, access, callback); });
  nb::dict made;
  made["colliders"] = report.colliders;
  made["triangles"] = report.triangles;
  made["is_closed"] = report.is_closed;
  made["size"] = nb::make_tuple(report.size.x, report.size.y, report.size.z);
  made["volume"] = report.volume;
  made["mass"] = report.mass;
  made["shared"] = report.shared;
  made["mean_distance"] = report.mean_distance;
  made["max_distance"] = report.max_distance;
  made["notes"] = report.notes;
  return made;
}

nb::dict check_file(const std::filesystem::path& file, const std::filesystem::path& folder,
                    const std::filesystem::path& root, bool strict) {
  const FileAccess access{.root = root, .strict = strict};
  const ModelCheck result = without_gil([&] { return check_model(file, access, folder); });
  check(result.status);
  nb::dict made;
  made["passed"] = result.passed();
  made["bodies"] = result.bodies;
  made["joints"] = result.joints;
  made["geoms"] = result.geoms;
  made["compared"] = result.compared;
  made["unlike_stock"] = result.unlike_stock;
  made["unlike_export"] = result.unlike_export;
  made["export_reason"] = result.export_reason;
  return made;
}

Trajectory trajectory_of(nb::handle times, nb::handle poses, const std::string& name) {
  const std::vector<double> t = doubles(times), x = doubles(poses);
  if (x.size() != 7 * t.size())
    throw nb::value_error("poses must have the shape (n, 7): x, y, z, qw, qx, qy, qz, for n times");
  std::vector<StampedPose> list;
  for (size_t i = 0; i < t.size(); ++i) {
    const double* p = x.data() + 7 * i;
    list.push_back({static_cast<int64_t>(t[i] * 1e9 + (t[i] < 0 ? -0.5 : 0.5)),
                    {{p[0], p[1], p[2]}, {p[3], p[4], p[5], p[6]}}});
  }
  return take(make_trajectory(list, name));
}

Alignment alignment_of(const std::string& name) {
  const std::vector<std::string> names = {"none", "origin", "se3", "sim3", "scale"};
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Alignment>(i);
  raise("UsageError", "there is no alignment '" + name + "'",
        "one of: none, origin, se3, sim3, scale");
}

nb::dict statistics_dict(const PoseErrors& errors) {
  const ErrorStatistics& s = errors.statistics;
  nb::dict made;
  made["rmse"] = s.rmse;
  made["mean"] = s.mean;
  made["median"] = s.median;
  made["std"] = s.std;
  made["min"] = s.min;
  made["max"] = s.max;
  made["sse"] = s.sse;
  made["count"] = errors.values.size();
  made["values"] = new_array<double>(std::vector<double>(errors.values), {errors.values.size()});
  return made;
}

DeltaUnit unit_of(const std::string& name) {
  if (name == "m") return DeltaUnit::kMeters;
  if (name == "f") return DeltaUnit::kFrames;
  if (name == "s") return DeltaUnit::kSeconds;
  if (name == "deg" || name == "rad") return DeltaUnit::kRadians;
  raise("UsageError", "there is no rpe_unit '" + name + "'", "one of: m, f, s, deg, rad");
}

// As the JSON of `gloam evaluate` has them.
Result<nb::dict> parts_dict(const std::function<Result<PoseErrors>(ErrorPart)>& errors) {
  constexpr std::pair<const char*, ErrorPart> kParts[] = {
      {"translation_m", ErrorPart::kTranslation},
      {"angle_rad", ErrorPart::kAngle},
      {"full", ErrorPart::kFull}};
  nb::dict made;
  for (const auto& [name, part] : kParts) {
    GLOAM_TRY(const PoseErrors found, errors(part));
    made[name] = statistics_dict(found);
  }
  return made;
}

nb::dict evaluate(const Trajectory& estimate, const Trajectory& reference,
                  const nb::dict& options) {
  Keywords keywords(options);
  std::string alignment = "se3", unit = "m";
  AssociationOptions association;
  RelativeOptions relative;
  std::optional<double> delta;
  keywords.read("align", &alignment);
  keywords.read("max_difference", &association.max_difference);
  keywords.read("offset", &association.offset);
  keywords.read("rpe_unit", &unit);
  keywords.read("rpe_delta", &delta);
  keywords.read("all_pairs", &relative.all_pairs);
  keywords.read("rpe_tolerance", &relative.tolerance);
  keywords.refuse_others();
  relative.unit = unit_of(unit);
  relative.delta = delta.value_or(1);
  if (unit == "deg") relative.delta *= std::numbers::pi / 180;
  TrajectoryPair pair = take(associate(reference, estimate, association));
  const Similarity X = take(align(alignment_of(alignment), &pair));
  nb::dict made, by;
  by["by"] = alignment;
  by["rotation_rows"] = std::vector<double>(X.R_AB.begin(), X.R_AB.end());
  by["translation_m"] = std::vector<double>{X.p_AB.x, X.p_AB.y, X.p_AB.z};
  by["scale"] = X.scale;
  made["align"] = by;
  made["reference_poses"] = reference.size();
  made["estimate_poses"] = estimate.size();
  made["pairs"] = pair.reference.size();
  made["reference_length_m"] = pair.reference.path_length();
  made["estimate_length_m"] = pair.estimate.path_length();
  made["ate"] = take(parts_dict([&](ErrorPart part) { return absolute_errors(pair, part); }));
  auto rpe = parts_dict([&](ErrorPart part) { return relative_errors(pair, part, relative); });
  // A delta that was asked for must be there; the usual one may be longer than the way.
  if (!rpe.ok() && delta) raise(rpe.error());
  made["rpe"] = nb::none();
  if (!rpe.ok()) return made;
  (*rpe)["delta"] = delta.value_or(1);
  (*rpe)["delta_unit"] = unit;
  (*rpe)["all_pairs"] = relative.all_pairs;
  made["rpe"] = *rpe;
  return made;
}

nb::dict robot_dict(const RobotModelInfo& robot) {
  nb::dict sensors;
  for (const RobotModelSensor& sensor : robot.sensors) sensors[sensor.name.c_str()] = sensor.kind;
  nb::dict made;
  made["name"] = robot.name;
  made["description"] = robot.description;
  made["file"] = robot.file;
  made["model"] = robot.defaults.file;
  made["keyframe"] = robot.defaults.keyframe;
  made["controller"] = robot.defaults.controller.type;
  made["sensors"] = sensors;
  made["joints"] = robot.joints;
  made["actuators"] = robot.actuators;
  made["floating"] = robot.is_floating;
  made["mass"] = robot.mass;
  return made;
}

void bind_robots(nb::module_& m) {
  m.def("robot_models", [] {
    nb::list list;
    for (const RobotModelInfo& robot : take(without_gil([] { return robot_models(); })))
      list.append(robot_dict(robot));
    return list;
  });
  m.def(
      "robot_model",
      [](const std::string& model, const std::filesystem::path& root, bool strict) {
        const FileAccess access{.root = root, .strict = strict};
        return robot_dict(take(without_gil([&] { return robot_model(model, access); })));
      },
      nb::arg("model"), nb::arg("root") = std::filesystem::path(), nb::arg("strict") = false);
  m.def(
      "guess_robot",
      [](const std::filesystem::path& file, const std::filesystem::path& root, bool strict) {
        const FileAccess access{.root = root, .strict = strict};
        const RobotGuess guess = take(without_gil([&] { return guess_robot(file, access); }));
        return nb::make_tuple(guess.kind, guess.toml);
      },
      nb::arg("file"), nb::arg("root") = std::filesystem::path(), nb::arg("strict") = false);
}

}  // namespace

void bind_tools(nb::module_& m) {
  bind_robots(m);
  nb::class_<Trajectory>(m, "Trajectory")
      .def_static(
          "read",
          [](const std::filesystem::path& file) { return take(read_trajectory_file(file)); })
      .def_static("make", &trajectory_of, nb::arg("times"), nb::arg("poses"),
                  nb::arg("name") = "trajectory")
      .def_prop_ro("name", [](const Trajectory& t) { return t.name; })
      .def_prop_ro("path_length", &Trajectory::path_length)
      .def_prop_ro("notes", [](const Trajectory& t) { return t.notes; })
      .def("__len__", &Trajectory::size);
  m.def("evaluate", &evaluate, nb::arg("estimate"), nb::arg("reference"), nb::arg("options"));
  m.def("trajectory_topics",
        [](const std::filesystem::path& log) { return take(trajectory_topics(log)); });
  m.def("convert_object", &convert, nb::arg("mesh"), nb::arg("progress").none() = nb::none(),
        nb::arg("root") = std::filesystem::path(), nb::arg("strict") = false);
  m.def("check_model", &check_file, nb::arg("file"), nb::arg("folder"),
        nb::arg("root") = std::filesystem::path(), nb::arg("strict") = false);
  m.def(
      "write_report",
      [](const std::vector<std::filesystem::path>& runs, const std::filesystem::path& out,
         bool overwrite, const std::string& title) {
        ReportRequest request;
        request.runs = runs;
        request.out = out;
        request.overwrite = overwrite;
        request.title = title;
        const ReportOutcome outcome = take(without_gil([&] { return write_report(request); }));
        std::vector<std::string> left_out;
        for (const Error& error : outcome.left_out) left_out.push_back(error.to_string());
        return nb::make_tuple(outcome.runs, outcome.pictures, left_out);
      },
      nb::arg("runs"), nb::arg("out"), nb::arg("overwrite") = false, nb::arg("title") = "");
  m.def(
      "encode_jpeg",
      [](nb::ndarray<const uint8_t, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu> rgb,
         int quality) {
        const auto bytes =
            take(encode_jpeg(static_cast<int>(rgb.shape(1)), static_cast<int>(rgb.shape(0)),
                             {rgb.data(), rgb.size()}, quality));
        return nb::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      },
      nb::arg("rgb"), nb::arg("quality") = 88);
}

}  // namespace gloam::python
