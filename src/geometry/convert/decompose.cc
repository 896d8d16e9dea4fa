// CoACD through its C API, declared here from its public header
// (https://github.com/SarahWeiii/CoACD, version 1.0.14): none is needed to build.

#include "geometry/convert/decompose.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "base/archive.h"
#include "base/cache.h"
#include "base/cache_writer.h"
#include "base/files.h"
#include "base/hash.h"
#include "geometry/convert/coarsen.h"
#include "geometry/convert/mass.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr const char* kLibrary = "lib_coacd.so";
// "GLOMHL03": changes with the layout and the parameters of CoACD.
constexpr uint64_t kHullsMagic = 0x33304C48'4D4F4C47ull;

// As the cache keeps it: an archive of whole meshes, with normals and more, is model_file_cache's.
struct KeptHull {
  std::vector<Vec3f> positions;
  std::vector<uint32_t> indices;
};
template <class F>
void visit_parts(F& f, KeptHull& hull) {
  f(hull.positions), f(hull.indices);
}

/// Iterations of CoACD's search for a cut through a mesh that it has remeshed.
constexpr int kOpenIterations = 20;

struct CoacdMesh {
  double* vertices;
  uint64_t vertex_count;
  int* triangles;
  uint64_t triangle_count;
};
struct CoacdMeshes {
  CoacdMesh* meshes;
  uint64_t count;
};

struct CoacdApi {
  CoacdMeshes (*run)(const CoacdMesh& mesh, double threshold, int max_hulls, int preprocess,
                     int preprocess_resolution, int sample_resolution, int mcts_nodes,
                     int mcts_iterations, int mcts_max_depth, bool pca, bool merge, bool decimate,
                     int max_hull_vertices, bool extrude, double extrude_margin, int approximation,
                     unsigned seed, bool real_metric) = nullptr;
  void (*free)(CoacdMeshes) = nullptr;
  void (*set_log_level)(const char* level) = nullptr;
  uint64_t version = 0;  // hash of the library
};

std::vector<fs::path> candidates() {
  if (const char* user = std::getenv("GLOAM_COACD"); user != nullptr && *user != 0) {
    std::error_code code;
    return {fs::is_directory(user, code) ? fs::path(user) / kLibrary : fs::path(user)};
  }
  std::vector<fs::path> paths;
  if (const Result<fs::path> home = gloam_home(); home.ok()) {
    paths.push_back(*home / ".venv" / "wheels" / "coacd" / kLibrary);
    const fs::path prefix = home->parent_path().parent_path();  // prefix of an installation
    paths.push_back(prefix / "lib" / "gloam" / "coacd" / kLibrary);
  }
  return paths;
}

Result<CoacdApi> load_library() {
  const Error missing{
      ErrorKind::kUnsupported,
      "CoACD, which decomposes meshes, is not installed",
      {},
      "run ./gloam setup, set GLOAM_COACD to its lib_coacd.so, or use colliders = \"hull\""};
#ifdef GLOAM_SANITIZED
  return missing;  // sanitizers end a program that loads a library with its own symbols first
#endif
  for (const fs::path& path : candidates()) {
    // Never unloaded: its threads may outlive the call. Its own symbols first: it has an spdlog
    // within that is not ours.
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE | RTLD_DEEPBIND);
    if (library == nullptr) continue;
    CoacdApi api;
    const auto load = [&](auto& function, const char* name) {
      function =
          reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
      return function != nullptr;
    };
    const Result<std::vector<uint8_t>> bytes = read_file(path);
    if (!load(api.run, "CoACD_run") || !load(api.free, "CoACD_freeMeshArray") ||
        !load(api.set_log_level, "CoACD_setLogLevel") || !bytes.ok())
      return missing;
    api.version = hash_large(std::as_bytes(std::span(*bytes)));
    api.set_log_level("off");
    return api;
  }
  return missing;
}

std::vector<TriangleMesh> run(const CoacdApi& api, const TriangleMesh& mesh,
                              const DecomposeOptions& options) {
  std::vector<double> vertices;
  for (const Vec3f p : mesh.positions) vertices.insert(vertices.end(), {p.x, p.y, p.z});
  std::vector<int> triangles(mesh.indices.begin(), mesh.indices.end());
  const CoacdMesh in{vertices.data(), mesh.positions.size(), triangles.data(),
                     mesh.triangle_count()};
  // Meshes that are not manifold it remeshes first, on a grid of 50 steps, which makes thin walls
  // thick. It would do so for pieces that cross each other, too, and can do without: a mug shares
  // 0.84 of its volume with its parts instead of 0.69, a chair 0.95 instead of 0.63, in half the
  // time. Its search is given a fifth of its usual time, or a fifteenth where a remeshed surface
  // has ten thousands of triangles: the parts are nearly as good.
  constexpr int kRemeshAuto = 0, kRemeshNever = 2;
  const bool is_closed = count_edges(mesh).is_closed();
  const int remesh = is_closed ? kRemeshNever : kRemeshAuto;
  constexpr int kGrid = 50, kSamples = 2000, kHullVertices = 256;
  constexpr int kNodes = 10, kDepth = 3;  // limits of the tree search
  const int iterations = is_closed ? 60 : kOpenIterations;
  const CoacdMeshes parts =
      api.run(in, options.concavity, options.max_hulls, remesh, kGrid, kSamples, kNodes, iterations,
              kDepth, false, true, false, kHullVertices, false, 0.01, 0, 0, false);
  std::vector<TriangleMesh> out;
  for (uint64_t i = 0; i < parts.count; ++i) {
    const CoacdMesh& part = parts.meshes[i];
    TriangleMesh& hull = out.emplace_back();
    for (uint64_t v = 0; v < part.vertex_count; ++v) {
      const double* p = part.vertices + 3 * v;
      hull.positions.push_back(
          {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    }
    hull.indices.assign(part.triangles, part.triangles + 3 * part.triangle_count);
  }
  api.free(parts);
  return out;
}

bool load_hulls(const fs::path& path, std::vector<TriangleMesh>* hulls) {
  std::error_code code;
  if (!fs::exists(path, code)) return false;
  const Result<std::vector<uint8_t>> bytes = read_file(path);
  if (!bytes.ok()) return false;
  ArchiveReader in(unseal_cache_entry(kHullsMagic, *bytes));
  std::vector<KeptHull> kept;
  in(kept);
  if (!in.is_done() || kept.empty()) return false;
  for (KeptHull& hull : kept)
    hulls->push_back({.positions = std::move(hull.positions), .indices = std::move(hull.indices)});
  mark_cache_use(path);
  return true;
}

Error cancelled() { return {ErrorKind::kInterrupted, "the conversion was cancelled"}; }

void store_hulls(const fs::path& entry, const std::vector<TriangleMesh>& hulls) {
  ArchiveWriter out;
  begin_cache_entry(&out.bytes);
  std::vector<KeptHull> kept;
  for (const TriangleMesh& hull : hulls) kept.push_back({hull.positions, hull.indices});
  out(kept);
  seal_cache_entry(kHullsMagic, &out.bytes);
  keep_in_cache(entry, out.bytes);
}

/// One decomposition; the only data that it shares with the waiting thread.
struct Job {
  CoacdApi api;
  TriangleMesh mesh;
  DecomposeOptions options;
  fs::path entry;
  std::atomic<bool> is_unwanted{false};

  std::mutex mutex;
  std::condition_variable changed;
  std::optional<Result<std::vector<TriangleMesh>>> result;  // guarded by mutex
};

Result<std::vector<TriangleMesh>> work(const Job& job) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  std::vector<TriangleMesh> hulls;
  if (job.is_unwanted) return cancelled();
  if (load_hulls(job.entry, &hulls)) return hulls;  // entry of a twin
  try {
    hulls = run(job.api, job.mesh, job.options);
  } catch (const std::exception& e) {
    return Error{ErrorKind::kInput, fmt::format("CoACD failed on the mesh: {}", e.what())};
  } catch (...) {
    hulls.clear();
  }
  if (hulls.empty())
    return Error{
        ErrorKind::kInput, "CoACD found no parts in the mesh", {}, "use colliders = \"hull\""};
  store_hulls(job.entry, hulls);  // at once: a run that starts now has the same parts
  return hulls;
}

/// Threads that nobody waits for any more, but the end of the program: CoACD's statics go then.
class LeftBehind {
 public:
  ~LeftBehind() {
    for (std::thread& thread : threads_) thread.join();
  }
  void add(std::thread thread) {
    const std::lock_guard lock(mutex_);
    threads_.push_back(std::move(thread));
  }

 private:
  std::mutex mutex_;
  std::vector<std::thread> threads_;
};

Result<std::vector<TriangleMesh>> work_unless_cancelled(const std::shared_ptr<Job>& job,
                                                        const std::atomic<bool>& is_cancelled) {
  static LeftBehind left_behind;
  std::thread thread([job] {
    Result<std::vector<TriangleMesh>> result = work(*job);
    const std::lock_guard lock(job->mutex);
    job->result = std::move(result);
    job->changed.notify_all();
  });
  constexpr std::chrono::milliseconds kPollPeriod{20};
  std::unique_lock lock(job->mutex);
  while (!job->changed.wait_for(lock, kPollPeriod, [&] { return job->result.has_value(); })) {
    if (!is_cancelled) continue;
    job->is_unwanted = true;
    left_behind.add(std::move(thread));
    return cancelled();
  }
  lock.unlock();
  thread.join();
  return std::move(*job->result);
}

}  // namespace

Result<std::vector<TriangleMesh>> decompose(const TriangleMesh& welded,
                                            const DecomposeOptions& options) {
  static const Result<CoacdApi> api = load_library();
  if (!api.ok()) return api.error();
  uint64_t key =
      hash_bytes(&options.concavity, sizeof(options.concavity), kHullsMagic ^ api->version);
  key = hash_bytes(&options.max_hulls, sizeof(options.max_hulls), key);
  key = hash_span(std::span<const Vec3f>(welded.positions), key);
  key = hash_span(std::span<const uint32_t>(welded.indices), key);
  if (!count_edges(welded).is_closed())
    key = hash_bytes(&kOpenIterations, sizeof(kOpenIterations), key);
  auto job = std::make_shared<Job>();
  job->entry = cache_folder(kHullCache) / cache_entry_name(kHullCache, key);
  std::vector<TriangleMesh> hulls;
  if (load_hulls(job->entry, &hulls)) return hulls;
  job->api = *api;
  job->mesh = coarsened(welded, kMostDecomposed);
  job->options = options;
  job->options.is_cancelled = nullptr;  // it may be gone before the job
  if (options.is_cancelled == nullptr) return work(*job);
  return work_unless_cancelled(job, *options.is_cancelled);
}

}  // namespace gloam
