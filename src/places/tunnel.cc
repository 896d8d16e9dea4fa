// A road tunnel: an arch along a curved path, road and walkways, lamps, pipes, emergency stations,
// and a portal at either end.

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "places/furnish/interior.h"
#include "places/generators.h"
#include "places/plan/curved_path.h"

namespace gloam {
namespace {

constexpr double kWalk = 0.9, kKerb = 0.15;  // width and height of the walkways [m]
constexpr double kFacet = 4;                 // of colliders along the path [m]
constexpr int kArch = 32, kArchFacets = 12;  // facets of the arch: of meshes, of colliders
constexpr double kOpen = 25;                 // road outside each portal [m]
constexpr double kStation = 40;              // between emergency stations [m]
constexpr double kLining = 0.4;              // thickness of what collides

using Station = CurvedPath::Station;

class TunnelBuilder {
 public:
  explicit TunnelBuilder(const TunnelOptions& options)
      : o_(options),
        dice_(options.seed, "tunnel"),
        place_("tunnel"),
        path_({o_.length, o_.curve, kOpen}, &dice_) {
    half_ = o_.width / 2 + kWalk;
    wall_ = 0.4 * o_.height;
  }

  Place build() {
    Workshop shop({"tunnel", o_.seed}, place_.style, &place_.materials);
    add_lining(&shop);
    add_road(&shop);
    add_pipes(&shop);
    add_portals(&shop);
    add_lamps();
    add_stations();
    add_clutter();
    place_.regions = path_.regions("road", o_.width, o_.height);
    place_.sky = draw_sky(&dice_, true);
    place_.ev100 = 5;
    return std::move(place_);
  }

 private:
  // Half of an ellipse on two walls, from the left foot over the crown to the right: i of n.
  Vec2f arch(double i, double n) const {
    const double angle = M_PI * i / n;
    return {float(half_ * std::cos(angle)), float(wall_ + (o_.height - wall_) * std::sin(angle))};
  }

  void put(const std::string& label, Prop prop) {
    prop.label = label;
    place_.put(place_.add(std::move(prop)), "", {});
  }

  void add_lining(Workshop* shop) {
    Prop p;
    PropPart& b = p.body();
    const std::string panels = shop->tiles({0.72, 0.73, 0.71}, 0.9f, {0.40, 0.40, 0.39});
    const std::string concrete = shop->plaster({0.47, 0.46, 0.44});
    const float half = float(half_), wall = float(wall_), panel = std::min(wall, 2.4f);
    b.show("panels", panels, path_.strip(0, o_.length, {half, panel}, {half, 0}));
    b.show("panels", panels, path_.strip(0, o_.length, {-half, 0}, {-half, panel}));
    if (panel < wall) {
      b.show("lining", concrete, path_.strip(0, o_.length, {half, wall}, {half, panel}));
      b.show("lining", concrete, path_.strip(0, o_.length, {-half, panel}, {-half, wall}));
    }
    std::vector<Vec3f> points;
    for (const Station& k : path_.within(0, o_.length))
      for (int i = kArch; i >= 0; --i) {
        const Vec2f q = arch(i, kArch);
        points.push_back(path_.point(k, q.x, q.y));
      }
    b.show("lining", concrete, sheet(points, kArch + 1));
    // Joints between the cast rings.
    const std::string joint = shop->plastic({0.16, 0.16, 0.155}, 0.9);
    for (double s = 8; s < o_.length - 4; s += 8) {
      std::vector<Vec3f> ring;
      for (const double ds : {-0.02, 0.02}) {
        ring.push_back(path_.point(path_.at(s + ds), -half * 0.999, kKerb));
        for (int i = kArch; i >= 0; --i) {
          const Vec2f q = arch(i, kArch) * 0.999f;
          ring.push_back(path_.point(path_.at(s + ds), q.x, q.y));
        }
        ring.push_back(path_.point(path_.at(s + ds), half * 0.999, kKerb));
      }
      b.show("joints", joint, sheet(ring, kArch + 3));
    }
    const int facets = std::max(1, static_cast<int>(std::lround(o_.length / kFacet)));
    for (int k = 0; k < facets; ++k) {
      const Station from = path_.at(o_.length * k / facets),
                    to = path_.at(o_.length * (k + 1) / facets);
      collide_strip(&b, from, to, {{half, wall}, {half, -0.2f}}, -kLining);
      collide_strip(&b, from, to, {{-half, -0.2f}, {-half, wall}}, -kLining);
      for (int i = 0; i < kArchFacets; ++i)
        collide_strip(&b, from, to, {arch(i, kArchFacets), arch(i + 1, kArchFacets)}, kLining);
    }
    put("wall", std::move(p));
  }

  void add_road(Workshop* shop) {
    const double from = path_.first(), to = path_.last();
    const float edge = float(o_.width / 2), half = float(half_), kerb = float(kKerb);
    Prop road;
    PropPart& b = road.body();
    b.show("asphalt", shop->asphalt(), path_.strip(from, to, {edge, 0}, {-edge, 0}));
    path_.collide_ground(&b, 30);
    put("road", std::move(road));

    Prop lines;
    const std::string white = shop->paint({0.78, 0.78, 0.75}, 0.6);
    for (const float side : {-1.0f, 1.0f})
      lines.body().show("lines", white,
                        path_.strip(from, to, {side * (edge - 0.2f) + 0.06f, 0.003f},
                                    {side * (edge - 0.2f) - 0.06f, 0.003f}));
    if (o_.width >= 5.5)
      for (double s = from + 2; s < to - 3; s += 9)
        lines.body().show("lines", white, path_.strip(s, s + 3, {0.06f, 0.003f}, {-0.06f, 0.003f}));
    put("lane_marking", std::move(lines));

    Prop walks;
    PropPart& w = walks.body();
    const std::string stone = shop->concrete({0.55, 0.54, 0.52});
    w.show("walkway", stone, path_.strip(0, o_.length, {half, kerb}, {edge, kerb}));
    w.show("walkway", stone, path_.strip(0, o_.length, {-edge, kerb}, {-half, kerb}));
    w.show("kerb", stone, path_.strip(0, o_.length, {edge, kerb}, {edge, 0}));
    w.show("kerb", stone, path_.strip(0, o_.length, {-edge, 0}, {-edge, kerb}));
    const int facets = std::max(1, static_cast<int>(std::lround(o_.length / kFacet)));
    for (int k = 0; k < facets; ++k) {
      const Station a = path_.at(o_.length * k / facets),
                    z = path_.at(o_.length * (k + 1) / facets);
      collide_strip(&w, a, z, {{half, kerb}, {edge, kerb}}, -kKerb + 0.001);
      collide_strip(&w, a, z, {{-edge, kerb}, {-half, kerb}}, -kKerb + 0.001);
    }
    put("walkway", std::move(walks));
  }

  void add_pipes(Workshop* shop) {
    Prop p;
    PropPart& b = p.body();
    const auto along = [&](double left, double z, double radius) {
      return path_.cable(0.5, o_.length - 0.5, {left, z}, radius);
    };
    const double z = std::min(wall_ - 0.2, 2.75);
    b.show("main", shop->paint({0.50, 0.07, 0.06}, 0.4), along(half_ - 0.12, z, 0.06));
    // A tray of cables on brackets on the other side.
    const std::string steel = shop->metal("galvanised");
    const float left = -float(half_) + 0.04f, tray = float(z);
    b.show("tray", steel, path_.strip(0.5, o_.length - 0.5, {left + 0.26f, tray}, {left, tray}));
    b.show("tray", steel,
           path_.strip(0.5, o_.length - 0.5, {left, tray - 0.001f}, {left + 0.26f, tray - 0.001f}));
    b.show("tray", steel,
           path_.strip(0.5, o_.length - 0.5, {left + 0.26f, tray + 0.06f}, {left + 0.26f, tray}));
    b.show("tray", steel,
           path_.strip(0.5, o_.length - 0.5, {left + 0.261f, tray}, {left + 0.261f, tray + 0.06f}));
    for (int i = 0; i < 4; ++i)
      b.show("cables", shop->rubber({0.05, 0.05, 0.055}),
             along(left + 0.05 + 0.05 * i, z + 0.022, 0.012 + 0.004 * (i % 2)));
    for (double s = 1.5; s < o_.length - 1; s += 3) {
      const Station k = path_.at(s);
      for (const double side : {-1.0, 1.0}) {
        const Vec3f a = path_.point(k, side * (half_ - 0.01), z - 0.07),
                    e = path_.point(k, side * (half_ - 0.3), z - 0.07);
        b.show("brackets", steel, bar(a, e, 0.012f, 0.012f, 6));
      }
    }
    put("pipe", std::move(p));
  }

  // A wall around the arch, banks beside the road in front of it, a hill above.
  void add_portals(Workshop* shop) {
    const std::string stone = shop->concrete({0.60, 0.59, 0.56}),
                      lawn = shop->carpet({0.34, 0.38, 0.22});
    const float half = float(half_), wide = half + 4.5f, top = float(o_.height) + 1.6f;
    for (const bool west : {true, false}) {
      const double end = west ? 0 : o_.length, out = west ? -kOpen : kOpen;
      const Station k = path_.at(end);
      Prop p;
      PropPart& b = p.body();
      // From the arch's line outwards to a rectangle.
      std::vector<Vec2f> inner = {{half, 0}};
      for (int i = 0; i <= kArch; ++i) inner.push_back(arch(i, kArch));
      inner.push_back({-half, 0});
      std::vector<Vec3f> face;
      for (const Vec2f q : inner) {
        const float grow =
            q.y <= 0 ? wide / half : std::min(wide / std::max(std::abs(q.x), 1e-3f), top / q.y);
        const Vec2f outer{std::clamp(q.x * grow, -wide, wide), std::min(q.y * grow, top)};
        face.push_back(path_.point(k, outer.x, q.y <= 0 ? 0 : outer.y));
      }
      std::vector<Vec3f> wall;
      for (size_t i = 0; i < inner.size(); ++i) {
        wall.push_back(west ? path_.point(k, inner[i].x, inner[i].y) : face[i]);
        wall.push_back(west ? face[i] : path_.point(k, inner[i].x, inner[i].y));
      }
      b.show("portal", stone, sheet(wall, 2, 0.002f));
      for (const float side : {-1.0f, 1.0f}) {
        // Its colliders: beside the road, and over it.
        const Vec3f c =
            path_.point(path_.at(end + (west ? 0.25 : -0.25)), side * (half + 2.25), top / 2);
        b.collide_box(c, {0.25f, 2.25f, top / 2}, turn({0, 0, 1}, k.heading));
      }
      b.collide_box(path_.point(path_.at(end + (west ? 0.25 : -0.25)), 0, (top + o_.height) / 2),
                    {0.25f, half, float(top - o_.height) / 2}, turn({0, 0, 1}, k.heading));
      put("portal", std::move(p));

      Prop bank;
      for (const float side : {-1.0f, 1.0f}) {
        // Verges that rise to banks of the cutting.
        std::vector<Vec3f> points;
        const double a = std::min(end, end + out), z = std::max(end, end + out);
        for (const Station& q : path_.within(a, z)) {
          const double share = std::abs(q.s - end) / kOpen;
          const double rise = top * (1 - 0.55 * share);
          const std::pair<double, double> line[] = {{o_.width / 2, -0.01},
                                                    {half_ + 0.2, 0.02},
                                                    {half_ + 4.4, rise},
                                                    {half_ + 30, rise + 3}};
          for (int i = 0; i < 4; ++i) {
            const auto& [left, height] = line[side > 0 ? 3 - i : i];
            points.push_back(path_.point(q, side * left, height));
          }
        }
        bank.body().show("grass", lawn, sheet(points, 4));
        for (double s = a; s < z - 0.1; s += 5) {
          const Station q = path_.at(s + 2.5);
          bank.body().collide_box(path_.point(q, side * (half_ + 5.5), top / 4),
                                  {2.6f, 3.0f, top / 4}, turn({0, 0, 1}, q.heading));
        }
      }
      put("bank", std::move(bank));
    }
    Prop hill;
    std::vector<Vec3f> points;
    for (const Station& q : path_.within(0, o_.length)) {
      const double share = std::min(q.s, o_.length - q.s) / std::max(o_.length / 2, 1.0);
      for (const double left : {30.0, half_ + 4.5, 0.0, -half_ - 4.5, -30.0})
        points.push_back(path_.point(q, left, top + (std::abs(left) > 20 ? 3 : 0) + 9 * share));
    }
    hill.body().show("grass", lawn, sheet(points, 5));
    put("hill", std::move(hill));
  }

  int make(const std::string& kind, std::optional<Vec3> size = {}, int variants = 6) {
    const Result<int> made =
        place_.make({kind, static_cast<uint64_t>(dice_.integer(0, variants - 1)), size});
    GLOAM_CHECK(made.ok(), made.error().message.c_str());
    return *made;
  }

  void add_lamps() {
    const int lit = make("strip_lamp", Vec3{0.09, 1.6, 0.09}, 1);
    Prop out = place_.prop(lit);
    out.lights.clear();
    Workshop shop({"tunnel", o_.seed}, place_.style, &place_.materials);
    for (PropVisual& visual : out.body().visuals)
      if (visual.name == "cover") visual.material = shop.plastic({0.36, 0.36, 0.35}, 0.5);
    out.label = "lamp";
    const int dark = place_.add(std::move(out));
    for (double s = o_.lamps / 2; s < o_.length; s += o_.lamps)
      for (const double side : {-1.0, 1.0}) {
        const double left = side * o_.width * 0.27;
        const double share = left / half_;
        const double z = wall_ + (o_.height - wall_) * std::sqrt(1 - share * share) - 0.12;
        place_.put(dice_.chance(o_.failed) ? dark : lit, "", path_.pose(s, left, z, M_PI / 2));
      }
  }

  // Telephone, extinguisher and way out on the right wall.
  void add_stations() {
    for (double s = std::min(10.0, o_.length / 2); s < o_.length - 4; s += kStation) {
      const double left = -half_ + 0.001;
      place_.put(make("wall_extinguisher"), "", path_.pose(s, left, kKerb + 1.0, M_PI / 2));
      place_.put(make("wall_phone"), "", path_.pose(s + 0.6, left, kKerb + 1.4, M_PI / 2));
      place_.put(make("exit_sign"), "", path_.pose(s + 0.3, left, kKerb + 2.0, M_PI / 2));
      if (s + 14 < o_.length - 2)
        place_.put(make("hose_reel"), "", path_.pose(s + 14, left, kKerb + 1.1, M_PI / 2));
    }
  }

  // Along one edge of the road, so that the rest of it stays free.
  void add_clutter() {
    const double side = dice_.chance(0.5) ? 1 : -1;
    const double lane = side * (o_.width / 2 - std::min(0.9, o_.width * 0.16));
    const int count = static_cast<int>(o_.clutter * o_.length / 5);
    double s = 3;
    for (int i = 0; i < count; ++i) {
      s += dice_.uniform(0.6, 1.4) * o_.length / (count + 1);
      if (s > o_.length - 3) break;
      if (std::abs(s - o_.length / 4) < 3) continue;
      const std::string kind =
          dice_.pick<const char*>({"traffic_cone", "traffic_cone", "traffic_cone", "safety_barrier",
                                   "cable_reel", "pallet", "drum", "carton"});
      if (kind == "traffic_cone") {
        for (int k = 0; k < 3; ++k) {
          const int cone = make(kind);
          const bool loose = dice_.chance(o_.loose);
          place_.put(cone, "", path_.pose(s + 1.3 * k, lane, 0, dice_.uniform(-3, 3)), loose);
        }
        s += 3;
      } else {
        const int thing = make(kind);
        const bool loose = place_.prop(thing).loose && dice_.chance(o_.loose);
        const double turned = kind == "safety_barrier" ? 0 : dice_.uniform(-0.3, 0.3);
        place_.put(thing, "", path_.pose(s, lane, 0, turned), loose);
      }
    }
  }

  const TunnelOptions& o_;
  Dice dice_;
  Place place_;
  double half_, wall_;  // half of the clear width, height of the upright walls [m]
  CurvedPath path_;
};

}  // namespace

Result<Place> make_tunnel(const TunnelOptions& options) { return TunnelBuilder(options).build(); }

}  // namespace gloam
