#include "world/deformable_layout.h"

namespace gloam {

DeformableLayout deformable_layout(const mjModel& model) {
  DeformableLayout layout;
  const int skin_vertices = static_cast<int>(model.nskinvert);
  for (int skin = 0; skin < model.nskin; ++skin) {
    layout.skin_first.push_back(model.skin_vertadr[skin]);
  }
  for (int flex = 0; flex < model.nflex; ++flex) {
    layout.flex_first.push_back(skin_vertices + model.flex_vertadr[flex]);
  }
  layout.nvertex = skin_vertices + static_cast<int>(model.nflexvert);
  return layout;
}

}  // namespace gloam
