#pragma once
// The measures that all units of a kitchen's row share.

#include "places/props/parts/fittings.h"

namespace gloam {

constexpr float kWorktop = 0.038f, kPlinth = 0.10f, kOverhang = 0.02f;  // [m]
/// Gap of a front to the end of its unit: half the joint of two [m]
constexpr float kGap = 0.0015f;

struct KitchenUnit {
  float x, y, z;                                 ///< half depth, half width, height of the worktop
  float front() const { return x - kOverhang; }  ///< x of the faces
  float top() const { return z - kWorktop; }     ///< top of the carcass
};

KitchenUnit kitchen_unit(Workshop& shop, float width);
void add_plinth(Workshop& shop, PropPart* part, const KitchenUnit& unit);
/// With its surface.
void add_worktop(Workshop& shop, Prop* prop, const KitchenUnit& unit);

}  // namespace gloam
