#include "world/materials/visual_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "base/parallel.h"
#include "geometry/image/image_file.h"
#include "world/materials/visual_rules.h"
#include "world/model_names.h"

namespace gloam {
namespace {

struct Texels {
  const mjtByte* data = nullptr;
  int width = 0, height = 0;
  /// Owner of by-reference textures
  std::unique_ptr<mjtByte, void (*)(void*)> owned{nullptr, mju_free};
};

/// MuJoCo keeps a KTX file as it is: a row of its bytes as one channel.
bool is_ktx(const Texels& texels, int channels) {
  constexpr std::string_view kMagic = "\xabKTX 11\xbb\r\n\x1a\n";
  return channels == 1 && texels.height == 1 && texels.data != nullptr &&
         texels.width >= static_cast<int>(kMagic.size()) &&
         std::memcmp(texels.data, kMagic.data(), kMagic.size()) == 0;
}

/// As cut_faces, of the bytes of a KTX file.
std::string decode_faces(const Texels& texels, ColorSpace color_space, std::vector<Image8>* faces) {
  Result<KtxImage> image =
      decode_ktx({texels.data, static_cast<size_t>(texels.width)}, "the KTX file");
  if (!image.ok()) return fmt::format("cannot be read: {}", image.error().to_string());
  if (image->faces.size() != 1) return "is a KTX file without an 8-bit image";
  image->faces[0].color_space = color_space;  // the role decides, as in MaterialTable::layer
  *faces = std::move(image->faces);
  return "";
}

/// Cuts the texels into one image or six; returns the problem, or "".
std::string cut_faces(const Texels& texels, int channels, bool cube, ColorSpace color_space,
                      std::vector<Image8>* faces) {
  const auto* bytes = texels.data;
  const int64_t size = int64_t{texels.width} * texels.height * channels;
  if (bytes == nullptr || size <= 0) return "has no texels";
  const int face_height = cube ? texels.width : texels.height;
  const bool six = cube && texels.height == 6 * texels.width;
  if (cube && !six && texels.height != texels.width) return "is not a cube";
  const int64_t face_size = int64_t{texels.width} * face_height * channels;
  faces->resize(cube ? 6 : 1);
  for (size_t i = 0; i < faces->size(); ++i) {
    const mjtByte* begin = bytes + (six ? static_cast<int64_t>(i) * face_size : 0);
    (*faces)[i] = {texels.width, face_height, channels, color_space, {begin, begin + face_size}};
  }
  return "";
}

}  // namespace

KtxImage embedded_ktx(const mjModel& model, int texid) {
  if (model.tex_adr[texid] < 0) return {};
  Texels texels;
  texels.data = model.tex_data + model.tex_adr[texid];
  texels.width = model.tex_width[texid];
  texels.height = model.tex_height[texid];
  if (!is_ktx(texels, model.tex_nchannel[texid])) return {};
  Result<KtxImage> image =
      decode_ktx({texels.data, static_cast<size_t>(texels.width)}, "the KTX file");
  return image.ok() ? std::move(*image) : KtxImage();
}

const float* drawn_rgba(const mjModel& model, int matid, const float* rgba) {
  return matid >= 0 && is_default_rgba(rgba) ? model.mat_rgba + 4 * matid : rgba;
}

int MaterialTable::texture_row(int texid, ColorSpace color_space) {
  const auto [entry, added] =
      texture_rows_.try_emplace({texid, color_space}, static_cast<int>(out_->textures.size()));
  if (added) {
    out_->textures.push_back(
        {name_of(model_, mjOBJ_TEXTURE, texid), {Image8{1, 1, 3, color_space, {255, 255, 255}}}});
    pending_.push_back({texid, entry->second});
  }
  return entry->second;
}

int MaterialTable::layer(int matid, mjtTextureRole role, MaterialDescription* material) {
  const int texid = model_.mat_texid[mjNTEXROLE * matid + role];
  if (texid < 0) return -1;
  const auto mapping = model_.tex_type[texid] == mjTEXTURE_2D ? TextureMapping::kUv  //
                                                              : TextureMapping::kCube;
  if (material->mapping != TextureMapping::kNone && material->mapping != mapping) {
    out_->unsupported.push_back(
        {ErrorKind::kUnsupported,
         fmt::format("material '{}' mixes 2d and cube textures; texture '{}' is not drawn",
                     material->name, name_of(model_, mjOBJ_TEXTURE, texid))});
    return -1;
  }
  material->mapping = mapping;
  const bool is_color =
      role == mjTEXROLE_RGB || role == mjTEXROLE_RGBA || role == mjTEXROLE_EMISSIVE;
  // tex_colorspace cannot distinguish an author's "linear" from a file without a colour space, like
  // most, which contain display colours. So the role decides.
  return texture_row(texid, is_color ? ColorSpace::kSrgb : ColorSpace::kLinear);
}

int MaterialTable::row(int matid, const float* rgba, ShapeType shape, bool textured) {
  const bool can_mirror = matid >= 0 && (shape == ShapeType::kPlane || shape == ShapeType::kBox);
  const float* color = drawn_rgba(model_, matid, rgba);
  const bool own_color = color == rgba;
  ModelSurface surface;
  std::copy_n(color, 4, surface.rgba.begin());
  const auto key_color = own_color ? surface.rgba : std::array<float, 4>{};
  const auto [entry, added] = rows_.try_emplace({matid, key_color, can_mirror, textured},
                                                static_cast<int>(out_->materials.size()));
  if (!added) return entry->second;

  MaterialDescription material;
  material.own_color = own_color;
  material.can_mirror = can_mirror;
  if (matid >= 0) {
    material.name = name_of(model_, mjOBJ_MATERIAL, matid);
    material.model_material = live_ ? matid : -1;
    surface.emission = model_.mat_emission[matid];
    surface.specular = model_.mat_specular[matid];
    surface.shininess = model_.mat_shininess[matid];
    surface.reflectance = model_.mat_reflectance[matid];
    surface.metallic = model_.mat_metallic[matid];
    surface.roughness = model_.mat_roughness[matid];
    material.texture_uniform = model_.mat_texuniform[matid] != 0;
    material.texture_repeat = {model_.mat_texrepeat[2 * matid],
                               model_.mat_texrepeat[2 * matid + 1]};
    if (textured) add_layers(matid, &material);
  }
  set_look(surface, &material);
  out_->materials.push_back(std::move(material));
  return entry->second;
}

void MaterialTable::add_layers(int matid, MaterialDescription* material) {
  MaterialTextures& textures = material->textures;
  textures.base_color = layer(matid, mjTEXROLE_RGBA, material);
  if (textures.base_color < 0) textures.base_color = layer(matid, mjTEXROLE_RGB, material);
  textures.roughness = layer(matid, mjTEXROLE_ROUGHNESS, material);
  textures.metallic = layer(matid, mjTEXROLE_METALLIC, material);
  textures.occlusion = layer(matid, mjTEXROLE_OCCLUSION, material);
  textures.orm = layer(matid, mjTEXROLE_ORM, material);
  textures.normal = layer(matid, mjTEXROLE_NORMAL, material);
  textures.opacity = layer(matid, mjTEXROLE_OPACITY, material);
  textures.emission = layer(matid, mjTEXROLE_EMISSIVE, material);
}

void MaterialTable::load_textures() {
  std::vector<std::string> problems(pending_.size());
  parallel_for("world.textures", static_cast<int64_t>(pending_.size()), [&](int64_t i) {
    const int texid = pending_[static_cast<size_t>(i)].texid;
    TextureDescription& texture =
        out_->textures[static_cast<size_t>(pending_[static_cast<size_t>(i)].row)];
    std::string& problem = problems[static_cast<size_t>(i)];
    Texels texels;
    if (model_.tex_adr[texid] >= 0) {
      texels.data = model_.tex_data + model_.tex_adr[texid];
      texels.width = model_.tex_width[texid];
      texels.height = model_.tex_height[texid];
    } else {  // by reference (compiler passthrough)
      mjtByte* data = nullptr;
      char error[500] = "";
      if (mj_loadTexture(&model_, texid, &data, &texels.width, &texels.height, nullptr, error,
                         sizeof(error)) != 0) {
        problem = fmt::format("cannot be read: {}", error);
        return;
      }
      texels.owned.reset(data);
      texels.data = data;
    }
    std::vector<Image8> faces;
    const int channels = model_.tex_nchannel[texid];
    const ColorSpace color_space = texture.faces.front().color_space;
    problem = is_ktx(texels, channels)
                  ? decode_faces(texels, color_space, &faces)
                  : cut_faces(texels, channels, model_.tex_type[texid] != mjTEXTURE_2D, color_space,
                              &faces);
    if (problem.empty()) texture.faces = std::move(faces);
  });
  for (size_t i = 0; i < problems.size(); ++i)
    if (!problems[i].empty())
      out_->unsupported.push_back(
          {ErrorKind::kUnsupported,
           fmt::format("texture '{}' {}", name_of(model_, mjOBJ_TEXTURE, pending_[i].texid),
                       problems[i]),
           {},
           "it is drawn white"});
  pending_.clear();
}

}  // namespace gloam
