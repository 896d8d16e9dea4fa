#include "world/materials/procedural_description.h"

namespace gloam {

// Albedos are those of dry materials, about: oak 0.35, Carrara marble 0.7, concrete 0.3 to 0.4, red
// brick 0.2 to 0.3, mortar 0.45, white glaze 0.75, linen 0.5, soil 0.1 (ASHRAE Fundamentals, solar
// absorptances; Oke 1987, "Boundary Layer Climates", table 1.1).
ProceduralDescription default_procedural(ProceduralKind kind) {
  ProceduralDescription d;
  d.kind = kind;
  switch (kind) {
    case ProceduralKind::kNoise:
      d.color_a = {0.15f, 0.15f, 0.15f};
      d.color_b = {0.75f, 0.75f, 0.75f};
      break;
    case ProceduralKind::kWood:
      d.color_a = {0.49f, 0.29f, 0.135f};
      d.color_b = {0.25f, 0.115f, 0.04f};
      d.color_c = {0.06f, 0.028f, 0.012f};
      d.scale = 0.004f;
      d.size_u = d.size_v = 0;
      d.gap = 0.001f;
      d.depth = 0.001f;
      d.bevel = 0.001f;
      d.roughness = 0.45f;
      d.coat = 0.5f;
      d.coat_roughness = 0.2f;
      d.amount = 0.4f;
      break;
    case ProceduralKind::kMarble:
      d.color_a = {0.76f, 0.75f, 0.73f};
      d.color_b = {0.2f, 0.215f, 0.235f};
      d.scale = 0.35f;
      d.roughness = 0.12f;
      d.amount = 0.85f;
      break;
    case ProceduralKind::kConcrete:
      d.color_a = {0.45f, 0.44f, 0.42f};
      d.color_b = {0.25f, 0.245f, 0.235f};
      d.color_c = {0.09f, 0.088f, 0.085f};
      d.scale = 0.6f;
      d.size_u = d.size_v = 0;
      d.gap = 0.004f;
      d.depth = 0.002f;
      d.bevel = 0.002f;
      d.roughness = 0.85f;
      break;
    case ProceduralKind::kBrick:
      d.color_a = {0.36f, 0.13f, 0.075f};
      d.color_b = {0.22f, 0.065f, 0.04f};
      d.color_c = {0.46f, 0.43f, 0.38f};
      d.size_u = 0.215f;
      d.size_v = 0.065f;
      d.gap = 0.01f;
      d.depth = 0.005f;
      d.bevel = 0.003f;
      d.roughness = 0.9f;
      d.gap_roughness = 0.95f;
      d.variation = 0.7f;
      break;
    case ProceduralKind::kTiles:
      d.color_a = {0.76f, 0.75f, 0.71f};
      d.color_b = {0.66f, 0.65f, 0.61f};
      d.color_c = {0.32f, 0.31f, 0.29f};
      d.size_u = d.size_v = 0.15f;
      d.gap = 0.003f;
      d.depth = 0.001f;
      d.bevel = 0.0015f;
      d.roughness = 0.35f;
      d.coat = 1;
      d.coat_roughness = 0.05f;
      break;
    case ProceduralKind::kFabric:
      d.color_a = {0.62f, 0.55f, 0.43f};
      d.color_b = {0.5f, 0.43f, 0.33f};
      d.scale = 0.0012f;
      d.depth = 0.0003f;
      d.roughness = 0.95f;
      d.fuzz = 0.4f;
      d.variation = 0.8f;
      break;
    case ProceduralKind::kScratches:
      d.color_a = {0.56f, 0.57f, 0.58f};  // steel
      d.color_b = {0.66f, 0.67f, 0.68f};
      d.scale = 0.12f;
      d.gap = 0.0003f;
      d.depth = 0.00005f;
      d.roughness = 0.25f;
      d.gap_roughness = 0.6f;
      d.metallic = 1;
      d.axis = {1, 0, 0};
      d.variation = 0.25f;
      d.amount = 0.9f;
      break;
    case ProceduralKind::kDirt:
      d.color_a = {0.6f, 0.6f, 0.58f};
      d.color_b = {0.115f, 0.085f, 0.055f};
      d.scale = 0.15f;
      d.depth = 0.0003f;
      d.roughness = 0.4f;
      d.gap_roughness = 0.95f;
      d.amount = 0.3f;
      break;
  }
  return d;
}

}  // namespace gloam
