#include "places/writer/place_looks.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "places/writer/place_writer.h"

namespace gloam {
namespace {

// Name of a look beside materials of the environment that use its own name: "NAME", "props/NAME",
// "props/NAME_2", "props/NAME_3" …
std::string look_name(const std::string& look, int number) {
  if (number == 0) return look;
  return number == 1 ? "props/" + look : fmt::format("props/{}_{}", look, number);
}

// Number of the last of these names that is taken, in a spec or in a model; -1 = none.
template <class IsTaken>
int last_taken(const std::string& look, const IsTaken& is_taken) {
  int last = is_taken(look) ? 0 : -1;
  for (int next = 1; is_taken(look_name(look, next)); ++next) last = next;
  return last;
}

// A maker may have mixed a material that this variant does not show.
std::vector<const Look*> shown_looks(const Place& place) {
  std::set<std::string> shown;
  for (const Placement& placement : place.placements())
    for (const PropPart& part : place.prop(placement.prop).parts)
      for (const PropVisual& visual : part.visuals) shown.insert(visual.material);
  for (const Scatter& scatter : place.scatters())
    for (const PropVisual& visual : place.prop(scatter.prop).body().visuals)
      shown.insert(visual.material);
  std::vector<const Look*> looks;
  for (const Look& look : place.materials.looks())
    if (shown.count(look.name)) looks.push_back(&look);
  return looks;
}

}  // namespace

std::string free_look_name(const std::string& look, mjSpec* spec) {
  const int taken = last_taken(look, [&](const std::string& name) {
    return mjs_findElement(spec, mjOBJ_MATERIAL, name.c_str()) != nullptr;
  });
  return look_name(look, taken + 1);
}

void match_place_looks(const Place& place, const mjModel& model, Scene* scene) {
  const auto is_taken = [&](const std::string& name) {
    return mj_name2id(&model, mjOBJ_MATERIAL, name.c_str()) >= 0;
  };
  size_t i = 0;  // they are the first of the scene's materials
  for (const Look* look : shown_looks(place))
    scene->materials[i++].name =
        look_name(look->name, std::max(last_taken(look->name, is_taken), 0));
}

void add_place_looks(const Place& place, Scene* scene) {
  std::vector<MaterialOptions> materials;
  for (const Look* look : shown_looks(place)) {
    MaterialOptions options = look->more;
    options.name = look->name;
    materials.push_back(std::move(options));
  }
  scene->materials.insert(scene->materials.begin(), materials.begin(), materials.end());
  std::vector<LightOptions> lights;
  for (const Placement& placement : place.placements()) {
    int number = 0;
    for (LightOptions light : place.prop(placement.prop).lights) {
      light.body = placement.name;
      light.name = fmt::format("{}/{}_{}", placement.name, light.name.empty() ? "lamp" : light.name,
                               ++number);
      lights.push_back(std::move(light));
    }
  }
  scene->lights.insert(scene->lights.begin(), lights.begin(), lights.end());
  if (!scene->sky) scene->sky = place.sky;
}

}  // namespace gloam
