#include "render/cpu/interactive/light_store.h"

#include "base/cache.h"
#include "base/cache_writer.h"
#include "base/files.h"
#include "base/hash.h"

namespace gloam {
namespace {

// "GLOMLT02": change it whenever the content of cells or the tracing of their light changes.
constexpr uint64_t kLightMagic = 0x3230544C4D4F4C47ull;

std::filesystem::path entry_of(uint64_t key) {
  return cache_folder(kLightCache) / cache_entry_name(kLightCache, key);
}

#if defined(__has_builtin)
#if __has_builtin(__builtin_clear_padding)
#define GLOAM_CLEARS_PADDING 1
#endif
#endif

#ifdef GLOAM_CLEARS_PADDING

/// Hash of plain structures, by their values: bytes of padding do not count.
class Digest {
 public:
  template <class T>
  void value(T v) {
    static_assert(std::is_trivially_copyable_v<T>);
    __builtin_clear_padding(&v);
    hash_ = hash_bytes(&v, sizeof v, hash_);
  }
  /// Elements, which `strip` rids of their pointers.
  template <class T, class Strip>
  void each(DeviceSpan<const T> values, const Strip& strip) {
    value(values.size);
    for (uint32_t i = 0; i < values.size; ++i) {
      T one = values[i];
      strip(&one);
      value(one);
    }
  }
  template <class T>
  void each(DeviceSpan<const T> values) {
    each(values, [](T*) {});
  }
  /// Many numbers without padding.
  template <class T>
  void numbers(DeviceSpan<const T> values) {
    value(values.size);
    value(hash_large(std::as_bytes(std::span(values.data, values.size))));
  }
  uint64_t result() const { return hash_ != 0 ? hash_ : 1; }

 private:
  uint64_t hash_ = kLightMagic;
};

void add_surfaces(const SceneView& scene, Digest* digest) {
  digest->each(scene.instances, [](InstanceView* v) { v->keys = {}; });
  for (uint32_t i = 0; i < scene.meshes.size; ++i) {
    const MeshView& mesh = scene.meshes[i];
    digest->numbers(mesh.positions);
    digest->numbers(mesh.indices);
    digest->numbers(mesh.corner_normals);
    digest->numbers(mesh.uvs);
  }
  digest->each(scene.materials);
  digest->each(scene.layers);
  digest->each(scene.procedurals);
  digest->each(scene.textures);
  digest->each(scene.texture_levels);
  digest->numbers(scene.texels);
  digest->value(scene.fallen.wetness);
  digest->value(scene.fallen.snow);
  digest->numbers(scene.fallen.shelter.height);
}

void add_light(const SceneView& scene, Digest* digest) {
  digest->each(scene.lights);
  digest->each(scene.profiles);
  digest->numbers(scene.profile_values);
  digest->numbers(scene.environment.texels);
  digest->value(scene.environment.R_WE);
  digest->value(scene.environment.scale);
  digest->value(scene.sky_texture);
  digest->value(scene.sky_scale);
  digest->value(scene.sky_ambient);
  for (uint32_t i = 0; i < scene.media.volumes.size; ++i) {
    VolumeView volume = scene.media.volumes[i];
    digest->numbers(volume.density);
    digest->numbers(volume.temperature);
    volume.density = volume.temperature = {};
    volume.cells = {};
    digest->value(volume);
  }
}

#endif

}  // namespace

#ifdef GLOAM_CLEARS_PADDING

uint64_t light_key(const SceneView& scene, const CameraView32& camera, int width, int height,
                   uint64_t seed) {
  Digest digest;
  add_surfaces(scene, &digest);
  add_light(scene, &digest);
  CameraView32 view = camera;
  view.pose.keys = {};
  digest.value(view);
  digest.value(width);
  digest.value(height);
  digest.value(seed);
  return digest.result();
}

#else

uint64_t light_key(const SceneView&, const CameraView32&, int, int, uint64_t) { return 0; }

#endif

bool load_light(uint64_t key, const std::function<void(ArchiveReader&)>& read) {
  if (key == 0) return false;
  const std::filesystem::path path = entry_of(key);
  const auto bytes = read_file(path, UINT64_MAX);
  if (!bytes.ok()) return false;
  ArchiveReader in(unseal_cache_entry(kLightMagic, *bytes));
  read(in);
  if (!in.is_done()) return false;
  mark_cache_use(path);
  return true;
}

void keep_light(uint64_t key, const std::function<void(ArchiveWriter&)>& write) {
  if (key == 0) return;
  ArchiveWriter out;
  begin_cache_entry(&out.bytes);
  write(out);
  keep_in_cache_later(entry_of(key), kLightMagic, std::move(out.bytes));
}

}  // namespace gloam
