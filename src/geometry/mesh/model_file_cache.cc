#include "geometry/mesh/model_file_cache.h"

#include <algorithm>

#include "base/archive.h"
#include "base/cache.h"
#include "base/cache_writer.h"
#include "base/files.h"
#include "base/hash.h"
#include "geometry/mesh/model_source.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

// "GLOMDL04": changes with what readers give.
constexpr uint64_t kModelMagic = 0x34304C444D4F4C47ull;
constexpr uint64_t kLargestEntry = uint64_t{8} << 30;

}  // namespace

// Parts of an entry, in the order of writing and of reading.
template <class F>
void visit_parts(F& f, TriangleMesh& m) {
  f(m.positions), f(m.normals), f(m.uvs), f(m.indices), f(m.uvs1);
}
template <class F>
void visit_parts(F& f, ImportedImage& i) {
  f(i.name), f(i.bytes);
}
template <class F>
void visit_parts(F& f, ImportedInstance& i) {
  f(i.name), f(i.mesh), f(i.material), f(i.X_FI);
}
template <class F>
void visit_parts(F& f, ImportedLight& l) {
  f(l.name), f(l.type), f(l.color), f(l.intensity), f(l.range), f(l.inner_cone), f(l.outer_cone);
  f(l.X_FL);
}
template <class F>
void visit_parts(F& f, ImportedMaterial& m) {
  f(m.name);
  f(static_cast<MaterialValues&>(m));
}
template <class F>
void visit_parts(F& f, ModelPart& p) {
  f(p.name), f(p.exists), f(p.hash);
}
template <class F>
void visit_parts(F& f, ModelFile& m) {
  f(m.meshes), f(m.materials), f(m.images), f(m.instances), f(m.lights), f(m.dropped_triangles);
  f(m.was_y_up), f(m.notes);
}

namespace {

// Path of an entry. The result of a reader depends on the content, on the ending of the file's name
// and on the limits, which lead to errors that are not cached.
fs::path entry_path(const fs::path& folder, const fs::path& model, uint64_t content) {
  const std::string ending = model.extension().string();
  const uint64_t key = hash_bytes(ending.data(), ending.size(), content ^ kModelMagic);
  return folder / cache_entry_name(kVisualCache, key);
}

struct Entry {
  uint64_t content = 0;  // hash of the model file
  std::vector<ModelPart> parts;
  ModelFile model;
};

bool are_unchanged(const std::vector<ModelPart>& parts, ModelFolder* beside,
                   const ModelFileOptions& options) {
  return std::all_of(parts.begin(), parts.end(), [&](const ModelPart& part) {
    const Result<std::vector<uint8_t>> bytes = beside->read(part.name, {}, options.limits);
    if (!bytes.ok()) return !part.exists && bytes.error().kind == ErrorKind::kIo;
    return part.exists && beside->parts().back().hash == part.hash;
  });
}

void list_parts(const std::vector<ModelPart>& parts, ModelFile* model) {
  for (const ModelPart& part : parts) model->parts.push_back(part.name);
}

bool load_entry(const fs::path& path, uint64_t content, ModelFolder beside,
                const ModelFileOptions& options, ModelFile* out) {
  std::error_code code;
  if (!fs::exists(path, code)) return false;
  const Result<std::vector<uint8_t>> bytes = read_file(path, kLargestEntry);
  if (!bytes.ok()) return false;
  ArchiveReader in(unseal_cache_entry(kModelMagic, *bytes));
  Entry entry;
  in(entry.content);
  in(entry.parts);
  if (entry.content != content || !are_unchanged(entry.parts, &beside, options)) return false;
  visit_parts(in, entry.model);
  if (!in.is_done()) return false;
  *out = std::move(entry.model);
  list_parts(entry.parts, out);
  mark_cache_use(path);
  return true;
}

void store_entry(const fs::path& path, Entry& entry) {
  ArchiveWriter out;
  begin_cache_entry(&out.bytes);
  out(entry.content);
  out(entry.parts);
  visit_parts(out, entry.model);
  keep_in_cache_later(path, kModelMagic, std::move(out.bytes));
}

}  // namespace

Result<ModelFile> read_model_file_cached(const fs::path& path, const fs::path& folder,
                                         const ModelFileOptions& options, bool* was_cached) {
  GLOAM_TRY(const std::vector<uint8_t> bytes, read_file(path, options.limits.file_bytes));
  GLOAM_TRY(ModelFolder beside, ModelFolder::open(path, options.root));
  const uint64_t content = hash_large(std::as_bytes(std::span(bytes)));
  const fs::path entry = entry_path(folder, path, content);
  ModelFile cached;
  const bool found = load_entry(entry, content, beside, options, &cached);
  if (was_cached != nullptr) *was_cached = found;
  if (found) {
    if (options.progress) options.progress(1);
    return cached;
  }
  GLOAM_TRY(ModelFile model, read_model_bytes({path.string(), bytes, &beside, &options}));
  Entry made{content, beside.parts(), std::move(model)};
  store_entry(entry, made);
  list_parts(made.parts, &made.model);
  return std::move(made.model);
}

}  // namespace gloam
