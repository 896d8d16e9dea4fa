#include "geometry/mesh/vertex_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/srgb.h"
#include "geometry/image/png_writer.h"

namespace gloam {
namespace {

// Texels along a triangle's square: fewer where there are many. Between the outer texels' centres
// the colour is exact; more texels keep neighbours apart in the coarser levels of the picture.
constexpr size_t kFewTriangles = size_t{1} << 16;
size_t texels_for(size_t triangles) { return triangles <= kFewTriangles ? 4 : 2; }

constexpr size_t kLargestPicture = size_t{1} << 14;  // [texels] a side

uint8_t texel_of(float linear) {
  const float v = srgb_encode(std::clamp(linear, 0.0f, 1.0f));
  return static_cast<uint8_t>(std::lround(v * 255));
}

bool has_pictures(const ImportedMaterial& m) {
  for (const TextureRef* t :
       {&m.base_color_texture, &m.metallic_texture, &m.roughness_texture, &m.normal_texture,
        &m.bump_texture, &m.emission_texture, &m.opacity_texture, &m.transmission_texture,
        &m.coat_weight_texture, &m.coat_roughness_texture})
    if (t->ok()) return true;
  return false;
}

// Every triangle with three vertices of its own.
TriangleMesh split_triangles(const TriangleMesh& from) {
  TriangleMesh out;
  const size_t count = from.indices.size();
  out.positions.resize(count);
  if (!from.normals.empty()) out.normals.resize(count);
  out.uvs.resize(count);
  out.indices.resize(count);
  for (size_t i = 0; i < count; ++i) {
    out.positions[i] = from.positions[from.indices[i]];
    if (!from.normals.empty()) out.normals[i] = from.normals[from.indices[i]];
    out.indices[i] = static_cast<uint32_t>(i);
  }
  return out;
}

// Fills the picture and the uvs; false when it would be too large.
bool paint(std::span<const Vec3f> colors, const TriangleMesh& from, TriangleMesh* mesh,
           std::vector<uint8_t>* png) {
  const size_t triangles = from.triangle_count(), side = texels_for(triangles);
  const auto columns = static_cast<size_t>(
      std::ceil(std::sqrt(static_cast<double>(std::max<size_t>(triangles, 1)))));
  const size_t rows = (triangles + columns - 1) / columns;
  const size_t width = columns * side, height = std::max<size_t>(rows, 1) * side;
  if (width > kLargestPicture || height > kLargestPicture) return false;
  std::vector<uint8_t> texels(width * height * 3, 255);
  parallel_for("paint vertices", static_cast<int64_t>(triangles), [&](int64_t index) {
    const auto t = static_cast<size_t>(index);
    const size_t x = t % columns * side, y = t / columns * side;  // from the upper left
    Vec3f c[3];
    for (size_t k = 0; k < 3; ++k) c[k] = colors[from.indices[3 * t + k]];
    const float step = 1 / static_cast<float>(side - 1);
    for (size_t j = 0; j < side; ++j) {
      for (size_t i = 0; i < side; ++i) {
        const Vec3f v = c[0] + (c[1] - c[0]) * (static_cast<float>(i) * step) +
                        (c[2] - c[0]) * (static_cast<float>(j) * step);
        uint8_t* to = &texels[((y + j) * width + x + i) * 3];
        to[0] = texel_of(v.x), to[1] = texel_of(v.y), to[2] = texel_of(v.z);
      }
    }
    const auto uv = [&](size_t i, size_t j) {
      return Vec2f{(static_cast<float>(x + i) + 0.5f) / static_cast<float>(width),
                   1 - (static_cast<float>(y + j) + 0.5f) / static_cast<float>(height)};
    };
    mesh->uvs[3 * t] = uv(0, 0);
    mesh->uvs[3 * t + 1] = uv(side - 1, 0);
    mesh->uvs[3 * t + 2] = uv(0, side - 1);
  });
  *png = encode_png8(static_cast<int>(width), static_cast<int>(height), 3, texels);
  return true;
}

// The mesh's picture, made when it is first asked for.
const PaintedMeshes::Picture& picture_of(std::span<const Vec3f> colors, int mesh,
                                         PaintedMeshes* painted, ModelFile* model) {
  const auto [known, is_new] = painted->by_mesh.try_emplace(mesh);
  PaintedMeshes::Picture& out = known->second;
  if (!is_new) return out;
  out.mesh = mesh;
  out.color = colors[0];
  if (std::all_of(colors.begin(), colors.end(), [&](Vec3f c) { return c == colors[0]; }))
    return out;
  const TriangleMesh& from = model->meshes[static_cast<size_t>(mesh)];
  TriangleMesh split = split_triangles(from);
  std::vector<uint8_t> png;
  if (!paint(colors, from, &split, &png)) {
    Vec3f sum;
    for (const Vec3f c : colors) sum += c;
    out.color = sum / static_cast<float>(colors.size());
    add_note(model, "only the mean of the vertex colours of a very large mesh is used");
    return out;
  }
  out.color = {1, 1, 1};
  out.image = static_cast<int>(model->images.size());
  out.mesh = static_cast<int>(model->meshes.size());
  model->images.push_back({fmt::format("vertex colours {}", out.image), std::move(png)});
  model->meshes.push_back(std::move(split));
  return out;
}

}  // namespace

int paint_vertices(std::span<const Vec3f> colors, int material, int* mesh, PaintedMeshes* painted,
                   ModelFile* model) {
  const TriangleMesh& from = model->meshes[static_cast<size_t>(*mesh)];
  if (colors.size() != from.positions.size() || from.indices.empty()) return material;
  ImportedMaterial own;
  if (material >= 0) own = model->materials[static_cast<size_t>(material)];
  const PaintedMeshes::Picture* known = nullptr;
  if (!has_pictures(own)) known = &picture_of(colors, *mesh, painted, model);
  if (known == nullptr) {
    const bool are_white =
        std::all_of(colors.begin(), colors.end(), [](Vec3f c) { return c == Vec3f{1, 1, 1}; });
    if (!are_white)
      add_note(model, fmt::format("vertex colours on the textured material '{:.80}' are ignored",
                                  own.name));
    return material;
  }
  const auto [made, is_new] = painted->materials.try_emplace({*mesh, material}, -1);
  *mesh = known->mesh;
  if (!is_new) return made->second;
  own.base_color = own.base_color * known->color;
  if (known->image >= 0) {
    own.base_color_texture.image = known->image;
    own.base_color_texture.color_space = ColorSpace::kSrgb;
    own.base_color_texture.wrap_u = own.base_color_texture.wrap_v = TextureWrap::kClamp;
  }
  if (material < 0) {
    own.name = "vertex colours";
    own.double_sided = true;
    own.roughness = 0.5f;
  }
  made->second = static_cast<int>(model->materials.size());
  model->materials.push_back(std::move(own));
  return made->second;
}

Vec3f color_from_display(Vec3f srgb) {
  const auto decode = [](float v) { return srgb_decode(std::clamp(v, 0.0f, 1.0f)); };
  return {decode(srgb.x), decode(srgb.y), decode(srgb.z)};
}

}  // namespace gloam
