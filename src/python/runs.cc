// Batch runs, stills, comparisons.

#include "gloam/run.h"

#include "frames.h"
#include "reports.h"
#include "streams.h"

namespace gloam::python {
namespace {

nb::list stills(const World& world, double time, const nb::list& requests, nb::object progress) {
  std::vector<CameraRequest> wanted;
  for (const nb::handle request : requests)
    wanted.push_back(camera_request(nb::cast<nb::dict>(request), world.scene().render));
  auto frames = with_progress(std::move(progress), [&](const ProgressCallback& callback) {
    return render_stills(world, time, wanted, callback);
  });
  nb::list list;
  for (CameraFrame& frame : frames)
    list.append(nb::cast(Frame{std::make_shared<CameraFrame>(std::move(frame))}));
  return list;
}

}  // namespace

RunRequest run_request(const nb::dict& options) {
  Keywords keywords(options);
  RunRequest request;
  keywords.read("out", &request.out);
  keywords.read("overwrite", &request.overwrite);
  keywords.read("cameras", &request.cameras);
  keywords.read("width", &request.width);
  keywords.read("height", &request.height);
  keywords.read("duration", &request.duration);
  keywords.read("seed", &request.simulation.seed);
  keywords.read("timestep", &request.simulation.timestep);
  double rate = 0;
  keywords.read("rate", &rate);
  keywords.read("mcap", &request.log.file);
  keywords.read("topics", &request.log.topics);
  keywords.refuse_others();
  request.rate = rational(rate);
  return request;
}

nb::dict report_dict(const RunReport& report) {
  nb::dict results;
  for (const auto& [name, value] : report.results) results[name.c_str()] = value;
  nb::dict made;
  made["out"] = report.out;
  made["steps"] = report.steps;
  made["sim_time"] = report.sim_time;
  made["wall_time"] = report.wall_time;
  made["hash"] = report.hash;
  made["frames"] = report.frames;
  made["written"] = report.written;
  made["results"] = results;
  made["notes"] = report.notes;
  made["error"] = report.status.ok() ? std::string() : report.status.error().to_string();
  return made;
}

void bind_runs(nb::module_& m) {
  m.def("set_record_outputs", [](Scene& scene, const std::vector<std::string>& outputs) {
    set_record_outputs(outputs, &scene);
  });
  m.def(
      "run_and_record",
      [](const World& world, const nb::dict& options, nb::object progress) {
        const RunRequest request = run_request(options);
        return report_dict(
            with_progress(std::move(progress), [&](const ProgressCallback& callback) {
              return run_and_record(world, request, callback);
            }));
      },
      nb::arg("world"), nb::arg("options"), nb::arg("progress").none() = nb::none());
  m.def("render_stills", &stills, nb::arg("world"), nb::arg("time"), nb::arg("requests"),
        nb::arg("progress").none() = nb::none());
}

}  // namespace gloam::python
