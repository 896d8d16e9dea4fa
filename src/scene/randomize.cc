#include "scene/randomize.h"

#include <fmt/format.h>

#include "scene/option_drawer.h"
#include "scene/toml/option_walker.h"
#include "scene/validate.h"

namespace gloam {
namespace {

bool is_of_place(const std::string& table) {
  return table == "environment" || table == "prop" || table == "object" || table == "hfield";
}

Status draw_override(const RandomizeOptions& o, Drawer* drawer, Scene* scene,
                     std::vector<DrawnOption>* drawn, const Status& status) {
  const std::optional<std::string> value = drawer->draw_override();
  if (!value) return status;
  GLOAM_TRY(const toml::table line,
            parse_toml(fmt::format("{} = {}", o.option, *value), o.loc.file));
  const toml::table* table = line["override"].as_table();
  const size_t before = scene->overrides.size();
  if (table != nullptr) GLOAM_TRY_STATUS(read_overrides(*table, o.loc.file, &scene->overrides));
  if (scene->overrides.size() == before)
    return Error{ErrorKind::kInput, fmt::format("[[randomize]]: '{}' names no attribute", o.option),
                 o.loc, "as in override.ROBOT.joint.NAME.damping"};
  for (size_t i = before; i < scene->overrides.size(); ++i) scene->overrides[i].loc = o.loc;
  drawn->push_back({o.option, *value});
  return {};
}

}  // namespace

double gaussian(Dice* dice) {  // Box and Muller 1958
  const double radius = std::sqrt(-2 * std::log(1 - dice->uniform()));
  return radius * std::cos(2 * M_PI * dice->uniform());
}

Distribution distribution_of(const RandomizeOptions& o) {
  if (!o.uniform.empty()) return {Distribution::kUniform, o.uniform};
  if (!o.log_uniform.empty()) return {Distribution::kLogUniform, o.log_uniform};
  if (!o.normal.empty()) return {Distribution::kNormal, o.normal};
  return {Distribution::kChoice, o.choice};
}

size_t choose(const RandomizeOptions& o, Dice* dice) {
  double sum = 0;
  for (size_t i = 0; i < o.choice.size(); ++i) sum += o.weights.empty() ? 1 : o.weights[i];
  double rest = dice->uniform() * sum;
  size_t last = 0;
  for (size_t i = 0; i < o.choice.size(); ++i) {
    const double weight = o.weights.empty() ? 1 : o.weights[i];
    if (weight <= 0) continue;
    last = i;
    if (rest < weight) return i;
    rest -= weight;
  }
  return last;
}

Status validate_randomize(const Scene& scene) {
  for (const RandomizeOptions& o : scene.randomize) {
    const auto bad = [&](std::string what, std::string hint = {}) {
      return Error{ErrorKind::kInput, fmt::format("[[randomize]] of '{}' {}", o.option, what),
                   o.loc, std::move(hint)};
    };
    if (!o.uniform.empty() + !o.log_uniform.empty() + !o.normal.empty() + !o.choice.empty() != 1)
      return bad(
          "needs one distribution",
          "uniform = [from, to], log_uniform = [from, to], normal = [mean, sd] or choice = […]");
    if (o.choice.empty() && distribution_of(o).values.size() != 2)
      return bad("needs two values", "as in uniform = [from, to]; of a vector [[…], […]]");
    double sum = 0;
    for (const double weight : o.weights) sum += weight;
    if (!o.weights.empty() && (o.weights.size() != o.choice.size() || sum <= 0))
      return bad("has other than one weight for each choice, or none above 0");
  }
  return {};
}

Status draw_options(DrawStage stage, Scene* scene, std::vector<DrawnOption>* drawn) {
  std::optional<FileFinder> files;
  std::map<std::string, int> times;
  const uint64_t seed = scene->sim.seed;
  const std::vector<RandomizeOptions> all = scene->randomize;
  Scene changed = *scene;
  bool any = false;
  for (const RandomizeOptions& o : all) {
    const std::vector<std::string> names = split_option_path(o.option);
    if (is_of_place(names[0]) != (stage == DrawStage::kPlace)) continue;
    any = true;
    if (!files && !scene->file.empty()) {
      GLOAM_TRY(files, FileFinder::of_scene(scene->file, scene->access));
    }
    Status status;
    Drawer drawer(o, seed, files ? &*files : nullptr, &times, drawn, &status);
    if (names[0] == "override") {
      GLOAM_TRY_STATUS(draw_override(o, &drawer, &changed, drawn, status));
    } else {
      walk_options(names, o.loc, &changed, &drawer, &status);
      GLOAM_TRY_STATUS(std::move(status));
    }
  }
  if (!any) return {};
  GLOAM_TRY_STATUS(validate_scene(changed));
  *scene = std::move(changed);
  return {};
}

}  // namespace gloam
