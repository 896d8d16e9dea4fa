// gloam export: the whole level as one MJCF that stock MuJoCo loads to the same model; of a log
// trajectories and tables.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include "gloam/log_export.h"
#include "gloam/report.h"
#include "log_report.h"
#include "print.h"
#include "run_options.h"
#include "trajectory_source.h"

namespace gloam::cli {
namespace {

struct ExportCommand {
  std::string file, out, to, topic;
  SceneOptions scene;
};

const std::map<std::string, TrajectoryFormat> kTrajectories = {{"tum", TrajectoryFormat::kTum},
                                                               {"kitti", TrajectoryFormat::kKitti},
                                                               {"euroc", TrajectoryFormat::kEuroc}};

/// Parts of a topic that are written, and their names.
struct TopicWriter {
  Result<int64_t> (*write)(const std::filesystem::path& log, const std::string& topic,
                           const std::filesystem::path& to);
  const char* parts;
};
const std::map<std::string, TopicWriter> kTopicWriters = {
    {"csv", {write_topic_table, "rows"}},
    {"parquet", {write_topic_parquet, "rows"}},
    {"png", {write_topic_pictures, "images"}},
    {"mp4", {write_topic_video, "images"}}};

int tell_count(const ExportCommand& command, const Result<int64_t>& count, const char* parts) {
  if (!count.ok()) return fail(count.error());
  say("{}: {} {}\n", command.out, *count, parts);
  return 0;
}

int export_log(const ExportCommand& command) {
  if (command.to.empty())
    return fail({ErrorKind::kUsage,
                 "--to is required to export a log",
                 {},
                 "one of tum, kitti, euroc, csv, parquet, png, mp4"});
  if (const auto writer = kTopicWriters.find(command.to); writer != kTopicWriters.end()) {
    if (command.topic.empty())
      return fail({ErrorKind::kUsage,
                   "--to " + command.to + " requires --topic",
                   {},
                   "`gloam info " + command.file + "` lists the topics"});
    return tell_count(command, writer->second.write(command.file, command.topic, command.out),
                      writer->second.parts);
  }
  const auto topic =
      command.topic.empty() ? only_pose_topic(command.file) : Result<std::string>(command.topic);
  if (!topic.ok()) return fail(topic.error());
  const auto poses = read_trajectory(command.file, *topic);
  if (!poses.ok()) return fail(poses.error());
  std::error_code code;
  if (std::filesystem::exists(command.out, code))
    return fail({ErrorKind::kUsage,
                 "file '" + command.out + "' already exists",
                 {},
                 "choose another name"});
  std::ofstream out(command.out, std::ios::binary);
  out << trajectory_text(*poses, kTrajectories.at(command.to));
  if (!out.flush())
    return fail({ErrorKind::kIo, "cannot write " + command.out, {}, "is the disk full?"});
  say("{}: {} poses of {}\n", command.out, poses->size(), *topic);
  return 0;
}

int export_scene(ExportCommand& command, const Globals& globals) {
  auto world = command.scene.compile(command.file, globals);
  if (!world.ok()) return fail(world.error());
  std::vector<Error> left_out;
  if (const Status status = world->export_mjcf(command.out, &left_out); !status.ok())
    return fail(status.error());
  for (const Error& error : left_out) tell("gloam: note: {}\n", error.to_string());
  say("{}\n", (std::filesystem::path(command.out) / "scene.xml").string());
  return 0;
}

}  // namespace

void add_export(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand(
      "export",
      "Export a scene to MJCF with its assets, or trajectories, tables and images from a log");
  auto command = std::make_shared<ExportCommand>();
  sub->add_option("FILE", command->file, "Scene, model, log or metrics.csv")->required();
  sub->add_option("--out", command->out,
                  "Folder for scene.xml and its assets; for logs and tables, the file to write")
      ->required();
  sub->add_option("--to", command->to,
                  "Format for logs: tum, kitti, euroc (poses), csv, parquet (any topic), png, mp4 "
                  "(images); for CSV tables: parquet")
      ->check(CLI::IsMember({"tum", "kitti", "euroc", "csv", "parquet", "png", "mp4"}));
  sub->add_option("--topic", command->topic,
                  "Topic of the log; a frame of /tf is written as /tf:robot/base");
  command->scene.add_to(*sub);
  sub->footer(
      "Examples:\n  gloam export examples/demo.toml --out exported\n  gloam export run.mcap --to "
      "tum "
      "--topic /go/odom --out go.tum");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] {
      if (command->to == "parquet" && std::filesystem::path(command->file).extension() == ".csv")
        return tell_count(*command, write_table_parquet(command->file, command->out), "rows");
      return is_log(command->file) ? export_log(*command) : export_scene(*command, globals);
    };
  });
}

}  // namespace gloam::cli
