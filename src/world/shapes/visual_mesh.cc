#include "world/shapes/visual_mesh.h"

#include <algorithm>

namespace gloam {
namespace {

constexpr float kEdgeCosine = 0.8f;  // measured on MuJoCo's classic renderer
constexpr uint32_t kNone = 0xffffffffu;

bool same_direction(Vec3f a, Vec3f b) { return dot(a, b) > 0.999999f; }

}  // namespace

TriangleMesh split_corners(const IndexedCorners& in) {
  TriangleMesh out;
  const size_t count = in.face.size();
  const bool has_uv = !in.uvs.empty();
  out.indices.resize(count);
  out.positions.reserve(in.positions.size());
  out.normals.reserve(in.positions.size());
  if (has_uv) out.uvs.reserve(in.positions.size());

  // Corners made so far of each position: a list through `next`, newest first.
  std::vector<uint32_t> newest(in.positions.size(), kNone), next;
  std::vector<int> uv_of;
  next.reserve(in.positions.size());
  if (has_uv) uv_of.reserve(in.positions.size());

  for (size_t f = 0; f + 2 < count; f += 3) {
    const Vec3f a = in.positions[static_cast<size_t>(in.face[f])];
    const Vec3f b = in.positions[static_cast<size_t>(in.face[f + 1])];
    const Vec3f c = in.positions[static_cast<size_t>(in.face[f + 2])];
    Vec3f face_normal = cross(b - a, c - a);
    const float area = length(face_normal);
    if (area > 0) face_normal = face_normal / area;
    for (size_t k = f; k < f + 3; ++k) {
      const auto position = static_cast<size_t>(in.face[k]);
      Vec3f normal =
          in.normals.empty() ? Vec3f{} : in.normals[static_cast<size_t>(in.face_normal[k])];
      if (area > 0 && dot(normal, face_normal) < kEdgeCosine) normal = face_normal;
      const int uv = has_uv ? in.face_uv[k] : 0;
      uint32_t vertex = newest[position];
      while (vertex != kNone &&
             !((!has_uv || uv_of[vertex] == uv) &&
               (out.normals[vertex] == normal || same_direction(out.normals[vertex], normal))))
        vertex = next[vertex];
      if (vertex == kNone) {
        vertex = static_cast<uint32_t>(out.positions.size());
        out.positions.push_back(in.positions[position]);
        out.normals.push_back(normal);
        if (has_uv) {
          const Vec2f st = in.uvs[static_cast<size_t>(uv)];
          out.uvs.push_back({st.x, 1 - st.y});
          uv_of.push_back(uv);
        }
        next.push_back(newest[position]);
        newest[position] = vertex;
      }
      out.indices[k] = vertex;
    }
  }
  return out;
}

TriangleMesh height_field_mesh(const HeightFieldDescription& field, std::span<const float> data) {
  const int rows = field.rows, columns = field.columns;
  std::vector<Vec3f> positions;
  positions.reserve(data.size() + static_cast<size_t>(2 * (rows + columns)));
  const auto x_of = [&](int c) {
    return field.size.x * (2.0f * static_cast<float>(c) / static_cast<float>(columns - 1) - 1);
  };
  const auto y_of = [&](int r) {
    return field.size.y * (2.0f * static_cast<float>(r) / static_cast<float>(rows - 1) - 1);
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      positions.push_back(
          {x_of(c), y_of(r), field.size.z * data[static_cast<size_t>(r * columns + c)]});

  std::vector<int> face;
  const auto triangle = [&](int a, int b, int c) { face.insert(face.end(), {a, b, c}); };
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      const int i = r * columns + c;
      triangle(i, i + 1, i + columns + 1);
      triangle(i, i + columns + 1, i + columns);
    }

  // The rim, counter-clockwise from above, and its copy at the base.
  std::vector<int> rim;
  for (int c = 0; c + 1 < columns; ++c) rim.push_back(c);
  for (int r = 0; r + 1 < rows; ++r) rim.push_back(r * columns + columns - 1);
  for (int c = columns - 1; c > 0; --c) rim.push_back((rows - 1) * columns + c);
  for (int r = rows - 1; r > 0; --r) rim.push_back(r * columns);
  const int n = static_cast<int>(rim.size());
  const int base = static_cast<int>(positions.size());
  for (const int i : rim) {
    const Vec3f p = positions[static_cast<size_t>(i)];
    positions.push_back({p.x, p.y, -field.base});
  }
  for (int k = 0; k < n; ++k) {
    const int l = (k + 1) % n, a = rim[static_cast<size_t>(k)], b = rim[static_cast<size_t>(l)];
    triangle(base + k, base + l, b);
    triangle(base + k, b, a);
  }
  const int corner[4] = {base, base + columns - 1, base + columns + rows - 2,
                         base + 2 * columns + rows - 3};
  triangle(corner[0], corner[2], corner[1]);
  triangle(corner[0], corner[3], corner[2]);

  // Normals of the surface: mean of the faces around, weighted by area; edges are sharpened below.
  std::vector<Vec3f> normals(positions.size());
  const size_t surface_corners = static_cast<size_t>(6 * (rows - 1) * (columns - 1));
  for (size_t f = 0; f < surface_corners; f += 3) {
    const auto a = static_cast<size_t>(face[f]), b = static_cast<size_t>(face[f + 1]),
               c = static_cast<size_t>(face[f + 2]);
    const Vec3f weighted = cross(positions[b] - positions[a], positions[c] - positions[a]);
    for (const size_t i : {a, b, c}) normals[i] += weighted;
  }
  for (Vec3f& normal : normals)
    if (length_squared(normal) > 0) normal = normalize(normal);
  return split_corners({positions, normals, {}, face, face, {}});
}

}  // namespace gloam
