// A warehouse: dock doors in the west, a zone where goods are staged, a cross aisle, then racks in
// rows along x with aisles between them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "places/furnish/shell.h"
#include "places/generators.h"
#include "places/plan/room_layout.h"

namespace gloam {
namespace {

constexpr double kStaging = 6, kCross = 3.2;    // depth of the zone before the docks, of the aisle
constexpr double kRackDepth = 1.1, kBay = 2.8;  // [m]
constexpr double kBackGap = 0.25;               // between racks back to back
constexpr double kRackToWall = 0.32;            // behind racks at a wall: columns
constexpr double kEnd = 1.6;                    // way around the far end of the racks
constexpr double kPalletPitch = 0.9;
constexpr double kDockWidth = 3.0, kDockHeight = 3.2;
constexpr double kAisleWidth = 1.1;  // stays free in the staging zone
constexpr double kLevel = 1.6;       // between shelves [m]
constexpr double kGirders = 0.6;     // height of the girders below the ceiling [m]
constexpr double kGirder = 6;        // between girders

class WarehouseBuilder {
 public:
  explicit WarehouseBuilder(const WarehouseOptions& options)
      : o_(options),
        dice_(options.seed, "warehouse"),
        place_("warehouse"),
        west_(-kStaging - kCross / 2),
        east_(west_ + options.length),
        south_(-options.width / 2),
        north_(options.width / 2) {}

  Result<Place> build() {
    const double needed = o_.aisle + 2 * kRackDepth + kBackGap;
    const double rows = (o_.width - 2 * kRackToWall + kBackGap) / needed;
    if (rows < 1)
      return Error{
          ErrorKind::kInput,
          fmt::format("a warehouse {} m wide has no room for racks beside an aisle of {} m",
                      o_.width, o_.aisle),
          {},
          fmt::format("make it at least {:.1f} m wide", needed - kBackGap + 2 * kRackToWall)};
    aisles_ = static_cast<int>(rows);
    // Space that the rows leave over makes the aisles wider.
    const double racks = aisles_ * 2 * kRackDepth + (aisles_ - 1) * kBackGap;
    aisle_ = (o_.width - racks - 2 * kRackToWall) / aisles_;
    bays_ = static_cast<int>((east_ - kEnd - kCross / 2) / kBay);
    place_.style.wood = "pine";
    Workshop shop({"warehouse", o_.seed}, place_.style, &place_.materials);
    add_shell(&shop);
    add_structure(&shop);
    add_racks();
    add_lamps();
    add_markings(&shop);
    add_staging();
    add_walls_things();
    add_yard(&shop);
    place_.regions.clear();
    add_regions();
    SkyOptions sky;
    sky.sun_elevation = dice_.uniform(25, 50);
    sky.sun_azimuth = dice_.uniform(0, 360);
    place_.sky = sky;
    place_.ev100 = 6.5;
    return std::move(place_);
  }

 private:
  int make(const std::string& kind, std::optional<Vec3> size = {}, int variants = 6) {
    return make_variant(kind, size, static_cast<uint64_t>(dice_.integer(0, variants - 1)));
  }
  int make_variant(const std::string& kind, std::optional<Vec3> size, uint64_t seed) {
    const Result<int> made = place_.make({kind, seed, size});
    GLOAM_CHECK(made.ok(), made.error().message.c_str());
    return *made;
  }
  void put(int prop, const std::string& zone, double x, double y, double z, double yaw,
           bool loose = false) {
    place_.put(prop, zone, {{x, y, z}, turn({0, 0, 1}, yaw)}, loose);
  }

  double door_y(int i) const { return south_ + o_.width * (i + 0.5) / (o_.dock_doors + 1); }

  void add_shell(Workshop* shop) {
    FloorPlan plan;
    plan.wall = 0.2;
    plan.ceiling = o_.height;
    plan.rooms.push_back({"hall", "warehouse", 0, {west_, south_, east_, north_}});
    plan.outline = plan.rooms[0].clear.grown(plan.wall / 2);
    for (int i = 0; i < o_.dock_doors; ++i) {
      const double room = o_.width / (o_.dock_doors + 1);
      if (room < kDockWidth + 0.6) break;
      Opening dock{OpeningKind::kBare, 0,          -1, Side::kWest,
                   door_y(i),          kDockWidth, 0,  std::min(kDockHeight, o_.height - 0.5)};
      plan.openings.push_back(dock);
      docks_.push_back(dock.center);
    }
    Opening entrance{OpeningKind::kEntrance, 0, -1, Side::kWest, north_ - 1.2, 0.96, 0, 2.1};
    plan.openings.push_back(entrance);
    ShellOptions shell;
    RoomFinish finish;
    finish.floor = shop->concrete({0.58, 0.58, 0.57});
    finish.wall = shop->paint({0.80, 0.81, 0.80}, 0.5);
    finish.ceiling = shop->paint({0.74, 0.75, 0.75}, 0.5);
    finish.skirting = false;
    shell.rooms.push_back(finish);
    shell.facade = shop->paint(
        dice_.pick<Vec3>({{0.46, 0.52, 0.56}, {0.66, 0.66, 0.64}, {0.36, 0.42, 0.40}}), 0.45);
    shell.roof = false;
    shell.seed = o_.seed;
    build_shell(plan, shell, &place_);
    for (const double y : docks_) {
      const int door =
          make("roller_door", Vec3{0.3, kDockWidth, std::min(kDockHeight, o_.height - 0.5)}, 3);
      put(door, "docks", west_ + 0.001, y, 0, 0);
    }
  }

  // Girders across, purlins along, columns at the walls, a base of concrete all around.
  void add_structure(Workshop* shop) {
    const std::string steel = shop->paint({0.36, 0.42, 0.48}, 0.45);
    const auto beam = [&](float height, float width, float length) {  // an I along z
      const float t = 0.014f, w = width / 2, h = height / 2;
      return extrude({{-w, -h},
                      {w, -h},
                      {w, -h + t},
                      {t / 2, -h + t},
                      {t / 2, h - t},
                      {w, h - t},
                      {w, h},
                      {-w, h},
                      {-w, h - t},
                      {-t / 2, h - t},
                      {-t / 2, -h + t},
                      {-w, -h + t}},
                     0, length);
    };
    Prop frame;
    frame.label = "steel_frame";
    const float top = float(o_.height);
    const int count = std::max(2, static_cast<int>(std::lround(o_.length / kGirder)));
    for (int i = 0; i <= count; ++i) {
      const float x = float(std::clamp(west_ + o_.length * i / count, west_ + 0.15, east_ - 0.15));
      frame.body().show("girders", steel,
                        beam(0.45f, 0.2f, float(o_.width))
                            .turned(Axis::kX, -90)
                            .moved(x, float(south_), top - 0.225f));
      for (const double wall : {south_ + 0.11, north_ - 0.11}) {
        frame.body().show("columns", steel, beam(0.2f, 0.2f, top - 0.45f).moved(x, float(wall), 0));
        frame.body().collide_box({x - 0.1f, float(wall) - 0.1f, 0},
                                 {x + 0.1f, float(wall) + 0.1f, top});
      }
    }
    const int purlins = static_cast<int>(o_.width / 2.2);
    for (int i = 0; i <= purlins; ++i) {
      const float y = float(south_ + 0.2 + (o_.width - 0.4) * i / purlins);
      frame.body().show("purlins", steel,
                        beam(0.18f, 0.08f, float(o_.length))
                            .turned(Axis::kY, 90)
                            .moved(float(west_), y, top - 0.09f));
    }
    const std::string concrete = shop->concrete();
    const float base = 0.9f, thick = 0.06f;
    const auto plinth = [&](double x0, double y0, double x1, double y1) {
      frame.body().show("plinth", concrete,
                        slab({float(x0), float(y0), 0}, {float(x1), float(y1), base}, 0.006f));
    };
    plinth(west_, south_, east_, south_ + thick);
    plinth(west_, north_ - thick, east_, north_);
    plinth(east_ - thick, south_ + thick, east_, north_ - thick);
    place_.put(place_.add(std::move(frame)), "", {});
  }

  // Rows of racks: y of their middle, and whether their front looks north.
  std::vector<std::pair<double, bool>> rack_rows() const {
    std::vector<std::pair<double, bool>> rows;
    double y = south_ + kRackToWall;
    for (int i = 0; i < aisles_; ++i) {
      rows.emplace_back(y + kRackDepth / 2, true);
      y += kRackDepth + aisle_;
      rows.emplace_back(y + kRackDepth / 2, false);
      y += kRackDepth + kBackGap;
    }
    return rows;
  }

  void add_racks() {
    const int fit = static_cast<int>((o_.height - kGirders - 0.25) / kLevel);
    const double levels = std::clamp(fit, 1, o_.levels);
    const int rack = make("pallet_rack", Vec3{kRackDepth, kBay, levels * kLevel + 0.25});
    const int guard = make("rack_guard");
    const std::vector<PropSurface> shelves = place_.prop(rack).surfaces;
    int row_number = 0;
    for (const auto& [y, north] : rack_rows()) {
      const std::string zone = fmt::format("row_{}", ++row_number);
      const double yaw = north ? M_PI / 2 : -M_PI / 2;
      for (int bay = 0; bay < bays_; ++bay) {
        const double x = kCross / 2 + 0.3 + (bay + 0.5) * kBay;
        put(rack, zone, x, y, 0, yaw);
        for (const PropSurface& shelf : shelves) fill(zone, x, y, yaw, shelf);
      }
      put(guard, zone, kCross / 2 + 0.12, y, 0, M_PI);
    }
  }

  // Load of one shelf of a bay: three pallets, or on the floor at times two tanks.
  void fill(const std::string& zone, double x, double y, double yaw, const PropSurface& shelf) {
    const double room = std::min({1.5, shelf.clearance - 0.12, o_.height - kGirders - shelf.z});
    if (room < 0.5) return;
    const double c = std::cos(yaw), s = std::sin(yaw);
    const auto load = [&](int prop, double across) {
      // Across the bay is the rack's y; the fork pockets look into the aisle.
      const double a = across + dice_.uniform(-0.02, 0.02), deep = dice_.uniform(-0.03, 0.03);
      const bool loose = dice_.chance(o_.loose);
      put(prop, zone, x + c * deep - s * a, y + s * deep + c * a, shelf.z,
          yaw + dice_.uniform(-0.012, 0.012), loose);
    };
    if (shelf.z < 0.01f && room > 1.25 && dice_.chance(0.15)) {
      for (const double across : {-0.65, 0.65})
        if (dice_.chance(o_.fill)) load(make("ibc_tank", {}, 1), across);
      return;
    }
    for (const int slot : {-1, 0, 1}) {
      if (!dice_.chance(o_.fill)) continue;
      const double kind = dice_.uniform(), height = dice_.pick({0.75, 1.0, 1.0, 1.25, 1.5});
      const int goods = kind < 0.06 ? make("pallet", {}, 2)
                        : kind < 0.14 && room > 1.0
                            ? make("crate", Vec3{1.0, 0.8, 0.8}, 3)
                            : make("goods_pallet", Vec3{1.2, 0.8, std::min(height, room)}, 8);
      load(goods, slot * kPalletPitch);
    }
  }

  double aisle_y(int i) const {
    return south_ + kRackToWall + kRackDepth + aisle_ / 2 +
           i * (aisle_ + 2 * kRackDepth + kBackGap);
  }
  double racks_end() const { return kCross / 2 + 0.3 + bays_ * kBay; }

  void add_lamps() {
    const int lamp = make("high_bay_lamp", {}, 1);
    const double z = o_.height - 0.46;
    const auto line = [&](double x0, double x1, double y) {
      const int count = std::max(1, static_cast<int>(std::lround((x1 - x0) / 5.5)));
      for (int i = 0; i < count; ++i)
        put(lamp, "ceiling", x0 + (x1 - x0) * (i + 0.5) / count, y, z, 0);
    };
    for (int i = 0; i < aisles_; ++i) line(kCross / 2, east_, aisle_y(i));
    const int rows = std::max(2, static_cast<int>(o_.width / 5.5));
    for (int i = 0; i < rows; ++i) line(west_, kCross / 2, south_ + o_.width * (i + 0.5) / rows);
  }

  // Lanes and staging places: paint of a tenth of a millimetre drawn as half a millimetre.
  void add_markings(Workshop* shop) {
    Prop lines;
    lines.label = "floor_marking";
    const std::string yellow = shop->paint({0.86, 0.66, 0.08}, 0.6),
                      white = shop->paint({0.80, 0.80, 0.78}, 0.6);
    const auto line = [&](const std::string& name, const std::string& paint, double x0, double y0,
                          double x1, double y1, double width = 0.08) {
      const double w = width / 2;
      lines.body().show(
          name, paint,
          slab({float(std::min(x0, x1) - w), float(std::min(y0, y1) - w), -0.001f},
               {float(std::max(x0, x1) + w), float(std::max(y0, y1) + w), 0.0006f}, 0));
    };
    for (int i = 0; i < aisles_; ++i)
      for (const double side : {-1.0, 1.0})
        line("lanes", yellow, kCross / 2 + 0.3, aisle_y(i) + side * (aisle_ / 2 - 0.15),
             racks_end(), aisle_y(i) + side * (aisle_ / 2 - 0.15));
    for (const double side : {-1.0, 1.0})
      line("lanes", yellow, side * (kCross / 2 - 0.2), south_ + 0.6, side * (kCross / 2 - 0.2),
           north_ - 0.6);
    for (const double y : docks_) {
      for (const double side : {-1.0, 1.0})
        line("docks", white, west_ + 0.4, y + side * 1.6, west_ + kStaging - 0.6, y + side * 1.6);
    }
    place_.put(place_.add(std::move(lines)), "", {});
  }

  // Before the docks things stand about, but a way stays free to each dock and past them.
  void add_staging() {
    plan_.ceiling = o_.height;
    plan_.rooms.push_back(
        {"staging", "staging", 0, {west_, south_ + 0.3, -kCross / 2, north_ - 0.3}});
    plan_.openings.push_back({OpeningKind::kBare, 0, -1, Side::kEast, 0, 2, 0, 2});
    for (const double y : docks_)
      plan_.openings.push_back({OpeningKind::kBare, 0, -1, Side::kWest, y, kDockWidth, 0, 3});
    plan_.openings.push_back(
        {OpeningKind::kEntrance, 0, -1, Side::kWest, north_ - 1.2, 0.96, 0, 2.1});
    RoomLayout layout(plan_, 0, kAisleWidth, o_.seed, &place_);
    const auto anywhere = [&](const Spot& s) {
      return dice_.uniform() + 0.1 * std::min(layout.to_opening(s), 3.0);
    };
    const auto stand = [&](const char* kind, bool at_wall, int variants = 4) {
      const int prop = make(kind, {}, variants);
      const std::optional<Spot> spot = at_wall ? layout.find_at_wall(place_.prop(prop), anywhere)
                                               : layout.find_free(place_.prop(prop), anywhere);
      if (!spot) return;
      layout.put(prop, *spot, place_.prop(prop).loose && dice_.chance(o_.loose * 3));
    };
    const double size = o_.width / 20;
    stand("forklift", false, 2);
    const auto several = [&](double mean, std::initializer_list<const char*> kinds, bool at_wall) {
      const int count = static_cast<int>(mean * size * o_.clutter * 2 + dice_.uniform());
      for (int i = 0; i < count; ++i) stand(dice_.pick(kinds), at_wall);
    };
    several(2, {"workbench", "shelf_rack", "locker"}, true);
    several(5, {"goods_pallet", "goods_pallet", "ibc_tank", "crate"}, false);
    several(2, {"pallet_jack", "hand_truck", "platform_cart"}, false);
    several(4, {"carton", "drum", "pallet", "plastic_bin", "cable_reel"}, false);
    several(3, {"traffic_cone", "safety_barrier", "traffic_cone"}, false);
  }

  void add_walls_things() {
    const int extinguisher = make("fire_extinguisher", {}, 1), bollard = make("bollard", {}, 1);
    for (const double y : docks_)
      for (const double side : {-1.0, 1.0})
        put(bollard, "docks", west_ + 0.45, y + side * (kDockWidth / 2 + 0.25), 0, 0);
    put(extinguisher, "walls", west_ + 0.001, south_ + 1.0, 1.1, 0);
    const int sign = make("exit_sign", {}, 1);
    put(sign, "walls", west_ + 0.001, north_ - 1.2, 2.4, 0);
  }

  void add_yard(Workshop* shop) {
    const float z = -float(kGroundDrop), far = float(std::max(o_.length, o_.width)) + 40;
    Prop yard;
    yard.label = "yard";
    yard.body().show("asphalt", shop->concrete({0.33, 0.33, 0.34}),
                     slab({-far, -far, z - 0.2f}, {far, far, z}, 0));
    yard.body().collide_box({-far, -far, z - 0.5f}, {far, far, z});
    place_.put(place_.add(std::move(yard)), "", {});
  }

  void add_regions() {
    const auto region = [&](const std::string& name, const char* label, double x0, double y0,
                            double x1, double y1) {
      place_.regions.push_back({name, label, {x0, y0, 0}, {x1, y1, o_.height}});
    };
    region("staging", "staging", west_, south_, -kCross / 2, north_);
    region("cross_aisle", "aisle", -kCross / 2, south_, kCross / 2, north_);
    for (int i = 0; i < aisles_; ++i)
      region(fmt::format("aisle_{}", i + 1), "aisle", kCross / 2, aisle_y(i) - aisle_ / 2,
             racks_end(), aisle_y(i) + aisle_ / 2);
    region("far_end", "aisle", racks_end(), south_, east_, north_);
  }

  const WarehouseOptions& o_;
  Dice dice_;
  Place place_;
  FloorPlan plan_;  // plan of the staging zone alone
  const double west_, east_, south_, north_;
  int aisles_ = 0, bays_ = 0;
  double aisle_ = 0;  // width [m]
  std::vector<double> docks_;
};

}  // namespace

Result<Place> make_warehouse(const WarehouseOptions& options) {
  return WarehouseBuilder(options).build();
}

}  // namespace gloam
