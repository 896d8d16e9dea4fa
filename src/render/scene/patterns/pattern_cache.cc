#include "render/scene/patterns/pattern_cache.h"

#include <array>
#include <unordered_map>

#include "base/cache.h"
#include "base/hash.h"

namespace gloam {
namespace {

class Hash {
 public:
  template <class T>
  void operator()(const T& value) {
    value_ = hash_bytes(&value, sizeof(value), value_);
  }
  void operator()(const Vec3f& v) {
    const std::array<float, 3> xyz{v.x, v.y, v.z};
    value_ = hash_bytes(xyz.data(), sizeof(xyz), value_);
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = kPatternMagic;
};

/// Field by field: between them there are bytes without a value.
void add(const ProceduralDescription& d, Hash* hash) {
  (*hash)(d.kind), (*hash)(d.seed);
  (*hash)(d.color_a), (*hash)(d.color_b), (*hash)(d.color_c);
  for (const float x :
       {d.scale, d.size_u, d.size_v, d.gap, d.depth, d.bevel, d.roughness, d.gap_roughness, d.coat,
        d.coat_roughness, d.variation, d.amount, d.metallic, d.fuzz, d.pith})
    (*hash)(x);
  (*hash)(d.axis);
  (*hash)(d.basis), (*hash)(d.bond), (*hash)(d.tile), (*hash)(d.weave);
}

uint64_t hash_of(const TriangleMesh& mesh) {
  const std::span<const Vec3f> positions(mesh.positions);
  const std::span<const uint32_t> indices(mesh.indices);
  return hash_large(std::as_bytes(positions)) ^ hash_span(indices, kPatternMagic);
}

}  // namespace

uint64_t pattern_key(const PatternBaking& baking, const PatternSurfaces& found) {
  Hash hash;
  hash(baking.metres_per_texel), hash(baking.most_bytes);
  std::unordered_map<const TriangleMesh*, uint64_t> meshes;
  for (const PatternSurface& s : found.surfaces) {
    const auto [mesh, is_new] = meshes.try_emplace(s.mesh);
    if (is_new) mesh->second = hash_of(*s.mesh);
    hash(mesh->second);
    add(*s.pattern, &hash);
    hash(s.shape), hash(s.size), hash(s.is_sheet), hash(s.has_place);
    hash(s.X_WG.x), hash(s.X_WG.y), hash(s.X_WG.z), hash(s.X_WG.p);
  }
  return hash.value();
}

}  // namespace gloam
