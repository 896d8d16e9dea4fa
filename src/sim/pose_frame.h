#pragma once
// Where everything visible is at one instant, in structure-of-arrays with a leading world index
// (one world live). Made by PoseSolver on the consumer's thread; free of MuJoCo types.

#include <cstdint>
#include <vector>

namespace gloam {

struct PoseFrame {
  int n_world = 1;
  int64_t step = 0;
  double time = 0;                ///< [s]
  std::vector<double> body_p;     ///< p_WB [m], (n_world x nbody x 3)
  std::vector<double> body_R;     ///< R_WB row-major, (n_world x nbody x 9)
  std::vector<double> camera_p;   ///< p_WC [m], (n_world x ncam x 3)
  std::vector<double> camera_R;   ///< R_WC row-major, (n_world x ncam x 9)
  std::vector<double> light_p;    ///< [m], (n_world x nlight x 3)
  std::vector<double> light_dir;  ///< unit, world, (n_world x nlight x 3)
  std::vector<float> vertices;    ///< deformables' vertices, world [m], (n_world x nvertex x 3)

  // Live fields as they were at this instant; `live_version` changes when any of them does.
  uint64_t live_version = 0;
  std::vector<float> light_diffuse;      ///< (n_world x nlight x 3)
  std::vector<float> light_intensity;    ///< (n_world x nlight) [cd]
  std::vector<uint8_t> light_active;     ///< (n_world x nlight)
  std::vector<float> material_rgba;      ///< (n_world x nmat x 4)
  std::vector<float> material_emission;  ///< (n_world x nmat)
  uint64_t height_field_version = 0;
  std::vector<float> height_field;  ///< (n_world x nhfielddata) 0..1; empty unless it ever changed
};

}  // namespace gloam
