#pragma once
// Panels that shine, on one side or on both.

#include "render/test/scene_builder.h"

namespace gloam {

/// Half a metre square, seen from -Z.
inline TriangleMesh make_panel() {
  TriangleMesh mesh;
  mesh.positions = {{-0.25f, -0.25f, 0}, {0.25f, -0.25f, 0}, {0.25f, 0.25f, 0}, {-0.25f, 0.25f, 0}};
  mesh.indices = {0, 2, 1, 0, 3, 2};
  return mesh;
}

inline int add_panel_material(SceneBuilder* b, bool outwards) {
  MaterialDescription m;
  m.emission = {100, 100, 100};
  m.emits_outwards = outwards;
  return b->add_material(m);
}

}  // namespace gloam
