#pragma once
// PrivateModel: a simulation's own copy of its World's model. Arrays that a simulation or its user
// may change are its own; meshes, textures, skins and trees of bounds, 95 % of a house's memory,
// stay the World's.

#include <cstddef>
#include <memory>
#include <vector>

#include "world/world.h"

namespace gloam {

class PrivateModel {
 public:
  explicit PrivateModel(std::shared_ptr<const CompiledWorld> world);
  PrivateModel(const PrivateModel&) = delete;
  PrivateModel& operator=(const PrivateModel&) = delete;

  mjModel& model() { return model_; }
  /// Writes what the World has into the options and the own arrays, which stay where they are.
  void renew();
  /// Makes bounds of trees own, too: mj_setConst writes them.
  void own_bounds();

 private:
  size_t bounds_bytes() const;

  const std::shared_ptr<const CompiledWorld> world_;
  mjModel model_;
  std::vector<std::byte> arrays_, bounds_;
};

}  // namespace gloam
