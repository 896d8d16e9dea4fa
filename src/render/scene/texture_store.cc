#include "render/scene/texture_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "base/srgb.h"

namespace gloam {
namespace {

std::array<uint16_t, 256> decode_table(ColorSpace space) {
  std::array<uint16_t, 256> table;
  for (int i = 0; i < 256; ++i) {
    const double v = i / 255.0;
    const double linear = space == ColorSpace::kLinear ? v : srgb_decode(v);
    table[i] = static_cast<uint16_t>(linear * 65535.0 + 0.5);
  }
  return table;
}

void decode(const Image8& image, Texel* out) {
  const auto color = decode_table(image.color_space);
  const size_t count = static_cast<size_t>(image.width) * image.height;
  const bool gray = image.channels <= 2, alpha = image.channels == 2 || image.channels == 4;
  for (size_t i = 0; i < count; ++i) {
    const uint8_t* in = image.texels.data() + i * image.channels;
    out[i] = {color[in[0]], color[in[gray ? 0 : 1]], color[in[gray ? 0 : 2]],
              alpha ? static_cast<uint16_t>(in[image.channels - 1] * 257) : uint16_t{65535}};
  }
}

/// Halves a level; each texel is the mean of what it covers, weighted by opacity.
void halve(const Texel* in, const TextureLevel& from, Texel* out, const TextureLevel& to) {
  for (int y = 0; y < to.height; ++y) {
    const int y0 = y * from.height / to.height,
              y1 = std::max(y0 + 1, (y + 1) * from.height / to.height);
    for (int x = 0; x < to.width; ++x) {
      const int x0 = x * from.width / to.width,
                x1 = std::max(x0 + 1, (x + 1) * from.width / to.width);
      uint64_t r = 0, g = 0, b = 0, a = 0, plain_r = 0, plain_g = 0, plain_b = 0, n = 0;
      for (int v = y0; v < y1; ++v) {
        for (int u = x0; u < x1; ++u) {
          const Texel& t = in[static_cast<size_t>(v) * from.width + u];
          r += uint64_t{t.r} * t.a;
          g += uint64_t{t.g} * t.a;
          b += uint64_t{t.b} * t.a;
          plain_r += t.r;
          plain_g += t.g;
          plain_b += t.b;
          a += t.a;
          ++n;
        }
      }
      const auto mean = [&](uint64_t weighted, uint64_t plain) {
        return static_cast<uint16_t>(a > 0 ? (weighted + a / 2) / a : (plain + n / 2) / n);
      };
      out[static_cast<size_t>(y) * to.width + x] = {mean(r, plain_r), mean(g, plain_g),
                                                    mean(b, plain_b),
                                                    static_cast<uint16_t>((a + n / 2) / n)};
    }
  }
}

Status check_texture(const TextureDescription& texture) {
  const auto bad = [&](const char* what) {
    return Error{ErrorKind::kInput, fmt::format("texture '{}' {}", texture.name, what)};
  };
  if (texture.faces.size() != 1 && texture.faces.size() != 6) return bad("needs 1 or 6 faces");
  for (const Image8& face : texture.faces) {
    if (face.width < 1 || face.height < 1 || face.channels < 1 || face.channels > 4 ||
        face.texels.size() != static_cast<size_t>(face.width) * face.height * face.channels) {
      return bad("has a face whose number of texels does not match its size");
    }
    if (face.width != texture.faces[0].width || face.height != texture.faces[0].height) {
      return bad("has faces of different sizes");
    }
  }
  return {};
}

}  // namespace

Result<TextureStore> make_texture_store(const std::vector<TextureDescription>& textures) {
  TextureStore store;
  uint64_t texel_count = 0;
  for (const TextureDescription& texture : textures) {
    GLOAM_TRY_STATUS(check_texture(texture));
    TextureView view;
    view.first_level = static_cast<uint32_t>(store.levels.size());
    view.face_count = static_cast<int>(texture.faces.size());
    view.wrap_u = texture.wrap_u;
    view.wrap_v = texture.wrap_v;
    const int width = texture.faces[0].width, height = texture.faces[0].height;
    view.log2_size = 0.5f * std::log2(static_cast<float>(width) * static_cast<float>(height));
    for (size_t face = 0; face < texture.faces.size(); ++face) {
      view.level_count = 0;
      for (int w = width, h = height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
        store.levels.push_back({static_cast<uint32_t>(texel_count), w, h});
        texel_count += static_cast<uint64_t>(w) * h;
        ++view.level_count;
        if (w == 1 && h == 1) break;
      }
    }
    if (texel_count > UINT32_MAX) {
      return Error{ErrorKind::kUnsupported, "the textures have more than 4 G texels"};
    }
    store.textures.push_back(view);
  }
  store.texels.resize(texel_count);
  store.has_alpha.resize(textures.size());
  std::vector<uint8_t> has_alpha(textures.size());
  parallel_for("textures", static_cast<int64_t>(textures.size()), [&](int64_t i) {
    const TextureView& view = store.textures[i];
    for (int face = 0; face < view.face_count; ++face) {
      const TextureLevel* level = &store.levels[view.first_level + face * view.level_count];
      Texel* finest = store.texels.data() + level[0].first;
      decode(textures[i].faces[face], finest);
      const size_t count = static_cast<size_t>(level[0].width) * level[0].height;
      has_alpha[i] |= std::any_of(finest, finest + count, [](Texel t) { return t.a < 65535; });
      for (int k = 1; k < view.level_count; ++k) {
        halve(store.texels.data() + level[k - 1].first, level[k - 1],
              store.texels.data() + level[k].first, level[k]);
      }
    }
  });
  store.has_alpha.assign(has_alpha.begin(), has_alpha.end());
  return store;
}

}  // namespace gloam
