// gloam convert: the [[object]] that a mesh file produces, and how well its colliders fit.

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "command.h"
#include "gloam/model_tools.h"
#include "gloam/world.h"
#include "interrupt.h"
#include "json_text.h"
#include "print.h"

namespace gloam::cli {
namespace {

struct ConvertCommand {
  ObjectOptions object;
  std::string file, scale = "1";
  FileAccess access;
  std::vector<std::string> packages;
};

// "2" or "1,1,2".
Status parse_scale(const std::string& text, Vec3* scale) {
  std::vector<double> numbers;
  const char *at = text.data(), *end = at + text.size();
  while (numbers.size() < 4) {
    double value = 0;
    const auto [after, error] = std::from_chars(at, end, value);
    if (error != std::errc() || value == 0 || !std::isfinite(value)) break;
    numbers.push_back(value);
    at = after;
    if (at == end) break;
    if (*at++ != ',') break;
  }
  if (at != end || (numbers.size() != 1 && numbers.size() != 3))
    return Error{ErrorKind::kUsage,
                 fmt::format("--scale {}: expected one or three numbers other than 0", text),
                 {},
                 "for example 0.5, 1,1,2 or -1,1,1 (mirrored)"};
  numbers.resize(3, numbers[0]);
  *scale = {numbers[0], numbers[1], numbers[2]};
  return {};
}

std::string count_kinds(const std::vector<std::string>& colliders) {
  std::map<std::string, int> counts;
  for (const std::string& kind : colliders) ++counts[kind];
  std::string out;
  for (const auto& [kind, count] : counts)
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, kind);
  return out.empty() ? "none" : out;
}

int convert(ConvertCommand command, const Globals& globals) {
  command.object.file = command.file;
  command.object.name = command.object.file.stem().string();
  if (const Status status = parse_scale(command.scale, &command.object.scale); !status.ok())
    return fail(status.error());
  if (const Status status = apply_packages(command.access, command.packages); !status.ok())
    return fail(status.error());
  const EndOnInterrupt watched;
  const Result<ObjectReport> made = convert_object(
      command.object, command.access, [show = progress_line(globals)](const Progress& progress) {
        show(progress);
        return true;
      });
  finish_progress();
  if (!made.ok()) return fail(made.error());
  const ObjectReport& r = *made;
  if (globals.json) {
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
    put_json(json);
    return 0;
  }
  say("mesh       {} triangles, {}, {:.3g} x {:.3g} x {:.3g} m\n", r.triangles,
      r.is_closed ? "closed" : "not closed", r.size.x, r.size.y, r.size.z);
  say("mass       {:.4g} kg of {:.4g} m³\n", r.mass, r.volume);
  say("colliders  {}, in {:.2f} s\n", count_kinds(r.colliders), r.seconds);
  if (!r.colliders.empty())
    say("overlap    {}surfaces {:.3g} mm apart on average, {:.3g} mm at most\n",
        r.is_closed ? fmt::format("{:.1f} % of the volumes, ", 100 * r.shared) : "",
        1e3 * r.mean_distance, 1e3 * r.max_distance);
  for (const std::string& note : r.notes) say("note       {}\n", note);
  return 0;
}

}  // namespace

void add_convert(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub = app.add_subcommand(
      "convert", "Report the body and colliders that a mesh file produces as an [[object]]");
  auto command = std::make_shared<ConvertCommand>();
  sub->add_option("FILE", command->file, "glTF, GLB, OBJ, STL or PLY")->required();
  sub->add_option("--node", command->object.node,
                  "Name of a node to convert; default: the whole file");
  sub->add_option("--colliders", command->object.colliders,
                  "Kind of colliders: auto (default), box, sphere, capsule, hull, hulls or none");
  ObjectOptions& o = command->object;
  sub->add_option("--scale", command->scale,
                  "Scale factor, or one factor per axis, such as 2, 1,1,2 or -1,1,1; default: 1");
  sub->add_option("--up", o.up,
                  "Axis of the file that points up; auto: y for glTF, z for other formats")
      ->check(CLI::IsMember({"auto", "y", "z"}));
  sub->add_option("--unit", o.unit,
                  "Length unit of the file in metres, such as 0.001 for millimetres; default: 1")
      ->check(positive_number());
  sub->add_option("--density", o.density, "Density in kg/m³; default: 1000")
      ->check(positive_number());
  sub->add_option("--mass", o.mass, "Mass in kg; overrides --density")->check(positive_number());
  sub->add_option("--concavity", o.concavity,
                  "For hulls: maximum distance between a part and its hull as a fraction of the "
                  "size, 0.01 … 1; default: 0.05");
  sub->add_option("--max-hulls", o.max_hulls,
                  "For hulls: maximum number of hulls, 1 … 256; default: 32");
  add_access_options(*sub, command->access, command->packages);
  sub->footer(
      "Examples:\n  gloam convert assets/models/lantern/lantern.glb --colliders hull\n"
      "  gloam convert part.stl --unit 0.001 --up y --density 2700\n"
      "  gloam convert chair.obj --colliders hulls --concavity 0.02 --max-hulls 64");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return convert(*command, globals); };
  });
}

}  // namespace gloam::cli
