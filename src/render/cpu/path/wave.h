#pragma once
// Paths of single rays, run together: each round traces all of their rays in packets, then advances
// every path.

#include "render/cpu/path/tile.h"

namespace gloam {

/// The paths of one sample of a tile, run together: each round traces all of their rays in packets,
/// then advances every path.
template <class State>
struct Wave {
  State states[kTile * kTile];
  RayHit hits[kTile * kTile];
  bool found[kTile * kTile];
  int alive[kTile * kTile];
  int count = 0;

  /// The closest hit of each path in `alive`.
  void trace_closest(const CpuTracer& tracer) { trace_kind(tracer, false, true); }

  template <class Advance>
  void run(const SceneView& scene, const CpuTracer& tracer, const Advance& advance) {
    for (int i = 0; i < count; ++i) alive[i] = i;
    for (bool first_round = true; count > 0; first_round = false) {
      trace_kind(tracer, false, first_round);
      trace_kind(tracer, true, false);
      int left = 0;
      const int all = count;
      for (int i = 0; i < all; ++i) {
        if (i + 2 * kPrefetchDistance < all)
          fetch_instance(scene, alive[i + 2 * kPrefetchDistance]);
        if (i + kPrefetchDistance < all) fetch_triangle(scene, alive[i + kPrefetchDistance]);
        const int k = alive[i];
        if (advance(&states[k], found[k], hits[k])) alive[left++] = k;
      }
      count = left;
    }
  }

 private:
  /// Paths between the prefetch of the data of a hit and its use.
  static constexpr int kPrefetchDistance = 4;

  bool needs_surface(int k) const { return found[k] && !states[k].any; }
  void fetch_instance(const SceneView& scene, int k) const {
    if (!needs_surface(k)) return;
    const char* instance = reinterpret_cast<const char*>(&scene.instances[hits[k].instance]);
    for (size_t byte = 0; byte < sizeof(InstanceView); byte += 64) {
      __builtin_prefetch(instance + byte);
    }
  }
  void fetch_triangle(const SceneView& scene, int k) const {
    if (!needs_surface(k)) return;
    const InstanceView& instance = scene.instances[hits[k].instance];
    const char* material = reinterpret_cast<const char*>(&scene.materials[instance.material]);
    __builtin_prefetch(material);
    __builtin_prefetch(material + 64);
    if (instance.shape != ShapeType::kMesh) return;
    const MeshView& mesh = scene.meshes[instance.mesh];
    const size_t triangle = hits[k].primitive;
    if (!mesh.corner_normals.empty()) {
      __builtin_prefetch(mesh.corner_normals.data + 3 * triangle);
      __builtin_prefetch(mesh.corner_normals.data + 3 * triangle + 2);
    }
    if (!mesh.uvs.empty()) __builtin_prefetch(mesh.uvs.data + triangle);
    __builtin_prefetch(mesh.indices.data + 3 * triangle);
  }

  void trace_kind(const CpuTracer& tracer, bool any, bool coherent) {
    constexpr int n = CpuTracer::kPacket;
    const Ray* rays[n];
    int who[n], used = 0;
    RayHit packet_hits[n];
    bool packet_found[n];
    const auto flush = [&] {
      if (used == 0) return;
      tracer.trace_packet(rays, used, any, coherent, packet_hits, packet_found);
      for (int j = 0; j < used; ++j) {
        found[who[j]] = packet_found[j];
        if (packet_found[j] && !any) hits[who[j]] = packet_hits[j];
      }
      used = 0;
    };
    for (int i = 0; i < count; ++i) {
      const int k = alive[i];
      if (states[k].any != any) continue;
      rays[used] = &states[k].ray;
      who[used++] = k;
      if (used == n) flush();
    }
    flush();
  }
};

}  // namespace gloam
