#pragma once
// Printed things, as materials for panels. Signs follow ISO 7010's shapes and colours.

#include "places/workshop.h"

namespace gloam {

std::string shipping_label(Workshop* shop);  ///< 10 : 7
std::string handling_mark(Workshop* shop);   ///< 3 : 2, "this side up" and a wine glass
std::string place_label(Workshop* shop);     ///< 4 : 1, bar code of a rack's place
std::string load_sign(Workshop* shop);       ///< 4 : 3, what a rack may carry
std::string exit_picture(Workshop* shop, double luminance);   ///< 2 : 1
std::string warning_picture(Workshop* shop, int kind);        ///< 1 : 1, 0 … 3
std::string extinguisher_picture(Workshop* shop);             ///< 1 : 1
std::string aid_picture(Workshop* shop);                      ///< 1 : 1
std::string stripes(Workshop* shop, Vec3 color, Vec3 other);  ///< 4 : 1, leaning bands
std::string extinguisher_label(Workshop* shop);               ///< 2 : 3

}  // namespace gloam
