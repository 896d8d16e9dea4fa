// Rocks and boulders, their lower part in the ground.

#include <cmath>

#include "places/props/parts/joinery.h"
#include "places/smooth_noise.h"

namespace gloam {
namespace {

// A cube's faces, cut into squares and blown up, dented by noise, with planes broken off.
Solid stone(Vec3f size, int cuts, uint64_t seed) {
  const SmoothNoise noise(seed);
  Dice dice(seed, "planes");
  std::vector<std::pair<Vec3f, float>> planes;
  for (int i = 0; i < 7; ++i) {
    const float z = float(dice.uniform(-0.4, 1)), a = float(dice.uniform(0, 2 * kPi)),
                r = std::sqrt(1 - z * z), at = float(dice.uniform(0.62, 0.95));
    planes.push_back({{r * std::cos(a), r * std::sin(a), z}, at});
  }
  Solid all = rounded_box({2, 2, 2}, 0.0001f, 1, cuts);
  TriangleMesh mesh = std::move(all).mesh();
  for (Vec3f& p : mesh.positions) {
    const Vec3f d = normalize(p);
    float r = 1;
    for (const auto& [n, at] : planes)
      if (dot(n, d) > 0.05f) r = min(r, at / dot(n, d));
    r *= 1 + 0.10f * float(noise.sum(1.6 * d.x + 2.1 * d.z, 1.6 * d.y - 1.3 * d.z, 3));
    p = d * r * Vec3f{size.x / 2, size.y / 2, size.z / 2};
    p.z = max(p.z, -0.22f * size.z);
  }
  mesh.uvs.clear();
  // Normals of the faces around each place: corners of the cube's faces lie together.
  mesh.normals.assign(mesh.positions.size(), {});
  std::vector<Vec3f> sums(mesh.positions.size());
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t* c = &mesh.indices[i];
    const Vec3f n = cross(mesh.positions[c[1]] - mesh.positions[c[0]],
                          mesh.positions[c[2]] - mesh.positions[c[0]]);
    for (int k = 0; k < 3; ++k) sums[c[k]] += n;
  }
  for (size_t i = 0; i < sums.size(); ++i) {
    Vec3f sum;
    for (size_t k = 0; k < sums.size(); ++k)
      if (length(mesh.positions[k] - mesh.positions[i]) < 1e-4f * size.x) sum += sums[k];
    mesh.normals[i] = length(sum) > 1e-12f ? normalize(sum) : Vec3f{0, 0, 1};
  }
  return Solid(std::move(mesh));
}

/// A rock; its part below `above` has a flat collider there.
Prop rock_of(Workshop& shop, Vec3f size, int cuts, float above = 0) {
  const uint64_t seed = shop.dice.seed();
  const float lift = 0.22f * size.z;
  Prop p;
  p.body().show("stone", shop.bedrock(), stone(size, cuts, seed).moved(0, 0, lift));
  TriangleMesh hull = stone(size, 3, seed).moved(0, 0, lift).mesh();
  for (Vec3f& v : hull.positions) v.z = max(v.z, above);
  p.body().collide_hull(Solid(std::move(hull)), 0.9);
  p.body().mass = 2600 * 0.3 * double(size.x * size.y * size.z);  // granite [kg/m³]
  return p;
}

Vec3f size_of(Workshop& shop, Vec3f usual) {
  return limited(shop.size(usual), {0.05f, 0.05f, 0.04f}, {8, 8, 6});
}

// On three feet: a hull that lies flat on a height field touches it in one point, another one at
// every step, and creeps.
Prop rock(Workshop& shop) {
  const Vec3f size = size_of(shop, {0.34f, 0.28f, 0.22f});
  const float radius = 0.09f * min(size.x, size.y), above = 0.04f * size.z;
  Prop p = rock_of(shop, size, 9, above);
  for (const float a : {0.0f, 2 * kPi / 3, -2 * kPi / 3})
    p.body().collide_sphere({0.28f * size.x * std::cos(a), 0.28f * size.y * std::sin(a), radius},
                            radius);
  p.loose = true;
  return p;
}

Prop boulder(Workshop& shop) { return rock_of(shop, size_of(shop, {1.3f, 1.1f, 1.0f}), 17); }

constexpr PropKind kRocks[] = {{"rock", rock, "loose stone, flat below"},
                               {"boulder", boulder, "large weathered stone, flat below"}};

}  // namespace

PropFamily rocks() { return kRocks; }

}  // namespace gloam
