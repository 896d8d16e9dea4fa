#include "places/terrain/landscape.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kSteepest = 0.42;               // slope of the hills: robots can climb it
constexpr double kFlatRadius = 2.5, kBlend = 7;  // about the origin [m]
constexpr double kRoadStep = 1, kRoadAway = 60;  // [m]
constexpr double kShoulder = 0.8, kGraded = 5;   // beside the road: level, then to the hills [m]
constexpr double kDitch = 0.16, kRut = 0.028;    // deep [m]
constexpr double kPondDepth = 0.9, kBank = 0.9;  // [m], of the radius
constexpr double kYard = 1.2, kSiteBlend = 5;    // around a building [m]

double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

double BuildingSite::distance(double px, double py) const {
  const double c = std::cos(heading), s = std::sin(heading), dx = px - x, dy = py - y;
  const double a = std::abs(c * dx + s * dy) - half_x, b = std::abs(c * dy - s * dx) - half_y;
  return std::hypot(std::max(a, 0.0), std::max(b, 0.0));
}

Landscape::Landscape(const TerrainOptions& options)
    : o_(options),
      area_{-options.length / 2, -options.width / 2, options.length / 2, options.width / 2},
      hills_(Dice(options.seed, "hills").seed()),
      ragged_(Dice(options.seed, "ragged").seed()),
      tint_(Dice(options.seed, "tint").seed()),
      rough_(Dice(options.seed, "rough").seed()) {
  Dice dice(options.seed, "landscape");
  wave_ = std::max(34.0, 5 * o_.relief);
  bend_ = std::min(4.0, 0.09 * o_.width) * dice.uniform(0.6, 1) * (dice.chance(0.5) ? 1 : -1);
  bend_phase_ = dice.uniform(-1, 1);
  bend_wave_ = dice.uniform(55, 85);
  limit_slopes();
  grade_road();
  place_pond(&dice);
  place_sites(&dice);
}

double Landscape::hills(double x, double y) const {
  return amplitude_ * hills_.sum(x / wave_ + 0.37, y / wave_ + 0.61, 3) - base_;
}

// As high as asked for, unless that is too steep.
void Landscape::limit_slopes() {
  double low = 1e9, high = -1e9, steepest = 0;
  for (double y = area_.y0; y <= area_.y1; y += 2)
    for (double x = area_.x0; x <= area_.x1; x += 2) {
      const double z = hills(x, y);
      low = std::min(low, z), high = std::max(high, z);
      steepest = std::max(steepest, std::hypot(hills(x + 1, y) - z, hills(x, y + 1) - z));
    }
  amplitude_ =
      std::min(o_.relief / std::max(high - low, 1e-6), kSteepest / std::max(steepest, 1e-6));
  base_ = 0;
  base_ = hills(0, 0);
}

double Landscape::road_y(double x) const {
  const double k = 2 * M_PI / bend_wave_;
  const double slant = k * std::cos(bend_phase_) * x * std::exp(-x * x / 900);
  return bend_ * (std::sin(k * x + bend_phase_) - std::sin(bend_phase_) - slant);
}

double Landscape::road_heading(double x) const {
  return std::atan2(road_y(x + 0.5) - road_y(x - 0.5), 1.0);
}

double Landscape::from_road(double x, double y) const {
  if (!has_road()) return 1e9;
  return std::abs(y - road_y(x)) * std::cos(road_heading(x));
}

// The hills along it, smoothed, level at the origin.
void Landscape::grade_road() {
  const int half = static_cast<int>(std::ceil((o_.length / 2 + kRoadAway) / kRoadStep));
  constexpr int kSmoothingRadius = 6;
  for (int i = -half; i <= half; ++i) {
    double sum = 0, weight = 0;
    for (int k = -kSmoothingRadius; k <= kSmoothingRadius; ++k) {
      const double x = (i + k) * kRoadStep, w = kSmoothingRadius + 1 - std::abs(k);
      sum += w * hills(x, road_y(x)), weight += w;
    }
    const double x = i * kRoadStep;
    road_z_.push_back(sum / weight * smooth_between(kFlatRadius, kFlatRadius + 14, std::abs(x)));
  }
}

double Landscape::road_z(double x) const {
  const double last = static_cast<double>(road_z_.size()) - 1;
  const double t = std::clamp(x / kRoadStep + last / 2, 0.0, last - 1e-6);
  const auto i = static_cast<size_t>(t);
  const double f = t - std::floor(t);
  return mix(road_z_[i], road_z_[i + 1], f * f * (3 - 2 * f));
}

// Places the pond at the lowest ground, clear of the road.
void Landscape::place_pond(Dice* dice) {
  const double side = std::min(o_.length, o_.width);
  const double wanted = std::min(0.16 * side, 12.0) * dice->uniform(0.85, 1.1);
  const double road = has_road() ? o_.road / 2 + 2.5 : 5;
  double best = 1e9;
  if (!o_.water) return;
  for (const double up : {-1.0, 1.0})
    for (double x = area_.x0 + 4; x <= area_.x1 - 4; x += 2) {
      const double edge = up * (o_.width / 2 - 1.5);
      const double room = (std::abs(edge - (has_road() ? road_y(x) : 0)) - road) / (2 + kBank);
      const double radius =
          std::min({wanted, room, (o_.length / 2 - std::abs(x) - 1) / (1 + 0.5 * kBank)});
      if (radius < 2.2) continue;
      const double y = edge - up * radius * (1 + 0.3 * kBank);
      double low = 1e9;
      for (int k = 0; k < 24; ++k) {
        const double a = 2 * M_PI * k / 24, r = 1.5 * radius;
        low = std::min(low, hills(x + r * std::cos(a), y + r * std::sin(a)));
      }
      const double cost = low - 0.8 * radius + 0.02 * std::abs(x);
      if (cost >= best) continue;
      best = cost;
      pond_ = Pond{x, y, radius, low - 0.12};
    }
}

void Landscape::place_sites(Dice* dice) {
  for (int tries = 0; tries < 60 && static_cast<int>(sites_.size()) < o_.buildings; ++tries) {
    BuildingSite s;
    const double reach = std::min(o_.length / 2 - 6, 14.0 + 9 * static_cast<double>(sites_.size()));
    s.x = dice->uniform(-reach, reach);
    s.half_x = dice->uniform(2.2, 2.8), s.half_y = dice->uniform(2.6, 3.6);
    const double side = dice->chance(0.5) ? 1 : -1;
    const double off = (has_road() ? o_.road / 2 + 2.6 : 5) + s.half_x + dice->uniform(0.5, 3);
    s.y = (has_road() ? road_y(s.x) : 0) + side * off;
    s.heading = -side * M_PI / 2 + dice->uniform(-0.25, 0.25);
    if (has_road()) s.heading += road_heading(s.x);
    const double reach_out = std::hypot(s.half_x, s.half_y);
    if (std::abs(s.y) + reach_out > o_.width / 2 - 1.5) continue;
    if (std::abs(s.x) + reach_out > o_.length / 2 - 1.5) continue;
    if (pond_ &&
        std::hypot(s.x - pond_->x, s.y - pond_->y) < pond_->radius * (1 + kBank) + reach_out + 1)
      continue;
    const bool is_near = std::any_of(sites_.begin(), sites_.end(), [&](const BuildingSite& other) {
      return std::hypot(s.x - other.x, s.y - other.y) <
             reach_out + std::hypot(other.half_x, other.half_y) + 4;
    });
    if (is_near || std::hypot(s.x, s.y) < reach_out + kFlatRadius) continue;
    s.z = country(s.x, s.y);
    sites_.push_back(s);
  }
}

double Landscape::country(double x, double y) const {
  double z = hills(x, y);
  for (const BuildingSite& s : sites_)
    z = mix(s.z, z, smooth_between(kYard, kYard + kSiteBlend, s.distance(x, y)));
  z *= smooth_between(kFlatRadius, kFlatRadius + kBlend, std::hypot(x, y));
  if (pond_) {
    const double t = pond_share(x, y), rim = pond_->z + 0.25 * (t - 1);
    z = mix(rim, std::max(z, rim), smooth_between(1, 1 + kBank, t));
    if (t < 1) z = pond_->z - kPondDepth * std::min(1 - t * t, 1.0);
  }
  return z;
}

double Landscape::height(double x, double y) const {
  const double from_origin = std::hypot(x, y);
  const double away =
      std::hypot(std::max(std::abs(x) - area_.x1, 0.0), std::max(std::abs(y) - area_.y1, 0.0));
  double z = country(x, y), rough = 1;
  if (has_road()) {
    const double d = from_road(x, y), half = o_.road / 2;
    const double on = (1 - smooth_between(half + kShoulder, half + kShoulder + kGraded, d)) *
                      (1 - smooth_between(kRoadAway, 2 * kRoadAway, away));
    z = mix(z, road_z(x), on);
    rough = 1 - 0.8 * on;
    // Crown, wheel ruts, ditches.
    const double wander = 0.10 * rough_(x / 7, 3.7);
    const double wheel = std::min(0.75, half * 0.5);
    const double rut = std::abs(d + wander - wheel) / 0.26;
    const double worn = 0.65 + 0.35 * rough_(x / 3, 8.2);
    double cut = kRut * worn * std::exp(-rut * rut);
    const double ditch = (d - half - kShoulder * 0.9) / 0.45;
    cut += kDitch * std::exp(-ditch * ditch) *
           smooth_between(-0.4, 0.3, ragged_(x / 11, y > road_y(x) ? 0.2 : 5.2)) * on;
    z -= cut * smooth_between(1.2, kFlatRadius + 1, from_origin);
  }
  double yard = 1;
  for (const BuildingSite& s : sites_)
    yard = std::min(yard, smooth_between(kYard, kYard + 2, s.distance(x, y)));
  // Tussocks and molehills.
  z += 0.035 * rough * yard * rough_.sum(x / 1.9, y / 1.9, 2) *
       smooth_between(1.2, kFlatRadius + 2, from_origin);
  // Higher country far off closes the view.
  const double range = smooth_between(50, 260, away);
  return z + range * (9 + 14 * (0.5 + 0.5 * hills_.sum(x / 90, y / 90, 3)));
}

Vec3f Landscape::normal(double x, double y) const {
  constexpr double kD = 0.1;
  const double dx = (height(x + kD, y) - height(x - kD, y)) / (2 * kD),
               dy = (height(x, y + kD) - height(x, y - kD)) / (2 * kD);
  return normalize(Vec3f{float(-dx), float(-dy), 1});
}

double Landscape::pond_share(double x, double y) const {
  if (!pond_) return 1e9;
  const double r = std::hypot(x - pond_->x, y - pond_->y);
  const double bay = ragged_.sum(x / (1.1 * pond_->radius), y / (1.1 * pond_->radius), 2);
  return r / (pond_->radius * (1 + 0.28 * bay));
}

bool Landscape::is_free(double x, double y, double margin) const {
  if (area_.grown(-margin).distance_to(x, y) > 0) return false;
  if (from_road(x, y) < o_.road / 2 + margin) return false;
  if (pond_share(x, y) < 1 + margin / std::max(pond_ ? pond_->radius : 1.0, 1.0)) return false;
  return std::none_of(sites_.begin(), sites_.end(),
                      [&](const BuildingSite& s) { return s.distance(x, y) < margin; });
}

}  // namespace gloam
