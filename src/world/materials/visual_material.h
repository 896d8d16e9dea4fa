#pragma once
// Materials and textures of one model, in the terms of the renderer.

#include <mujoco/mujoco.h>

#include <map>
#include <tuple>
#include <vector>

#include "geometry/image/image_file.h"
#include "world/render_description.h"

namespace gloam {

/// Hands out rows of RenderDescription::materials and ::textures; each is made on first use.
class MaterialTable {
 public:
  /// `live` = the model is the simulated one, so its material rows follow PoseFrame.
  MaterialTable(const mjModel& model, bool live, RenderDescription* out)
      : model_(model), live_(live), out_(out) {}

  /// Row of the material of an element with material `matid` (-1 = none) and colour `rgba`, which
  /// wins over the material's where it differs from MuJoCo's default. Reflectance counts on planes
  /// and boxes, textures on shapes that can carry them (`textured`).
  int row(int matid, const float* rgba, ShapeType shape, bool textured = true);
  /// Row of a texture read as `color_space`.
  int texture_row(int texid, ColorSpace color_space);

  /// Copies the texels of all textures handed out. Textures that cannot be read are reported in
  /// RenderDescription::unsupported and are left as one white texel.
  void load_textures();

 private:
  struct PendingTexture {
    int texid = 0, row = 0;
  };
  int layer(int matid, mjtTextureRole role, MaterialDescription* material);
  void add_layers(int matid, MaterialDescription* material);

  const mjModel& model_;
  bool live_;
  RenderDescription* out_;
  std::map<std::tuple<int, std::array<float, 4>, bool, bool>, int> rows_;
  std::map<std::pair<int, ColorSpace>, int> texture_rows_;
  std::vector<PendingTexture> pending_;
};

/// Picture in a texture whose texels are a KTX file inside the model; empty when they are not, or
/// are damaged.
KtxImage embedded_ktx(const mjModel& model, int texid);

/// Colour that MuJoCo draws an element with: its own where that differs from the default, else its
/// material's.
const float* drawn_rgba(const mjModel& model, int matid, const float* rgba);

}  // namespace gloam
