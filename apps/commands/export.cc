// gloam export: the whole level as one MJCF that stock MuJoCo loads to the same model; of a log
// trajectories and tables.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include "gloam/log_export.h"
#include "log_report.h"
#include "run_options.h"

namespace gloam::cli {
namespace {

struct ExportCommand {
  std::string file, out, to, topic;
  SceneOptions scene;
};

const std::map<std::string, TrajectoryFormat> kTrajectories = {{"tum", TrajectoryFormat::kTum},
                                                               {"kitti", TrajectoryFormat::kKitti},
                                                               {"euroc", TrajectoryFormat::kEuroc}};

// Its only topic with poses, where none is named.
Result<std::string> topic_of(const ExportCommand& command) {
  if (!command.topic.empty()) return command.topic;
  GLOAM_TRY(const auto topics, trajectory_topics(command.file));
  if (topics.size() == 1) return topics[0];
  std::string all;
  for (const std::string& topic : topics) all += (all.empty() ? "" : ", ") + topic;
  return Error{ErrorKind::kUsage,
               topics.empty() ? "the log has no topic of poses" : "the log has several: " + all,
               {},
               "name one with --topic; a frame as in /tf:robot/base"};
}

int export_log(const ExportCommand& command) {
  if (command.to.empty())
    return fail({ErrorKind::kUsage,
                 "of a log --to says what is written",
                 {},
                 "one of tum, kitti, euroc, csv"});
  if (command.to == "csv") {
    if (command.topic.empty())
      return fail({ErrorKind::kUsage,
                   "--to csv needs a --topic",
                   {},
                   "`gloam info " + command.file + "` lists them"});
    const auto rows = write_topic_table(command.file, command.topic, command.out);
    if (!rows.ok()) return fail(rows.error());
    std::printf("%s: %lld rows\n", command.out.c_str(), static_cast<long long>(*rows));
    return 0;
  }
  const auto topic = topic_of(command);
  if (!topic.ok()) return fail(topic.error());
  const auto poses = read_trajectory(command.file, *topic);
  if (!poses.ok()) return fail(poses.error());
  std::error_code code;
  if (std::filesystem::exists(command.out, code))
    return fail({ErrorKind::kUsage,
                 "there is a file '" + command.out + "' already",
                 {},
                 "choose another name"});
  std::ofstream out(command.out, std::ios::binary);
  out << trajectory_text(*poses, kTrajectories.at(command.to));
  if (!out.flush())
    return fail({ErrorKind::kIo, "cannot write " + command.out, {}, "is the disk full?"});
  std::printf("%s: %zu poses of %s\n", command.out.c_str(), poses->size(), topic->c_str());
  return 0;
}

int export_scene(ExportCommand& command, const Globals& globals) {
  auto world = command.scene.compile(command.file, globals);
  if (!world.ok()) return fail(world.error());
  std::vector<Error> left_out;
  if (const Status status = world->export_mjcf(command.out, &left_out); !status.ok())
    return fail(status.error());
  for (const Error& error : left_out)
    std::fprintf(stderr, "gloam: note: %s\n", error.to_string().c_str());
  std::printf("%s\n", (std::filesystem::path(command.out) / "scene.xml").string().c_str());
  return 0;
}

}  // namespace

void add_export(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand(
      "export", "Write a scene as one MJCF with its assets, or a log's trajectories and tables");
  auto command = std::make_shared<ExportCommand>();
  sub->add_option("FILE", command->file, "Scene, model or log")->required();
  sub->add_option("--out", command->out,
                  "Folder to write scene.xml and its assets into; of a log the file to write")
      ->required();
  sub->add_option("--to", command->to, "Of a log: tum, kitti, euroc or csv")
      ->check(CLI::IsMember({"tum", "kitti", "euroc", "csv"}));
  sub->add_option("--topic", command->topic,
                  "Of a log: the topic; a frame of /tf as in /tf:robot/base");
  command->scene.add_to(*sub);
  sub->footer(
      "Examples:\n  gloam export examples/demo.toml --out exported\n  gloam export run.mcap --to "
      "tum "
      "--topic /go/odom --out go.tum");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] {
      return is_log(command->file) ? export_log(*command) : export_scene(*command, globals);
    };
  });
}

}  // namespace gloam::cli
