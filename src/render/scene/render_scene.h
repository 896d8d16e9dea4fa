#pragma once
// The buffers behind a SceneView: made once from a RenderDescription, moved by PoseFrames.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/scene/environment_table.h"
#include "render/scene/level_table.h"
#include "render/scene/light_table.h"
#include "render/scene/material_store.h"
#include "render/scene/mesh_store.h"
#include "render/scene/moving_sky.h"
#include "render/scene/patterns/pattern_store.h"
#include "render/scene/profile_store.h"
#include "render/scene/texture_store.h"
#include "render/scene/volume_store.h"

namespace gloam {

/// The scene as described, whatever has been changed or switched off since.
struct DescribedLook {
  std::vector<MaterialView> materials;
  std::vector<InstanceView> instances;  ///< static ones stand where they are
  std::vector<LightView> lights;        ///< those with a row of LightGuide::visible
  EnvironmentView environment;
  Vec3f sky_ambient;  ///< [cd/m²]
};

class RenderScene {
 public:
  /// The description must outlive it. Errors: indices that refer to nothing, sizes that are not
  /// positive, broken meshes and textures.
  static Result<std::unique_ptr<RenderScene>> make(const RenderDescription& description);

  /// Updates as Renderer::update does.
  void update(std::span<const PoseFrame* const> keys, const PoseFrame& previous);
  /// Scene with its headlights at the camera, which is at `keys` at the scene's keys; empty = it
  /// stands still. Valid until the next update or view_from.
  SceneView view_from(const Affine3f& X_WC, std::span<const Affine3f> keys = {});

  const RenderDescription& description() const { return description_; }
  const std::vector<InstanceView>& instances() const { return instances_; }
  const std::vector<MeshView>& meshes() const { return mesh_views_; }
  /// Description of the scene that a LightGuide is made of.
  DescribedLook described_look(const PoseFrame& frame) const;
  /// Whether something moves between shutter open and close.
  bool has_motion() const;
  /// Whether a light flickers between shutter open and close.
  bool has_flicker() const { return !levels_.bins().empty(); }
  /// Invisible instances are in the tables but never traced: fully transparent ones and those
  /// that are not shown.
  bool is_drawn(size_t instance) const { return drawn_[instance]; }
  /// Whether light may pass straight through it.
  bool lets_light_through(size_t instance) const {
    return materials_.views()[instances_[instance].material].transparent;
  }
  /// Changes whenever is_drawn() does for some instance.
  uint64_t drawn_version() const { return drawn_version_; }
  /// Neither moves nor may change its form: height fields may.
  bool is_fixed(size_t instance) const {
    const InstanceView& in = instances_[instance];
    return description_.instances[instance].is_static &&
           !(in.shape == ShapeType::kMesh && is_height_field_[in.mesh]);
  }
  /// Rows of the meshes that the last update rebuilt.
  const std::vector<uint32_t>& rebuilt_meshes() const { return rebuilt_meshes_; }

 private:
  explicit RenderScene(const RenderDescription& description) : description_(description) {}
  void follow_live_fields(const PoseFrame& frame);
  void follow_materials();
  void bake_patterns(const PoseFrame& frame);
  EnvironmentView described_environment() const;
  bool add_keys(std::span<const PoseFrame* const> keys, const InstanceDescription& in,
                const Affine3f& X_WG);

  const RenderDescription& description_;
  TextureStore textures_;
  MeshStore meshes_;
  LightTable lights_;
  ProfileStore profiles_;
  std::optional<EnvironmentTable> environment_;
  std::optional<MovingSky> moving_sky_;
  VolumeStore volumes_;
  std::optional<PatternStore> patterns_;  ///< baked by the first update
  AlbedoTable albedo_;
  std::unique_ptr<GlassTable> glass_;  ///< where some material is glass
  MaterialStore materials_;
  Vec3f sky_ambient_;  ///< [cd/m²]
  LevelTable levels_;
  std::vector<InstanceView> instances_;
  std::vector<Affine3f> pose_keys_;  ///< of the instances that move while the shutter is open
  std::vector<MeshView> mesh_views_;
  std::vector<bool> drawn_;            ///< by instance
  std::vector<bool> is_height_field_;  ///< by mesh
  double time_ = 0;                    ///< of the first key [s]
  uint64_t drawn_version_ = 0, height_field_serial_ = 0;
  std::vector<uint32_t> rebuilt_meshes_;
};

}  // namespace gloam
