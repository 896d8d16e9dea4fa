// gloam props: the catalogue.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command.h"
#include "gloam/scene.h"
#include "json_text.h"
#include "print.h"

namespace gloam::cli {
namespace {

using Json = nlohmann::ordered_json;

int list_props(const Globals& globals) {
  const std::vector<PropInfo> props = prop_kinds();
  if (globals.json) {
    Json json = Json::array();
    for (const PropInfo& p : props)
      json.push_back({{"kind", p.kind},
                      {"text", p.text},
                      {"size", {p.size.x, p.size.y, p.size.z}},
                      {"mass", p.mass},
                      {"loose", p.loose}});
    put_json(json);
    return 0;
  }
  size_t width = 4;
  for (const PropInfo& p : props) width = std::max(width, p.kind.size());
  say("{:{}}  {:>18}  {:>8}  description\n", "kind", width, "size [m]", "mass");
  for (const PropInfo& p : props)
    say("{:{}}  {:>18}  {:>5.{}f} kg  {}{}\n", p.kind, width,
        fmt::format("{:.2f} {:.2f} {:.2f}", p.size.x, p.size.y, p.size.z), p.mass,
        p.mass < 10 ? 2 : 0, p.text, p.loose ? " (loose)" : "");
  return 0;
}

}  // namespace

void add_props(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub =
      app.add_subcommand("props", "List the objects that a [[prop]] can add to a scene");
  sub->footer(
      "The size is depth, width and height; objects are fixed unless they are marked as "
      "loose.\nExamples:\n  gloam props\n  gloam --json props");
  sub->callback([&globals, &action] { action = [&globals] { return list_props(globals); }; });
}

}  // namespace gloam::cli
