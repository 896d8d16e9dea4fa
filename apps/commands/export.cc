// gloam export: the whole level as one MJCF that stock MuJoCo loads to the same model.

#include <cstdio>

#include "run_options.h"

namespace gloam::cli {
namespace {

struct ExportCommand {
  std::string file, out;
  SceneOptions scene;
};

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
  CLI::App* sub = app.add_subcommand("export", "Write a scene as one MJCF with its assets");
  auto command = std::make_shared<ExportCommand>();
  sub->add_option("FILE", command->file, "Scene or model")->required();
  sub->add_option("--out", command->out, "Folder to write scene.xml and its assets into")
      ->required();
  command->scene.add_to(*sub);
  sub->footer("Example:\n  gloam export examples/demo.toml --out exported");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return export_scene(*command, globals); };
  });
}

}  // namespace gloam::cli
