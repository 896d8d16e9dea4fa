#include "places/props/furniture/art.h"

#include <array>
#include <cmath>

#include "places/dice.h"

namespace gloam {
namespace {

Vec3 mix(Vec3 a, Vec3 b, double t) {
  return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t};
}

double smooth(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Calls color(u, v), u and v from 0 to 1 from the lower left corner, row by row from the top.
template <class Color>
Image8 painted(int width, int height, const Color& color) {
  Image8 image{width, height, 3};
  image.texels.reserve(size_t(width) * size_t(height) * 3);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Vec3 c = color((column + 0.5) / width, 1 - (row + 0.5) / height);
      for (const double x : {c.x, c.y, c.z})
        image.texels.push_back(uint8_t(std::lround(std::clamp(x, 0.0, 1.0) * 255)));
    }
  }
  return image;
}

// column(u) gives color(v). What depends on u alone, ridges above all, is thus worked out once per
// column.
template <class Column>
Image8 painted_by_columns(int width, int height, const Column& column) {
  Image8 image{width, height, 3};
  image.texels.resize(size_t(width) * size_t(height) * 3);
  for (int x = 0; x < width; ++x) {
    const auto color = column((x + 0.5) / width);
    for (int row = 0; row < height; ++row) {
      const Vec3 c = color(1 - (row + 0.5) / height);
      uint8_t* texel = &image.texels[3 * (size_t(row) * size_t(width) + size_t(x))];
      for (const double part : {c.x, c.y, c.z})
        *texel++ = uint8_t(std::lround(std::clamp(part, 0.0, 1.0) * 255));
    }
  }
  return image;
}

// Smooth noise of one variable.
class Ridge {
 public:
  Ridge(Dice& dice, double rough) : rough_(rough) {
    for (auto& w : waves_) w = {dice.uniform(0, 2 * M_PI), dice.uniform(0.7, 1.3)};
  }
  double operator()(double u) const {
    double sum = 0, size = 1, frequency = 4;
    for (const auto& [phase, factor] : waves_) {
      sum += size * std::sin(frequency * factor * u + phase);
      size *= rough_, frequency *= 2.1;
    }
    return sum;
  }

 private:
  double rough_;
  std::array<std::pair<double, double>, 5> waves_;
};

constexpr Vec3 kPalettes[4][5] = {{{0.93, 0.89, 0.80},
                                   {0.80, 0.45, 0.28},
                                   {0.24, 0.36, 0.38},
                                   {0.87, 0.68, 0.36},
                                   {0.16, 0.20, 0.24}},
                                  {{0.91, 0.90, 0.86},
                                   {0.33, 0.45, 0.52},
                                   {0.62, 0.70, 0.70},
                                   {0.16, 0.24, 0.33},
                                   {0.84, 0.62, 0.46}},
                                  {{0.90, 0.86, 0.78},
                                   {0.46, 0.53, 0.40},
                                   {0.25, 0.33, 0.27},
                                   {0.73, 0.58, 0.40},
                                   {0.60, 0.32, 0.24}},
                                  {{0.94, 0.91, 0.87},
                                   {0.72, 0.52, 0.50},
                                   {0.42, 0.34, 0.42},
                                   {0.90, 0.74, 0.62},
                                   {0.22, 0.22, 0.27}}};

Image8 hills(Dice& dice, const Vec3* palette, int width, int height) {
  std::vector<Ridge> ridges;
  for (int k = 0; k < 5; ++k) ridges.emplace_back(dice, 0.34 + 0.04 * k);
  const double sun_u = dice.uniform(0.25, 0.75), sun_v = dice.uniform(0.66, 0.8),
               aspect = double(width) / height;
  return painted_by_columns(width, height, [&](double u) {
    std::array<double, 5> crests;
    for (int k = 0; k < 5; ++k)
      crests[size_t(k)] = 0.60 - 0.12 * k + 0.045 * ridges[size_t(k)](u * aspect);
    return [=](double v) {
      Vec3 c = mix(palette[3], palette[0], smooth(0.3, 1.0, v));
      const double d = std::hypot((u - sun_u) * aspect, v - sun_v);
      c = mix(palette[1], c, smooth(0.105, 0.112, d));
      for (int k = 0; k < 5; ++k) {
        const double crest = crests[size_t(k)];
        c = mix(c, mix(palette[0], palette[4], 0.25 + 0.17 * k),
                smooth(crest + 0.004, crest - 0.004, v));
      }
      return c;
    };
  });
}

Image8 discs(Dice& dice, const Vec3* palette, int width, int height) {
  struct Disc {
    double u, v, r;
    int tint;
  };
  std::vector<Disc> all;
  const double aspect = double(width) / height;
  for (int k = 0; k < 9; ++k)
    all.push_back({dice.uniform(0.1, 0.9), dice.uniform(0.1, 0.9), dice.uniform(0.07, 0.28),
                   dice.integer(1, 4)});
  return painted_by_columns(width, height, [&](double u) {
    return [&, u](double v) {
      Vec3 c = palette[0];
      for (const Disc& disc : all) {
        const double d = std::hypot((u - disc.u) * aspect, v - disc.v);
        // Half a disc, cut by an upright line.
        const double inside =
            smooth(disc.r + 0.004, disc.r - 0.004, d) * (disc.tint % 2 && u < disc.u ? 0.25 : 0.92);
        c = mix(c, palette[disc.tint], inside);
      }
      return c;
    };
  });
}

Image8 bands(Dice& dice, const Vec3* palette, int width, int height) {
  Ridge edge(dice, 0.5);
  std::array<double, 7> cuts;
  double v0 = 0;
  for (double& cut : cuts) cut = v0 += dice.uniform(0.08, 0.2);
  std::array<int, 8> tints;
  for (int& t : tints) t = dice.integer(0, 4);
  return painted_by_columns(width, height, [&](double u) {
    std::array<double, 7> edges;
    for (size_t k = 0; k < cuts.size(); ++k)
      edges[k] = cuts[k] / v0 + 0.012 * edge(u + 0.37 * double(k));
    const double turn = 9 * edge(1.7 * u);
    return [=, &tints](double v) {
      Vec3 c = palette[tints[0]];
      for (size_t k = 0; k < edges.size(); ++k)
        c = mix(c, palette[tints[k + 1]], smooth(edges[k] - 0.012, edges[k] + 0.012, v));
      const double brush = 0.025 * std::sin(220 * v + turn) * std::sin(17 * u + 40 * v);
      return Vec3{c.x + brush, c.y + brush, c.z + brush};
    };
  });
}

Image8 night(Dice& dice, int width, int height) {
  std::vector<Ridge> ridges;
  for (int k = 0; k < 3; ++k) ridges.emplace_back(dice, 0.4);
  const double aspect = double(width) / height, moon_u = dice.uniform(0.3, 0.7);
  return painted_by_columns(width, height, [&](double u) {
    std::array<double, 3> crests;
    for (int k = 0; k < 3; ++k)
      crests[size_t(k)] = 0.35 - 0.11 * k + 0.04 * ridges[size_t(k)](u * aspect);
    return [=](double v) {
      Vec3 c = mix({0.20, 0.28, 0.40}, {0.05, 0.08, 0.17}, smooth(0.2, 1, v));
      const double d = std::hypot((u - moon_u) * aspect, v - 0.72);
      c = mix(c, {0.55, 0.58, 0.62}, 0.5 * smooth(0.32, 0.08, d));
      c = mix(c, {0.94, 0.92, 0.84}, smooth(0.088, 0.082, d));
      for (int k = 0; k < 3; ++k) {
        const double crest = crests[size_t(k)];
        c = mix(c, mix({0.12, 0.18, 0.26}, {0.02, 0.03, 0.06}, 0.4 * k),
                smooth(crest + 0.003, crest - 0.003, v));
      }
      return c;
    };
  });
}

}  // namespace

Image8 paint_art(uint64_t seed, int width, int height) {
  Dice dice(seed, "art");
  const Vec3* palette = kPalettes[dice.integer(0, 3)];
  switch (dice.integer(0, 3)) {
    case 0:
      return hills(dice, palette, width, height);
    case 1:
      return discs(dice, palette, width, height);
    case 2:
      return bands(dice, palette, width, height);
    default:
      return night(dice, width, height);
  }
}

Image8 paint_rug(uint64_t seed, int width, int height, Vec3 ground) {
  Dice dice(seed, "rug");
  const Vec3* palette = kPalettes[dice.integer(0, 3)];
  const Vec3 light = mix(ground, palette[0], 0.7), dark = mix(ground, palette[4], 0.65),
             warm = palette[1];
  const int kind = dice.integer(0, 2);
  const double aspect = double(width) / height, cell = dice.uniform(0.10, 0.16);
  uint32_t state = uint32_t(seed) | 1;
  return painted(width, height, [&](double u, double v) {
    const double x = u * aspect, edge = std::min(std::min(x, aspect - x), std::min(v, 1 - v));
    Vec3 c = ground;
    const double a = x / cell, b = v / cell;
    if (kind == 0) {  // lozenges
      const double d = std::fabs(a - std::floor(a) - 0.5) + std::fabs(b - std::floor(b) - 0.5);
      c = mix(light, c, smooth(0.30, 0.33, d));
      c = mix(warm, c, smooth(0.12, 0.15, d));
    } else if (kind == 1) {  // broad stripes, thin ones between them
      const double s = b * 0.5 - std::floor(b * 0.5);
      c = mix(c, light, smooth(0.50, 0.52, s));
      c = mix(c, dark, smooth(0.03, 0.02, std::fabs(s - 0.25)));
      c = mix(c, warm, smooth(0.03, 0.02, std::fabs(s - 0.75)));
    } else {  // a trellis of thin lines on light ground
      const double p = (a + b) * 0.7, q = (a - b) * 0.7;
      const double d = std::min(std::fabs(p - std::round(p)), std::fabs(q - std::round(q)));
      c = mix(dark, light, smooth(0.05, 0.08, d));
    }
    if (kind != 1) {
      c = mix(dark, c, smooth(0.060, 0.063, edge));
      c = mix(ground, c, smooth(0.045, 0.048, edge));
      c = mix(dark, c, smooth(0.016, 0.018, edge));
    }
    // Knots: rows of pile, no two the same.
    state = state * 1664525u + 1013904223u;
    const double fleck = 0.93 + 0.10 * double(state >> 8) / 16777216.0;
    return Vec3{c.x * fleck, c.y * fleck, c.z * fleck};
  });
}

Image8 paint_cover(uint64_t seed, int width, int height) {
  Dice dice(seed, "cover");
  const Vec3* palette = kPalettes[dice.integer(0, 3)];
  const Vec3 ground = palette[dice.integer(1, 3)],
             ink = dice.chance(0.5) ? palette[0] : Vec3{0.08, 0.08, 0.09};
  const Image8 art = paint_art(dice.seed(), width, height);
  const double end = dice.uniform(0.6, 0.92);
  std::array<double, 8> lines;
  for (double& l : lines) l = dice.uniform(0.15, 0.42);
  return painted(width, height, [&](double u, double v) {
    if (v > 0.08 && v < 0.66 && u > 0.08 && u < 0.92) {
      const size_t at = (size_t((1 - v) * height) * size_t(width) + size_t(u * width)) * 3;
      Vec3 c{art.texels[at] / 255.0, art.texels[at + 1] / 255.0, art.texels[at + 2] / 255.0};
      // Two columns of words over the picture.
      const int row = int((0.60 - v) / 0.045);
      const bool word = u > 0.12 && row >= 0 && row < 8 && u < 0.12 + lines[size_t(row)] &&
                        std::fmod((0.60 - v) / 0.045, 1.0) < 0.4 && row > 3;
      return word ? ink : c;
    }
    // The title: five bold letters' bars.
    if (v > 0.74 && v < 0.92 && u > 0.08 && u < end) {
      const double letter = (u - 0.08) / 0.14, in = letter - std::floor(letter);
      const bool upright = in < 0.28 || (in > 0.55 && in < 0.83 && int(letter) % 2 == 0);
      const bool cross = in < 0.83 && (v > 0.88 || (v < 0.78 && int(letter) % 3 != 1) ||
                                       std::fabs(v - 0.83) < 0.018);
      return upright || cross ? ink : ground;
    }
    return ground;
  });
}

}  // namespace gloam
