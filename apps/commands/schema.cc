// gloam schema: JSON Schemas with which editors complete and check scenes and models in TOML.

#include <cstdio>

#include "command.h"
#include "gloam/mjcf.h"
#include "gloam/scene.h"

namespace gloam::cli {

void add_schema(CLI::App& app, Globals& /*globals*/, Action& action) {
  CLI::App* sub =
      app.add_subcommand("schema", "Print the JSON Schema of scenes or of models, for editors");
  auto what = std::make_shared<std::string>();
  sub->add_option("WHAT", *what, "scene: scene files; model: models in TOML")
      ->required()
      ->check(CLI::IsMember({"scene", "model"}));
  sub->footer(
      "Example:\n  gloam schema scene > gloam-scene.json\nThen begin each scene with the line: "
      "#:schema ./gloam-scene.json");
  sub->callback([&action, what] {
    action = [what] {
      std::printf("%s\n", (*what == "scene" ? scene_schema() : mjcf::model_schema()).c_str());
      return 0;
    };
  });
}

}  // namespace gloam::cli
