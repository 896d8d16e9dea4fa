#pragma once
// Everything that can stand in a place, by kind. A family of kinds is a file of props/.

#include <span>
#include <string_view>

#include "places/prop.h"
#include "places/workshop.h"

namespace gloam {

struct PropKind {
  const char* name;  ///< as in [[prop]] kind, and the semantic class
  Prop (*make)(Workshop& shop);
  const char* text;  ///< description, for lists
};

using PropFamily = std::span<const PropKind>;

// One line each: the files of props/.
PropFamily seating();
PropFamily tables();
PropFamily upholstery();
PropFamily small_tables();
PropFamily cabinets();
PropFamily beds();
PropFamily shelving();
PropFamily lamps();
PropFamily seats();
PropFamily electronics();
PropFamily decor();
PropFamily textiles();
PropFamily plants();
PropFamily clutter();
PropFamily kitchen_units();
PropFamily kitchen_appliances();
PropFamily refrigerators();
PropFamily kitchen_machines();
PropFamily kitchenware();
PropFamily kitchen_stores();
PropFamily kitchen_seats();
PropFamily sanitary();
PropFamily bathing();
PropFamily bathroom_fittings();
PropFamily bathroom_things();
PropFamily laundry();
PropFamily ironing();
PropFamily household();
PropFamily cleaning();
PropFamily utility();
PropFamily goods();
PropFamily containers();
PropFamily racks();
PropFamily trucks();
PropFamily vehicles();
PropFamily tableware();
PropFamily bags();
PropFamily baskets();
PropFamily fixtures();
PropFamily ceiling_lamps();
PropFamily computers();
PropFamily carts();
PropFamily safety();
PropFamily halls();
PropFamily stations();
PropFamily street();
PropFamily offices();
PropFamily trees();
PropFamily rocks();

/// All kinds, family by family.
const std::vector<PropKind>& prop_catalogue();
std::vector<std::string_view> prop_kind_names();
/// nullptr when there is none of that name.
const PropKind* find_prop_kind(std::string_view name);

/// Errors: no such kind (the nearest is named); a size that is not from 1 mm to 100 m.
Status check_request(const PropRequest& request);

/// Makes one. Errors: as check_request.
Result<Prop> make_prop(const PropRequest& request, const Style& style, MaterialSet* materials);

}  // namespace gloam
