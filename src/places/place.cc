#include "places/place.h"

#include <fmt/format.h>

#include <span>

#include "base/archive.h"
#include "base/hash.h"
#include "base/parallel.h"

namespace gloam {
namespace {

void key(ArchiveWriter& out, const PropPart& part) {
  out(part.name);
  out(part.parent);
  out(part.p_P);
  out(part.joint.has_value());
  if (part.joint) {
    const PropJoint& j = *part.joint;
    out(j.slides);
    for (const double x :
         {j.axis.x, j.axis.y, j.axis.z, j.low, j.high, j.initial, j.damping, j.friction})
      out(x);
  }
  out(part.mass);
  for (const PropVisual& visual : part.visuals) {
    out(visual.name);
    out(visual.material);
    const TriangleMesh& mesh = visual.mesh;
    out(hash_span<Vec3f>(mesh.positions));
    out(hash_span<Vec3f>(mesh.normals));
    out(hash_span<Vec2f>(mesh.uvs));
    out(hash_span<uint32_t>(mesh.indices));
  }
  for (const PropCollider& c : part.colliders) {
    out(c.shape);
    out(c.size);
    out(c.X_PG);
    out(c.friction);
    out(hash_span<Vec3f>(c.hull.positions));
  }
}

}  // namespace

Result<int> Place::make(const PropRequest& request) {
  for (const Made& known : made_)
    if (known.request == request && known.openable == openable) return known.index;
  GLOAM_TRY(Prop made, make_prop(request, style, &materials));
  for (PropPart& part : made.parts) {
    part.join_visuals();
    // A part that stands ajar from the start stays a joint.
    if (!openable && part.joint && part.joint->initial == 0) part.joint.reset();
  }
  const int index = add(std::move(made));
  made_.push_back({request, openable, index});
  return index;
}

int Place::add(Prop prop) {
  props_.push_back(std::move(prop));
  return static_cast<int>(props_.size()) - 1;
}

int Place::put(int index, const std::string& room, const Pose& X_WP, bool loose) {
  const std::string stem = (room.empty() ? "" : room + "/") + prop(index).label;
  const int number = ++numbers_[stem];
  placements_.push_back({index, fmt::format("{}_{}", stem, number), X_WP, loose});
  return static_cast<int>(placements_.size()) - 1;
}

// Looks of materials beyond MuJoCo's are not compiled; those that MuJoCo knows are.
uint64_t Place::hash() const {
  const std::span<const Look> looks = materials.looks();
  std::vector<uint64_t> pictures(looks.size());
  parallel_for("pictures of a place", static_cast<int64_t>(looks.size()), [&](int64_t i) {
    const Picture& picture = looks[static_cast<size_t>(i)].picture;
    pictures[static_cast<size_t>(i)] =
        hash_span<uint8_t>(picture.empty() ? std::span<const uint8_t>() : picture.image().texels);
  });
  constexpr int kWriter = 4;  // counts changes of what place_writer makes of the same place
  ArchiveWriter out;
  out(kWriter);
  out(name);
  out(pictures);
  for (const Look& look : looks) {
    out(look.name);
    out(look.color);
    for (const double x : {look.roughness, look.metallic, look.opacity, look.luminance}) out(x);
  }
  for (const Prop& prop : props_) {
    out(prop.label);
    for (const PropPart& part : prop.parts) key(out, part);
  }
  for (const Placement& placement : placements_) {
    out(placement.prop);
    out(placement.name);
    out(placement.X_WP);
    out(placement.loose);
    out(placement.driven);
  }
  for (const Scatter& scatter : scatters_) {
    out(scatter.prop);
    out(scatter.name);
    out(hash_span<Pose>(scatter.poses));
  }
  for (const Ground& ground : grounds) {
    const HeightGrid& grid = ground.field.grid;
    out(ground.name);
    for (const double x :
         {grid.low[0], grid.low[1], grid.step[0], grid.step[1], ground.field.base, ground.friction})
      out(x);
    out(grid.columns);
    out(hash_span<float>(ground.field.z));
  }
  return hash_bytes(out.bytes.data(), out.bytes.size());
}

}  // namespace gloam
