#include "world/agents/person_skin.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "base/rng.h"
#include "places/writer/spec_edit.h"
#include "places/writer/spec_geom.h"
#include "world/shapes/implicit_mesh.h"

namespace gloam {
namespace {

constexpr float kLegsApart = 0.16f, kArmsApart = 0.6f;  // in the pose that is modelled [rad]
constexpr float kBlendWidth = 0.022f;  // over which a vertex goes from one bone to the next [m]

using Color = std::array<float, 3>;  // sRGB
constexpr Color kSkins[] = {{0.91f, 0.75f, 0.66f},
                            {0.84f, 0.66f, 0.54f},
                            {0.72f, 0.53f, 0.40f},
                            {0.55f, 0.38f, 0.28f},
                            {0.38f, 0.26f, 0.19f}};
constexpr Color kHairs[] = {{0.09f, 0.07f, 0.06f},
                            {0.19f, 0.13f, 0.09f},
                            {0.33f, 0.22f, 0.13f},
                            {0.58f, 0.45f, 0.28f},
                            {0.48f, 0.47f, 0.46f}};
constexpr Color kShirts[] = {{0.20f, 0.28f, 0.42f}, {0.55f, 0.20f, 0.18f}, {0.78f, 0.77f, 0.73f},
                             {0.24f, 0.36f, 0.27f}, {0.86f, 0.45f, 0.12f}, {0.35f, 0.36f, 0.39f},
                             {0.80f, 0.72f, 0.30f}, {0.42f, 0.58f, 0.70f}};
constexpr Color kTrousers[] = {{0.16f, 0.20f, 0.31f},
                               {0.22f, 0.22f, 0.24f},
                               {0.46f, 0.40f, 0.30f},
                               {0.30f, 0.32f, 0.28f},
                               {0.34f, 0.40f, 0.50f}};
constexpr Color kShoes[] = {{0.10f, 0.09f, 0.09f}, {0.28f, 0.18f, 0.11f}, {0.62f, 0.62f, 0.62f}};

/// The pose that is modelled: legs and arms a little apart, feet level.
struct BindPose {
  Vec3f joint[kPersonParts];
  Quat q[kPersonParts];
  Vec3f tip[kPersonParts];  // the other end of each bone
};

Quat about_x(float angle) { return {std::cos(angle / 2), std::sin(angle / 2), 0, 0}; }

BindPose bind_pose(const PersonShape& s) {
  const auto f = [](double x) { return static_cast<float>(x); };
  BindPose b;
  b.joint[kPelvis] = {0, 0, f(s.hip_height)};
  b.tip[kPelvis] = b.joint[kPelvis] + Vec3f{0, 0, f(s.waist)};
  b.joint[kChest] = b.tip[kPelvis];
  b.tip[kChest] = b.joint[kChest] + Vec3f{0, 0, f(s.trunk)};
  b.joint[kHead] = b.tip[kChest] + Vec3f{0, 0, f(s.neck)};
  b.tip[kHead] = {0, 0, f(s.height)};
  for (int i = 0; i < 2; ++i) {
    const float side = i == 0 ? 1.0f : -1.0f;
    const int thigh = kThighL + 3 * i, arm = kUpperArmL + 2 * i;
    const Vec3f down{0, side * std::sin(kLegsApart), -std::cos(kLegsApart)};
    b.joint[thigh] = b.joint[kPelvis] + Vec3f{0, side * f(s.hip), 0};
    b.joint[thigh + 1] = b.tip[thigh] = b.joint[thigh] + down * f(s.thigh);
    b.joint[thigh + 2] = b.tip[thigh + 1] = b.joint[thigh + 1] + down * f(s.shank);
    b.tip[thigh + 2] = b.joint[thigh + 2] + Vec3f{0.5f * f(s.foot), 0, -f(s.ankle)};
    b.q[thigh] = b.q[thigh + 1] = about_x(side * kLegsApart);
    const Vec3f out{0, side * std::sin(kArmsApart), -std::cos(kArmsApart)};
    b.joint[arm] = b.tip[kChest] + Vec3f{0, side * f(s.shoulder), 0};
    b.joint[arm + 1] = b.tip[arm] = b.joint[arm] + out * f(s.upper_arm);
    b.tip[arm + 1] = b.joint[arm + 1] + out * f(s.forearm);
    b.q[arm] = b.q[arm + 1] = about_x(side * kArmsApart);
  }
  return b;
}

RoundSolid ball(Vec3f p, float r, float flat = 1) { return {p, p, r, r, flat}; }

/// Builds the shapes of one person.
class Tailor {
 public:
  explicit Tailor(const AgentDescription& agent)
      : s_(agent.person),
        h_(static_cast<float>(s_.height)),
        g_(static_cast<float>(s_.height * s_.girth)),
        pose_(bind_pose(s_)),
        random_{agent.seed, stream_id("agent.clothes")} {}

  const BindPose& pose() const { return pose_; }
  double draw(uint32_t index) const { return random_.uniform(0, index); }
  template <size_t N>
  const Color& pick(const Color (&colors)[N], uint32_t index) const {
    return colors[static_cast<size_t>(draw(index) * N)];
  }

  ImplicitShape skin() const {
    ImplicitShape shape;
    shape.blend = 0.014f * h_;
    const float top = pose_.tip[kChest].z;
    auto& out = shape.solids;
    add_head(0, &out);
    out.push_back({{-0.01f * h_, 0, top - 0.02f * h_},
                   {0.002f * h_, 0, 0.885f * h_},
                   0.037f * g_,
                   0.032f * g_});
    out.push_back(
        {{0.062f * h_, 0, 0.928f * h_}, {0.07f * h_, 0, 0.917f * h_}, 0.005f * h_, 0.0075f * h_});
    for (const float side : {1.0f, -1.0f})
      out.push_back({{0.002f * h_, side * 0.048f * h_, 0.922f * h_},
                     {-0.003f * h_, side * 0.051f * h_, 0.938f * h_},
                     0.007f * h_,
                     0.009f * h_});
    for (const int arm : {kUpperArmL, kUpperArmR}) {
      const Vec3f elbow = pose_.joint[arm + 1], along = normalize(pose_.tip[arm + 1] - elbow);
      const Vec3f wrist = elbow + along * (0.146f * h_), forward{1, 0, 0};
      out.push_back({pose_.joint[arm], elbow, 0.026f * g_, 0.022f * g_});
      out.push_back({elbow, elbow + along * (0.05f * h_), 0.023f * g_, 0.024f * g_});
      out.push_back({elbow + along * (0.05f * h_), wrist, 0.024f * g_, 0.015f * g_});
      // A palm and fingers that are a little bent, and a thumb in front.
      const Vec3f knuckles = wrist + along * (0.052f * h_);
      for (const float x : {-0.011f, 0.0f, 0.011f}) {
        const Vec3f at = knuckles + forward * (x * h_);
        out.push_back({wrist + forward * (0.6f * x * h_), at, 0.0125f * h_, 0.011f * h_});
        out.push_back(
            {at, at + along * (0.044f * h_) + forward * (0.004f * h_), 0.0085f * h_, 0.006f * h_});
      }
      const Vec3f thumb = wrist + along * (0.018f * h_) + forward * (0.014f * h_);
      out.push_back({thumb, thumb + along * (0.032f * h_) + forward * (0.012f * h_), 0.009f * h_,
                     0.007f * h_});
    }
    return shape;
  }

  // The head again, a little larger, above a line from the forehead to the neck; eyes and brows.
  ImplicitShape hair() const {
    ImplicitShape shape;
    shape.blend = 0.012f * h_;
    add_head(0.006f * h_, &shape.solids);
    const bool is_long = draw(0) < 0.4;
    const Vec3f back{-0.045f * h_, 0, 0.92f * h_};
    if (is_long)
      shape.solids.push_back({back, {-0.05f * h_, 0, 0.855f * h_}, 0.042f * h_, 0.03f * h_});
    const float slope = is_long ? 0.85f : 0.65f;
    const Vec3f n = normalize(Vec3f{-slope, 0, 0.78f});
    shape.cuts.push_back({{0.066f * h_, 0, 0.972f * h_}, n});
    return shape;
  }
  ImplicitShape eyes() const {
    ImplicitShape shape;
    shape.blend = 0.001f;
    for (const float side : {1.0f, -1.0f}) {
      const float y = side * 0.018f * h_;
      shape.solids.push_back(ball({0.0585f * h_, y, 0.938f * h_}, 0.0048f * h_));
      shape.solids.push_back({{0.0595f * h_, y - 0.007f * h_, 0.949f * h_},
                              {0.0575f * h_, y + 0.007f * h_, 0.949f * h_},
                              0.0025f * h_,
                              0.0025f * h_});
    }
    return shape;
  }

  ImplicitShape shirt() const {
    ImplicitShape shape;
    shape.blend = 0.035f * h_;
    auto& out = shape.solids;
    const float hips = pose_.joint[kPelvis].z, waist = pose_.joint[kChest].z,
                top = pose_.tip[kChest].z;
    out.push_back({{0, 0, hips - 0.01f * h_}, {0, 0, waist}, 0.101f * g_, 0.086f * g_, 1.25f});
    out.push_back(
        {{0, 0, waist}, {0.004f * h_, 0, top - 0.08f * h_}, 0.083f * g_, 0.097f * g_, 1.4f});
    for (const float side : {1.0f, -1.0f}) {
      const float y = side * static_cast<float>(s_.shoulder);
      out.push_back({{-0.004f * h_, 0, top - 0.012f * h_},
                     {-0.004f * h_, 0.8f * y, top - 0.006f * h_},
                     0.04f * g_,
                     0.031f * g_});
    }
    if (s_.girth > 1.02)
      out.push_back(ball({0.02f * h_ * static_cast<float>(s_.girth), 0, waist - 0.02f * h_},
                         0.078f * g_, 1.15f));
    const bool is_long = has_long_sleeves();
    for (const int arm : {kUpperArmL, kUpperArmR}) {
      const Vec3f shoulder = pose_.joint[arm], elbow = pose_.joint[arm + 1];
      const Vec3f along = normalize(pose_.tip[arm + 1] - elbow);
      const float end = is_long ? 1.0f : 0.62f;
      out.push_back({shoulder, lerp(shoulder, elbow, end), 0.035f * g_, 0.031f * g_});
      if (is_long) out.push_back({elbow, elbow + along * (0.128f * h_), 0.031f * g_, 0.023f * g_});
    }
    shape.cuts.push_back({{0, 0, hips - 0.035f * h_}, {0, 0, 1}});
    return shape;
  }

  ImplicitShape trousers() const {
    ImplicitShape shape;
    shape.blend = 0.03f * h_;
    auto& out = shape.solids;
    const Vec3f hips = pose_.joint[kPelvis];
    for (const float side : {1.0f, -1.0f})
      out.push_back({hips + Vec3f{-0.006f * h_, side * 0.026f * g_, 0.0f},
                     hips + Vec3f{0, side * 0.022f * g_, 0.05f * h_}, 0.064f * g_, 0.054f * g_,
                     1.08f});
    for (const int leg : {kThighL, kThighR}) {
      const Vec3f hip = pose_.joint[leg], knee = pose_.joint[leg + 1], ankle = pose_.tip[leg + 1];
      out.push_back({hip + Vec3f{-0.004f * h_, 0, -0.02f * h_}, knee, 0.055f * g_, 0.041f * g_});
      out.push_back(
          {knee, lerp(knee, ankle, 0.35f) + Vec3f{-0.008f * h_, 0, 0}, 0.039f * g_, 0.037f * g_});
      out.push_back({lerp(knee, ankle, 0.35f) + Vec3f{-0.008f * h_, 0, 0}, lerp(knee, ankle, 0.96f),
                     0.039f * g_, 0.033f * g_});
    }
    return shape;
  }

  ImplicitShape shoes() const {
    ImplicitShape shape;
    shape.blend = 0.02f * h_;
    const float foot = static_cast<float>(s_.foot), sole = static_cast<float>(s_.ankle);
    for (const int part : {kFootL, kFootR}) {
      const Vec3f a = pose_.joint[part];
      const float r = 0.02f * h_;
      shape.solids.push_back({a + Vec3f{-0.16f * foot, 0, r - sole},
                              a + Vec3f{0.45f * foot, 0, r - sole - 0.002f}, r, 1.12f * r});
      shape.solids.push_back({a + Vec3f{0.45f * foot, 0, r - sole - 0.002f},
                              a + Vec3f{0.64f * foot, 0, 0.75f * r - sole}, 1.12f * r, 0.8f * r});
      shape.solids.push_back({a + Vec3f{0.3f * foot, 0, r - sole + 0.004f * h_},
                              a + Vec3f{-0.05f * foot, 0, 0.012f * h_}, 0.9f * r, 1.15f * r});
      shape.solids.push_back({a + Vec3f{-0.12f * foot, 0, 1.3f * r - sole},
                              a + Vec3f{-0.06f * foot, 0, 0.012f * h_}, r, 1.1f * r});
    }
    shape.cuts.push_back({pose_.joint[kFootL] + Vec3f{0, 0, -sole}, {0, 0, 1}});
    return shape;
  }

  bool has_long_sleeves() const { return draw(1) < 0.6; }
  float height() const { return h_; }
  float girth() const { return g_; }

 private:
  void add_head(float more, std::vector<RoundSolid>* out) const {
    // Skull, face and chin.
    out->push_back({{-0.012f * h_, 0, 0.943f * h_},
                    {0.01f * h_, 0, 0.946f * h_},
                    0.0535f * h_ + more,
                    0.05f * h_ + more,
                    0.95f});
    out->push_back({{0.016f * h_, 0, 0.925f * h_},
                    {0.022f * h_, 0, 0.893f * h_},
                    0.041f * h_ + more,
                    0.026f * h_ + more});
  }

  const PersonShape& s_;
  float h_, g_;  // height, and with the girth in it [m]
  BindPose pose_;
  RandomStream random_;
};

class SkinWriter {
 public:
  SkinWriter(const AgentDescription& agent, const Tailor& tailor, mjSpec* spec)
      : agent_(agent), tailor_(tailor), spec_(spec) {}

  void add(const char* what, const ImplicitShape& shape, float cell, const std::vector<int>& bones,
           const Color& color, float roughness) {
    const std::string name = fmt::format("{}/{}", agent_.name, what);
    add_material(name, color, roughness);
    add_skin(name, name, mesh_of(shape, cell), bones);
  }
  /// Adds a skin of a material that exists already.
  void add_of(const char* what, const char* material, const ImplicitShape& shape, float cell,
              const std::vector<int>& bones) {
    add_skin(fmt::format("{}/{}", agent_.name, what), fmt::format("{}/{}", agent_.name, material),
             mesh_of(shape, cell), bones);
  }

 private:
  void add_material(const std::string& name, const Color& color, float roughness) {
    mjsMaterial* material = edit(mjs_addMaterial, spec_, own_defaults());
    edit(mjs_setName, material->element, name.c_str());
    for (size_t i = 0; i < 3; ++i) material->rgba[i] = color[i];
    material->roughness = roughness;
    material->specular = 0.3f;
  }

  // Thickness of a part about its bone [m].
  float thickness(int part) const {
    const float g = tailor_.girth();
    switch (part) {
      case kPelvis:
      case kChest:
        return 0.08f * g;
      case kHead:
        return 0.05f * tailor_.height();
      case kThighL:
      case kThighR:
        return 0.045f * g;
      case kShankL:
      case kShankR:
        return 0.035f * g;
      default:
        return 0.028f * g;
    }
  }

  void add_skin(const std::string& name, const std::string& material, const TriangleMesh& mesh,
                const std::vector<int>& bones) {
    mjsSkin* skin = edit(mjs_addSkin, spec_);
    edit(mjs_setName, skin->element, name.c_str());
    edit(mjs_setString, skin->material, material.c_str());
    skin->group = kVisualGroup;
    edit(mjs_setFloat, skin->vert, &mesh.positions[0].x,
         static_cast<int>(3 * mesh.positions.size()));
    const std::vector<int> faces(mesh.indices.begin(), mesh.indices.end());
    edit(mjs_setInt, skin->face, faces.data(), static_cast<int>(faces.size()));
    std::vector<std::vector<int>> ids(bones.size());
    std::vector<std::vector<float>> weights(bones.size());
    std::vector<float> share(bones.size());
    const BindPose& pose = tailor_.pose();
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      float nearest = 1e9f, sum = 0;
      for (size_t i = 0; i < bones.size(); ++i) {
        const Vec3f a = pose.joint[bones[i]], ab = pose.tip[bones[i]] - a,
                    ap = mesh.positions[v] - a;
        const float t = clamp(dot(ap, ab) / dot(ab, ab), 0, 1);
        share[i] = length(ap - ab * t) - thickness(bones[i]);
        nearest = min(nearest, share[i]);
      }
      for (float& w : share) {
        w = std::exp(-(w - nearest) / kBlendWidth);
        if (w < 0.03f) w = 0;
        sum += w;
      }
      for (size_t i = 0; i < bones.size(); ++i) {
        if (share[i] == 0) continue;
        ids[i].push_back(static_cast<int>(v));
        weights[i].push_back(share[i] / sum);
      }
    }
    std::vector<float> bind_p, bind_q;
    for (size_t i = 0; i < bones.size(); ++i) {
      if (ids[i].empty()) continue;
      const Vec3f p = pose.joint[bones[i]];
      const Quat q = pose.q[bones[i]];
      edit(mjs_appendString, skin->bodyname, agent_.body_name(bones[i]).c_str());
      bind_p.insert(bind_p.end(), {p.x, p.y, p.z});
      for (const double x : {q.w, q.x, q.y, q.z}) bind_q.push_back(static_cast<float>(x));
      edit(mjs_appendIntVec, skin->vertid, ids[i].data(), static_cast<int>(ids[i].size()));
      edit(mjs_appendFloatVec, skin->vertweight, weights[i].data(),
           static_cast<int>(weights[i].size()));
    }
    edit(mjs_setFloat, skin->bindpos, bind_p.data(), static_cast<int>(bind_p.size()));
    edit(mjs_setFloat, skin->bindquat, bind_q.data(), static_cast<int>(bind_q.size()));
  }

  const AgentDescription& agent_;
  const Tailor& tailor_;
  mjSpec* spec_;
};

}  // namespace

void add_person_skins(const AgentDescription& agent, mjSpec* spec) {
  const Tailor tailor(agent);
  SkinWriter writer(agent, tailor, spec);
  writer.add("skin", tailor.skin(), 0.0095f,
             {kHead, kChest, kUpperArmL, kForearmL, kUpperArmR, kForearmR}, tailor.pick(kSkins, 2),
             0.5f);
  writer.add("hair", tailor.hair(), 0.011f, {kHead}, tailor.pick(kHairs, 3), 0.55f);
  writer.add_of("eyes", "hair", tailor.eyes(), 0.0028f, {kHead});
  writer.add("shirt", tailor.shirt(), 0.016f,
             {kChest, kPelvis, kUpperArmL, kForearmL, kUpperArmR, kForearmR},
             tailor.pick(kShirts, 4), 0.9f);
  writer.add("trousers", tailor.trousers(), 0.016f, {kPelvis, kThighL, kShankL, kThighR, kShankR},
             tailor.pick(kTrousers, 5), 0.9f);
  writer.add("shoes", tailor.shoes(), 0.012f, {kFootL, kFootR}, tailor.pick(kShoes, 6), 0.6f);
}

}  // namespace gloam
