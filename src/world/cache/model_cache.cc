#include "world/cache/model_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <limits>

#include "base/archive.h"
#include "base/cache.h"
#include "base/cache_writer.h"
#include "base/files.h"
#include "base/hash.h"
#include "geometry/mesh/model_file.h"
#include "scene/files/mujoco_guard.h"
#include "scene/files/mujoco_plugins.h"
#include "world/compile/sampled_ground.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

/// Data that an entry holds beside the models.
struct CacheEntry {
  std::vector<Dependency> dependencies;
  int initial_key = -1;
  std::vector<RobotInstance> robots;  // without their options
  std::vector<VisualOnlyGeom> visual_only;
  std::vector<VisualOnlyMesh> visual_meshes;
  std::vector<Error> notes, unsupported;
  ElementLines lines;
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
void visit_parts(F& f, VisualOnlyMesh& m) {
  std::string path = m.file.string();
  f(m.name), f(m.label), f(path), f(m.scale), f(m.loc.file), f(m.loc.line);
  m.file = path;
}
template <class F>
void visit_parts(F& f, Error& e) {
  f(e.kind), f(e.message), f(e.loc.file), f(e.loc.line), f(e.loc.column), f(e.hint);
}

namespace {

template <class F>
void visit_entry(F& f, CacheEntry& e) {
  f(e.dependencies), f(e.initial_key), f(e.robots), f(e.visual_only), f(e.visual_meshes);
  f(e.notes), f(e.unsupported), f(e.has_plugins);
  f(e.lines.geoms), f(e.lines.sites), f(e.lines.tendons);
}

constexpr uint64_t kMagic = 0x44444C574D4F4C47ull;  // "GLOMWLDD": changes with the layout below
constexpr uint64_t kLargestEntry = uint64_t{2} << 30;

fs::path entry_of(const Scene& scene, uint64_t place_hash) {
  return cache_folder(kModelCache) /
         cache_entry_name(kModelCache, world_cache_key(scene, place_hash));
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
  CacheEntry entry{dependencies,      world.initial_key,   world.robots,
                   world.visual_only, world.visual_meshes, world.notes,
                   world.unsupported, world.lines,         world.model->nplugin > 0};
  ArchiveWriter out;
  begin_cache_entry(&out.bytes);
  visit_entry(out, entry);
  put_model(world.model.get(), &out);
  put_model(world.visual_model.get(), &out);
  if (out.bytes.size() > kLargestEntry) return {};
  return std::move(out.bytes);
}

}  // namespace

uint64_t world_cache_key(const Scene& scene, uint64_t place_hash) {
  ArchiveWriter key;
  key(kMagic);
  key(std::string(mj_versionString()));
  key(absolute_path(scene.bare_model, "").string());
  key(scene.bare_model.empty());
  key(scene.environment.file.empty() ? std::string()
                                     : absolute_path(scene.environment.file, "").string());
  key(place_hash);
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
    key(robot.base);
    key(robot.loc.line);  // stands in cached messages
  }
  for (const HeightFieldOptions& o : scene.hfields) {
    key(o.name);
    key(absolute_path(o.file, "").string());
    key(o.up);
    constexpr double kAll = std::numeric_limits<double>::infinity();
    const auto [low, high] = std::pair(o.low.value_or(std::array{-kAll, -kAll}),
                                       o.high.value_or(std::array{kAll, kAll}));
    const Vec3 friction = o.friction.value_or(Vec3{-1, -1, -1});
    for (const double number :
         {o.X_WF.p.x, o.X_WF.p.y, o.X_WF.p.z, o.X_WF.q.w, o.X_WF.q.x, o.X_WF.q.y, o.X_WF.q.z,
          o.scale.x, o.scale.y, o.scale.z, o.unit, low[0], low[1], high[0], high[1], o.resolution,
          friction.x, friction.y, friction.z})
      key(number);
    key(o.layers);
    key(o.drawn);
    key(o.loc.line);
  }
  for (const AgentOptions& o : scene.agents) {
    key(o.name), key(o.kind), key(o.seed), key(o.height.value_or(0)), key(o.position);
  }
  for (const CrowdOptions& o : scene.crowds) key(o.name), key(o.count), key(o.seed);
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

std::shared_ptr<CompiledWorld> load_cached_world(const Scene& scene, uint64_t place_hash) {
  const fs::path path = entry_of(scene, place_hash);
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
  if (!is_model_file(scene.environment.file)) admit(scene.environment.file);
  for (const RobotOptions& robot : scene.robots) admit(robot.file);
  if (!admitted || !admit_ground_files(scene, &files).ok()) return nullptr;

  ArchiveReader in(payload);
  CacheEntry entry;
  visit_entry(in, entry);
  if (!in.ok() || !std::all_of(entry.dependencies.begin(), entry.dependencies.end(),
                               [&](const Dependency& d) { return files.is_unchanged(d); }))
    return nullptr;
  auto world = std::make_shared<CompiledWorld>();
  world->scene = scene;
  world->files = entry.dependencies;
  world->initial_key = entry.initial_key;
  world->robots = std::move(entry.robots);
  for (size_t i = 0; i < world->robots.size() && i < scene.robots.size(); ++i)
    world->robots[i].options = scene.robots[i];
  world->visual_only = std::move(entry.visual_only);
  world->visual_meshes = std::move(entry.visual_meshes);
  world->notes = std::move(entry.notes);
  world->unsupported = std::move(entry.unsupported);
  world->lines = std::move(entry.lines);
  if (entry.has_plugins) load_mujoco_plugins();  // it loads only where they are
  world->model = get_model(&in);
  world->visual_model = get_model(&in);
  if (!in.ok() || world->model == nullptr) return nullptr;
  mark_cache_use(path);
  return world;
}

void store_cached_world(std::shared_ptr<const CompiledWorld> world,
                        std::vector<Dependency> dependencies) {
  const fs::path path = entry_of(world->scene, world->place_hash);
  const auto bytes_of = [](const ModelPtr& model) { return model ? uint64_t(model->nbuffer) : 0; };
  const uint64_t held = bytes_of(world->model) + bytes_of(world->visual_model);
  keep_in_cache_later(path, kMagic, held,
                      [world = std::move(world), files = std::move(dependencies)] {
                        return serialise(*world, files);
                      });
}

}  // namespace gloam
