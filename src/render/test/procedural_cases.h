#pragma once
// Every procedural material and its options, for tests that hold for all of them.

#include <vector>

#include "render/kernel/surface/procedural.h"

namespace gloam {

struct ProceduralCase {
  const char* name;
  ProceduralDescription d;
  float unit;  ///< size of its typical detail [m]
};

inline std::vector<ProceduralCase> procedural_cases() {
  std::vector<ProceduralCase> cases;
  const auto add = [&](const char* name, ProceduralKind kind, float unit, auto change) {
    ProceduralDescription d = default_procedural(kind);
    change(d);
    cases.push_back({name, d, unit});
  };
  using D = ProceduralDescription;
  const auto as_is = [](D&) {};
  for (const auto& [name, basis] : {std::pair{"noise", NoiseBasis::kFbm},
                                    std::pair{"noise, turbulence", NoiseBasis::kTurbulence},
                                    std::pair{"noise, ridged", NoiseBasis::kRidged},
                                    std::pair{"noise, cells", NoiseBasis::kCells}}) {
    add(name, ProceduralKind::kNoise, 0.05f, [&](D& d) { d.basis = basis; });
  }
  add("wood", ProceduralKind::kWood, 0.004f, as_is);
  add("wood, boards", ProceduralKind::kWood, 0.03f, [](D& d) {
    d.size_u = 1.2f;
    d.size_v = 0.12f;
  });
  add("marble", ProceduralKind::kMarble, 0.1f, as_is);
  add("concrete", ProceduralKind::kConcrete, 0.05f, as_is);
  add("concrete, panels", ProceduralKind::kConcrete, 0.2f, [](D& d) {
    d.size_u = 1.2f;
    d.size_v = 0.6f;
  });
  add("brick", ProceduralKind::kBrick, 0.07f, as_is);
  add("brick, stack bond", ProceduralKind::kBrick, 0.07f, [](D& d) { d.bond = BrickBond::kStack; });
  add("brick, English bond", ProceduralKind::kBrick, 0.07f,
      [](D& d) { d.bond = BrickBond::kEnglish; });
  add("tiles", ProceduralKind::kTiles, 0.05f, as_is);
  add("tiles, hexagons", ProceduralKind::kTiles, 0.05f, [](D& d) { d.tile = TileShape::kHexagon; });
  add("fabric", ProceduralKind::kFabric, 0.0012f, as_is);
  add("fabric, twill", ProceduralKind::kFabric, 0.0012f, [](D& d) {
    d.weave = Weave::kTwill;
    d.color_b = {0.1f, 0.15f, 0.3f};
  });
  add("scratches", ProceduralKind::kScratches, 0.005f, as_is);
  add("dirt", ProceduralKind::kDirt, 0.1f, as_is);
  return cases;
}

}  // namespace gloam
