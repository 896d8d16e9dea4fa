#pragma once
// Poses of everything visible at one instant, in structure-of-arrays with a leading world index
// (one world live). Made by PoseSolver on the consumer's thread; free of MuJoCo types. Places are
// counted from the World's render origin (world/view/render_origin.h).

#include <cstdint>
#include <vector>

#include "world/media/medium_description.h"

namespace gloam {

struct PoseFrame {
  int n_world = 1;
  int64_t run = 0;  ///< resets before it
  int64_t step = 0;
  double time = 0;                ///< [s]
  std::vector<double> body_p;     ///< p_WB [m], (n_world x nbody x 3)
  std::vector<double> body_R;     ///< R_WB row-major, (n_world x nbody x 9)
  std::vector<double> camera_p;   ///< p_WC [m], (n_world x ncam x 3)
  std::vector<double> camera_R;   ///< R_WC row-major, (n_world x ncam x 9)
  std::vector<double> light_p;    ///< [m], (n_world x nlight x 3)
  std::vector<double> light_dir;  ///< unit, world, (n_world x nlight x 3)
  std::vector<float> vertices;    ///< deformables' vertices, world [m], (n_world x nvertex x 3)

  // Live fields as they were at this instant. Of one simulation, equal `live_serial`s mean equal
  // fields; 0 = all as in the World's model.
  uint64_t live_serial = 0;
  std::vector<float> light_diffuse;      ///< (n_world x nlight x 3)
  std::vector<float> light_intensity;    ///< (n_world x nlight) [cd]
  std::vector<uint8_t> light_active;     ///< (n_world x nlight)
  std::vector<float> geom_rgba;          ///< (n_world x ngeom x 4)
  std::vector<float> material_rgba;      ///< (n_world x nmat x 4)
  std::vector<float> material_emission;  ///< (n_world x nmat); likewise below
  std::vector<float> material_specular, material_shininess, material_reflectance;
  std::vector<float> material_metallic, material_roughness;  ///< -1 = not given
  uint64_t height_field_serial = 0;  ///< serial of their last change, 0 = as in the World's model
  std::vector<float> height_field;   ///< (n_world x nhfielddata) 0..1; empty while that is 0

  /// Grids of what is solved for, by VolumeDescription::field.
  struct Field {
    VolumeGrid density, temperature;  ///< null = clear
    VolumeGrid flame;                 ///< absorption by flames [1/m]; null = nothing burns
  };
  std::vector<Field> fields;  ///< (n_world x ngas)

  /// Fraction of its snow that a body has not shed, 0 … 1, (n_world x nbody); empty = all of it.
  std::vector<float> snow_left;
};

}  // namespace gloam
