// gloam info: the contents of a scene or model, and its unsupported elements.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "gloam/topics.h"
#include "json_text.h"
#include "log_report.h"
#include "print.h"
#include "run_options.h"
#include "schema_report.h"

namespace gloam::cli {
namespace {

struct InfoCommand {
  std::string file;
  SceneOptions scene;
  bool schema = false, streams = false, topics = false, metrics = false;
};

using Section = std::pair<const char*, const std::vector<NamedElement>*>;

void print_json(const WorldInfo& info, const NotDrawn& not_drawn,
                const std::vector<Section>& sections) {
  nlohmann::ordered_json json = {{"nq", info.nq},
                                 {"nv", info.nv},
                                 {"nu", info.nu},
                                 {"timestep_s", info.timestep},
                                 {"mass_kg", info.mass},
                                 {"model_bytes", info.model_bytes},
                                 {"triangles", info.triangles}};
  auto& regions = json["regions"] = nlohmann::ordered_json::array();
  for (const Region& r : info.regions) {
    regions.push_back({{"name", r.name},
                       {"label", r.label},
                       {"low_m", {r.low.x, r.low.y, r.low.z}},
                       {"high_m", {r.high.x, r.high.y, r.high.z}}});
  }
  auto& drawn = json["drawn"] = nlohmann::ordered_json::array();
  for (const DrawnOption& d : info.drawn)
    drawn.push_back({{"option", d.option}, {"value", d.value}});
  for (const auto& [title, elements] : sections) {
    auto& list = json[title] = nlohmann::ordered_json::array();
    for (const NamedElement& element : *elements)
      list.push_back({{"name", element.name}, {"detail", element.detail}});
  }
  for (const auto& [title, errors] :
       {std::pair("notes", &info.notes), std::pair("unsupported", &info.unsupported),
        std::pair("hidden", &not_drawn.hidden)}) {
    auto& list = json[title] = nlohmann::ordered_json::array();
    for (const Error& error : *errors) {
      list.push_back({{"file", error.loc.file},
                      {"line", error.loc.line},
                      {"what", error.message},
                      {"hint", error.hint}});
    }
  }
  put_json(json);
}

void print_text(const WorldInfo& info, const NotDrawn& not_drawn,
                const std::vector<Section>& sections) {
  say("{} positions, {} velocities, {} controls; time step {} s; mass {:.3f} kg\n", info.nq,
      info.nv, info.nu, info.timestep, info.mass);
  say("model size {:.2f} MiB, {} triangles rendered\n",
      static_cast<double>(info.model_bytes) / (1 << 20), info.triangles);
  if (!info.drawn.empty()) say("\nrandomized ({})\n", info.drawn.size());
  for (const DrawnOption& d : info.drawn) say("  {} = {}\n", d.option, d.value);
  if (!info.regions.empty()) say("\nregions ({})\n", info.regions.size());
  for (const Region& r : info.regions) {
    say("  {:<32} {}: {:.1f} x {:.1f} m around ({:.1f}, {:.1f}), floor at {:.2f} m\n", r.name,
        r.label, r.high.x - r.low.x, r.high.y - r.low.y, (r.low.x + r.high.x) / 2,
        (r.low.y + r.high.y) / 2, r.low.z);
  }
  for (const auto& [title, elements] : sections) {
    if (elements->empty()) continue;
    say("\n{} ({})\n", title, elements->size());
    for (const NamedElement& element : *elements) {
      say("  {:<32} {}\n", element.name.empty() ? "(unnamed)" : element.name, element.detail);
    }
  }
  for (const auto& [title, errors] :
       {std::pair("notes", &info.notes), std::pair("not supported", &info.unsupported),
        std::pair("hidden by default", &not_drawn.hidden)}) {
    if (!errors->empty()) say("\n{} ({})\n", title, errors->size());
    for (const Error& error : *errors) say("  {}\n", error.to_string());
  }
  // MuJoCo's own remarks report elements that it ignores.
  const bool is_ignored = std::ranges::any_of(info.notes, [](const Error& note) {
    return note.kind == ErrorKind::kUnsupported || note.message.starts_with("MuJoCo: ");
  });
  if (info.unsupported.empty() && not_drawn.hidden.empty() && !is_ignored)
    say("\neverything in the file is simulated and rendered\n");
}

nlohmann::ordered_json pose_json(const Pose& X) {
  return {{"position", {X.p.x, X.p.y, X.p.z}}, {"orientation_wxyz", {X.q.w, X.q.x, X.q.y, X.q.z}}};
}

void print_streams_json(const World& world) {
  const std::vector<BodyInfo> bodies = world.bodies();
  nlohmann::ordered_json json;
  auto& says = json["says"] = nlohmann::ordered_json::array();
  for (const StreamInfo& stream : world.streams()) {
    says.push_back({{"kind", to_string(stream.kind)},
                    {"name", stream.name},
                    {"frame_id", stream.frame_id},
                    {"parent", bodies[static_cast<size_t>(stream.parent.id)].name},
                    {"pose_in_parent", pose_json(stream.X_PS)},
                    {"rate_hz", {stream.rate.num, stream.rate.den}},
                    {"outputs", stream.outputs},
                    {"unit", stream.unit}});
  }
  auto& hears = json["hears"] = nlohmann::ordered_json::array();
  const auto limits = [](const std::vector<double>& values) {
    auto list = nlohmann::ordered_json::array();
    for (const double v : values) {
      if (std::isfinite(v))
        list.push_back(v);
      else
        list.push_back(nullptr);
    }
    return list;
  };
  for (const InputInfo& input : world.inputs()) {
    hears.push_back({{"kind", to_string(input.kind)},
                     {"name", input.name},
                     {"elements", input.elements},
                     {"count", input.count},
                     {"low", limits(input.low)},
                     {"high", limits(input.high)},
                     {"unit", input.unit}});
  }
  put_json(json);
}

void print_streams(const World& world) {
  const std::vector<BodyInfo> bodies = world.bodies();
  say("outputs\n  {:<10} {:<32} {:<24} {:<12} {}\n", "kind", "name", "on body", "rate", "outputs");
  for (const StreamInfo& stream : world.streams()) {
    const std::string& parent = bodies[static_cast<size_t>(stream.parent.id)].name;
    say("  {:<10} {:<32} {:<24} {:<12} {}\n", to_string(stream.kind), stream.name,
        parent.empty() ? "world" : parent,
        stream.rate.num == 0 ? "every step" : fmt::format("{:g} Hz", stream.rate.value()),
        stream.outputs.size() > 6
            ? fmt::format("{} … ({})",
                          fmt::join(stream.outputs.begin(), stream.outputs.begin() + 5, " "),
                          stream.outputs.size())
            : fmt::format("{}", fmt::join(stream.outputs, " ")));
  }
  say("\ninputs\n");
  for (const InputInfo& input : world.inputs())
    say("  {:<10} {:<32} {}\n", to_string(input.kind), input.name,
        input.elements.empty() || input.elements.size() > 6
            ? fmt::format("{} values", input.count)
            : fmt::format("{}", fmt::join(input.elements, " ")));
}

int report_metrics(const World& world, const Globals& globals) {
  const auto metrics = world.metrics();
  if (!metrics.ok()) return fail(metrics.error());
  nlohmann::ordered_json json;
  auto& list = json["metrics"] = nlohmann::ordered_json::array();
  for (const MetricInfo& metric : *metrics) {
    list.push_back({{"name", metric.name},
                    {"unit", metric.unit},
                    {"robot", metric.robot},
                    {"declared", metric.declared}});
    if (!globals.json)
      say("{:<40} {:<8} {}\n", metric.name, metric.unit, metric.declared ? "declared" : "built in");
  }
  if (globals.json) put_json(json);
  return 0;
}

int info(InfoCommand& command, const Globals& globals) {
  if (command.schema) return report_schema(globals);
  if (is_log(command.file)) return report_log(command.file, globals);
  auto world = command.scene.compile(command.file, globals);
  if (!world.ok()) return fail(world.error());
  if (command.topics) return report_topics(*world, globals);
  if (command.metrics) return report_metrics(*world, globals);
  if (const auto metrics = world->metrics(); !metrics.ok()) return fail(metrics.error());
  if (command.streams) {
    globals.json ? print_streams_json(*world) : print_streams(*world);
    return 0;
  }
  WorldInfo info = world->info();
  const std::vector<Error> renamed = topic_notes(*world);
  info.notes.insert(info.notes.end(), renamed.begin(), renamed.end());
  const NotDrawn not_drawn = world->not_drawn();
  info.unsupported.insert(info.unsupported.end(), not_drawn.lacking.begin(),
                          not_drawn.lacking.end());
  const std::vector<Section> sections = {
      {"bodies", &info.bodies},         {"joints", &info.joints},
      {"actuators", &info.actuators},   {"sensors", &info.sensors},
      {"cameras", &info.cameras},       {"lights", &info.lights},
      {"materials", &info.materials},   {"geoms", &info.geoms},
      {"sites", &info.sites},           {"tendons", &info.tendons},
      {"equalities", &info.equalities}, {"keyframes", &info.keyframes},
      {"textures", &info.textures}};
  globals.json ? print_json(info, not_drawn, sections) : print_text(info, not_drawn, sections);
  return 0;
}

}  // namespace

void add_info(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand(
      "info", "Summarize a scene, model or log, and report unsupported elements");
  auto command = std::make_shared<InfoCommand>();
  CLI::Option* file = sub->add_option("FILE", command->file, "Scene, model or log");
  CLI::Option* schema = sub->add_flag(
      "--schema", command->schema,
      "Report the coverage of MuJoCo's schema: attributes and the fields that they set");
  file->excludes(schema);
  sub->add_flag("--streams", command->streams,
                "List output streams and inputs of the simulation: cameras, sensors, controls …")
      ->excludes(schema);
  sub->add_flag("--topics", command->topics, "List ROS 2 topics of the simulation")
      ->excludes(schema);
  sub->add_flag("--metrics", command->metrics, "List metrics of a run: the columns of metrics.csv")
      ->excludes(schema);
  command->scene.add_keyframe_to(*sub);
  command->scene.add_to(*sub);
  sub->footer(
      "Examples:\n  gloam info robot.urdf --json\n  gloam info examples/demo.toml --streams\n  "
      "gloam info --schema");
  sub->callback([&globals, &action, command] {
    if (command->file.empty() && !command->schema) throw CLI::RequiredError("FILE");
    action = [&globals, command] { return info(*command, globals); };
  });
}

}  // namespace gloam::cli
