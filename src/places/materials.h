#pragma once
// The materials of generated places: a look by name, made once for a place.

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "geometry/image/image.h"
#include "geometry/solid.h"
#include "gloam/scene.h"

namespace gloam {

/// A picture that is painted when it is first looked at, by any thread: makers mix many materials,
/// a place keeps few. Copies share it.
class Picture {
 public:
  Picture() = default;
  explicit Picture(std::function<Image8()> paint) : state_(std::make_shared<State>()) {
    state_->paint = std::move(paint);
  }
  bool empty() const { return state_ == nullptr; }
  const Image8& image() const;  ///< not of an empty one

 private:
  struct State {
    std::once_flag once;
    std::function<Image8()> paint;  ///< until it is done
    Image8 image;
  };
  std::shared_ptr<State> state_;
};

/// One material: what MJCF says of it, and what a [[material]] does.
struct Look {
  std::string name;
  Vec3 color{1, 1, 1};  ///< display (sRGB), 0 … 1
  double roughness = 0.6, metallic = 0;
  double opacity = 1;
  double luminance = 0;       ///< luminance of glowing materials [cd/m²]
  Picture picture = {};       ///< on texture coordinates; empty = none
  MaterialOptions more = {};  ///< its name is empty
};

/// The looks of a place. Names are words and numbers: "oak_x", "paint_e3dccf".
class MaterialSet {
 public:
  /// Keeps it unless one of its name is there. Returns its name.
  std::string add(Look look);
  const std::vector<Look>& looks() const { return looks_; }

 private:
  std::vector<Look> looks_;
};

/// Style that a whole place has in common.
struct Style {
  std::string wood = "oak";       ///< oak walnut pine birch
  std::string metal = "steel";    ///< metal of handles and taps: steel brass black
  Vec3 fabric{0.55, 0.53, 0.50};  ///< colour of the large upholstery
  Vec3 accent{0.20, 0.36, 0.38};
  Vec3 wall{0.90, 0.88, 0.84};
  Vec3 trim{0.86, 0.85, 0.82};     ///< skirting, doors, window frames
  Vec3 cabinet{0.83, 0.83, 0.80};  ///< kitchen fronts
  Vec3 tiles{0.86, 0.86, 0.84};    ///< behind worktops
  bool wooden_fronts = false;      ///< kitchens have fronts of `wood` instead of `cabinet`
  std::string worktop = "wood";    ///< wood marble concrete
  uint64_t door = 0;               ///< seed of the make of inner doors
};

}  // namespace gloam
