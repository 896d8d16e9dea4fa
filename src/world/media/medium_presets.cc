#include "world/media/medium_presets.h"

namespace gloam {
namespace {

// Bands: red 612, green 550, blue 465, 905, 1550 nm and the mean from 8 to 14 µm.
//
// smoke: soot of flaming fires. 8.7 m²/g at 633 nm (Mulholland and Croarkin 2000, "Specific
//   extinction coefficient of flame generated smoke"), as 1 / wavelength; albedo 0.25 and g at 550
//   nm after Bond and Bergstrom 2006, "Light absorption by carbonaceous particles", falling towards
//   the infrared as the particles become small.
// fog, mist: Mie theory of water (Hale and Querry 1973) over the gamma distributions of Shettle and
//   Fenn 1979, "Models for the aerosols of the lower atmosphere": advection fog (mode 10 µm, shape
//   3; effective radius 20 µm) and radiation fog (2 µm, 6; 3 µm), which steam over a kettle is
//   like.
// haze: "continental polluted" at 80 % humidity of OPAC 3.1 (Hess, Koepke and Schult 1998): 2.86
//   m²/g, albedo 0.89 and g 0.70 at 550 nm; other visible and near bands by its Ångström exponent
//   1.4, far infrared by its insoluble part and what the rest absorbs.
// dust: Mie theory (Bohren and Huffman 1983) of mineral grains. Refractive index in the
//   visible: mean of 19 soils of eight regions, n 1.52, k 0.0033, 0.0024, 0.0018, 0.0012, 0.0010,
//   0.0009, 0.0009 at 370, 470, 520, 590, 660, 880, 950 nm (Di Biagio et al. 2019, table 4), the
//   last of them held to 1550 nm; from 8 to 14 µm "mineral" of OPAC (after Volz 1973). Sizes:
//   coarse mode over Cape Verde, log-normal about a radius of 1.90 µm by volume, ln sigma 0.60
//   (Dubovik et al. 2002, "Variability of absorption and optical properties of key aerosol types
//   observed in worldwide locations", table 1); 2600 kg/m³ (OPAC). Sun photometers found an albedo
//   of 0.92 to 0.93 at 440 nm and of 0.95 to 0.98 at 670 nm over three deserts, and g 0.66 to 0.73
//   (there).
// clang-format off: a line per medium: name, mass extinction, albedo, g
const MediumDescription kPresets[] = {
    {"smoke", {9000, 10000, 11800, 6090, 3550, 514}, {.23f, .25f, .27f, .17f, .09f, .01f}, {.58f, .6f, .64f, .48f, .3f, .02f}},
    {"fog", {77.4f, 77, 76.9f, 78.1f, 79.4f, 85.3f}, {1, 1, 1, .9999f, .984f, .539f}, {.872f, .873f, .874f, .868f, .865f, .931f}},
    {"mist", {556, 550, 545, 571, 626, 202}, {1, 1, 1, 1, .998f, .359f}, {.83f, .835f, .838f, .806f, .776f, .666f}},
    {"haze", {2470, 2860, 3620, 1430, 670, 90}, {.89f, .89f, .89f, .88f, .86f, .38f}, {.69f, .7f, .71f, .66f, .65f, .75f}},
    {"dust", {439, 432, 423, 473, 526, 212}, {.964f, .948f, .911f, .98f, .989f, .408f}, {.722f, .735f, .759f, .691f, .68f, .431f}},
};
// clang-format on

}  // namespace

const MediumDescription* find_medium(std::string_view name) {
  for (const MediumDescription& preset : kPresets) {
    if (preset.name == name) return &preset;
  }
  return nullptr;
}

std::vector<std::string> medium_names() {
  std::vector<std::string> names;
  for (const MediumDescription& preset : kPresets) names.push_back(preset.name);
  return names;
}

float lidar_ratio(std::string_view name) {
  // Drops at 905 nm: O'Connor, Illingworth and Hogan 2004, "A technique for autocalibration of
  // cloud lidar". Others at 1064 nm, as polluted continental air and dust: Omar et al. 2009, "The
  // CALIPSO automated aerosol classification and lidar ratio selection algorithm".
  if (name == "fog" || name == "mist") return 18.8f;
  if (name == "rain" || name == "snowfall") return 18.8f;  // spheres of water; ice is taken as they
  if (name == "haze") return 30;
  if (name == "dust") return 55;
  return 0;
}

}  // namespace gloam
