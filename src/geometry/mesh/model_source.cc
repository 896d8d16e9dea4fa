#include "geometry/mesh/model_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/path_readings.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr int64_t kGrain = 1 << 14;
constexpr uint64_t kNoContent = UINT64_MAX;

bool is_below(const fs::path& path, const fs::path& folder) {
  const auto [in_folder, in_path] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return in_folder == folder.end() && in_path != path.end();
}

std::string why_not_a_relative_path(std::string_view name) {
  if (name.empty()) return "is empty";
  if (name.size() > 2000) return fmt::format("has {} characters", name.size());
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 0x20) return "contains a control character";
  if (name.find(':') < name.find('/'))
    return "is a network address or has a drive or scheme; only files beside the model are read";
  if (name.front() == '/') return "is an absolute path; only files beside the model are read";
  return {};
}

// First element for which `is_bad` holds, found in parallel; kNone = none.
template <class T, class F>
uint64_t find_first(const std::vector<T>& values, const F& is_bad) {
  std::atomic<uint64_t> first{kNoContent};
  parallel_for_range("check mesh", static_cast<int64_t>(values.size()), kGrain,
                     [&](int64_t begin, int64_t end) {
                       for (int64_t i = begin; i < end; ++i) {
                         if (!is_bad(values[static_cast<size_t>(i)])) continue;
                         const uint64_t at = static_cast<uint64_t>(i);
                         uint64_t known = first.load();
                         while (at < known && !first.compare_exchange_weak(known, at)) {
                         }
                         return;
                       }
                     });
  return first;
}

bool not_finite(Vec3f v) {
  return !(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
}
bool not_finite(Vec2f v) { return !(std::isfinite(v.x) && std::isfinite(v.y)); }

bool has_area(const TriangleMesh& mesh, size_t triangle) {
  const uint32_t* corner = mesh.indices.data() + 3 * triangle;
  if (corner[0] == corner[1] || corner[1] == corner[2] || corner[0] == corner[2]) return false;
  using Vec3d = Vec3Of<double>;
  const auto at = [&](int i) {
    const Vec3f p = mesh.positions[corner[i]];
    return Vec3d{p.x, p.y, p.z};
  };
  const Vec3d a = at(0), n = cross(at(1) - a, at(2) - a);
  return n.x != 0 || n.y != 0 || n.z != 0;
}

uint64_t drop_flat_triangles(TriangleMesh* mesh) {
  const size_t count = mesh->triangle_count();
  std::vector<uint8_t> keep(count);
  parallel_for_range("find flat triangles", static_cast<int64_t>(count), kGrain,
                     [&](int64_t begin, int64_t end) {
                       for (int64_t i = begin; i < end; ++i)
                         keep[static_cast<size_t>(i)] = has_area(*mesh, static_cast<size_t>(i));
                     });
  const auto kept = static_cast<size_t>(std::count(keep.begin(), keep.end(), uint8_t{1}));
  if (kept == count) return 0;
  size_t to = 0;
  for (size_t i = 0; i < count; ++i) {
    if (keep[i] == 0) continue;
    std::copy_n(mesh->indices.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                mesh->indices.begin() + static_cast<std::ptrdiff_t>(3 * to));
    ++to;
  }
  mesh->indices.resize(3 * kept);
  return count - kept;
}

}  // namespace

Result<ModelFolder> ModelFolder::open(const fs::path& model, const fs::path& root) {
  std::error_code code;
  ModelFolder out;
  out.folder_ = fs::weakly_canonical(model, code).parent_path();
  out.root_ = root.empty() ? out.folder_ : fs::weakly_canonical(root, code);
  if (out.folder_ != out.root_ && !is_below(out.folder_, out.root_)) {
    return Error{ErrorKind::kInput,
                 fmt::format("is outside of the root folder '{}'", root.string()),
                 {model.string(), 0, 0},
                 "choose a root that contains the file"};
  }
  return out;
}

Result<std::vector<uint8_t>> ModelFolder::read(std::string_view name, const SourceLoc& loc,
                                               const ModelLimits& limits) {
  const auto refuse = [&](std::string_view why) {
    return Error{ErrorKind::kInput, fmt::format("the file name '{}' {}", name.substr(0, 200), why),
                 loc, "put the file beside the model and refer to it by a relative path"};
  };
  if (root_.empty()) return refuse("cannot be resolved: the model was not read from a folder");
  if (parts_.size() >= limits.external_files)
    return refuse(fmt::format("exceeds the limit of {} files", limits.external_files));
  fs::path path;
  std::error_code code;
  for (const std::string& reading : path_readings(name)) {
    if (const std::string why = why_not_a_relative_path(reading); !why.empty()) return refuse(why);
    path = fs::weakly_canonical(folder_ / fs::path(reading), code);
    if (code || !is_below(path, root_))
      return refuse(fmt::format("leads outside of the folder '{}'", root_.string()));
    if (fs::exists(path, code)) break;
  }
  if (!fs::exists(path, code)) {
    parts_.push_back({std::string(name), false, 0});
    return Error{ErrorKind::kIo, fmt::format("the file '{}' is missing", name), loc,
                 fmt::format("put it into '{}'", path.parent_path().string())};
  }
  GLOAM_TRY(std::vector<uint8_t> bytes, read_file(path, limits.file_bytes));
  parts_.push_back({std::string(name), true, hash_bytes(bytes.data(), bytes.size())});
  return bytes;
}

void ProgressCount::add(uint64_t done) {
  const uint64_t now = done_.fetch_add(done) + done;
  if (!report_ || total_ == 0) return;
  std::unique_lock lock(mutex_, std::defer_lock);
  if (now >= total_)
    lock.lock();  // the end is always reported
  else if (!lock.try_lock())
    return;
  const double share = std::min(1.0, static_cast<double>(now) / static_cast<double>(total_));
  if (share <= reported_ || (share < 1 && share < reported_ + 0.005)) return;
  reported_ = share;
  report_(share);
}

void add_note(ModelFile* model, std::string note) {
  if (std::find(model->notes.begin(), model->notes.end(), note) != model->notes.end()) return;
  if (model->notes.size() + 1 == kMaxNotes) note = "further notes are omitted";
  if (model->notes.size() < kMaxNotes) model->notes.push_back(std::move(note));
}

Status finish_mesh(TriangleMesh* mesh, const std::string& what, const std::string& file,
                   ModelFile* model) {
  const auto bad = [&](std::string_view kind, uint64_t index, const char* hint) {
    return Error{ErrorKind::kInput,
                 fmt::format("{}: {} {} is not finite", what, kind, index),
                 {file, 0, 0},
                 hint};
  };
  const char* repair = "repair the mesh in the program that created it and export it again";
  const auto bad3 = [](Vec3f v) { return not_finite(v); };
  const auto bad2 = [](Vec2f v) { return not_finite(v); };
  if (const uint64_t i = find_first(mesh->positions, bad3); i != kNoContent)
    return bad("the position of vertex", i, repair);
  if (const uint64_t i = find_first(mesh->normals, bad3); i != kNoContent)
    return bad("the normal of vertex", i, repair);
  if (const uint64_t i = find_first(mesh->uvs, bad2); i != kNoContent)
    return bad("the uv of vertex", i, repair);
  if (const uint64_t i = find_first(mesh->uvs1, bad2); i != kNoContent)
    return bad("the second uv of vertex", i, repair);
  const uint64_t count = mesh->positions.size();
  if (const uint64_t i = find_first(mesh->indices, [count](uint32_t v) { return v >= count; });
      i != kNoContent) {
    return Error{ErrorKind::kInput,
                 fmt::format("{}: triangle {} uses vertex {}, but there are {}", what, i / 3,
                             mesh->indices[i], count),
                 {file, 0, 0},
                 repair};
  }
  model->dropped_triangles += drop_flat_triangles(mesh);
  return {};
}

}  // namespace gloam
