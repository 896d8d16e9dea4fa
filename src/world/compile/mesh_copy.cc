#include "world/compile/mesh_copy.h"

#include <fmt/format.h>

#include <iterator>

#include "geometry/mesh/model_source.h"

namespace gloam {
namespace {

// 9 digits give every float back.
void append_obj(const ModelFile& model, const ImportedInstance& in, size_t* first, std::string* v,
                std::string* f) {
  const TriangleMesh& mesh = model.meshes[static_cast<size_t>(in.mesh)];
  const Affine3f& X = in.X_FI;
  const bool is_mirrored = dot(X.x, cross(X.y, X.z)) < 0;
  for (const Vec3f& position : mesh.positions) {
    const Vec3f p = transform_point(X, position);
    fmt::format_to(std::back_inserter(*v), "v {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
  }
  for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    fmt::format_to(std::back_inserter(*f), "f {} {} {}\n", *first + mesh.indices[t],
                   *first + mesh.indices[t + 1 + is_mirrored],
                   *first + mesh.indices[t + 2 - is_mirrored]);
  *first += mesh.positions.size();
}

Status add_copy(const UrdfMeshCopy& copy, ModelFiles* files) {
  const auto said = [&](const Error& error) {
    return Error{error.kind,
                 fmt::format("the collision mesh '{:.200}': {}", copy.file.string(), error.message),
                 copy.loc, error.hint.empty() ? "convert it to OBJ or binary STL" : error.hint};
  };
  // Read by way of ModelFiles, which decides what may be read and remembers what it was.
  const Result<std::shared_ptr<const std::string>> content = files->read(copy.file);
  if (!content.ok()) return said(content.error());
  const std::string& text = **content;
  const ModelFileOptions options;
  Result<ModelFolder> folder = ModelFolder::open(copy.file, {});
  if (!folder.ok()) return said(folder.error());
  const Result<ModelFile> model =
      read_model_bytes({copy.file.string(),
                        {reinterpret_cast<const uint8_t*>(text.data()), text.size()},
                        &*folder,
                        &options});
  if (!model.ok()) return said(model.error());
  for (const ModelPart& part : folder->parts())
    if (part.exists) (void)files->read(copy.file.parent_path() / part.name);
  std::string v, f;
  size_t first = 1;
  for (const ImportedInstance& in : model->instances) append_obj(*model, in, &first, &v, &f);
  if (f.empty()) return said({ErrorKind::kInput, "has no triangles", {}});
  files->set_overlay(copy.copy, v + f);
  return {};
}

}  // namespace

Status add_mesh_copies(const std::vector<UrdfMeshCopy>& copies, ModelFiles* files) {
  for (const UrdfMeshCopy& copy : copies) GLOAM_TRY_STATUS(add_copy(copy, files));
  return {};
}

}  // namespace gloam
