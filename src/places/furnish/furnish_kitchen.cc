// Kitchens: rows of units along one wall or two, cupboards and tiles above, a table where there is
// room.

#include <algorithm>
#include <cmath>

#include "places/furnish/furnish.h"
#include "places/furnish/shell.h"

namespace gloam {
namespace {

constexpr double kDepth = 0.62;     // depth of a row of units, with the gap behind
constexpr double kCorner = 1.10;    // length of a corner's cabinet along its wall
constexpr double kTop = 0.9;        // height of the worktop
constexpr double kTilesTop = 1.45;  // height where cupboards begin

// The wall that a corner's cabinet stands at has the corner on the cabinet's right, its -y.
bool has_corner_right(Side side, Side other) {
  switch (side) {
    case Side::kWest:
      return other == Side::kSouth;
    case Side::kSouth:
      return other == Side::kEast;
    case Side::kEast:
      return other == Side::kNorth;
    default:
      return other == Side::kWest;
  }
}

// Lower or upper end of `side` lies at the wall `other`.
bool at_low_end(Side other) { return other == Side::kWest || other == Side::kSouth; }

std::vector<KitchenWall> stretches(const RoomLayout& layout) {
  const Rect& r = layout.room().clear;
  std::vector<KitchenWall> out;
  for (const Side side : {Side::kSouth, Side::kNorth, Side::kWest, Side::kEast}) {
    const bool along_x = runs_along_x(side);
    std::vector<std::pair<double, double>> doors;
    bool window = false;
    for (const Opening& o : layout.openings(side)) {
      // A window is welcome, but not a low one.
      if (o.kind == OpeningKind::kWindow && o.sill > 0.94)
        window = true;
      else
        doors.emplace_back(o.low() - 0.15, o.high() + 0.15);
    }
    const double from = (along_x ? r.x0 : r.y0) + 0.02, to = (along_x ? r.x1 : r.y1) - 0.02;
    std::sort(doors.begin(), doors.end());
    doors.emplace_back(to, to);
    double at = from;
    for (const auto& [a, b] : doors) {
      if (a > at) out.push_back({side, at, a, window});
      at = std::max(at, b);
    }
  }
  return out;
}

// Does a row of units fit there? Rows may share the floor before them.
bool has_room(const RoomLayout& layout, const KitchenWall& s, bool share) {
  const float half = float(s.length() / 2 - 0.05);
  Prop row;
  row.body().collide_box({0, -half, 0}, {float(kDepth - 0.06), half, 0.9f});
  row.front = 0.75f;
  return layout.fits(row, against(layout.room().clear, s.side, (s.from + s.to) / 2, 0.02), share);
}

double width_of(const std::vector<KitchenPiece>& row) {
  double sum = 0;
  for (const KitchenPiece& piece : row) sum += piece.width;
  return sum;
}

// Cooker and sink, and as much more as the length has room for; the refrigerator at one end.
std::vector<KitchenPiece> main_row(double length, bool cold_first) {
  std::vector<KitchenPiece> row = {{"cooker", 0.6}, {"sink_cabinet", 0.8}};
  double used = 1.4;
  const bool cold = length >= 2.0;
  if (cold) used += 0.6;
  if (length - used >= 0.6) row.push_back({"dishwasher", 0.6}), used += 0.6;
  // The rest of the wall becomes cupboards of one width.
  const double rest = length - used;
  const int cupboards = static_cast<int>(std::ceil(rest / 0.85));
  for (int i = 0; i < cupboards && rest / cupboards >= 0.35; ++i)
    row.insert(row.begin() + (i % 2 == 0 ? 0 : 2), {"kitchen_cabinet", rest / cupboards});
  if (cold) row.insert(cold_first ? row.begin() : row.end(), {"refrigerator", 0.6, true});
  return row;
}

std::vector<KitchenPiece> cupboards(double length) {
  const auto count = static_cast<size_t>(std::floor(length / 0.55));
  const double width = std::min(length / double(count), 0.8);
  return std::vector<KitchenPiece>(length < 0.55 ? 0 : count, {"kitchen_cabinet", width});
}

// Two stretches that meet in a corner of the room.
bool meet(const Rect& r, const KitchenWall& a, const KitchenWall& b) {
  const auto touches = [&](const KitchenWall& s, Side other) {
    const double low = runs_along_x(s.side) ? r.x0 : r.y0,
                 high = runs_along_x(s.side) ? r.x1 : r.y1;
    return at_low_end(other) ? s.from < low + 0.03 : s.to > high - 0.03;
  };
  return runs_along_x(a.side) != runs_along_x(b.side) && touches(a, b.side) && touches(b, a.side);
}

}  // namespace

void Furnisher::kitchen() {
  const Rect& r = layout_.room().clear;
  const std::vector<KitchenWall> walls = stretches(layout_);
  const KitchenWall* best = nullptr;
  double best_score = 0;
  for (const KitchenWall& s : walls) {
    const double score = s.length() + (s.window ? 0.8 : 0) + dice_.uniform(0, 0.4);
    if (s.length() > 1.9 && score > best_score && has_room(layout_, s, false))
      best = &s, best_score = score;
  }
  if (best) kitchen_rows(walls, *best);
  if (r.area() > 9) {
    if (const auto table = dining_set({0.75, dice_.uniform(0.8, 1.3), 0.745}))
      tidy(*table, {"fruit_bowl", "mug", "plate", "bowl"}, 3);
  }
  in_corner(make("waste_bin"));
  if (dice_.chance(0.5)) in_corner(make("potted_plant"));
  layout_.hang(make("wall_clock"), 1.9, [&](const Spot& s) { return -layout_.to_middle(s); });
  pictures(1);
  light("ceiling_lamp", 4.2);
  if (dice_.chance(0.4)) floor_clutter({"cardboard_box", "basket", "wine_bottle"});
}

void Furnisher::kitchen_rows(const std::vector<KitchenWall>& walls, const KitchenWall& first) {
  const Rect& r = layout_.room().clear;
  const double across = runs_along_x(first.side) ? r.depth() : r.width();
  // A second row: around a corner or along the wall opposite.
  const KitchenWall* second = nullptr;
  bool is_corner = false;
  if (r.area() > 10 && dice_.chance(0.75)) {
    for (const KitchenWall& s : walls) {
      const bool corner = meet(r, first, s);
      const bool facing = s.side == opposite(first.side) && across > 2 * kDepth + 1.2;
      if (!(corner ? s.length() > 1.7 && first.length() > 3.1 : facing && s.length() > 1.2) ||
          (second && s.length() < second->length()) || !has_room(layout_, s, false))
        continue;
      second = &s, is_corner = corner;
    }
  }
  KitchenWall a = first;
  std::optional<KitchenWall> b;
  if (second) b = *second;
  double at = (a.from + a.to) / 2;  // place of the window
  for (const Opening& o : layout_.openings(a.side))
    if (o.kind == OpeningKind::kWindow) at = o.center;
  bool high = std::abs(at - a.from) > std::abs(at - a.to);  // the row ends at the upper end
  if (is_corner) {
    high = !at_low_end(b->side);
    // One of the two walls has the corner's cabinet, the other begins at its front.
    KitchenWall& shorter = has_corner_right(a.side, b->side) ? *b : a;
    const Side other = &shorter == &a ? b->side : a.side;
    (at_low_end(other) ? shorter.from : shorter.to) +=
        (at_low_end(other) ? 1 : -1) * (kDepth - 0.015);
  }
  const KitchenPiece corner{"corner_cabinet", kCorner};
  const bool has_a = is_corner && has_corner_right(a.side, b->side);
  const double length = std::min(a.length(), 4.4) - (has_a ? kCorner : 0);
  std::vector<KitchenPiece> row = main_row(length, high);
  if (has_a) row.insert(high ? row.end() : row.begin(), corner);
  kitchen_row(a.side, high ? a.to - width_of(row) : a.from, row);
  if (!b || !has_room(layout_, *b, true)) return;
  const bool has_b = is_corner && !has_a, b_high = is_corner && !at_low_end(a.side);
  std::vector<KitchenPiece> more = cupboards(std::min(b->length(), 3.0) - (has_b ? kCorner : 0));
  if (has_b) more.insert(b_high ? more.end() : more.begin(), corner);
  kitchen_row(b->side, b_high ? b->to - width_of(more) : b->from, more);
}

void Furnisher::kitchen_row(Side side, double from, const std::vector<KitchenPiece>& row) {
  const Rect& r = layout_.room().clear;
  std::vector<Opening> windows;
  for (const Opening& o : layout_.openings(side))
    if (o.kind == OpeningKind::kWindow) windows.push_back(o);
  double at = from, low = 1e9, high = -1e9;  // ends of the worktop
  uint64_t number = 2;
  for (const KitchenPiece& piece : row) {
    const std::string kind = piece.kind;
    const bool is_cupboard = kind == "kitchen_cabinet";
    const int made =
        make(kind, Vec3{0.6, piece.width, piece.is_tall ? 1.85 : kTop}, is_cupboard ? number++ : 2);
    const double middle = at + piece.width / 2;
    const int placement =
        layout_.put(made, against(r, side, middle, 0.02 - prop(made).bounds().low.x));
    at += piece.width;
    if (piece.is_tall) continue;
    low = std::min(low, at - piece.width), high = std::max(high, at);
    const bool free_above = std::none_of(windows.begin(), windows.end(), [&](const Opening& o) {
      return o.low() - 0.1 < at && at - piece.width < o.high() + 0.1;
    });
    if (free_above) {
      const bool is_cooker = kind == "cooker";
      const int above = is_cooker ? make("range_hood", {}, 1)
                                  : make("wall_cabinet", Vec3{0.35, piece.width, 0.7}, 2);
      layout_.hang_at(above, against(r, side, middle, 0), is_cooker ? 1.75 : kTilesTop + 0.35);
    }
    if (is_cupboard || kind == "dishwasher")
      tidy(placement,
           {"kettle", "toaster", "coffee_machine", "knife_block", "jar", "fruit_bowl", "mug",
            "spice_rack", "wine_bottle", "cutting_board", "paper_roll", "bowl"},
           3);
    if (kind == "cooker" && dice_.chance(0.6)) layout_.scatter(placement, {"pot", "pan"}, 1, 0);
  }
  tiles_behind(side, low, high, windows);
}

// Between worktop and cupboards, around the windows, with a strip that closes the worktop's gap.
void Furnisher::tiles_behind(Side side, double low, double high,
                             const std::vector<Opening>& windows) {
  Workshop shop({"tiles_behind", 0}, place_->style, &place_->materials);
  const std::string tiles = shop.tiles(place_->style.tiles, 0.1f);
  const float half = float(high - low) / 2, middle = float(high + low) / 2, top = float(kTop);
  const Spot spot = against(layout_.room().clear, side, middle, 0);
  // +1 where the local +y runs to higher coordinates.
  const float up = side == Side::kWest || side == Side::kNorth ? 1.0f : -1.0f;
  Prop p;
  p.label = "tiles";
  const auto piece = [&](double from, double to, float z) {
    const float y0 = up * float(std::max(from, low) - middle),
                y1 = up * float(std::min(to, high) - middle);
    if (std::min(to, high) - std::max(from, low) < 0.01) return;
    p.body().show("tiles", tiles,
                  slab({0, std::min(y0, y1), top - 0.03f}, {0.008f, std::max(y0, y1), z}, 0.001f));
  };
  double from = low;
  for (const Opening& o : windows) {
    piece(from, o.low() - 0.03, float(kTilesTop));
    piece(o.low() - 0.03, o.high() + 0.03, float(std::min(o.sill - 0.024, kTilesTop)));
    from = o.high() + 0.03;
  }
  piece(from, high, float(kTilesTop));
  p.body().show("strip", shop.metal("aluminium"),
                slab({0.006f, -half, top}, {0.03f, half, top + 0.018f}, 0.004f));
  place_->put(place_->add(std::move(p)), layout_.room().name,
              spot.pose(plan_.floor_of(layout_.room().storey)));
}

}  // namespace gloam
