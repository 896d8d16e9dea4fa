#include "world/shapes/visual_deformable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "world/model_memory.h"
#include "world/model_names.h"
#include "world/shapes/capsule_mesh.h"
#include "world/shapes/deformable_layout.h"
#include "world/shapes/tendon_path.h"
#include "world/shapes/visual_pose.h"

namespace gloam {
namespace {

void add_instance(RenderDescription* out, TriangleMesh rest, int first_vertex, int material,
                  int group, LabelRow label) {
  InstanceDescription instance;
  instance.shape = ShapeType::kDeformable;
  instance.mesh = static_cast<int>(out->deformables.size());
  instance.size = {1, 1, 1};
  instance.material = material;
  instance.group = group;
  instance.shown = group < 3;
  label.material = out->materials[static_cast<size_t>(material)].name;
  label.part = static_cast<uint32_t>(out->instances.size()) + 1;
  instance.label = std::move(label);
  out->deformables.push_back({std::move(rest), first_vertex});
  out->instances.push_back(std::move(instance));
}

/// Cables and tendons at qpos0.
struct Capsules {
  DeformableLayout layout;
  std::vector<float> vertices;  // as PoseFrame::vertices

  TriangleMesh chain(int first_vertex, int count) const {
    TriangleMesh mesh;
    const float* v = vertices.data() + 3 * first_vertex;
    for (int i = 0; i < count * kCapsuleVertices; ++i, v += 3)
      mesh.positions.push_back({v[0], v[1], v[2]});
    append_capsule_triangles(count, &mesh.indices);
    return mesh;
  }
};

/// Linear blend skinning at qpos0, as MuJoCo skins at every instant.
std::vector<Vec3f> skin_vertices(const mjModel& m, int skin, const std::vector<Affine3f>& poses) {
  std::vector<Vec3f> vertices(static_cast<size_t>(m.skin_vertnum[skin]));
  const float* rest = m.skin_vert + 3 * m.skin_vertadr[skin];
  for (int b = m.skin_boneadr[skin]; b < m.skin_boneadr[skin] + m.skin_bonenum[skin]; ++b) {
    mjtNum position[3], quaternion[4];
    std::copy_n(m.skin_bonebindpos + 3 * b, 3, position);
    std::copy_n(m.skin_bonebindquat + 4 * b, 4, quaternion);
    const Affine3f X_W = poses[static_cast<size_t>(m.skin_bonebodyid[b])] *
                         inverse(rigid_pose(position, quaternion));
    for (int k = m.skin_bonevertadr[b]; k < m.skin_bonevertadr[b] + m.skin_bonevertnum[b]; ++k) {
      const auto v = static_cast<size_t>(m.skin_bonevertid[k]);
      const Vec3f p{rest[3 * v], rest[3 * v + 1], rest[3 * v + 2]};
      vertices[v] += transform_point(X_W, p) * m.skin_bonevertweight[k];
    }
  }
  return vertices;
}

void describe_skin(const mjModel& m, int i, const std::vector<Affine3f>& poses,
                   MaterialTable* materials, LabelTable* labels, RenderDescription* out) {
  const float* rgba = m.skin_rgba + 4 * i;
  if (drawn_rgba(m, m.skin_matid[i], rgba)[3] == 0) return;
  TriangleMesh rest;
  rest.positions = skin_vertices(m, i, poses);
  const bool has_uv = m.skin_texcoordadr[i] >= 0;
  if (has_uv) {
    const float* st = m.skin_texcoord + 2 * m.skin_texcoordadr[i];
    for (int v = 0; v < m.skin_vertnum[i]; ++v) rest.uvs.push_back({st[2 * v], 1 - st[2 * v + 1]});
  }
  const int* face = m.skin_face + 3 * m.skin_faceadr[i];
  rest.indices.assign(face, face + 3 * m.skin_facenum[i]);
  const int body = m.skin_bonenum[i] > 0 ? m.skin_bonebodyid[m.skin_boneadr[i]] : 0;
  const std::string name = name_of(m, mjOBJ_SKIN, i);
  LabelRow label = labels->label(body, name, mjOBJ_SKIN, i);
  label.geom = name;
  const int material = materials->row(m.skin_matid[i], rgba, ShapeType::kDeformable, has_uv);
  add_instance(out, std::move(rest), m.skin_vertadr[i], material, m.skin_group[i],
               std::move(label));
  out->instances.back().bone = body;
}

/// Element of a flex of dimension 3 that each face belongs to, by its sorted vertices.
std::map<std::array<int, 3>, int> elements_by_face(const mjModel& m, int flex) {
  std::map<std::array<int, 3>, int> elements;
  const int* vertex = m.flex_elem + m.flex_elemdataadr[flex];
  for (int e = 0; e < m.flex_elemnum[flex]; ++e, vertex += 4)
    for (int opposite = 0; opposite < 4; ++opposite) {
      std::array<int, 3> face{};
      for (int k = 0, n = 0; k < 4; ++k)
        if (k != opposite) face[static_cast<size_t>(n++)] = vertex[k];
      std::sort(face.begin(), face.end());
      elements.try_emplace(face, e);
    }
  return elements;
}

/// One uv per vertex; false if a vertex has several (a seam), of which the first is kept.
bool flex_uvs(const mjModel& m, int flex, std::vector<Vec2f>* uvs) {
  const int count = m.flex_elemnum[flex] * (m.flex_dim[flex] + 1);
  const int* vertex = m.flex_elem + m.flex_elemdataadr[flex];
  const int* texcoord = m.flex_elemtexcoord + m.flex_elemdataadr[flex];
  std::vector<int> chosen(static_cast<size_t>(m.flex_vertnum[flex]), -1);
  uvs->assign(chosen.size(), Vec2f{});
  bool unique = true;
  for (int k = 0; k < count; ++k) {
    const auto v = static_cast<size_t>(vertex[k]);
    unique = unique && (chosen[v] < 0 || chosen[v] == texcoord[k]);
    if (chosen[v] >= 0) continue;
    chosen[v] = texcoord[k];
    const float* st = m.flex_texcoord + 2 * (m.flex_texcoordadr[flex] + texcoord[k]);
    (*uvs)[v] = {st[0], 1 - st[1]};
  }
  return unique;
}

/// A flex of a robot belongs to it; any other is an object of its own.
LabelRow flex_label(const mjModel& m, int i, LabelTable* labels) {
  const int vertex_body = m.flex_interp[i] != 0 ? m.flex_nodebodyid[m.flex_nodeadr[i]]
                                                : m.flex_vertbodyid[m.flex_vertadr[i]];
  const int body = vertex_body > 0 && labels->is_robot(vertex_body) ? vertex_body : 0;
  LabelRow label = labels->label(body, name_of(m, mjOBJ_FLEX, i), mjOBJ_FLEX, i);
  label.geom = name_of(m, mjOBJ_FLEX, i);
  return label;
}

/// A dimension of one has no surface: its elements are capsules, as MuJoCo draws them.
void describe_cable(const mjModel& m, int i, const Capsules& capsules, MaterialTable* materials,
                    LabelTable* labels, RenderDescription* out) {
  const int first = capsules.layout.cable_first[static_cast<size_t>(i)];
  // Elements of one material follow each other, or are drawn as several things.
  for (int begin = 0, end = 0; begin < m.flex_elemnum[i]; begin = end) {
    const int* matid = m.flex_matid + m.flex_elemadr[i];
    while (end < m.flex_elemnum[i] && matid[end] == matid[begin]) ++end;
    if (drawn_rgba(m, matid[begin], m.flex_rgba + 4 * i)[3] == 0) continue;
    const int vertex = first + begin * kCapsuleVertices;
    add_instance(out, capsules.chain(vertex, end - begin), vertex,
                 materials->row(matid[begin], m.flex_rgba + 4 * i, ShapeType::kDeformable, false),
                 m.flex_group[i], flex_label(m, i, labels));
  }
}

void describe_tendon(const mjModel& m, int i, const Capsules& capsules, MaterialTable* materials,
                     LabelTable* labels, RenderDescription* out) {
  const int first = capsules.layout.tendon_first[static_cast<size_t>(i)];
  const float* rgba = m.tendon_rgba + 4 * i;
  if (first < 0 || drawn_rgba(m, m.tendon_matid[i], rgba)[3] == 0) return;
  // A tendon belongs to the robot that its path begins on; any other is an object of its own.
  int body = 0;
  for (int k = m.tendon_adr[i]; k < m.tendon_adr[i] + m.tendon_num[i] && body == 0; ++k) {
    const int on = m.wrap_type[k] == mjWRAP_SITE     ? m.site_bodyid[m.wrap_objid[k]]
                   : m.wrap_type[k] == mjWRAP_PULLEY ? 0
                                                     : m.geom_bodyid[m.wrap_objid[k]];
    if (on > 0 && labels->is_robot(on)) body = on;
  }
  const std::string name = name_of(m, mjOBJ_TENDON, i);
  LabelRow label = labels->label(body, name, mjOBJ_TENDON, i);
  label.geom = name;
  add_instance(out, capsules.chain(first, tendon_segments(m, i)), first,
               materials->row(m.tendon_matid[i], rgba, ShapeType::kDeformable, false),
               m.tendon_group[i], std::move(label));
}

void describe_flex(const mjModel& m, int i, const mjtNum* vertices_W, MaterialTable* materials,
                   LabelTable* labels, RenderDescription* out) {
  const int dim = m.flex_dim[i];
  const std::string name = name_of(m, mjOBJ_FLEX, i);
  // Triangles by material: the elements themselves, or the shell of a solid.
  std::map<int, std::vector<uint32_t>> triangles;
  const auto material_of = [&](int element) { return m.flex_matid[m.flex_elemadr[i] + element]; };
  if (dim == 2) {
    const int* vertex = m.flex_elem + m.flex_elemdataadr[i];
    for (int e = 0; e < m.flex_elemnum[i]; ++e, vertex += 3) {
      std::vector<uint32_t>& indices = triangles[material_of(e)];
      indices.insert(indices.end(), vertex, vertex + 3);
    }
  } else {
    const auto elements = elements_by_face(m, i);
    const int* vertex = m.flex_shell + m.flex_shelldataadr[i];
    for (int s = 0; s < m.flex_shellnum[i]; ++s, vertex += 3) {
      std::array<int, 3> face{vertex[0], vertex[1], vertex[2]};
      std::sort(face.begin(), face.end());
      const auto found = elements.find(face);
      std::vector<uint32_t>& indices =
          triangles[material_of(found != elements.end() ? found->second : 0)];
      indices.insert(indices.end(), vertex, vertex + 3);
    }
  }

  TriangleMesh rest;
  const mjtNum* p = vertices_W + 3 * m.flex_vertadr[i];
  for (int v = 0; v < m.flex_vertnum[i]; ++v, p += 3)
    rest.positions.push_back(
        {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  const bool has_uv = m.flex_texcoordadr[i] >= 0;
  if (has_uv && !flex_uvs(m, i, &rest.uvs))
    out->unsupported.push_back(
        {ErrorKind::kUnsupported,
         fmt::format("flex '{}' has texture seams, which are drawn smeared", name)});

  for (auto& [matid, indices] : triangles) {
    const float* rgba = m.flex_rgba + 4 * i;
    if (drawn_rgba(m, matid, rgba)[3] == 0) continue;
    TriangleMesh mesh = rest;
    mesh.indices = std::move(indices);
    add_instance(out, std::move(mesh), static_cast<int>(m.nskinvert) + m.flex_vertadr[i],
                 materials->row(matid, rgba, ShapeType::kDeformable, has_uv), m.flex_group[i],
                 flex_label(m, i, labels));
  }
}

}  // namespace

void describe_deformables(const mjModel& model, const std::vector<Affine3f>& poses,
                          MaterialTable* materials, LabelTable* labels, RenderDescription* out) {
  for (int i = 0; i < static_cast<int>(model.nskin); ++i)
    describe_skin(model, i, poses, materials, labels, out);
  const DeformableLayout layout = deformable_layout(model);
  if (model.nflex == 0 && !layout.has_tendons) return;
  // MuJoCo knows how interpolated flexes place their vertices.
  const DataPtr data = make_data(model);
  mj_kinematics(&model, data.get());
  mj_comPos(&model, data.get());
  mj_flex(&model, data.get());
  if (layout.has_tendons) mj_tendon(&model, data.get());
  Capsules capsules{layout, std::vector<float>(static_cast<size_t>(3 * layout.nvertex))};
  place_capsules(model, *data, model.opt.gravity, layout, capsules.vertices.data());
  for (int i = 0; i < static_cast<int>(model.nflex); ++i) {
    if (model.flex_dim[i] == 1)
      describe_cable(model, i, capsules, materials, labels, out);
    else
      describe_flex(model, i, data->flexvert_xpos, materials, labels, out);
  }
  for (int i = 0; i < static_cast<int>(model.ntendon); ++i)
    describe_tendon(model, i, capsules, materials, labels, out);
}

}  // namespace gloam
