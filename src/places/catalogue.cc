#include "places/catalogue.h"

#include <fmt/format.h>

#include "base/text.h"
#include "gloam/scene/object.h"

namespace gloam {

namespace {

constexpr PropFamily (*kFamilies[])() = {
    seating,             //
    tables,              //
    upholstery,          //
    small_tables,        //
    cabinets,            //
    beds,                //
    shelving,            //
    lamps,               //
    seats,               //
    electronics,         //
    decor,               //
    textiles,            //
    plants,              //
    clutter,             //
    kitchen_units,       //
    kitchen_appliances,  //
    refrigerators,       //
    kitchen_machines,    //
    kitchenware,         //
    kitchen_stores,      //
    kitchen_seats,       //
    sanitary,            //
    bathing,             //
    bathroom_fittings,   //
    bathroom_things,     //
    laundry,             //
    ironing,             //
    household,           //
    cleaning,            //
    utility,             //
    goods,               //
    containers,          //
    racks,               //
    trucks,              //
    vehicles,            //
    tableware,           //
    bags,                //
    baskets,             //
    fixtures,            //
    ceiling_lamps,       //
    computers,           //
    carts,               //
    safety,              //
    halls,               //
    stations,            //
    street,              //
    offices,             //
    trees,               //
    rocks,               //
};

}  // namespace

const std::vector<PropKind>& prop_catalogue() {
  static const std::vector<PropKind> all = [] {
    std::vector<PropKind> list;
    for (const auto family : kFamilies) {
      const PropFamily kinds = family();
      list.insert(list.end(), kinds.begin(), kinds.end());
    }
    return list;
  }();
  return all;
}

std::vector<std::string_view> prop_kind_names() {
  std::vector<std::string_view> names;
  for (const PropKind& kind : prop_catalogue()) names.emplace_back(kind.name);
  return names;
}

const PropKind* find_prop_kind(std::string_view name) {
  for (const PropKind& kind : prop_catalogue())
    if (name == kind.name) return &kind;
  return nullptr;
}

namespace {

bool uses(const Prop& prop, const std::string& material) {
  for (const PropPart& part : prop.parts)
    for (const PropVisual& visual : part.visuals)
      if (visual.material == material) return true;
  return false;
}

}  // namespace

Status check_request(const PropRequest& request) {
  constexpr double kSmallest = 0.001, kLargest = 100;
  if (find_prop_kind(request.kind) == nullptr) {
    const std::vector<std::string_view> kinds = prop_kind_names();
    const std::vector<std::string> names(kinds.begin(), kinds.end());
    return Error{ErrorKind::kInput,
                 fmt::format("there is no prop '{}'", request.kind),
                 {},
                 suggest_name(request.kind, names)};
  }
  if (request.size) {
    for (const double edge : {request.size->x, request.size->y, request.size->z})
      if (!(edge >= kSmallest && edge <= kLargest))
        return Error{ErrorKind::kInput,
                     fmt::format("a prop's size cannot be {} m", edge),
                     {},
                     "depth, width and height must be from 0.001 to 100 m"};
  }
  return {};
}

Result<Prop> make_prop(const PropRequest& request, const Style& style, MaterialSet* materials) {
  GLOAM_TRY_STATUS(check_request(request));
  const PropKind* kind = find_prop_kind(request.kind);
  MaterialSet tried;  // a maker may choose among materials; the rest is not the place's
  Workshop shop(request, style, &tried);
  Prop prop = kind->make(shop);
  prop.label = kind->name;
  for (const Look& look : tried.looks())
    if (uses(prop, look.name)) materials->add(look);
  return prop;
}

std::vector<PropInfo> prop_kinds() {
  std::vector<PropInfo> list;
  for (const PropKind& kind : prop_catalogue()) {
    MaterialSet materials;
    Workshop shop({kind.name}, {}, &materials);
    const Prop prop = kind.make(shop);
    const Prop::Box box = prop.bounds();
    const Vec3f size = box.high - box.low;
    list.push_back({kind.name, kind.text, {size.x, size.y, size.z}, prop.mass(), prop.loose});
  }
  return list;
}

}  // namespace gloam
