#include "world/model_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

#include "base/files.h"
#include "base/hash.h"
#include "base/log.h"
#include "scene/mujoco_guard.h"
#include "scene/mujoco_plugins.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kMagic = 0x31444C574D4F4C47ull;  // "GLOMWLD1": changes with the layout below
constexpr uint64_t kLargestCache = uint64_t{4} << 30;
constexpr uint64_t kLargestEntry = uint64_t{2} << 30;

fs::path model_cache_folder() { return cache_folder() / "models"; }

class Writer {
 public:
  std::string bytes;
  template <class T>
    requires(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>)
  void put(const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void put(const std::string& text) {
    put(static_cast<uint64_t>(text.size()));
    bytes += text;
  }
  void put(const Error& error) {
    put(error.kind);
    put(error.message);
    put(error.loc.file);
    put(error.loc.line);
    put(error.loc.column);
    put(error.hint);
  }
  void put_model(const mjModel* model) {
    const uint64_t size = model == nullptr ? 0 : static_cast<uint64_t>(mj_sizeModel(model));
    put(size);
    if (size == 0) return;
    const size_t at = bytes.size();
    bytes.resize(at + size);
    mj_saveModel(model, nullptr, bytes.data() + at, static_cast<mjtSize>(size));
  }
};

// Every read is bounded; after the first that fails all others fail.
class Reader {
 public:
  explicit Reader(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  bool ok() const { return ok_; }
  template <class T>
    requires std::is_trivially_copyable_v<T>
  T get() {
    T value{};
    if (const uint8_t* from = take(sizeof(T))) std::memcpy(&value, from, sizeof(T));
    return value;
  }
  std::string text() {
    const uint64_t size = get<uint64_t>();
    const uint8_t* from = take(size);
    return from == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(from), size);
  }
  Error error() {
    Error out;
    out.kind = get<ErrorKind>();
    out.message = text();
    out.loc.file = text();
    out.loc.line = get<int>();
    out.loc.column = get<int>();
    out.hint = text();
    return out;
  }
  ModelPtr model() {
    const uint64_t size = get<uint64_t>();
    const uint8_t* from = size == 0 ? nullptr : take(size);
    if (from == nullptr) return nullptr;
    mjModel* model = nullptr;
    const MujocoWarningCapture warnings;
    if (!try_mujoco([&] { model = mj_loadModelBuffer(from, static_cast<mjtSize>(size)); }))
      model = nullptr;
    if (model == nullptr) ok_ = false;
    return ModelPtr(model);
  }
  /// A count of things that take at least one byte each.
  uint64_t count() {
    const uint64_t n = get<uint64_t>();
    if (n > bytes_.size() - at_) ok_ = false;
    return ok_ ? n : 0;
  }

 private:
  const uint8_t* take(uint64_t size) {
    if (!ok_ || size > bytes_.size() - at_) {
      ok_ = false;
      return nullptr;
    }
    const uint8_t* from = bytes_.data() + at_;
    at_ += size;
    return from;
  }
  std::span<const uint8_t> bytes_;
  size_t at_ = 0;
  bool ok_ = true;
};

constexpr size_t kHeaderSize = 2 * sizeof(uint64_t);  // magic, hash of the rest

std::string serialise(const CompiledWorld& world, const std::vector<Dependency>& dependencies) {
  Writer out;
  out.put(kMagic);
  out.put(uint64_t{0});
  out.put(static_cast<uint64_t>(dependencies.size()));
  for (const Dependency& dependency : dependencies) {
    out.put(dependency.path.string());
    out.put(dependency.exists);
    out.put(dependency.hash);
  }
  out.put(world.initial_key);
  out.put(static_cast<uint64_t>(world.robots.size()));
  for (const RobotInstance& robot : world.robots) {
    out.put(robot.name);
    out.put(robot.prefix);
    out.put(robot.root_body);
  }
  out.put(static_cast<uint64_t>(world.visual_only.size()));
  for (const VisualOnlyGeom& geom : world.visual_only) out.put(geom);
  out.put(static_cast<uint64_t>(world.unsupported.size()));
  for (const Error& error : world.unsupported) out.put(error);
  out.put(world.model->nplugin > 0);
  out.put_model(world.model.get());
  out.put_model(world.visual_model.get());
  const uint64_t hash = hash_bytes(out.bytes.data() + kHeaderSize, out.bytes.size() - kHeaderSize);
  std::memcpy(out.bytes.data() + sizeof(kMagic), &hash, sizeof(hash));
  return std::move(out.bytes);
}

void write_entry(const CompiledWorld& world, const std::vector<Dependency>& dependencies) {
  const fs::path folder = model_cache_folder();
  const std::string entry = serialise(world, dependencies);
  if (entry.size() > kLargestEntry) return;
  Status status = make_folder(folder);
  if (status.ok()) {
    const fs::path path = folder / (hash_to_hex(world_cache_key(world.scene)) + ".world");
    status =
        write_file_atomic(path, {reinterpret_cast<const uint8_t*>(entry.data()), entry.size()});
  }
  if (!status.ok()) return log_debug("cache not written: {}", status.error().to_string());
  trim_cache(folder, kLargestCache);
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
  Writer key;
  key.put(kMagic);
  key.put(std::string(mj_versionString()));
  key.put(absolute_path(scene.bare_model, "").string());
  key.put(scene.bare_model.empty());
  key.put(scene.environment.file.empty() ? "" : absolute_path(scene.environment.file, "").string());
  key.put(scene.name);
  key.put(scene.access.root.string());
  key.put(scene.access.strict);
  for (const auto& [name, folder] : scene.access.packages) {
    key.put(name);
    key.put(absolute_path(folder, "").string());
  }
  key.put(scene.sim.timestep.value_or(0));
  for (const RobotOptions& robot : scene.robots) {
    key.put(robot.name);
    key.put(absolute_path(robot.file, "").string());
    key.put(robot.X_WR);
    key.put(robot.keyframe);
    key.put(robot.loc.line);  // stands in cached messages
  }
  for (const CameraOptions& camera : scene.cameras) {
    key.put(camera.name);
    key.put(camera.body);
    key.put(camera.track);
    key.put(camera.position);
    key.put(camera.look_at.has_value());
    key.put(camera.look_at.value_or(Vec3{}));
    key.put(camera.orientation.has_value());
    key.put(camera.orientation.value_or(Quat{}));
    key.put(camera.fovy);
    key.put(camera.width);
    key.put(camera.height);
  }
  return hash_bytes(key.bytes.data(), key.bytes.size());
}

std::shared_ptr<CompiledWorld> load_cached_world(const Scene& scene) {
  const fs::path path = model_cache_folder() / (hash_to_hex(world_cache_key(scene)) + ".world");
  std::error_code code;
  if (!fs::exists(path, code)) return nullptr;
  const Result<std::vector<uint8_t>> bytes = read_file(path, kLargestEntry);
  if (!bytes.ok()) return nullptr;
  Reader header(*bytes);
  const uint64_t magic = header.get<uint64_t>(), hash = header.get<uint64_t>();
  if (!header.ok() || magic != kMagic) return nullptr;
  const std::span<const uint8_t> payload = std::span(*bytes).subspan(kHeaderSize);
  if (hash_bytes(payload.data(), payload.size()) != hash) return nullptr;

  ModelFiles files;
  bool admitted = true;
  const auto admit = [&](const fs::path& file) {
    admitted = admitted && (file.empty() || files.admit(file, scene.access).ok());
  };
  admit(scene.bare_model);
  admit(scene.environment.file);
  for (const RobotOptions& robot : scene.robots) admit(robot.file);
  if (!admitted) return nullptr;

  Reader in(payload);
  for (uint64_t i = in.count(); i > 0 && in.ok(); --i) {
    Dependency dependency;
    dependency.path = in.text();
    dependency.exists = in.get<bool>();
    dependency.hash = in.get<uint64_t>();
    if (!in.ok() || !files.is_unchanged(dependency)) return nullptr;
  }
  auto world = std::make_shared<CompiledWorld>();
  world->scene = scene;
  world->initial_key = in.get<int>();
  for (uint64_t i = 0, n = in.count(); i < n && in.ok(); ++i) {
    RobotInstance robot;
    robot.name = in.text();
    robot.prefix = in.text();
    robot.root_body = in.get<int>();
    if (i < scene.robots.size()) robot.options = scene.robots[i];
    world->robots.push_back(std::move(robot));
  }
  for (uint64_t n = in.count(); n > 0 && in.ok(); --n)
    world->visual_only.push_back(in.get<VisualOnlyGeom>());
  for (uint64_t n = in.count(); n > 0 && in.ok(); --n) world->unsupported.push_back(in.error());
  if (in.get<bool>()) load_mujoco_plugins();  // a model with plugins loads only where they are
  world->model = in.model();
  world->visual_model = in.model();
  if (!in.ok() || world->model == nullptr) return nullptr;
  fs::last_write_time(path, fs::file_time_type::clock::now(), code);  // used now: evict it late
  return world;
}

void store_cached_world(std::shared_ptr<const CompiledWorld> world,
                        std::vector<Dependency> dependencies) {
  background_writer().start(std::move(world), std::move(dependencies));
}

void finish_cache_writes() { background_writer().finish(); }

void trim_cache(const fs::path& folder, uint64_t limit) {
  struct Entry {
    fs::path path;
    fs::file_time_type used;
    uint64_t size;
  };
  std::vector<Entry> entries;
  uint64_t total = 0;
  std::error_code code;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
    std::error_code ignored;
    if (!it->is_regular_file(ignored)) continue;
    entries.push_back({it->path(), it->last_write_time(ignored), it->file_size(ignored)});
    total += entries.back().size;
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& entry : entries) {
    if (total <= limit) break;
    if (fs::remove(entry.path, code)) total -= entry.size;
  }
}

}  // namespace gloam
