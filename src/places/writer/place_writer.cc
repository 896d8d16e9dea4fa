#include "places/writer/place_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <tuple>

#include "base/check.h"
#include "places/writer/height_field_spec.h"
#include "places/writer/place_looks.h"
#include "places/writer/spec_edit.h"
#include "places/writer/spec_geom.h"

namespace gloam {
namespace {

constexpr double kWhiteLuminance = 100;  // luminance of MuJoCo's emission 1 (docs/light.md) [cd/m²]

// Enclosed by a closed mesh.
double volume_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    sum += dot(mesh.positions[mesh.indices[i]],
               cross(mesh.positions[mesh.indices[i + 1]], mesh.positions[mesh.indices[i + 2]]));
  return sum / 6;
}

double volume_of(const PropCollider& c) {
  const double r = c.size.x;
  switch (c.shape) {
    case ColliderShape::kHull:
      return volume_of(c.hull);
    case ColliderShape::kBox:
      return 8.0 * c.size.x * c.size.y * c.size.z;
    case ColliderShape::kCylinder:
      return M_PI * r * r * 2 * c.size.y;
    case ColliderShape::kCapsule:
      return M_PI * r * r * (2 * c.size.y + 4 * r / 3);
    default:
      return 4 * M_PI * r * r * r / 3;
  }
}

mjtGeom type_of(ColliderShape shape) {
  switch (shape) {
    case ColliderShape::kHull:
      return mjGEOM_MESH;
    case ColliderShape::kBox:
      return mjGEOM_BOX;
    case ColliderShape::kCylinder:
      return mjGEOM_CYLINDER;
    case ColliderShape::kCapsule:
      return mjGEOM_CAPSULE;
    default:
      return mjGEOM_SPHERE;
  }
}

class PlaceWriter {
 public:
  PlaceWriter(const Place& place, mjSpec* spec) : place_(place), spec_(spec) {}

  Status write() {
    for (const Look& look : place_.materials.looks()) add_material(look);
    meshes_.resize(place_.props().size());
    for (const Ground& ground : place_.grounds) {
      mjsGeom* geom = add_height_field(ground.name, ground.field, spec_);
      geom->group = kColliderGroup;
      geom->friction[0] = ground.friction;
    }
    for (const Placement& placement : place_.placements()) {
      GLOAM_TRY_STATUS(check_names(placement));
      add_placement(placement);
    }
    for (const Scatter& scatter : place_.scatters()) {
      GLOAM_TRY_STATUS(check_name(mjOBJ_BODY, scatter.name, {}));
      add_scatter(scatter);
    }
    return {};
  }

 private:
  Status check_name(mjtObj type, const std::string& text, const SourceLoc& loc) const {
    if (mjs_findElement(spec_, type, text.c_str()) == nullptr) return {};
    return Error{ErrorKind::kInput,
                 fmt::format("the environment already has a {} '{}'",
                             type == mjOBJ_BODY ? "body" : "joint", text),
                 loc, "rename the element that the scene adds"};
  }

  // Bodies and joints are looked up by their names, which must therefore be these.
  Status check_names(const Placement& placement) const {
    for (const PropPart& part : place_.prop(placement.prop).parts) {
      const std::string body = body_name_of(placement, part);
      GLOAM_TRY_STATUS(check_name(mjOBJ_BODY, body, placement.loc));
      if (part.joint || (placement.loose && part.parent < 0))
        GLOAM_TRY_STATUS(check_name(mjOBJ_JOINT, body, placement.loc));
    }
    return {};
  }

  static std::string body_name_of(const Placement& placement, const PropPart& part) {
    return part.parent < 0 ? placement.name : placement.name + "/" + part.name;
  }

  static void name(mjsElement* element, const std::string& text) {
    edit(mjs_setName, element, text.c_str());
  }

  void add_material(const Look& look) {
    const std::string& written = looks_[look.name] = free_look_name(look.name, spec_);
    mjsMaterial* material = edit(mjs_addMaterial, spec_, own_defaults());
    name(material->element, written);
    if (!look.picture.empty()) {
      const Image8& image = look.picture.image();
      mjsTexture* texture = edit(mjs_addTexture, spec_, own_defaults());
      const std::string texture_name = set_free_name(texture->element, written);
      texture->type = mjTEXTURE_2D;
      texture->colorspace = mjCOLORSPACE_SRGB;
      texture->width = image.width;
      texture->height = image.height;
      texture->nchannel = image.channels;
      edit(mjs_setBuffer, texture->data, image.texels.data(),
           static_cast<int>(image.texels.size()));
      edit(mjs_setInStringVec, material->textures, mjTEXROLE_RGB, texture_name.c_str());
    }
    const double rgba[4] = {look.color.x, look.color.y, look.color.z, look.opacity};
    for (int i = 0; i < 4; ++i) material->rgba[i] = static_cast<float>(rgba[i]);
    material->roughness = static_cast<float>(look.roughness);
    material->metallic = static_cast<float>(look.metallic);
    material->specular = 0.3f;
    material->shininess = static_cast<float>(0.6 * (1 - look.roughness));
    material->emission = static_cast<float>(look.luminance / kWhiteLuminance);
  }

  // Meshes belong to the prop and are shared by all that stand of it.
  const std::string& mesh_of(int prop, size_t part, size_t visual) {
    auto& names = meshes_[static_cast<size_t>(prop)];
    const Prop& from = place_.prop(prop);
    if (names.empty()) names.resize(from.parts.size());
    if (names[part].empty()) names[part].resize(from.parts[part].visuals.size());
    std::string& known = names[part][visual];
    if (!known.empty()) return known;
    const PropVisual& source = from.parts[part].visuals[visual];
    const std::string& part_name = from.parts[part].name;
    known = fmt::format("{}.{}/{}{}{}", from.label, prop, part_name, part_name.empty() ? "" : ".",
                        source.name);
    known = add_mesh(known, source.mesh);
    return known;
  }

  std::string add_mesh(const std::string& mesh_name, const TriangleMesh& from) {
    mjsMesh* mesh = edit(mjs_addMesh, spec_, own_defaults());
    std::string written = set_free_name(mesh->element, mesh_name);
    mesh->inertia = mjMESH_INERTIA_SHELL;  // a visual has no mass, and may be open
    const auto count = static_cast<int>(from.positions.size());
    edit(mjs_setFloat, mesh->uservert, &from.positions[0].x, 3 * count);
    edit(mjs_setFloat, mesh->usernormal, &from.normals[0].x, 3 * count);
    const std::vector<int> faces(from.indices.begin(), from.indices.end());
    const auto corners = static_cast<int>(faces.size());
    edit(mjs_setInt, mesh->userface, faces.data(), corners);
    edit(mjs_setInt, mesh->userfacenormal, faces.data(), corners);
    if (from.uvs.empty()) return written;
    std::vector<float> uvs;
    for (const Vec2f uv : from.uvs) uvs.insert(uvs.end(), {uv.x, 1 - uv.y});
    edit(mjs_setFloat, mesh->usertexcoord, uvs.data(), static_cast<int>(uvs.size()));
    edit(mjs_setInt, mesh->userfacetexcoord, faces.data(), corners);
    return written;
  }

  void add_placement(const Placement& placement) {
    const Prop& prop = place_.prop(placement.prop);
    std::vector<mjsBody*> bodies;
    for (size_t i = 0; i < prop.parts.size(); ++i) {
      const PropPart& part = prop.parts[i];
      mjsBody* parent = part.parent < 0 || placement.driven
                            ? mjs_findBody(spec_, "world")
                            : bodies[static_cast<size_t>(part.parent)];
      mjsBody* body = edit(mjs_addBody, parent, nullptr);
      bodies.push_back(body);
      const std::string body_name = body_name_of(placement, part);
      name(body->element, body_name);
      body->mocap = placement.driven ? 1 : 0;
      if (part.parent < 0 || placement.driven) {
        write_pose(placement.X_WP, body->pos, body->quat);
        if (placement.loose) name(edit(mjs_addFreeJoint, body)->element, body_name);
      } else {
        write_pose({part.p_P, {}}, body->pos, body->quat);
      }
      if (part.joint) add_joint(*part.joint, body_name, part.p_P, body);
      add_visuals(placement, i, body_name, body);
      add_colliders(placement.prop, i, body_name, body);
      if (part.joint) exclude(bodies[static_cast<size_t>(part.parent)], body);
    }
  }

  // Stands at `initial` in the reference pose, and counts from where the joint is at zero.
  void add_joint(const PropJoint& from, const std::string& body_name, const Vec3& p_P,
                 mjsBody* body) {
    mjsJoint* joint = edit(mjs_addJoint, body, own_defaults());
    name(joint->element, body_name);
    joint->type = from.slides ? mjJNT_SLIDE : mjJNT_HINGE;
    const double axis[3] = {from.axis.x, from.axis.y, from.axis.z};
    std::copy(axis, axis + 3, joint->axis);
    joint->limited = mjLIMITED_TRUE;
    const double unit = !from.slides && spec_->compiler.degree ? 180 / M_PI : 1;
    joint->range[0] = from.low * unit;
    joint->range[1] = from.high * unit;
    joint->ref = from.initial * unit;
    joint->damping[0] = from.damping;
    joint->frictionloss = from.friction;
    // Dry friction must hold loads up to its limit: with MuJoCo's softness, a lid would creep down.
    joint->solimp_friction[0] = 0.999;
    joint->solimp_friction[1] = 0.9999;
    if (from.slides) {
      const double p[3] = {p_P.x, p_P.y, p_P.z};
      for (int i = 0; i < 3; ++i) body->pos[i] = p[i] + from.initial * axis[i];
    } else {
      write_pose({p_P, turn(from.axis, from.initial)}, body->pos, body->quat);
    }
  }

  void add_visuals(const Placement& placement, size_t part, const std::string& body_name,
                   mjsBody* body) {
    const std::vector<PropVisual>& visuals = place_.prop(placement.prop).parts[part].visuals;
    for (size_t v = 0; v < visuals.size(); ++v) {
      mjsGeom* geom = edit(mjs_addGeom, body, own_defaults());
      set_free_name(geom->element, body_name + "/" + visuals[v].name);
      show(geom, mesh_of(placement.prop, part, v), visuals[v].material);
    }
  }

  void show(mjsGeom* geom, const std::string& mesh, const std::string& material) const {
    geom->type = mjGEOM_MESH;
    edit(mjs_setString, geom->meshname, mesh.c_str());
    edit(mjs_setString, geom->material, looks_.at(material).c_str());
    geom->contype = geom->conaffinity = 0;
    geom->group = kVisualGroup;
    geom->mass = 0;
  }

  void add_scatter(const Scatter& scatter) {
    mjsBody* body = edit(mjs_addBody, mjs_findBody(spec_, "world"), nullptr);
    name(body->element, scatter.name);
    const std::vector<PropVisual>& visuals = place_.prop(scatter.prop).body().visuals;
    for (const Pose& X_WP : scatter.poses)
      for (size_t v = 0; v < visuals.size(); ++v) {
        mjsGeom* geom = edit(mjs_addGeom, body, own_defaults());
        show(geom, mesh_of(scatter.prop, 0, v), visuals[v].material);
        write_pose(X_WP, geom->pos, geom->quat);
      }
  }

  // The hulls of a prop are shared as its visuals are.
  const std::string& hull_of(int prop, size_t part, size_t number, const TriangleMesh& hull) {
    std::string& known = hulls_[{prop, part, number}];
    if (!known.empty()) return known;
    known = fmt::format("{}.{}/{}.hull_{}", place_.prop(prop).label, prop, part, number + 1);
    mjsMesh* mesh = edit(mjs_addMesh, spec_, own_defaults());
    known = set_free_name(mesh->element, known);
    mesh->inertia = mjMESH_INERTIA_CONVEX;
    edit(mjs_setFloat, mesh->uservert, &hull.positions[0].x,
         3 * static_cast<int>(hull.positions.size()));
    const std::vector<int> faces(hull.indices.begin(), hull.indices.end());
    edit(mjs_setInt, mesh->userface, faces.data(), static_cast<int>(faces.size()));
    return known;
  }

  // A part's mass lies in its colliders, evenly.
  void add_colliders(int prop, size_t index, const std::string& body_name, mjsBody* body) {
    const PropPart& part = place_.prop(prop).parts[index];
    double volume = 0;
    for (const PropCollider& c : part.colliders) volume += volume_of(c);
    int number = 0;
    for (const PropCollider& c : part.colliders) {
      mjsGeom* geom = add_collider_geom(body, fmt::format("{}/collider_{}", body_name, ++number),
                                        own_defaults());
      geom->type = type_of(c.shape);
      const double size[3] = {c.size.x, c.size.y, c.size.z};
      if (c.shape == ColliderShape::kHull)
        edit(mjs_setString, geom->meshname,
             hull_of(prop, index, static_cast<size_t>(number) - 1, c.hull).c_str());
      else
        std::copy(size, size + 3, geom->size);
      write_pose(c.X_PG, geom->pos, geom->quat);
      geom->mass = part.mass * volume_of(c) / volume;
      geom->friction[0] = c.friction;
    }
  }

  // A leaf and its frame touch by design.
  void exclude(mjsBody* a, mjsBody* b) {
    mjsExclude* exclude = edit(mjs_addExclude, spec_);
    edit(mjs_setString, exclude->bodyname1, mjs_getString(mjs_getName(a->element)));
    edit(mjs_setString, exclude->bodyname2, mjs_getString(mjs_getName(b->element)));
  }

  const Place& place_;
  mjSpec* spec_;
  std::vector<std::vector<std::vector<std::string>>> meshes_;     // names by prop, part, visual
  std::map<std::tuple<int, size_t, size_t>, std::string> hulls_;  // by prop, part, collider
  std::map<std::string, std::string> looks_;                      // names in the spec by look
};

}  // namespace

Status add_place(const Place& place, mjSpec* spec) { return PlaceWriter(place, spec).write(); }

}  // namespace gloam
