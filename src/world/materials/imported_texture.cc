#include "world/materials/imported_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/memory.h"
#include "base/parallel.h"
#include "geometry/image/image_file.h"
#include "world/materials/visual_rules.h"

namespace gloam {
namespace {

/// Limit on all pictures of one file [pixels]: their mip-mapped texels take 11 bytes each.
constexpr uint64_t kMostPixels = uint64_t{1} << 28;

Result<Image8> decode_picture(const ImportedImage& image, uint64_t most) {
  const std::vector<uint8_t>& b = image.bytes;
  const auto starts = [&](std::string_view magic) {
    return b.size() >= magic.size() && std::memcmp(b.data(), magic.data(), magic.size()) == 0;
  };
  most = std::min(most, kMaxImagePixels);
  if (starts("\x89PNG")) return decode_png(b, image.name, most);
  if (starts("\xff\xd8\xff")) return decode_jpeg(b, image.name, most);
  if (starts("\xabKTX 11")) {
    GLOAM_TRY(KtxImage ktx, decode_ktx(b, image.name, most));
    if (ktx.faces.size() == 1) return std::move(ktx.faces[0]);
  }
  return Error{ErrorKind::kUnsupported,
               "unsupported image format (expected PNG, JPEG or 8-bit KTX)",
               {image.name, 0, 0}};
}

/// Pictures that a material shows; occlusion is no business of a path tracer's.
std::vector<const TextureRef*> textures_of(const ImportedMaterial& m) {
  return {&m.base_color_texture,     &m.metallic_texture,
          &m.roughness_texture,      &m.specular_weight_texture,
          &m.specular_color_texture, &m.transmission_texture,
          &m.coat_weight_texture,    &m.coat_roughness_texture,
          &m.fuzz_color_texture,     &m.fuzz_roughness_texture,
          &m.emission_texture,       &m.opacity_texture,
          &m.normal_texture,         &m.bump_texture};
}

/// Byte of a channel, as a picture of 1, 2 (grey, alpha), 3 or 4 channels has it.
uint8_t texel(const Image8& image, size_t i, int channel) {
  const uint8_t* t = image.texels.data() + i * static_cast<size_t>(image.channels);
  const bool has_alpha = image.channels == 2 || image.channels == 4;
  if (channel == 3) return has_alpha ? t[image.channels - 1] : uint8_t{255};
  return t[image.channels <= 2 ? 0 : channel];
}

Image8 make_texture(const Image8& in, const TextureRecipe& recipe) {
  const auto channel = recipe.source.channel;
  const size_t count = static_cast<size_t>(in.width) * static_cast<size_t>(in.height);
  const bool color = channel == TextureChannel::kColor;
  Image8 out{in.width,
             in.height,
             color ? 3 + (recipe.keep_alpha ? 1 : 0) : 1,
             recipe.source.color_space,
             {}};
  const auto n = static_cast<size_t>(out.channels);
  out.texels.resize(count * n);
  const auto byte = [](float x) { return static_cast<uint8_t>(clamp(x, 0, 1) * 255 + 0.5f); };
  const auto cut = [&](uint8_t alpha) {
    if (recipe.cutoff < 0) return alpha;
    return static_cast<float>(alpha) >= recipe.cutoff * 255 ? uint8_t{255} : uint8_t{0};
  };
  for (size_t i = 0; i < count; ++i) {
    uint8_t* t = out.texels.data() + i * n;
    if (!color) {
      const bool is_opacity = channel == TextureChannel::kAlpha || recipe.cutoff >= 0;
      const uint8_t value = texel(in, i, static_cast<int>(channel));
      t[0] = is_opacity ? cut(value) : value;
      continue;
    }
    for (int k = 0; k < 3; ++k) t[k] = texel(in, i, k);
    if (recipe.keep_alpha) t[3] = cut(texel(in, i, 3));
    if (recipe.normal_scale == 1) continue;
    const auto signed_of = [](uint8_t b) { return static_cast<float>(b) / 127.5f - 1; };
    const Vec3f normal{signed_of(t[0]) * recipe.normal_scale, signed_of(t[1]) * recipe.normal_scale,
                       max(signed_of(t[2]), 1e-3f)};
    const Vec3f unit = normalize(normal) * 0.5f + Vec3f{0.5f, 0.5f, 0.5f};
    t[0] = byte(unit.x), t[1] = byte(unit.y), t[2] = byte(unit.z);
  }
  return out;
}

bool is_same(const TextureRecipe& a, const TextureRecipe& b) {
  const TextureRef &s = a.source, &t = b.source;
  return s.image == t.image && s.channel == t.channel && s.color_space == t.color_space &&
         s.wrap_u == t.wrap_u && s.wrap_v == t.wrap_v && a.keep_alpha == b.keep_alpha &&
         a.cutoff == b.cutoff && a.normal_scale == b.normal_scale;
}

}  // namespace

Result<ImportedTextures> ImportedTextures::decode(const ModelFile& model, const std::string& what,
                                                  RenderDescription* out) {
  ImportedTextures made;
  made.out_ = out;
  made.images_.resize(model.images.size());
  for (const ImportedImage& image : model.images) made.names_.push_back(image.name);
  std::vector<bool> is_used(model.images.size());
  for (const ImportedMaterial& material : model.materials)
    for (const TextureRef* texture : textures_of(material))
      if (texture->ok()) is_used[static_cast<size_t>(texture->image)] = true;
  std::vector<size_t> used;
  for (size_t i = 0; i < is_used.size(); ++i)
    if (is_used[i]) used.push_back(i);

  constexpr uint64_t kPixelBytes = 24;  // decoded, as a texture, and mip-mapped
  uint64_t left = std::min(kMostPixels, memory_room().bytes / kPixelBytes);
  const auto at_once = static_cast<size_t>(std::max(thread_count(), 1));
  for (size_t first = 0; first < used.size(); first += at_once) {
    const size_t count = std::min(at_once, used.size() - first);
    std::vector<std::string> problems(count);
    parallel_for("decode pictures", static_cast<int64_t>(count), [&](int64_t k) {
      const size_t i = used[first + static_cast<size_t>(k)];
      Result<Image8> image = decode_picture(model.images[i], left);
      if (image.ok())
        made.images_[i] = std::move(*image);
      else
        problems[static_cast<size_t>(k)] = image.error().to_string();
    });
    uint64_t pixels = 0;
    for (size_t k = 0; k < count; ++k) {
      const Image8& image = made.images_[used[first + k]];
      pixels += static_cast<uint64_t>(image.width) * static_cast<uint64_t>(image.height);
      if (!problems[k].empty())
        out->unsupported.push_back({ErrorKind::kUnsupported,
                                    fmt::format("{}: an image is ignored: {}", what, problems[k]),
                                    {},
                                    "convert it to PNG"});
    }
    if (pixels > left)
      return Error{ErrorKind::kInput,
                   fmt::format("{}: the images exceed the available memory by {} million pixels",
                               what, (pixels - left) / 1000000 + 1),
                   {},
                   "use smaller images"};
    left -= pixels;
  }
  return made;
}

bool ImportedTextures::has(const TextureRef& texture) const {
  return texture.ok() && !images_[static_cast<size_t>(texture.image)].texels.empty();
}

int ImportedTextures::row(const TextureRecipe& recipe) {
  for (const auto& [known, row] : rows_)
    if (is_same(known, recipe)) return row;
  const auto image = static_cast<size_t>(recipe.source.image);
  const int row = static_cast<int>(out_->textures.size());
  out_->textures.push_back({names_[image], {Image8{}}, recipe.source.wrap_u, recipe.source.wrap_v});
  rows_.emplace_back(recipe, row);
  return row;
}

void ImportedTextures::finish() {
  parallel_for("make textures", static_cast<int64_t>(rows_.size()), [&](int64_t i) {
    const auto& [recipe, row] = rows_[static_cast<size_t>(i)];
    out_->textures[static_cast<size_t>(row)].faces[0] =
        make_texture(images_[static_cast<size_t>(recipe.source.image)], recipe);
  });
}

Vec3f ImportedTextures::mean(const TextureRef& texture) const {
  if (!has(texture)) return {1, 1, 1};
  const Image8& image = images_[static_cast<size_t>(texture.image)];
  const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  const size_t stride = count / 65536 + 1;
  Vec3Of<double> sum;
  size_t n = 0;
  for (size_t i = 0; i < count; i += stride, ++n) {
    const auto value = [&](int k) {
      const bool color = texture.channel == TextureChannel::kColor;
      return static_cast<float>(texel(image, i, color ? k : static_cast<int>(texture.channel))) /
             255;
    };
    Vec3f v{value(0), value(1), value(2)};
    if (texture.color_space == ColorSpace::kSrgb) v = linear_color(v);
    sum += {v.x, v.y, v.z};
  }
  const Vec3Of<double> mean = sum * (1.0 / static_cast<double>(n));
  return {static_cast<float>(mean.x), static_cast<float>(mean.y), static_cast<float>(mean.z)};
}

bool ImportedTextures::looks_like_normals(const TextureRef& texture) const {
  if (!has(texture) || images_[static_cast<size_t>(texture.image)].channels < 3) return false;
  TextureRef all = texture;
  all.channel = TextureChannel::kColor;
  const Vec3f m = mean(all);
  return std::abs(m.x - 0.5f) < 0.1f && std::abs(m.y - 0.5f) < 0.1f && m.z > 0.7f;
}

}  // namespace gloam
