// gloam convert: what a mesh file becomes as an [[object]], and how well its colliders fit.

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "command.h"
#include "gloam/world.h"

namespace gloam::cli {
namespace {

struct ConvertCommand {
  ObjectOptions object;
  std::string file;
};

std::string count_kinds(const std::vector<std::string>& colliders) {
  std::map<std::string, int> counts;
  for (const std::string& kind : colliders) ++counts[kind];
  std::string out;
  for (const auto& [kind, count] : counts)
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, kind);
  return out.empty() ? "none" : out;
}

int convert(ConvertCommand command, bool as_json) {
  command.object.file = command.file;
  command.object.name = command.object.file.stem().string();
  const Result<ObjectReport> made = convert_object(command.object);
  if (!made.ok()) return fail(made.error());
  const ObjectReport& r = *made;
  if (as_json) {
    const nlohmann::ordered_json json = {{"triangles", r.triangles},
                                         {"closed", r.is_closed},
                                         {"size", {r.size.x, r.size.y, r.size.z}},
                                         {"volume", r.volume},
                                         {"mass", r.mass},
                                         {"colliders", r.colliders},
                                         {"shared", r.shared},
                                         {"mean_distance", r.mean_distance},
                                         {"max_distance", r.max_distance},
                                         {"seconds", r.seconds},
                                         {"notes", r.notes}};
    fmt::print("{}\n", json.dump(2));
    return 0;
  }
  fmt::print("mesh       {} triangles, {}, {:.3g} x {:.3g} x {:.3g} m\n", r.triangles,
             r.is_closed ? "closed" : "not closed", r.size.x, r.size.y, r.size.z);
  fmt::print("mass       {:.4g} kg of {:.4g} m³\n", r.mass, r.volume);
  fmt::print("colliders  {}, in {:.2f} s\n", count_kinds(r.colliders), r.seconds);
  if (!r.colliders.empty())
    fmt::print("overlap    {}surfaces {:.3g} mm apart in the mean, {:.3g} mm at most\n",
               r.is_closed ? fmt::format("{:.1f} % of the volumes, ", 100 * r.shared) : "",
               1e3 * r.mean_distance, 1e3 * r.max_distance);
  for (const std::string& note : r.notes) fmt::print("note       {}\n", note);
  return 0;
}

}  // namespace

void add_convert(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand("convert", "Tell what a mesh file becomes as an [[object]]");
  auto command = std::make_shared<ConvertCommand>();
  sub->add_option("FILE", command->file, "glTF, GLB, OBJ, STL or PLY")->required();
  sub->add_option("--node", command->object.node, "One node by its name");
  sub->add_option("--colliders", command->object.colliders, "As in [[object]]");
  sub->add_option("--unit", command->object.unit, "Metres of one unit of the file")
      ->check(positive_number());
  sub->footer("Example:\n  gloam convert assets/models/lantern/lantern.glb --colliders hull");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return convert(*command, globals.json); };
  });
}

}  // namespace gloam::cli
