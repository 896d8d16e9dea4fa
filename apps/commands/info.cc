// gloam info: what a scene or model holds, and what of it Gloam cannot do.

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "command.h"
#include "schema_report.h"

namespace gloam::cli {
namespace {

struct InfoCommand {
  std::string file;
  FileAccess access;
  std::vector<std::string> packages;
  bool schema = false;
};

using Section = std::pair<const char*, const std::vector<NamedElement>*>;

void print_json(const WorldInfo& info, const std::vector<Section>& sections) {
  nlohmann::ordered_json json = {{"nq", info.nq},
                                 {"nv", info.nv},
                                 {"nu", info.nu},
                                 {"timestep_s", info.timestep},
                                 {"mass_kg", info.mass},
                                 {"model_bytes", info.model_bytes},
                                 {"triangles", info.triangles}};
  for (const auto& [title, elements] : sections) {
    auto& list = json[title] = nlohmann::ordered_json::array();
    for (const NamedElement& element : *elements)
      list.push_back({{"name", element.name}, {"detail", element.detail}});
  }
  auto& list = json["unsupported"] = nlohmann::ordered_json::array();
  for (const Error& error : info.unsupported) {
    list.push_back({{"file", error.loc.file}, {"line", error.loc.line}, {"what", error.message}});
  }
  std::printf("%s\n", json.dump(2).c_str());
}

void print_text(const WorldInfo& info, const std::vector<Section>& sections) {
  fmt::print("{} positions, {} velocities, {} controls; time step {} s; mass {:.3f} kg\n", info.nq,
             info.nv, info.nu, info.timestep, info.mass);
  fmt::print("{:.2f} MiB of model, {} triangles drawn\n",
             static_cast<double>(info.model_bytes) / (1 << 20), info.triangles);
  for (const auto& [title, elements] : sections) {
    if (elements->empty()) continue;
    fmt::print("\n{} ({})\n", title, elements->size());
    for (const NamedElement& element : *elements) {
      fmt::print("  {:<32} {}\n", element.name.empty() ? "(unnamed)" : element.name,
                 element.detail);
    }
  }
  if (info.unsupported.empty()) {
    fmt::print("\neverything in the file is simulated and drawn\n");
    return;
  }
  fmt::print("\nnot supported ({})\n", info.unsupported.size());
  for (const Error& error : info.unsupported) fmt::print("  {}\n", error.to_string());
}

int info(const InfoCommand& command, const Globals& globals) {
  if (command.schema) return report_schema(globals);
  auto world = load_world(command.file, command.access, command.packages);
  if (!world.ok()) return fail(world.error());
  const WorldInfo info = world->info();
  const std::vector<Section> sections = {{"bodies", &info.bodies},       {"joints", &info.joints},
                                         {"actuators", &info.actuators}, {"sensors", &info.sensors},
                                         {"cameras", &info.cameras},     {"lights", &info.lights},
                                         {"materials", &info.materials}, {"geoms", &info.geoms}};
  globals.json ? print_json(info, sections) : print_text(info, sections);
  return 0;
}

}  // namespace

void add_info(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub =
      app.add_subcommand("info", "List what a scene or model holds, and what is not supported");
  auto command = std::make_shared<InfoCommand>();
  CLI::Option* file = sub->add_option("FILE", command->file, "Scene or model");
  CLI::Option* schema =
      sub->add_flag("--schema", command->schema,
                    "How much of MuJoCo's own schema is mirrored, and what sets what");
  file->excludes(schema);
  add_access_options(*sub, command->access, command->packages);
  sub->footer("Examples:\n  gloam info robot.urdf --json\n  gloam info --schema");
  sub->callback([&globals, &action, command] {
    if (command->file.empty() && !command->schema) throw CLI::RequiredError("FILE");
    action = [&globals, command] { return info(*command, globals); };
  });
}

}  // namespace gloam::cli
