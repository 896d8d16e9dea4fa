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

/// [material.pattern] and [material.wear]: a procedural material, in metres (docs/materials.md).
/// Omitted values are the defaults of the kind: solid oak, Carrara marble, a red brick wall …
struct PatternOptions {
  std::string kind = {};  ///< noise wood marble concrete brick tiles fabric scratches dirt
  uint64_t seed = 0;      ///< selects another piece of the same material
  std::optional<Vec3> color_a = {};  ///< ground colour, linear Rec. 709, 0 … 1
  std::optional<Vec3> color_b =
      {};  ///< late wood, veins, other end of the brick colours, weft, dirt
  std::optional<Vec3> color_c = {};      ///< pores, seams, mortar, grout
  std::optional<double> scale = {};      ///< characteristic length [m]
  std::optional<double> size_u = {};     ///< length of a board, panel, brick or tile [m]
  std::optional<double> size_v = {};     ///< its other side [m]
  std::optional<double> gap = {};        ///< width of a joint or scratch [m]
  std::optional<double> depth = {};      ///< depth of joints, pores, yarns [m]
  std::optional<double> roughness = {};  ///< roughness of the ground, 0 … 1
  std::optional<double> coat = {};       ///< weight of varnish or glaze, 0 … 1
  std::optional<double> variation = {};  ///< variation between units, 0 … 1
  std::optional<double> amount = {};     ///< amount of pores, veins, scratches or dirt, 0 … 1
  std::optional<Vec3> axis = {};         ///< direction of the grain or the scratches
  std::string basis = "fbm";             ///< noise: fbm turbulence ridged cells
  std::string bond = "running";          ///< brick: running stack english
  std::string tile = "square";           ///< tiles: square hexagon
  std::string weave = "plain";           ///< fabric: plain twill
  SourceLoc loc = {};
};

/// [[material]]: properties of a material that MJCF cannot express, named as in OpenPBR 1.1.
/// Colour, roughness, metalness, emission, opacity and textures of an MJCF material are taken from
/// the model. Omitted values are taken from the file of the material, or from OpenPBR's defaults.
struct MaterialOptions {
  /// Name of the model's material with the robot prefix, or "VISUAL/MATERIAL"; * matches any text.
  std::string name = {};
  // Values only for materials of [[visual]] tables; they multiply the textures of the file.
  std::optional<Vec3> base_color = {};                  ///< linear Rec. 709, 0 … 1
  std::optional<double> metallic = {}, roughness = {};  ///< 0 … 1
  std::optional<Vec3> emission = {};                    ///< luminance per channel [cd/m²]
  // Values for all materials.
  std::optional<double> ior = {};                  ///< index of refraction, 1 … 3
  std::optional<double> anisotropy = {};           ///< 0 … 1, along the texture's u
  std::optional<double> anisotropy_rotation = {};  ///< [turns], counter-clockwise
  std::optional<double> transmission_weight = {};  ///< 0 … 1: glass
  /// Colour at transmission_depth, or of one passage if that is 0.
  std::optional<Vec3> transmission_color = {};
  std::optional<double> transmission_depth = {};  ///< [m]
  std::optional<bool> thin_walled = {};           ///< a sheet: window panes, leaves, paper
  std::optional<double> subsurface_weight =
      {};                                     ///< 0 … 1; for sheets, light transmitted through them
  std::optional<Vec3> subsurface_color = {};  ///< default 0.8
  std::optional<double> coat_weight = {}, coat_roughness = {}, coat_ior = {};  ///< ior: 1.6
  std::optional<Vec3> coat_color = {};  ///< colour of the coat, linear Rec. 709, 0 … 1
  /// 0 … 1, default 1: the base absorbs light again that the coat reflects back to it, as under
  /// real lacquer; 0: the base keeps its colour (OpenPBR 1.1)
  std::optional<double> coat_darkening = {};
  std::optional<double> fuzz_weight = {}, fuzz_roughness = {};  ///< roughness: 0.5
  std::optional<Vec3> fuzz_color = {};         ///< colour of the fibres, linear Rec. 709, 0 … 1
  std::optional<PatternOptions> pattern = {};  ///< multiplies the colour, sets roughness and bumps
  std::optional<PatternOptions> wear = {};     ///< scratches or dirt on the surface
  std::optional<double> wetness = {};          ///< 0 dry … 1 under water if level
  std::optional<double> porosity = {};         ///< 0 glass and metal … 0.8 concrete, wood
  std::optional<double> dust = {}, snow = {};  ///< 0 … 1
  /// PNG or JPEG, as for `bump`; the red channel multiplies the number of the same name. Empty =
  /// none.
  std::filesystem::path coat_weight_map = {}, coat_roughness_map = {}, transmission_weight_map = {};
  /// Height map (PNG or JPEG), relative to the scene file, with the texture's coordinates; empty =
  /// none
  std::filesystem::path bump = {};
  std::optional<double> bump_scale = {};  ///< height of white above black [m], default 0.001
  SourceLoc loc = {};
};

}  // namespace gloam
