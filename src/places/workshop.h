#pragma once
// Tools of makers of props: the request, random numbers of its own, and materials by their trade
// names.

#include <functional>
#include <optional>
#include <string>

#include "places/dice.h"
#include "places/materials.h"

namespace gloam {

/// Variant of a kind that is wanted.
struct PropRequest {
  std::string kind;
  uint64_t seed = 0;
  std::optional<Vec3> size = {};   ///< size of its bounding box: depth x, width y, height z [m]
  std::optional<Vec3> color = {};  ///< display (sRGB), of what is coloured about it
  bool operator==(const PropRequest&) const = default;
};

class Workshop {
 public:
  Workshop(const PropRequest& request, const Style& style, MaterialSet* materials)
      : dice(request.seed, request.kind), style(style), request_(request), materials_(materials) {}

  Dice dice;
  const Style style;

  /// The size that is asked for, else `usual`.
  Vec3f size(Vec3f usual) const;
  /// The colour that is asked for, else `usual`.
  Vec3 color(Vec3 usual) const { return request_.color.value_or(usual); }

  // Each returns the material's name. Colours are display values (sRGB).
  std::string wood(Axis grain) { return wood(style.wood, grain); }
  std::string wood(const std::string& species, Axis grain);
  std::string boards(const std::string& species, Axis along, float length, float width);
  std::string paint(Vec3 color, double roughness = 0.4);  ///< lacquer on wood and metal
  std::string plaster(Vec3 color);                        ///< painted walls, slightly uneven
  std::string plastic(Vec3 color, double roughness = 0.35);
  std::string rubber(Vec3 color = {0.04, 0.04, 0.042});
  std::string fabric(Vec3 color, double yarn = 0.0016);  ///< woven; yarn [m]
  std::string carpet(Vec3 color);
  std::string leather(Vec3 color);
  std::string metal() { return metal(style.metal); }
  std::string metal(
      const std::string& kind);         ///< steel chrome brass black galvanised aluminium rust
  std::string glass();                  ///< panes: thin
  std::string solid_glass(Vec3 color);  ///< bottles, vases
  std::string mirror();
  std::string ceramic(Vec3 color);
  std::string tiles(Vec3 color, float size, Vec3 grout = {0.72, 0.71, 0.69});
  std::string marble();
  std::string concrete(Vec3 color = {0.62, 0.61, 0.59});
  std::string brick();
  std::string asphalt();
  std::string ceiling_tiles();  ///< mineral fibre, 60 x 60 cm
  std::string cardboard();
  std::string rough_wood(Axis grain);  ///< sawn and grey: pallets, crates
  std::string chipboard();
  std::string film();              ///< stretched over goods: thin and clear
  std::string reflex(Vec3 color);  ///< bands that shine in headlights
  std::string paper(Vec3 color);
  std::string leaf(Vec3 color);
  std::string earth();
  // Ground and what grows on it; colours are linear.
  std::string gravel();                                   ///< gravel of a worn track
  std::string soil(Vec3 dry, Vec3 dark, double wet = 0);  ///< bare, with crumbs and stones
  std::string turf();                                     ///< ground between blades of grass
  std::string bedrock();                                  ///< grey, with lichen
  std::string blasted_rock();                             ///< rock underground, with dust on it
  std::string blades(const std::string& name, Vec3 young, Vec3 old);  ///< grass, thin
  std::string water();                             ///< water of a pond, clear to murky
  std::string weathered_boards(Axis grain);        ///< grey, never painted
  std::string rusty_sheet();                       ///< zinc that is mostly gone
  std::string glow(Vec3 color, double luminance);  ///< shades and screens that shine [cd/m²]
  std::string picture(const std::string& name, std::function<Image8()> paint,
                      double roughness = 0.6);
  /// One that shines [cd/m²].
  std::string lit_picture(const std::string& name, std::function<Image8()> paint, double luminance);

 private:
  std::string add(Look look) { return materials_->add(std::move(look)); }

  PropRequest request_;
  MaterialSet* materials_;
};

}  // namespace gloam
