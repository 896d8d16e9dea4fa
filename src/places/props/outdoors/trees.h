#pragma once
// Trees, as gardens and open country have them.

#include "places/catalogue.h"

namespace gloam {

/// A leaf of two triangles, pointed at both ends, of that length along `d`.
void add_leaf(Vec3f at, Vec3f d, Vec3f side, float length, Solid* leaves);

/// A broadleaf of that height [m].
Prop make_tree(double high, Workshop* shop, Dice* dice);

}  // namespace gloam
