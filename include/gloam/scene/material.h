#pragma once
// Materials of a scene: [[material]] and its procedural patterns. Part of gloam/scene.h;
// docs/materials.md has examples.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [material.pattern] and [material.wear]: a material made by formula, in metres
/// (docs/materials.md). What is not given is the kind's own: solid oak, Carrara marble, a red brick
/// wall …
struct PatternOptions {
  std::string kind = {};  ///< noise wood marble concrete brick tiles fabric scratches dirt
  uint64_t seed = 0;      ///< another piece of the same stuff
  std::optional<Vec3> color_a = {};      ///< ground, linear Rec. 709, 0 … 1
  std::optional<Vec3> color_b = {};      ///< late wood, veins, brick's other end, weft, dirt
  std::optional<Vec3> color_c = {};      ///< pores, seams, mortar, grout
  std::optional<double> scale = {};      ///< characteristic length [m]
  std::optional<double> size_u = {};     ///< length of a board, panel, brick or tile [m]
  std::optional<double> size_v = {};     ///< the other side [m]
  std::optional<double> gap = {};        ///< joint, or width of a scratch [m]
  std::optional<double> depth = {};      ///< depth of joints, pores, yarns [m]
  std::optional<double> roughness = {};  ///< roughness of the ground, 0 … 1
  std::optional<double> coat = {};       ///< varnish or glaze, 0 … 1
  std::optional<double> variation = {};  ///< between units, 0 … 1
  std::optional<double> amount = {};     ///< amount of pores, veins, scratches or dirt, 0 … 1
  std::optional<Vec3> axis = {};         ///< direction of the grain or the scratches
  std::string basis = "fbm";             ///< noise: fbm turbulence ridged cells
  std::string bond = "running";          ///< brick: running stack english
  std::string tile = "square";           ///< tiles: square hexagon
  std::string weave = "plain";           ///< fabric: plain twill
  SourceLoc loc = {};
};

/// [[material]]: what MJCF cannot say of one of its materials; names after OpenPBR 1.1. Colour,
/// roughness, metalness, emission, opacity and textures of an MJCF material stay the model's. What
/// is not given stays as the file has it that the material came with, or as in OpenPBR.
struct MaterialOptions {
  /// Name of the model's material, robot prefix included, or "VISUAL/MATERIAL"; * stands for any
  /// text.
  std::string name = {};
  // Values for materials of [[visual]]s alone; they multiply the file's textures.
  std::optional<Vec3> base_color = {};                  ///< linear Rec. 709, 0 … 1
  std::optional<double> metallic = {}, roughness = {};  ///< 0 … 1
  std::optional<Vec3> emission = {};                    ///< luminance per channel [cd/m²]
  // Values for all materials.
  std::optional<double> ior = {};                  ///< index of refraction, 1 … 3
  std::optional<double> anisotropy = {};           ///< 0 … 1, along the texture's u
  std::optional<double> anisotropy_rotation = {};  ///< [turns], counter-clockwise
  std::optional<double> transmission_weight = {};  ///< 0 … 1: glass
  /// At transmission_depth, or of one passage where that is 0.
  std::optional<Vec3> transmission_color = {};
  std::optional<double> transmission_depth = {};  ///< [m]
  std::optional<bool> thin_walled = {};           ///< a sheet: window panes, leaves, paper
  std::optional<double> subsurface_weight = {};   ///< 0 … 1; light that goes through, of sheets
  std::optional<Vec3> subsurface_color = {};      ///< default 0.8
  std::optional<double> coat_weight = {}, coat_roughness = {}, coat_ior = {};  ///< ior: 1.6
  std::optional<Vec3> coat_color = {};  ///< colour of the coat, linear Rec. 709, 0 … 1
  /// 0 … 1, default 1: light that the coat reflects back down is dimmed by the base again, as it is
  /// beneath real lacquer; 0: the base keeps its colour (OpenPBR 1.1)
  std::optional<double> coat_darkening = {};
  std::optional<double> fuzz_weight = {}, fuzz_roughness = {};  ///< roughness: 0.5
  std::optional<Vec3> fuzz_color = {};         ///< colour of the fibres, linear Rec. 709, 0 … 1
  std::optional<PatternOptions> pattern = {};  ///< multiplies the colour, sets roughness and bumps
  std::optional<PatternOptions> wear = {};     ///< scratches or dirt over it
  std::optional<double> wetness = {};          ///< 0 dry … 1 under water where level
  std::optional<double> porosity = {};         ///< 0 glass and metal … 0.8 concrete, wood
  std::optional<double> dust = {}, snow = {};  ///< 0 … 1
  /// PNG or JPEG, as `bump`; their red times the number of the same name. Empty = none.
  std::filesystem::path coat_weight_map = {}, coat_roughness_map = {}, transmission_weight_map = {};
  /// PNG or JPEG of heights, relative to the scene file, on the texture's coordinates; empty = none
  std::filesystem::path bump = {};
  std::optional<double> bump_scale = {};  ///< [m] that white stands above black, default 0.001
  SourceLoc loc = {};
};

}  // namespace gloam
