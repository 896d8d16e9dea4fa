#include "world/lights/ktx_light.h"

#include <cmath>

#include "base/parallel.h"
#include "world/materials/texture_coordinates.h"

namespace gloam {
namespace {

float usable(float x) { return std::isfinite(x) ? max(x, 0) : 0; }

/// Bilinear, clamped to the face.
Vec3f lookup(const ImageF& face, Vec2f uv) {
  const float x = uv.x * static_cast<float>(face.width) - 0.5f;
  const float y = (1 - uv.y) * static_cast<float>(face.height) - 0.5f;
  const auto texel = [&](int column, int row) {
    const auto c = static_cast<size_t>(column < 0             ? 0
                                       : column >= face.width ? face.width - 1
                                                              : column);
    const auto r = static_cast<size_t>(row < 0 ? 0 : (row >= face.height ? face.height - 1 : row));
    const auto channels = static_cast<size_t>(face.channels);
    const float* t = face.texels.data() + (r * static_cast<size_t>(face.width) + c) * channels;
    const bool gray = channels < 3;
    return Vec3f{usable(t[0]), usable(t[gray ? 0 : 1]), usable(t[gray ? 0 : 2])};
  };
  const float left = std::floor(x), top = std::floor(y);
  const int c = static_cast<int>(left), r = static_cast<int>(top);
  return lerp(lerp(texel(c, r), texel(c + 1, r), x - left),
              lerp(texel(c, r + 1), texel(c + 1, r + 1), x - left), y - top);
}

}  // namespace

EnvironmentDescription environment_of(const KtxImage& cube, std::string name) {
  EnvironmentDescription out;
  out.name = std::move(name);
  out.width = 4 * cube.float_faces[0].width;
  out.height = 2 * cube.float_faces[0].width;
  const auto width = static_cast<size_t>(out.width);
  out.texels.resize(width * static_cast<size_t>(out.height));
  parallel_for("image light", out.height, [&](int64_t row) {
    const float theta = kPi * (static_cast<float>(row) + 0.5f) / static_cast<float>(out.height);
    for (size_t column = 0; column < width; ++column) {
      // The middle column looks along +X, those to the right of it along -Y.
      const float phi =
          2 * kPi * (0.5f - (static_cast<float>(column) + 0.5f) / static_cast<float>(out.width));
      const Vec3f d_W{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                      std::cos(theta)};
      const CubeTexel at = cube_texel(sky_cube_direction(d_W));
      out.texels[static_cast<size_t>(row) * width + column] =
          lookup(cube.float_faces[static_cast<size_t>(at.face)], at.uv);
    }
  });
  return out;
}

}  // namespace gloam
