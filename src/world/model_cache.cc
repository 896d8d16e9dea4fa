#include "world/model_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/archive.h"
#include "base/cache.h"
#include "base/files.h"
#include "base/hash.h"
#include "scene/mujoco_guard.h"
#include "scene/mujoco_plugins.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

/// What an entry holds beside the models.
struct CacheEntry {
  std::vector<Dependency> dependencies;
  int initial_key = -1;
  std::vector<RobotInstance> robots;  // without their options
  std::vector<VisualOnlyGeom> visual_only;
  std::vector<Error> unsupported;
  bool has_plugins = false;
};

}  // namespace

// For writing, and in the same order for reading.
template <class F>
void visit_parts(F& f, Dependency& d) {
  std::string path = d.path.string();
  f(path), f(d.exists), f(d.hash);
  d.path = path;
}
template <class F>
void visit_parts(F& f, RobotInstance& r) {
  f(r.name), f(r.prefix), f(r.root_body);
}
template <class F>
void visit_parts(F& f, Error& e) {
  f(e.kind), f(e.message), f(e.loc.file), f(e.loc.line), f(e.loc.column), f(e.hint);
}

namespace {

template <class F>
void visit_entry(F& f, CacheEntry& e) {
  f(e.dependencies), f(e.initial_key), f(e.robots), f(e.visual_only), f(e.unsupported);
  f(e.has_plugins);
}

constexpr uint64_t kMagic = 0x33444C574D4F4C47ull;  // "GLOMWLD3": changes with the layout below
constexpr uint64_t kLargestEntry = uint64_t{2} << 30;

fs::path entry_of(const Scene& scene) {
  return cache_folder(kModelCache) / cache_entry_name(kModelCache, world_cache_key(scene));
}

void put_model(const mjModel* model, ArchiveWriter* out) {
  const uint64_t size = model == nullptr ? 0 : static_cast<uint64_t>(mj_sizeModel(model));
  const std::span<uint8_t> block = out->block(size);
  if (size > 0) mj_saveModel(model, nullptr, block.data(), static_cast<mjtSize>(size));
}

ModelPtr get_model(ArchiveReader* in) {
  const std::span<const uint8_t> block = in->block();
  if (block.empty()) return nullptr;
  mjModel* model = nullptr;
  const MujocoWarningCapture warnings;
  const auto size = static_cast<mjtSize>(block.size());
  if (!try_mujoco([&] { model = mj_loadModelBuffer(block.data(), size); })) model = nullptr;
  if (model == nullptr) in->fail();
  return ModelPtr(model);
}

std::vector<uint8_t> serialise(const CompiledWorld& world,
                               const std::vector<Dependency>& dependencies) {
  CacheEntry entry{dependencies,      world.initial_key, world.robots,
                   world.visual_only, world.unsupported, world.model->nplugin > 0};
  ArchiveWriter out;
  begin_cache_entry(&out.bytes);
  visit_entry(out, entry);
  put_model(world.model.get(), &out);
  put_model(world.visual_model.get(), &out);
  seal_cache_entry(kMagic, &out.bytes);
  return std::move(out.bytes);
}

void write_entry(const CompiledWorld& world, const std::vector<Dependency>& dependencies) {
  const std::vector<uint8_t> entry = serialise(world, dependencies);
  if (entry.size() <= kLargestEntry) keep_in_cache(entry_of(world.scene), entry);
}

// A program that has just compiled a world goes on to start up; an entry of 70 MB can wait for
// that.
constexpr std::chrono::seconds kStartUp{2};

// One writer at a time; its destructor at the end of the program waits for the last entry.
class BackgroundWriter {
 public:
  ~BackgroundWriter() { finish(); }
  void start(std::shared_ptr<const CompiledWorld> world, std::vector<Dependency> dependencies) {
    const std::lock_guard lock(mutex_);
    join();
    thread_ = std::thread([this, world = std::move(world), dependencies = std::move(dependencies)] {
      wait_for_start_up();
      write_entry(*world, dependencies);
    });
  }
  void finish() {
    const std::lock_guard lock(mutex_);
    join();
  }

 private:
  void wait_for_start_up() {
    std::unique_lock lock(hurry_mutex_);
    hurried_.wait_for(lock, kStartUp, [this] { return hurry_; });
  }
  void set_hurry(bool hurry) {
    const std::lock_guard lock(hurry_mutex_);
    hurry_ = hurry;
  }
  void join() {
    if (!thread_.joinable()) return;
    set_hurry(true);
    hurried_.notify_one();
    thread_.join();
    set_hurry(false);
  }

  std::mutex mutex_;
  std::thread thread_;
  std::mutex hurry_mutex_;
  std::condition_variable hurried_;
  bool hurry_ = false;  // someone waits for the entry
};

BackgroundWriter& background_writer() {
  static BackgroundWriter writer;
  return writer;
}

}  // namespace

uint64_t world_cache_key(const Scene& scene) {
  ArchiveWriter key;
  key(kMagic);
  key(std::string(mj_versionString()));
  key(absolute_path(scene.bare_model, "").string());
  key(scene.bare_model.empty());
  key(scene.environment.file.empty() ? std::string()
                                     : absolute_path(scene.environment.file, "").string());
  key(scene.name);
  key(scene.access.root.string());
  key(scene.access.strict);
  for (const auto& [name, folder] : scene.access.packages) {
    key(name);
    key(absolute_path(folder, "").string());
  }
  key(scene.sim.timestep.value_or(0));
  for (const RobotOptions& robot : scene.robots) {
    key(robot.name);
    key(absolute_path(robot.file, "").string());
    key(robot.X_WR);
    key(robot.keyframe);
    key(robot.loc.line);  // stands in cached messages
  }
  for (const OverrideOptions& override : scene.overrides) {
    for (const std::string* part :
         {&override.robot, &override.tag, &override.pattern, &override.attribute, &override.value})
      key(*part);
  }
  for (const CameraOptions& camera : scene.cameras) {
    key(camera.name);
    key(camera.body);
    key(camera.track);
    key(camera.position);
    key(camera.look_at.has_value());
    key(camera.look_at.value_or(Vec3{}));
    key(camera.orientation.has_value());
    key(camera.orientation.value_or(Quat{}));
    key(camera.fovy);
    key(camera.width);
    key(camera.height);
  }
  return hash_bytes(key.bytes.data(), key.bytes.size());
}

std::shared_ptr<CompiledWorld> load_cached_world(const Scene& scene) {
  const fs::path path = entry_of(scene);
  std::error_code code;
  if (!fs::exists(path, code)) return nullptr;
  const Result<std::vector<uint8_t>> bytes = read_file(path, kLargestEntry);
  if (!bytes.ok()) return nullptr;
  const std::span<const uint8_t> payload = unseal_cache_entry(kMagic, *bytes);
  if (payload.empty()) return nullptr;

  ModelFiles files;
  bool admitted = true;
  const auto admit = [&](const fs::path& file) {
    admitted = admitted && (file.empty() || files.admit(file, scene.access).ok());
  };
  admit(scene.bare_model);
  admit(scene.environment.file);
  for (const RobotOptions& robot : scene.robots) admit(robot.file);
  if (!admitted) return nullptr;

  ArchiveReader in(payload);
  CacheEntry entry;
  visit_entry(in, entry);
  if (!in.ok() || !std::all_of(entry.dependencies.begin(), entry.dependencies.end(),
                               [&](const Dependency& d) { return files.is_unchanged(d); }))
    return nullptr;
  auto world = std::make_shared<CompiledWorld>();
  world->scene = scene;
  world->initial_key = entry.initial_key;
  world->robots = std::move(entry.robots);
  for (size_t i = 0; i < world->robots.size() && i < scene.robots.size(); ++i)
    world->robots[i].options = scene.robots[i];
  world->visual_only = std::move(entry.visual_only);
  world->unsupported = std::move(entry.unsupported);
  if (entry.has_plugins) load_mujoco_plugins();  // it loads only where they are
  world->model = get_model(&in);
  world->visual_model = get_model(&in);
  if (!in.ok() || world->model == nullptr) return nullptr;
  mark_cache_use(path);
  return world;
}

void store_cached_world(std::shared_ptr<const CompiledWorld> world,
                        std::vector<Dependency> dependencies) {
  background_writer().start(std::move(world), std::move(dependencies));
}

void finish_cache_writes() { background_writer().finish(); }

}  // namespace gloam
