#include "places/workshop.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/srgb.h"

namespace gloam {
namespace {

Vec3 linear(Vec3 c) { return {srgb_decode(c.x), srgb_decode(c.y), srgb_decode(c.z)}; }
Vec3 times(Vec3 c, double by) { return {c.x * by, c.y * by, c.z * by}; }

// Six hexadecimal digits.
std::string hex(Vec3 c) {
  const auto byte = [](double x) {
    return static_cast<int>(std::lround(std::clamp(x, 0.0, 1.0) * 255));
  };
  return fmt::format("{:02x}{:02x}{:02x}", byte(c.x), byte(c.y), byte(c.z));
}

const char* letter(Axis axis) { return axis == Axis::kX ? "x" : axis == Axis::kY ? "y" : "z"; }
Vec3 along(Axis axis) {
  return {axis == Axis::kX ? 1.0 : 0.0, axis == Axis::kY ? 1.0 : 0.0, axis == Axis::kZ ? 1.0 : 0.0};
}

struct Species {
  const char* name;
  Vec3 early, late;  // wood of spring and summer, linear
  double roughness;
};
// Albedo of planed and oiled heartwood, about: oak 0.35, walnut 0.12, pine 0.5, birch 0.55.
constexpr Species kSpecies[] = {{"oak", {0.50, 0.335, 0.195}, {0.31, 0.175, 0.085}, 0.45},
                                {"walnut", {0.19, 0.095, 0.048}, {0.085, 0.038, 0.018}, 0.42},
                                {"pine", {0.66, 0.45, 0.22}, {0.47, 0.24, 0.085}, 0.5},
                                {"birch", {0.68, 0.52, 0.33}, {0.56, 0.39, 0.22}, 0.45}};

const Species& species_of(const std::string& name) {
  for (const Species& s : kSpecies)
    if (name == s.name) return s;
  return kSpecies[0];
}

PatternOptions wood_pattern(const std::string& name, Axis grain) {
  const Species& s = species_of(name);
  PatternOptions p;
  p.kind = "wood";
  p.color_a = s.early;
  p.color_b = s.late;
  p.color_c = times(s.late, 0.3);
  p.roughness = s.roughness;
  p.axis = along(grain);
  return p;
}

PatternOptions noise(Vec3 color_a, Vec3 color_b, double scale, double depth, double roughness,
                     const char* basis = "fbm") {
  PatternOptions p;
  p.kind = "noise";
  p.basis = basis;
  p.color_a = color_a;
  p.color_b = color_b;
  p.scale = scale;
  p.depth = depth;
  p.roughness = roughness;
  return p;
}

PatternOptions dirt(Vec3 color, double scale, double amount) {
  PatternOptions p;
  p.kind = "dirt";
  p.color_b = color;
  p.scale = scale;
  p.amount = amount;
  return p;
}

Look plain(std::string name, Vec3 color, double roughness, double metallic = 0) {
  Look look;
  look.name = std::move(name);
  look.color = color;
  look.roughness = roughness;
  look.metallic = metallic;
  return look;
}

Look patterned(std::string name, PatternOptions pattern) {
  Look look;
  look.name = std::move(name);
  look.more.pattern = std::move(pattern);
  return look;
}

}  // namespace

const Image8& Picture::image() const {
  std::call_once(state_->once, [this] { state_->image = std::exchange(state_->paint, nullptr)(); });
  return state_->image;
}

std::string MaterialSet::add(Look look) {
  for (const Look& there : looks_)
    if (there.name == look.name) return look.name;
  looks_.push_back(std::move(look));
  return looks_.back().name;
}

Vec3f Workshop::size(Vec3f usual) const {
  if (!request_.size) return usual;
  return {float(request_.size->x), float(request_.size->y), float(request_.size->z)};
}

std::string Workshop::wood(const std::string& species, Axis grain) {
  return add(patterned(fmt::format("{}_{}", species, letter(grain)), wood_pattern(species, grain)));
}

std::string Workshop::boards(const std::string& species, Axis grain, float length, float width) {
  PatternOptions p = wood_pattern(species, grain);
  p.size_u = length;
  p.size_v = width;
  p.coat = 0.35;
  return add(patterned(fmt::format("{}_boards_{}_{:.0f}x{:.0f}", species, letter(grain),
                                   length * 1000, width * 1000),
                       std::move(p)));
}

std::string Workshop::paint(Vec3 color, double roughness) {
  return add(plain(fmt::format("paint_{}_{:.0f}", hex(color), roughness * 100), color, roughness));
}

std::string Workshop::plaster(Vec3 color) {
  Look look = plain("plaster_" + hex(color), {1, 1, 1}, 0.9);
  look.more.pattern = noise(times(linear(color), 0.955), linear(color), 0.35, 0.0004, 0.9);
  return add(std::move(look));
}

std::string Workshop::plastic(Vec3 color, double roughness) {
  return add(
      plain(fmt::format("plastic_{}_{:.0f}", hex(color), roughness * 100), color, roughness));
}

std::string Workshop::rubber(Vec3 color) { return add(plain("rubber_" + hex(color), color, 0.85)); }

std::string Workshop::fabric(Vec3 color, double yarn) {
  PatternOptions p;
  p.kind = "fabric";
  p.color_a = linear(color);
  p.color_b = times(linear(color), 0.8);
  p.scale = yarn;
  p.depth = yarn * 0.25;
  return add(patterned(fmt::format("fabric_{}_{:.0f}", hex(color), yarn * 1e5), std::move(p)));
}

std::string Workshop::carpet(Vec3 color) {
  Look look = patterned("carpet_" + hex(color),
                        noise(times(linear(color), 0.75), linear(color), 0.006, 0.001, 1));
  look.more.fuzz_weight = 0.5;
  look.more.fuzz_color = linear(color);
  return add(std::move(look));
}

std::string Workshop::leather(Vec3 color) {
  Look look = plain("leather_" + hex(color), {1, 1, 1}, 0.5);
  look.more.pattern = noise(times(linear(color), 0.85), linear(color), 0.004, 0.0003, 0.5, "cells");
  return add(std::move(look));
}

std::string Workshop::metal(const std::string& kind) {
  if (kind == "chrome") return add(plain("chrome", {0.78, 0.78, 0.79}, 0.06, 1));
  if (kind == "brass") return add(plain("brass", {0.86, 0.68, 0.36}, 0.28, 1));
  if (kind == "black") return add(plain("black_metal", {0.11, 0.11, 0.115}, 0.45));
  if (kind == "aluminium") return add(plain("aluminium", {0.82, 0.82, 0.83}, 0.35, 1));
  if (kind == "galvanised") {
    Look look = plain("galvanised", {0.72, 0.73, 0.74}, 0.45, 1);
    look.more.pattern = noise({0.78, 0.78, 0.78}, {1, 1, 1}, 0.02, 0, 0.42, "cells");
    return add(std::move(look));
  }
  if (kind == "rust") return add(plain("rust", {0.36, 0.20, 0.12}, 0.9));
  return add(plain("steel", {0.68, 0.68, 0.67}, 0.3, 1));
}

std::string Workshop::glass() {
  Look look = plain("window_glass", {1, 1, 1}, 0);
  look.opacity = 0.15;  // in viewers that know no transmission
  look.more.transmission_weight = 1;
  look.more.thin_walled = true;
  return add(std::move(look));
}

std::string Workshop::solid_glass(Vec3 color) {
  Look look = plain("glass_" + hex(color), {1, 1, 1}, 0.02);
  look.opacity = 0.4;
  look.more.transmission_weight = 1;
  look.more.thin_walled = true;
  look.more.transmission_color = linear(color);
  return add(std::move(look));
}

std::string Workshop::mirror() { return add(plain("mirror", {0.9, 0.9, 0.9}, 0.0, 1)); }

std::string Workshop::ceramic(Vec3 color) {
  Look look = plain("ceramic_" + hex(color), color, 0.35);
  look.more.coat_weight = 0.8;
  look.more.coat_roughness = 0.06;
  return add(std::move(look));
}

std::string Workshop::tiles(Vec3 color, float size, Vec3 grout) {
  PatternOptions p;
  p.kind = "tiles";
  p.color_a = linear(color);
  p.color_b = times(linear(color), 0.92);
  p.color_c = linear(grout);
  p.size_u = size;
  p.size_v = size;
  return add(patterned(fmt::format("tiles_{}_{:.0f}", hex(color), size * 1000), std::move(p)));
}

std::string Workshop::marble() {
  PatternOptions p;
  p.kind = "marble";
  return add(patterned("marble", std::move(p)));
}

std::string Workshop::concrete(Vec3 color) {
  PatternOptions p;
  p.kind = "concrete";
  p.color_a = linear(color);
  p.color_b = times(linear(color), 0.6);
  return add(patterned("concrete_" + hex(color), std::move(p)));
}

std::string Workshop::asphalt() {
  return add(patterned(
      "asphalt", noise({0.035, 0.035, 0.036}, {0.085, 0.083, 0.080}, 0.012, 0.0015, 0.9, "cells")));
}

std::string Workshop::ceiling_tiles() {
  PatternOptions p;
  p.kind = "tiles";
  p.color_a = linear(Vec3{0.91, 0.91, 0.90});
  p.color_c = linear(Vec3{0.66, 0.66, 0.65});
  p.size_u = p.size_v = 0.6;
  p.gap = 0.008;
  p.depth = 0.003;
  p.roughness = 0.95;
  p.coat = 0;
  p.variation = 0.04;
  return add(patterned("ceiling_tiles", std::move(p)));
}

std::string Workshop::brick() {
  PatternOptions p;
  p.kind = "brick";
  return add(patterned("brick", std::move(p)));
}

std::string Workshop::cardboard() {
  return add(
      patterned("cardboard", noise({0.35, 0.22, 0.115}, {0.42, 0.275, 0.15}, 0.05, 0.0002, 0.85)));
}

std::string Workshop::rough_wood(Axis grain) {
  PatternOptions p = wood_pattern("pine", grain);
  p.color_a = Vec3{0.46, 0.33, 0.20};  // weathered for a summer
  p.color_b = Vec3{0.30, 0.195, 0.105};
  p.roughness = 0.85;
  return add(patterned(fmt::format("rough_wood_{}", letter(grain)), std::move(p)));
}

std::string Workshop::chipboard() {
  return add(patterned(
      "chipboard", noise({0.36, 0.235, 0.12}, {0.56, 0.40, 0.23}, 0.006, 0.0002, 0.75, "cells")));
}

std::string Workshop::film() {
  Look look =
      patterned("stretch_film", noise({0.93, 0.94, 0.95}, {1, 1, 1}, 0.09, 0.006, 0.12, "ridged"));
  look.roughness = 0.12;
  look.opacity = 0.25;  // in viewers that know no transmission
  look.more.transmission_weight = 0.85;
  look.more.thin_walled = true;
  return add(std::move(look));
}

std::string Workshop::reflex(Vec3 color) {
  Look look = plain("reflex_" + hex(color), color, 0.25);
  look.more.coat_weight = 0.7;
  look.more.coat_roughness = 0.1;
  return add(std::move(look));
}

std::string Workshop::paper(Vec3 color) { return add(plain("paper_" + hex(color), color, 0.9)); }

std::string Workshop::leaf(Vec3 color) {
  Look look = plain("leaf_" + hex(color), color, 0.45);
  look.more.subsurface_weight = 0.5;
  look.more.subsurface_color = linear(color);
  look.more.thin_walled = true;
  return add(std::move(look));
}

std::string Workshop::earth() {
  return add(
      patterned("earth", noise({0.022, 0.014, 0.009}, {0.06, 0.04, 0.026}, 0.015, 0.004, 1)));
}

std::string Workshop::gravel() {
  Look look = patterned(
      "gravel", noise({0.050, 0.044, 0.036}, {0.140, 0.124, 0.102}, 0.022, 0.006, 0.95, "cells"));
  look.more.wear = dirt({0.116, 0.102, 0.082}, 0.8, 0.42);
  return add(std::move(look));
}

std::string Workshop::soil(Vec3 dry, Vec3 dark, double wet) {
  Look look =
      patterned(fmt::format("soil_{}", hex(times(dry, 4))), noise(dark, dry, 0.11, 0.012, 1));
  if (wet > 0) {
    look.more.wetness = wet;
    look.more.porosity = 0.6;
  }
  return add(std::move(look));
}

std::string Workshop::turf() {
  Look look = patterned("turf", noise({0.022, 0.028, 0.009}, {0.066, 0.070, 0.024}, 0.09, 0.02, 1));
  look.more.fuzz_weight = 0.3;
  look.more.fuzz_color = Vec3{0.10, 0.11, 0.05};
  return add(std::move(look));
}

std::string Workshop::bedrock() {
  Look look = patterned("bedrock", noise({0.042, 0.040, 0.036}, {0.125, 0.119, 0.108}, 0.16, 0.014,
                                         0.9, "turbulence"));
  look.more.wear = dirt({0.095, 0.098, 0.055}, 0.12, 0.36);
  return add(std::move(look));
}

std::string Workshop::blasted_rock() {
  Look look = patterned("blasted_rock", noise({0.050, 0.045, 0.040}, {0.165, 0.152, 0.136}, 0.35,
                                              0.03, 0.85, "turbulence"));
  look.more.wear = dirt({0.210, 0.192, 0.168}, 0.5, 0.3);
  return add(std::move(look));
}

std::string Workshop::blades(const std::string& name, Vec3 young, Vec3 old) {
  Look look = patterned(name, noise(old, young, 0.22, 0, 0.55));
  look.more.subsurface_weight = 0.45;
  look.more.subsurface_color = times(young, 1.3);
  look.more.thin_walled = true;
  return add(std::move(look));
}

std::string Workshop::water() {
  Look look = plain("water", {1, 1, 1}, 0);
  look.opacity = 0.5;  // in viewers that know no transmission
  look.more.transmission_weight = 1;
  look.more.ior = 1.33;
  look.more.transmission_color = Vec3{0.34, 0.40, 0.24};
  look.more.transmission_depth = 0.45;
  return add(std::move(look));
}

std::string Workshop::weathered_boards(Axis grain) {
  PatternOptions p = wood_pattern("pine", grain);
  p.color_a = Vec3{0.25, 0.235, 0.215};
  p.color_b = Vec3{0.135, 0.122, 0.107};
  p.depth = 0.002;
  p.coat = 0;
  p.roughness = 0.9;
  return add(patterned(fmt::format("weathered_boards_{}", letter(grain)), std::move(p)));
}

std::string Workshop::rusty_sheet() {
  return add(patterned("rusty_sheet", noise({0.115, 0.048, 0.022}, {0.30, 0.27, 0.245}, 0.5, 0.0008,
                                            0.75, "turbulence")));
}

std::string Workshop::glow(Vec3 color, double luminance) {
  Look look = plain(fmt::format("glow_{}_{:.0f}", hex(color), luminance), color, 0.9);
  look.luminance = luminance;
  return add(std::move(look));
}

std::string Workshop::picture(const std::string& name, std::function<Image8()> paint,
                              double roughness) {
  Look look = plain(name, {1, 1, 1}, roughness);
  look.picture = Picture(std::move(paint));
  return add(std::move(look));
}

std::string Workshop::lit_picture(const std::string& name, std::function<Image8()> paint,
                                  double luminance) {
  Look look = plain(name, {1, 1, 1}, 0.4);
  look.picture = Picture(std::move(paint));
  look.luminance = luminance;
  return add(std::move(look));
}

}  // namespace gloam
