#pragma once
// A RenderScene and what the CPU's rays go through: Embree where it is given one, or our own BVH.

#include <memory>
#include <new>
#include <utility>

#include "render/cpu/tracer/embree_scene.h"
#include "render/scene/bvh_scene.h"

namespace gloam {

class TracedScene {
 public:
  /// `embree` may be null. `keeps_own`: our own BVH is kept up to date beside Embree.
  TracedScene(std::unique_ptr<RenderScene> scene, std::unique_ptr<EmbreeScene> embree,
              bool keeps_own = false)
      : scene_(std::move(scene)),
        embree_(std::move(embree)),
        keeps_own_(keeps_own || embree_ == nullptr) {}

  void update(std::span<const PoseFrame* const> keys, const PoseFrame& previous) {
    scene_->update(keys, previous);
    embree_is_behind_ = embree_ != nullptr;
    // Whether Embree is used is known only when a tracer is requested, but rebuilt meshes are
    // listed only until the next update.
    if (!keeps_own_ || !scene_->rebuilt_meshes().empty()) bring_embree_up();
    if (keeps_own_) own_.update(*scene_);
  }

  /// Valid until the next update, as the one below.
  CpuTracer tracer() {
    bring_embree_up();
    return embree_ != nullptr ? embree_->tracer(*scene_) : by_own(own_.tracer(*scene_));
  }
  /// Tracer of the bodies that never move, without infinite planes.
  CpuTracer static_tracer() {
    bring_embree_up();
    return embree_ != nullptr ? embree_->static_tracer(*scene_)
                              : by_own(own_.static_tracer(*scene_));
  }
  RenderScene& scene() { return *scene_; }
  const RenderScene& scene() const { return *scene_; }
  const BvhScene& own() const { return own_; }

 private:
  void bring_embree_up() {
    if (!embree_is_behind_) return;
    // All geometry is valid, so that Embree can only fail for want of memory.
    if (!embree_->update(*scene_).ok()) throw std::bad_alloc();
    embree_is_behind_ = false;
  }
  CpuTracer by_own(const BvhTracer& own) const {
    CpuTracer tracer;
    tracer.rows = {own_.still().data(), static_cast<uint32_t>(own_.still().size())};
    tracer.own = own;
    return tracer;
  }

  std::unique_ptr<RenderScene> scene_;
  std::unique_ptr<EmbreeScene> embree_;
  BvhScene own_;
  bool keeps_own_;
  bool embree_is_behind_ = false;
};

}  // namespace gloam
