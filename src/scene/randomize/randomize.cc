#include "scene/randomize/randomize.h"

#include <fmt/format.h>

#include "base/log.h"
#include "places/generators.h"
#include "scene/randomize/option_drawer.h"
#include "scene/toml/option_walker.h"
#include "scene/toml/override_reader.h"
#include "scene/validate/validate.h"

namespace gloam {
namespace {

bool is_of_place(const std::string& table) {
  return table == "environment" || table == "prop" || table == "object" || table == "hfield";
}

// "[[randomize]] of 'light.a.flux': …", at its line.
Error blamed(const RandomizeOptions& o, Error error) {
  if (!error.message.starts_with("[[randomize]]"))
    error.message = fmt::format("[[randomize]] of '{}': {}", o.option, error.message);
  error.loc = o.loc;
  if (error.kind == ErrorKind::kUsage) error.kind = ErrorKind::kInput;
  return error;
}
Status blamed(const RandomizeOptions& o, const Status& status) {
  return status.ok() ? Status() : Status(blamed(o, status.error()));
}

// As if `value` were written for it in a scene.
Status add_override(const RandomizeOptions& o, const std::string& value,
                    std::vector<OverrideOptions>* overrides) {
  GLOAM_TRY(const toml::table line,
            parse_toml(fmt::format("{} = {}", o.option, value), o.loc.file));
  const toml::table* table = line["override"].as_table();
  const size_t before = overrides->size();
  if (table != nullptr) GLOAM_TRY_STATUS(read_overrides(*table, o.loc.file, overrides));
  if (overrides->size() == before)
    return Error{ErrorKind::kInput, "it does not name an attribute", o.loc,
                 "as in override.ROBOT.joint.NAME.damping"};
  for (size_t i = before; i < overrides->size(); ++i) (*overrides)[i].loc = o.loc;
  return {};
}

Status draw_override(const RandomizeOptions& o, Drawer* drawer, Scene* scene,
                     std::vector<DrawnOption>* drawn, const Status& status) {
  const std::optional<std::string> value = drawer->draw_override();
  if (!value) return status;
  GLOAM_TRY_STATUS(add_override(o, *value, &scene->overrides));
  drawn->push_back({o.option, *value});
  return {};
}

// Inputs and results of all draws.
struct Draws {
  DrawStage stage;
  std::optional<FileFinder> files = {};
  std::map<std::string, int> times = {};  // number of times that an option has been drawn
  std::vector<DrawnOption> drawn = {};

  bool has(const RandomizeOptions& o) const {
    return is_of_place(split_option_path(o.option)[0]) == (stage == DrawStage::kPlace);
  }
  Status draw(const RandomizeOptions& o, bool warns, Scene* scene) {
    const std::vector<std::string> names = split_option_path(o.option);
    Status status;
    Drawer drawer(o, o.seed.value_or(scene->sim.seed), files ? &*files : nullptr, &times, &drawn,
                  &status);
    if (names[0] == "override") return blamed(o, draw_override(o, &drawer, scene, &drawn, status));
    walk_options(names, o.loc, scene, &drawer, &status);
    if (warns && status.ok() && drawer.fitting() == 0)
      log_warning("{}:{}: [[randomize]] of '{}' matches nothing and has no effect", o.loc.file,
                  o.loc.line, o.option);
    return blamed(o, status);
  }
};

// The first draw that makes of a valid scene one that is not.
Error blame(const Draws& like, const Scene& before, const Error& error) {
  Draws draws{like.stage, like.files};
  Scene scene = before;
  for (const RandomizeOptions& o : before.randomize)
    if (draws.has(o) && draws.draw(o, false, &scene).ok())
      if (const Status status = validate_scene(scene); !status.ok())
        return blamed(o, status.error());
  return error;
}

Status check_form(const RandomizeOptions& o) {
  const auto bad = [&](std::string what, std::string hint = {}) {
    return Error{ErrorKind::kInput, fmt::format("[[randomize]] of '{}' {}", o.option, what), o.loc,
                 std::move(hint)};
  };
  if (!o.uniform.empty() + !o.log_uniform.empty() + !o.normal.empty() + !o.choice.empty() != 1)
    return bad(
        "needs exactly one distribution",
        "uniform = [from, to], log_uniform = [from, to], normal = [mean, sd] or choice = […]");
  if (o.choice.empty() && distribution_of(o).values.size() != 2)
    return bad("needs two values", "as in uniform = [from, to], or [[…], […]] for a vector");
  double sum = 0;
  for (const double weight : o.weights) sum += weight;
  if (!o.weights.empty() && (o.weights.size() != o.choice.size() || sum <= 0))
    return bad("needs one weight for each choice, and at least one above 0");
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
  for (const RandomizeOptions& o : scene.randomize) GLOAM_TRY_STATUS(check_form(o));
  // No draw may fail for some seeds only. Generated elements do not exist yet.
  Scene any = scene;
  for (const RandomizeOptions& o : scene.randomize) {
    const std::vector<std::string> names = split_option_path(o.option);
    if (names[0] == "override") {
      std::vector<OverrideOptions> overrides;
      for (const TomlText& value : o.choice)
        GLOAM_TRY_STATUS(blamed(o, add_override(o, value.text, &overrides)));
      continue;
    }
    Status status;
    Drawer drawer(o, &status);
    walk_options(names, o.loc, &any, &drawer, &status);
    if (status.ok()) status = validate_environment(any);
    GLOAM_TRY_STATUS(blamed(o, status));
  }
  return {};
}

Status draw_options(DrawStage stage, Scene* scene, std::vector<DrawnOption>* drawn) {
  Draws draws{stage};
  Scene changed = *scene;
  bool any = false;
  for (const RandomizeOptions& o : scene->randomize) {
    if (!draws.has(o)) continue;
    any = true;
    if (!draws.files && !scene->file.empty()) {
      GLOAM_TRY(draws.files, FileFinder::of_scene(scene->file, scene->access));
    }
    GLOAM_TRY_STATUS(draws.draw(o, true, &changed));
  }
  if (!any) return {};
  if (const Status status = validate_scene(changed); !status.ok())
    return blame(draws, *scene, status.error());
  *scene = std::move(changed);
  drawn->insert(drawn->end(), draws.drawn.begin(), draws.drawn.end());
  return {};
}

}  // namespace gloam
