// gloam robots: the catalogue, and settings for models from elsewhere.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "command.h"
#include "gloam/scene.h"
#include "json_text.h"
#include "print.h"

namespace gloam::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPreviewSamples = 64, kPreviewWidth = 640, kPreviewHeight = 480;

struct RobotsCommand {
  std::vector<std::string> names;
  std::string guess, preview;
  FileAccess access;
  std::vector<std::string> packages;
};

Json json_of(const RobotModelInfo& robot) {
  Json sensors = Json::array();
  for (const RobotModelSensor& sensor : robot.sensors)
    sensors.push_back({{"name", sensor.name}, {"kind", sensor.kind}});
  return {{"name", robot.name},
          {"description", robot.description},
          {"file", robot.file.string()},
          {"model", robot.defaults.file.string()},
          {"keyframe", robot.defaults.keyframe},
          {"base", robot.defaults.base},
          {"controller", robot.defaults.controller.type},
          {"joints", robot.joints},
          {"actuators", robot.actuators},
          {"floating", robot.is_floating},
          {"mass", robot.mass},
          {"sensors", std::move(sensors)}};
}

void print_table(const std::vector<RobotModelInfo>& robots) {
  size_t name = 5, controller = 10;
  for (const RobotModelInfo& robot : robots) {
    name = std::max(name, robot.name.size());
    controller = std::max(controller, robot.defaults.controller.type.size());
  }
  say("{:{}}  {:>6}  {:>9}  {:{}}  description\n", "model", name, "joints", "mass", "controller",
      controller);
  for (const RobotModelInfo& robot : robots)
    say("{:{}}  {:>6}  {:>6.2f} kg  {:{}}  {}\n", robot.name, name, robot.joints, robot.mass,
        robot.defaults.controller.type, controller, robot.description);
}

// say() makes line breaks within a text visible.
void say_lines(std::string_view text) {
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    say("{}\n", text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// The [[robot]] with which a scene uses the robot.
std::string toml_of(const RobotModelInfo& robot, const std::string& model) {
  std::string text = fmt::format("[[robot]]\nmodel = \"{}\"\n", model);
  std::string sensors;
  for (const RobotModelSensor& sensor : robot.sensors)
    sensors += fmt::format("{}\"{}\"", sensors.empty() ? "" : ", ", sensor.name);
  if (!sensors.empty()) text += fmt::format("sensors = [{}]\n", sensors);
  return text;
}

void print_robot(const RobotModelInfo& robot, const std::string& model) {
  const RobotOptions& o = robot.defaults;
  say("{}: {}\n", robot.name, robot.description);
  say("  file        {}\n", o.file.string());
  say("  joints      {}, {} actuators, {}\n", robot.joints, robot.actuators,
      robot.is_floating || o.base == "free" ? "floating base" : "fixed base");
  say("  mass        {:.2f} kg\n", robot.mass);
  say("  keyframe    {}\n", o.keyframe.empty() ? "-" : o.keyframe);
  say("  controller  {}\n", o.controller.type);
  for (const RobotModelSensor& sensor : robot.sensors)
    say("  sensor      {} ({})\n", sensor.name, sensor.kind);
  say("\n");
  say_lines(toml_of(robot, model));
}

Result<std::vector<RobotModelInfo>> chosen(const RobotsCommand& command) {
  if (command.names.empty()) return robot_models();
  std::vector<RobotModelInfo> robots;
  for (const std::string& name : command.names) {
    auto robot = robot_model(name, command.access);
    if (!robot.ok()) return robot.error();
    robots.push_back(std::move(*robot));
  }
  return robots;
}

int show(const RobotsCommand& command, const Globals& globals) {
  const auto found = chosen(command);
  if (!found.ok()) return fail(found.error());
  const std::vector<RobotModelInfo>& robots = *found;
  const bool is_list = command.names.empty();
  if (globals.json) {
    Json json = Json::array();
    for (const RobotModelInfo& robot : robots) json.push_back(json_of(robot));
    put_json(is_list || json.size() > 1 ? json : json[0]);
  } else if (is_list) {
    print_table(robots);
  } else {
    for (size_t i = 0; i < robots.size(); ++i) print_robot(robots[i], command.names[i]);
  }
  return 0;
}

int propose(const RobotsCommand& command, const Globals& globals) {
  const auto guess = guess_robot(command.guess, command.access);
  if (!guess.ok()) return fail(guess.error());
  if (globals.json)
    put_json(Json{{"kind", guess->kind}, {"toml", guess->toml}});
  else
    say_lines(guess->toml);
  return 0;
}

/// Renders one robot alone, at its keyframe, as gloam render shows a bare model.
Result<std::filesystem::path> preview(const RobotModelInfo& robot, const RobotsCommand& command,
                                      const Globals& globals) {
  Result<Scene> scene = load_scene(robot.defaults.file, command.access);
  if (!scene.ok()) return scene.error();
  auto world = compile(*scene, globals, robot.defaults.keyframe);
  if (!world.ok()) return world.error();
  CameraRequest request;
  request.camera = "free";
  request.render.spp = kPreviewSamples;
  request.width = kPreviewWidth;
  request.height = kPreviewHeight;
  request.outputs = {"rgb"};
  auto frames = render_stills(*world, 0, {request}, progress_display(globals));
  finish_progress();
  if (!frames.ok()) return frames.error();
  auto files = write_frame(frames->front(), command.preview, robot.name, {"rgb"});
  if (!files.ok()) return files.error();
  return files->front();
}

int preview_all(const RobotsCommand& command, const Globals& globals) {
  auto robots = chosen(command);
  if (!robots.ok()) return fail(robots.error());
  std::error_code code;
  std::filesystem::create_directories(command.preview, code);
  if (code)
    return fail({ErrorKind::kIo,
                 fmt::format("cannot create folder {}: {}", command.preview, code.message())});
  Json json = Json::array();
  for (const RobotModelInfo& robot : *robots) {
    const auto file = preview(robot, command, globals);
    if (!file.ok()) return fail(file.error());
    json.push_back({{"name", robot.name}, {"file", file->string()}});
    if (!globals.json) say("{}\n", file->string());
  }
  if (globals.json) put_json(json);
  return 0;
}

}  // namespace

void add_robots(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand(
      "robots",
      "List and preview the robots that [[robot]] model names; propose settings for others");
  auto command = std::make_shared<RobotsCommand>();
  CLI::Option* names = sub->add_option(
      "MODEL", command->names,
      "Robots of the catalogue, or paths of robot.toml files or their folders; default: "
      "all of the catalogue");
  CLI::Option* preview = sub->add_option("--preview", command->preview,
                                         "Render each robot into this folder as NAME.png");
  sub->add_option("--guess", command->guess,
                  "Print a [[robot]] for an MJCF or URDF file from elsewhere: base, keyframe, "
                  "controller and joints, as far as the shape of its tree shows them")
      ->excludes(preview)
      ->excludes(names);
  add_access_options(*sub, command->access, command->packages);
  sub->footer(
      "Examples:\n  gloam robots\n  gloam robots quadruped\n  gloam --json robots arm cart\n"
      "  gloam robots --preview pictures\n  gloam robots --guess go2.xml >> scene.toml");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] {
      if (const Status status = apply_packages(command->access, command->packages); !status.ok())
        return fail(status.error());
      if (!command->guess.empty()) return propose(*command, globals);
      return command->preview.empty() ? show(*command, globals) : preview_all(*command, globals);
    };
  });
}

}  // namespace gloam::cli
