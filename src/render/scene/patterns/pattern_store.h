#pragma once
// Procedural materials, baked onto the surfaces of a scene.

#include <filesystem>
#include <span>
#include <vector>

#include "render/kernel/surface/baked_view.h"
#include "render/scene/patterns/pattern_surface.h"

namespace gloam {

class PatternStore {
 public:
  /// Bakes as the description asks for, or finds what was baked before in the cache; nothing where
  /// it asks for formulas. `frame` as in collect_pattern_surfaces().
  static PatternStore make(const RenderDescription& description, const PoseFrame& frame);

  BakedView view() const;
  /// Rows of BakedView::patterns, by instance; empty where nothing is baked.
  const std::vector<InstancePatterns>& instances() const { return instances_; }

 private:
  void bake(const PatternBaking& baking, std::span<PatternSurface> surfaces);
  bool load(const std::filesystem::path& path, size_t surfaces);
  void keep(const std::filesystem::path& path);

  std::vector<BakedPattern> patterns_;
  std::vector<BakedSlot> slots_;
  std::vector<BakedTexel> texels_;
  std::vector<InstancePatterns> instances_;
};

}  // namespace gloam
