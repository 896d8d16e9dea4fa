#pragma once
// The buffers behind a SceneView: made once from a RenderDescription, moved by PoseFrames.

#include <memory>
#include <vector>

#include "render/scene/light_table.h"
#include "render/scene/mesh_store.h"
#include "render/scene/texture_store.h"

namespace gloam {

class RenderScene {
 public:
  /// The description must outlive it. Errors: indices that refer to nothing, sizes that are not
  /// positive, broken meshes and textures.
  static Result<std::unique_ptr<RenderScene>> make(const RenderDescription& description);

  /// `open` and `close` bracket the shutter; `previous` is the frame before.
  void update(const PoseFrame& open, const PoseFrame& close, const PoseFrame& previous);
  /// Scene with its headlights at the camera. Valid until the next update or view_from.
  SceneView view_from(const Affine3f& X_WC);

  const RenderDescription& description() const { return description_; }
  const std::vector<InstanceView>& instances() const { return instances_; }
  const std::vector<MeshView>& meshes() const { return mesh_views_; }
  /// What a LightGuide has rows for.
  std::vector<LightView> guided_lights(const PoseFrame& frame) const {
    return LightTable::guided(description_, frame, instances_);
  }
  /// Something moves between shutter open and close.
  bool has_motion() const;
  /// Invisible instances are in the tables but never traced: transparent ones, and MuJoCo's geom
  /// groups 3 and up, where robots keep what they collide with.
  bool is_drawn(size_t instance) const {
    constexpr int kDrawnGroups = 3;
    return materials_[instances_[instance].material].opacity > 0 &&
           description_.instances[instance].group < kDrawnGroups;
  }

 private:
  explicit RenderScene(const RenderDescription& description) : description_(description) {}

  const RenderDescription& description_;
  TextureStore textures_;
  MeshStore meshes_;
  LightTable lights_;
  AlbedoTable albedo_;
  std::vector<MaterialView> materials_;
  std::vector<InstanceView> instances_;
  std::vector<MeshView> mesh_views_;
};

}  // namespace gloam
