// Logs: written, read, verified, played again.

#include "gloam/log.h"

#include "core.h"
#include "gloam/log_export.h"
#include "gloam/log_player.h"
#include "gloam/log_replay.h"
#include "gloam/report.h"
#include "reports.h"
#include "run.h"
#include "streams.h"

namespace gloam::python {
namespace {

std::unique_ptr<LogStream> start(Run& run, const std::filesystem::path& file,
                                 const nb::dict& options) {
  Keywords keywords(options);
  LogRequest request;
  request.file = file;
  keywords.read("overwrite", &request.overwrite);
  keywords.read("required", &request.required);
  keywords.read("durable", &request.durable);
  keywords.read("embed", &request.embed);
  keywords.read("topics", &request.topics);
  keywords.read("width", &request.width);
  keywords.read("height", &request.height);
  double state_rate = request.state_rate.value();
  keywords.read("state_rate", &state_rate);
  keywords.refuse_others();
  request.state_rate = rational(state_rate);
  return take(without_gil([&] { return start_log(run.simulation(), request); }));
}

nb::dict describe(const std::filesystem::path& file) {
  const LogInfo info = take(without_gil([&] { return describe_log(file); }));
  nb::list topics;
  for (const LoggedTopic& topic : info.topics) {
    nb::dict made;
    made["name"] = topic.name;
    made["type"] = topic.type;
    made["messages"] = topic.messages;
    made["rate"] = topic.rate;
    topics.append(made);
  }
  nb::dict made;
  made["profile"] = info.profile;
  made["library"] = info.library;
  made["bytes"] = info.bytes;
  made["messages"] = info.messages;
  made["start"] = info.start;
  made["duration"] = info.duration;
  made["topics"] = topics;
  made["has_run"] = info.has_run;
  made["scene"] = info.scene;
  made["damage"] = info.damage;
  return made;
}

nb::dict verify(const std::filesystem::path& file, const std::string& folder, nb::object progress) {
  const LogVerification result = with_progress(
      std::move(progress),
      [&](const ProgressCallback& callback) { return verify_log(file, folder, callback); });
  nb::dict made;
  made["runs"] = result.runs;
  made["steps"] = result.steps;
  made["states"] = result.states;
  made["differing_steps"] = result.differing;
  made["run"] = result.run;
  made["equal_step"] = result.equal_step;
  made["step"] = result.step;
  made["where"] = result.where;
  made["notes"] = result.notes;
  return made;
}

ReplayMotion motion_of(const std::string& name) {
  if (name == "stepped") return ReplayMotion::kStepped;
  if (name == "poses") return ReplayMotion::kPoses;
  if (name == "new_run") return ReplayMotion::kNewRun;
  raise("UsageError", "there is no motion '" + name + "'", "one of: stepped, poses, new_run");
}

LogReplay replay_of(const std::filesystem::path& file, const nb::dict& options) {
  LogReplay replay;
  replay.log = file;
  Keywords keywords(options);
  std::string folder, motion = "stepped";
  keywords.read("folder", &folder);
  keywords.read("run", &replay.run);
  keywords.read("overlays", &replay.overlays);
  keywords.read("draw_seed", &replay.draw_seed);
  keywords.read("settings", &replay.settings);
  keywords.read("outputs", &replay.outputs);
  keywords.read("motion", &motion);
  nb::dict request;
  keywords.read("request", &request);
  keywords.refuse_others();
  replay.folder = folder;
  replay.motion = motion_of(motion);
  replay.request = run_request(request);
  return replay;
}

nb::list variants(const std::filesystem::path& file, const nb::dict& options,
                  const std::filesystem::path& randomize, int64_t count, uint64_t first_seed,
                  nb::object progress) {
  const VariantRequest request{replay_of(file, options), randomize, count, first_seed};
  nb::list list;
  for (const ReplayVariant& variant : with_progress(
           std::move(progress),
           [&](const ProgressCallback& callback) { return replay_variants(request, callback); })) {
    nb::dict made;
    made["seed"] = variant.seed;
    made["out"] = variant.out;
    made["was_done"] = variant.was_done;
    list.append(made);
  }
  return list;
}

int64_t export_topic(const std::filesystem::path& log, const std::string& topic,
                     const std::filesystem::path& to, const std::string& format) {
  using Writer = Result<int64_t> (*)(const std::filesystem::path&, const std::string&,
                                     const std::filesystem::path&);
  const std::vector<std::pair<std::string, Writer>> writers = {{"csv", &write_topic_table},
                                                               {"parquet", &write_topic_parquet},
                                                               {"png", &write_topic_pictures},
                                                               {"mp4", &write_topic_video}};
  for (const auto& [name, writer] : writers)
    if (name == format) return take(without_gil([&, w = writer] { return w(log, topic, to); }));
  raise("UsageError", "there is no format '" + format + "'", "one of: csv, parquet, png, mp4");
}

nb::tuple trajectory(const std::filesystem::path& log, const std::string& topic) {
  const auto poses = take(without_gil([&] { return read_trajectory(log, topic); }));
  std::vector<double> times, numbers;
  for (const StampedPose& pose : poses) {
    times.push_back(1e-9 * static_cast<double>(pose.stamp));
    const Pose& X = pose.X_AB;
    numbers.insert(numbers.end(), {X.p.x, X.p.y, X.p.z, X.q.w, X.q.x, X.q.y, X.q.z});
  }
  const size_t n = poses.size();
  return nb::make_tuple(new_array<double>(std::move(times), {n}),
                        new_array<double>(std::move(numbers), {n, 7}));
}

}  // namespace

void bind_logs(nb::module_& m) {
  nb::class_<LogStream>(m, "LogStream")
      .def_prop_ro("dropped", &LogStream::dropped)
      .def("finish", [](LogStream& log) { check(without_gil([&] { return log.finish(); })); });
  m.def("start_log", &start, nb::arg("run"), nb::arg("file"), nb::arg("options"),
        nb::keep_alive<0, 1>());
  m.def("describe_log", &describe);
  m.def("verify_log", &verify, nb::arg("file"), nb::arg("folder") = "",
        nb::arg("progress").none() = nb::none());
  m.def("recover_log", [](const std::filesystem::path& file, const std::filesystem::path& to) {
    const LogRecovery recovery = take(without_gil([&] { return recover_log(file, to); }));
    return nb::make_tuple(recovery.is_whole, recovery.messages, recovery.messages_lost,
                          recovery.damage);
  });
  m.def(
      "replay_log",
      [](const std::filesystem::path& file, const nb::dict& options, nb::object progress) {
        const LogReplay replay = replay_of(file, options);
        return report_dict(with_progress(
            std::move(progress),
            [&](const ProgressCallback& callback) { return replay_log(replay, callback); }));
      },
      nb::arg("file"), nb::arg("options"), nb::arg("progress").none() = nb::none());
  m.def("replay_variants", &variants, nb::arg("file"), nb::arg("options"), nb::arg("randomize"),
        nb::arg("count"), nb::arg("first_seed") = 1, nb::arg("progress").none() = nb::none());
  m.def(
      "log_checkpoint",
      [](const std::filesystem::path& log, const std::string& folder, int64_t run, double time) {
        return take(without_gil([&] { return log_checkpoint(log, folder, run, time); }));
      },
      nb::arg("log"), nb::arg("folder") = "", nb::arg("run") = 0, nb::arg("time") = 0.0);
  m.def("checkpoint_world", [](const Checkpoint& checkpoint) { return checkpoint.world(); });
  m.def("export_topic", &export_topic);
  m.def("export_trajectory", [](const std::filesystem::path& log, const std::string& topic) {
    return trajectory(log, topic);
  });
}

}  // namespace gloam::python
