#include "world/compile/sampled_ground.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/log.h"
#include "places/writer/height_field_spec.h"
#include "places/writer/spec_geom.h"
#include "world/compile/model_loader.h"
#include "world/compile/progress/compile_progress.h"
#include "world/shapes/visual_file.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr double kSuspiciousSize = 1000;  // [m] more of a file in metres is worth a question

VisualOptions visual_of(const HeightFieldOptions& o) {
  VisualOptions visual;
  visual.name = o.name;
  visual.file = o.file;
  visual.X_BV = o.X_WF;
  visual.scale = o.scale;
  visual.up = o.up;
  visual.unit = o.unit;
  visual.loc = o.loc;
  return visual;
}

std::string title(const HeightFieldOptions& o) { return fmt::format("hfield '{}'", o.name); }

/// The file's meshes where the picture has them, too.
std::vector<PlacedMesh> place_meshes(const HeightFieldOptions& o, const ModelFile& model) {
  const auto wide = [](Vec3f v) { return Vec3Of<double>{v.x, v.y, v.z}; };
  std::vector<PlacedMesh> meshes;
  const Affine3f X_WF = visual_placement(visual_of(o), model.was_y_up);
  for (const ImportedInstance& in : model.instances) {
    const Affine3f X = X_WF * in.X_FI;
    meshes.push_back({&model.meshes[static_cast<size_t>(in.mesh)],
                      {wide(X.x), wide(X.y), wide(X.z), wide(X.p)}});
  }
  return meshes;
}

/// The meshes' horizontal bounds, and the part of them to be sampled.
struct SampledRegion {
  std::array<double, 2> mesh_low{}, mesh_high{}, low{}, high{};

  double extent() const { return std::max(mesh_high[0] - mesh_low[0], mesh_high[1] - mesh_low[1]); }
  std::string text() const {
    return fmt::format("the mesh extends over x {:.4g} … {:.4g} m, y {:.4g} … {:.4g} m",
                       mesh_low[0], mesh_high[0], mesh_low[1], mesh_high[1]);
  }
};

Result<SampledRegion> region_of(const HeightFieldOptions& o,
                                const std::vector<PlacedMesh>& meshes) {
  Vec3Of<double> low, high;
  if (!bounds_of(meshes, &low, &high))
    return Error{ErrorKind::kInput, "the file contains no triangles"};
  SampledRegion region{{low.x, low.y}, {high.x, high.y}, {}, {}};
  region.low = o.low.value_or(region.mesh_low);
  region.high = o.high.value_or(region.mesh_high);
  return region;
}

void report(const HeightFieldOptions& o, const Floors& floors,
            const std::vector<HeightField>& fields, const HeightError& error) {
  const HeightGrid& grid = floors.grid;
  std::string more;
  if (fields.size() > 1)
    more += fmt::format(", {} height fields of floors above", fields.size() - 1);
  if (fields[0].filled > 0)
    more += fmt::format(", {} samples missed the mesh and were filled", fields[0].filled);
  std::string distance = "; no cell has all its corners on the mesh";
  if (error.points > 0)
    distance =
        fmt::format("; distance to the mesh: mean {:.2g} m, 95 % below {:.2g} m, at most {:.2g} m",
                    error.mean, error.p95, error.most);
  log_info("hfield '{}': {} x {} samples, {:.4g} x {:.4g} m apart{}{}", o.name, grid.columns,
           grid.rows, grid.step[0], grid.step[1], more, distance);
}

Result<std::vector<HeightField>> sample(const HeightFieldOptions& o, const ModelFile& model,
                                        std::vector<Error>* notes) {
  const auto note = [&](std::string text, std::string hint) {
    notes->push_back(
        {ErrorKind::kInput, fmt::format("{}: {}", title(o), text), o.loc, std::move(hint)});
  };
  const std::vector<PlacedMesh> meshes = place_meshes(o, model);
  GLOAM_TRY(const SampledRegion region, region_of(o, meshes));
  const bool is_doubtful = o.unit == 1 && region.extent() > kSuspiciousSize;
  const std::string unit_hint = "if the file is in millimetres, set unit = 0.001";
  if (is_doubtful) note(fmt::format("the mesh is {:.0f} m wide", region.extent()), unit_hint);
  Result<HeightGrid> grid = make_height_grid(region.low, region.high, o.resolution, o.layers);
  if (!grid.ok()) {
    Error error = grid.error();
    if (is_doubtful) error.hint += "; " + unit_hint;
    if (error.hint.empty()) error.hint = region.text();
    return error;
  }
  GLOAM_TRY(const Floors floors, sample_floors(meshes, *grid, o.layers));
  Result<HeightField> ground = ground_of(floors);
  if (!ground.ok()) {
    return Error{ErrorKind::kInput,
                 ground.error().message,
                 {},
                 region.text() + "; exactly vertical walls are not ground"};
  }
  GLOAM_TRY(std::vector<HeightField> fields, slabs_of(floors));
  if (o.layers > 1 && fields.empty())
    note("only one layer was found: no floor lies below another",
         "lower floors must face up: are the mesh's triangles inside out?");
  fields.insert(fields.begin(), std::move(ground).value());
  GLOAM_TRY(const HeightError error, height_error(meshes, floors, fields));
  const auto samples = static_cast<int64_t>(fields[0].grid.size());
  if (fields[0].filled > samples / 2)
    note(fmt::format("{} of {} samples missed the mesh: most of this ground is filled in",
                     fields[0].filled, samples),
         region.text());
  report(o, floors, fields, error);
  return fields;
}

void add_field(const std::string& name, const HeightFieldOptions& o, const HeightField& field,
               mjSpec* spec) {
  mjsGeom* geom = add_height_field(name, field, spec);
  if (o.drawn) geom->group = kColliderGroup;
  write_friction(o.friction, geom);
}

}  // namespace

Status admit_ground_files(const Scene& scene, ModelFiles* files) {
  for (const HeightFieldOptions& o : scene.hfields)
    GLOAM_TRY_STATUS(files->admit(scene.file.empty() ? o.file : scene.file, scene.access));
  return {};
}

Result<std::vector<SampledGround>> sample_grounds(const Scene& scene, ModelFiles* files,
                                                  std::vector<Error>* notes,
                                                  CompileProgress* progress) {
  std::vector<SampledGround> grounds;
  for (const HeightFieldOptions& o : scene.hfields) {
    if (progress != nullptr) {
      GLOAM_TRY_STATUS(progress->check());
      progress->begin(fmt::format("sampling '{}'", o.name),
                      kSampleWeight / static_cast<double>(scene.hfields.size()));
    }
    GLOAM_TRY(const ModelFile model, load_model_file(scene, o.file, title(o), o.loc));
    GLOAM_TRY_STATUS(files->read(o.file));
    for (const std::string& part : model.parts)
      (void)files->read(o.file.parent_path() / part);  // a missing file is remembered as missing
    Result<std::vector<HeightField>> fields = sample(o, model, notes);
    if (!fields.ok()) return said_of(title(o), o.loc, fields.error());
    grounds.push_back({o, std::move(fields).value()});
  }
  return grounds;
}

Status add_grounds(const std::vector<SampledGround>& grounds, mjSpec* spec) {
  for (const SampledGround& ground : grounds) {
    for (size_t i = 0; i < ground.fields.size(); ++i) {
      const std::string& own = ground.options.name;
      const std::string name = i == 0 ? own : fmt::format("{}_{}", own, i + 1);
      for (const mjtObj type : {mjOBJ_GEOM, mjOBJ_HFIELD}) {
        if (mjs_findElement(spec, type, name.c_str()) == nullptr) continue;
        return Error{ErrorKind::kInput,
                     fmt::format("{}: the environment already has a {} '{}'", title(ground.options),
                                 mju_type2Str(type), name),
                     ground.options.loc, "choose another name"};
      }
      add_field(name, ground.options, ground.fields[i], spec);
    }
  }
  return {};
}

Status add_ground_looks(Scene* scene) {
  for (const HeightFieldOptions& o : scene->hfields) {
    if (!o.drawn) continue;
    GLOAM_TRY_STATUS(add_visual_of(title(o), visual_of(o), scene));
  }
  return {};
}

}  // namespace gloam
