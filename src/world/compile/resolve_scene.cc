#include "world/compile/resolve_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <utility>

#include "geometry/mesh/model_file.h"
#include "gloam/output_names.h"
#include "places/generators.h"
#include "places/writer/place_writer.h"
#include "scene/adversity.h"
#include "scene/overcast.h"
#include "scene/randomize/randomize.h"
#include "world/compile/rigs.h"
#include "world/compile/sampled_ground.h"

namespace gloam {
namespace {

// Notes requested sizes that exceed the limits of their kind of prop.
void note_sizes(const Scene& scene, const Place& place, std::vector<Error>* notes) {
  constexpr double kAbsoluteTolerance = 0.05, kRelativeTolerance = 0.1;  // [m], of the edge
  for (const PropOptions& prop : scene.props) {
    if (!prop.size) continue;
    for (const Placement& placement : place.placements()) {
      if (placement.name != prop.name) continue;
      const Prop::Box box = place.prop(placement.prop).bounds();
      const Vec3f made = box.high - box.low;
      const double edges[3][2] = {
          {prop.size->x, made.x}, {prop.size->y, made.y}, {prop.size->z, made.z}};
      std::string told;
      for (size_t i = 0; i < 3; ++i) {
        const auto [asked, is] = std::pair(edges[i][0], edges[i][1]);
        if (std::abs(asked - is) <= kAbsoluteTolerance + kRelativeTolerance * asked) continue;
        constexpr const char* kEdges[] = {"deep", "wide", "high"};
        told += fmt::format("{}{:.2f} m {}, not {:.4g} m", told.empty() ? "" : ", ", is, kEdges[i],
                            asked);
      }
      if (told.empty()) continue;
      notes->push_back(
          {ErrorKind::kInput, fmt::format("prop '{}': it is {}", prop.name, told), prop.loc,
           fmt::format("the closest possible size of a {}; `gloam props` lists typical sizes",
                       prop.kind)});
    }
  }
}

// Channels among outputs become the outputs that a recording makes of them.
void expand_outputs(Scene* scene) {
  scene->record.outputs = recorded_outputs(scene->record.outputs);
  for (CameraOptions& camera : scene->cameras)
    if (camera.outputs) camera.outputs = recorded_outputs(*camera.outputs);
}

bool has_meshes(const Scene& scene) {
  return !scene.objects.empty() || is_model_file(scene.environment.file);
}

// The sky of the weather, and lamps and materials of the place.
Status add_looks(Place* place, Scene* scene) {
  if (scene->weather && !scene->sky) {
    scene->sky = overcast_sky(*scene->weather);
    if (scene->sky && place != nullptr && scene->environment.terrain)
      place->ev100 = overcast_ev100(*scene->sky);
  }
  if (place != nullptr) {
    const size_t own = scene->lights.size();
    add_place_looks(*place, scene);
    apply_adversity_to_lamps(*scene, std::span(scene->lights).first(scene->lights.size() - own));
  }
  return add_ground_looks(scene);
}

}  // namespace

double compile_weight(const Scene& scene) {
  return kModelWeight + (has_meshes(scene) ? kReadWeight + kConvertWeight : 0) +
         (scene.hfields.empty() ? 0 : kSampleWeight);
}

Result<ResolvedScene> resolve_scene(Scene written, CompileProgress* progress) {
  ResolvedScene resolved{.written = std::move(written)};
  Scene& scene = resolved.scene = resolved.written;

  // The place, of which adversity and random values are a part
  GLOAM_TRY_STATUS(draw_options(DrawStage::kPlace, &scene, &resolved.drawn));
  apply_adversity(&scene);
  if (has_generator(scene.environment)) progress->begin("generating the place", 0);
  GLOAM_TRY(resolved.place, make_place(scene));
  GLOAM_TRY_STATUS(progress->check());
  Place* const place = resolved.place ? &*resolved.place : nullptr;
  GLOAM_TRY_STATUS(add_looks(place, &scene));

  // Meshes, whose materials the remaining random values may change
  if (has_meshes(scene)) progress->begin("reading model files", kReadWeight);
  GLOAM_TRY(resolved.objects, load_mesh_objects(scene, progress));
  GLOAM_TRY_STATUS(add_object_visuals(resolved.objects, &scene));
  GLOAM_TRY_STATUS(draw_options(DrawStage::kRest, &scene, &resolved.drawn));
  scene.randomize.clear();

  // Cameras of rigs, and outputs by their full names
  GLOAM_TRY(scene, with_rig_cameras(scene));
  expand_outputs(&scene);
  resolved.place_hash = (place != nullptr ? place->hash() : 0) ^ resolved.objects.hash;
  if (place != nullptr) note_sizes(scene, *place, &resolved.notes);
  return resolved;
}

}  // namespace gloam
