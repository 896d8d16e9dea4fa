// gloam export: the whole level as one MJCF that stock MuJoCo loads to the same model.

#include <cstdio>

#include "command.h"

namespace gloam::cli {
namespace {

struct ExportCommand {
  std::string file, out;
  FileAccess access;
  std::vector<std::string> packages;
};

int export_scene(const ExportCommand& command) {
  auto world = load_world(command.file, command.access, command.packages);
  if (!world.ok()) return fail(world.error());
  if (const Status status = world->export_mjcf(command.out); !status.ok())
    return fail(status.error());
  std::printf("%s\n", (std::filesystem::path(command.out) / "scene.xml").string().c_str());
  return 0;
}

}  // namespace

void add_export(CLI::App& app, Globals& /*globals*/, Action& action) {
  CLI::App* sub = app.add_subcommand("export", "Write a scene as one MJCF with its assets");
  auto command = std::make_shared<ExportCommand>();
  sub->add_option("FILE", command->file, "Scene or model")->required();
  sub->add_option("--out", command->out, "Folder to write scene.xml and its assets into")
      ->required();
  add_access_options(*sub, command->access, command->packages);
  sub->footer("Example:\n  gloam export examples/demo.toml --out exported");
  sub->callback([&action, command] { action = [command] { return export_scene(*command); }; });
}

}  // namespace gloam::cli
