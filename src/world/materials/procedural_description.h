#pragma once
// Materials made by formula instead of by pictures, in metres: render/kernel/surface/procedural.h
// evaluates them. Plain data that both sides of a device read.

#include "base/vec.h"

namespace gloam {

/// Solids (noise, wood, marble, concrete) run through the volume; the others lie on the surface,
/// projected along the axis of the frame that the normal is nearest to, so that rows of a wall run
/// level and z is up.
enum class ProceduralKind : uint8_t {
  kNoise,      ///< plain noise between two colours
  kWood,       ///< rings, fibres, pores and rays; solid or in boards
  kMarble,     ///< veins through a cloudy ground
  kConcrete,   ///< mottled, with pores; may show the panels of its formwork
  kBrick,      ///< bricks in mortar
  kTiles,      ///< tiles in grout
  kFabric,     ///< woven yarns
  kScratches,  ///< fine lines; `mask` = fraction of the surface that they take
  kDirt,       ///< grime in corners, near the floor and on top; `mask` = how much covers
};
inline constexpr int kProceduralKindCount = 9;

enum class NoiseBasis : uint8_t { kFbm, kTurbulence, kRidged, kCells };
enum class BrickBond : uint8_t { kRunning, kStack, kEnglish };
enum class TileShape : uint8_t { kSquare, kHexagon };
enum class Weave : uint8_t { kPlain, kTwill };

/// Every kind reads the fields that it names; default_procedural() fills them with a
/// real material's. Colours are linear Rec. 709 albedos.
struct ProceduralDescription {
  ProceduralKind kind = ProceduralKind::kNoise;
  uint32_t seed = 0;
  Vec3f color_a{0.5f, 0.5f, 0.5f};  ///< ground: early wood, stone, brick, tile, warp, clean surface
  Vec3f color_b{0.5f, 0.5f, 0.5f};  ///< second: late wood, veins, brick's other end, weft, dirt
  /// Third: pores, seams, mortar, grout, over-burnt bricks' shade.
  Vec3f color_c{0.5f, 0.5f, 0.5f};
  /// Characteristic length [m], > 0: largest noise cell, mean ring width, distance of veins,
  /// largest stain, yarn spacing, length of a scratch, size of dirt's ragged edge.
  float scale = 0.1f;
  /// Size of a board, formwork panel, brick or tile [m], > 0; 0 for wood and concrete = no boards,
  /// no panels
  float size_u = 0.2f, size_v = 0.1f;
  float gap = 0.01f;           ///< joint between units, or width of a scratch [m]
  float depth = 0.002f;        ///< depth of joints, pores, scratches; height of noise and yarns [m]
  float bevel = 0.002f;        ///< width over which a unit's edge falls into its joint [m], > 0
  float roughness = 0.5f;      ///< roughness of the ground, 0..1
  float gap_roughness = 0.9f;  ///< roughness of joints, scratches, dirt, 0..1
  float coat = 0;              ///< weight of varnish or glaze, 0..1
  float coat_roughness = 0.1f;
  float variation = 0.5f;  ///< between units and of the ground's tone, 0..1
  float amount = 0.5f;     ///< amount of pores, veins, rays, chips, scratches or dirt, 0..1
  float metallic = 0;      ///< metalness of the ground
  float fuzz = 0;          ///< weight of a fabric's sheen, 0..1
  float pith = 0.2f;       ///< wood: how far the log's middle is from the surface's origin [m]
  Vec3f axis{0, 0, 1};     ///< unit: grain of solid wood, direction of scratches
  NoiseBasis basis = NoiseBasis::kFbm;
  BrickBond bond = BrickBond::kRunning;
  TileShape tile = TileShape::kSquare;
  Weave weave = Weave::kPlain;
};

/// The kind's usual look: solid oak, Carrara marble, a red brick wall, white wall tiles, linen,
/// scratched steel, soiled paint.
ProceduralDescription default_procedural(ProceduralKind kind);

}  // namespace gloam
