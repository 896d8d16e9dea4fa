// The plan of a house: a hall along x, a strip of rooms on either side of it, and with luck one
// large room across its end. Every room opens to the hall, so every room can be reached.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "places/dice.h"
#include "places/plan/floor_plan.h"

namespace gloam {
namespace {

// A room that the house should have.
struct RoomRequest {
  std::string kind;
  double width_low, width_high;  // along its strip [m]
};

// Rooms of a home, in the order in which each is first given space.
const RoomRequest kLiving{"living", 5.0, 6.2}, kKitchen{"kitchen", 3.3, 4.0},
    kBath{"bathroom", 2.2, 2.7}, kBedroom{"bedroom", 3.4, 4.2}, kStudy{"study", 2.8, 3.4},
    kUtilityRoom{"utility", 2.2, 2.6};
const std::vector<RoomRequest> kOneStorey = {kLiving,  kBedroom, kBath,    kKitchen,
                                             kBedroom, kStudy,   kBedroom, kUtilityRoom,
                                             kBath,    kBedroom, kStudy};
// Upstairs and downstairs in turn.
const std::vector<RoomRequest> kDownstairs = {kLiving, kKitchen, kUtilityRoom, kStudy, kBath};
const std::vector<RoomRequest> kUpstairs = {kBedroom, kBath, kBedroom, kBedroom, kStudy};

constexpr double kStairWidth = 2.1, kHallLow = 1.5, kHallHigh = 1.9;

struct Slot {
  RoomRequest request;
  double width = 0;
};
using Strip = std::vector<Slot>;

double width_of(const Strip& strip, double wall) {
  double sum = strip.empty() ? 0 : -wall;
  for (const Slot& slot : strip) sum += slot.width + wall;
  return sum;
}

class HousePlanner {
 public:
  explicit HousePlanner(const HouseOptions& options)
      : options_(options), dice_(options.seed, "house.plan") {}

  FloorPlan plan() {
    plan_.ceiling = options_.ceiling;
    plan_.storeys = options_.storeys;
    hall_ = dice_.uniform(kHallLow, kHallHigh);
    south_ = dice_.uniform(3.5, 4.2);
    north_ = dice_.uniform(3.5, 4.2);
    std::vector<std::vector<RoomRequest>> requests = assign_to_storeys();
    end_room_ = options_.storeys == 1 && requests[0].size() >= 4 && dice_.chance(0.4);
    if (end_room_) {
      std::erase_if(requests[0], [](const RoomRequest& w) { return w.kind == "living"; });
      end_width_ = dice_.uniform(3.9, 4.6);
    }
    // All storeys are as long as the longest needs.
    std::vector<std::pair<Strip, Strip>> strips;
    double length = 0;
    for (const std::vector<RoomRequest>& storey : requests) {
      strips.push_back(split(storey));
      length = std::max({length, width_of(strips.back().first, plan_.wall),
                         width_of(strips.back().second, plan_.wall)});
    }
    for (int storey = 0; storey < options_.storeys; ++storey)
      build(storey, strips[static_cast<size_t>(storey)], length);
    const double h = plan_.wall / 2;
    plan_.outline = plan_.rooms[0].clear.grown(h);
    for (const PlanRoom& room : plan_.rooms) {
      const Rect r = room.clear.grown(h);
      Rect& o = plan_.outline;
      o = {std::min(o.x0, r.x0), std::min(o.y0, r.y0), std::max(o.x1, r.x1), std::max(o.y1, r.y1)};
    }
    add_windows();
    return std::move(plan_);
  }

 private:
  // Rooms of each storey, without the halls.
  std::vector<std::vector<RoomRequest>> assign_to_storeys() const {
    std::vector<std::vector<RoomRequest>> out(static_cast<size_t>(options_.storeys));
    if (options_.storeys == 1) {
      const auto count =
          std::min<size_t>(static_cast<size_t>(options_.rooms - 1), kOneStorey.size());
      out[0].assign(kOneStorey.begin(), kOneStorey.begin() + static_cast<std::ptrdiff_t>(count));
      return out;
    }
    const int left = std::max(options_.rooms - 2, 2);
    for (int i = 0; i < left; ++i) {
      const std::vector<RoomRequest>& list = i % 2 == 0 ? kDownstairs : kUpstairs;
      out[static_cast<size_t>(i % 2)].push_back(list[static_cast<size_t>(i / 2)]);
    }
    return out;
  }

  // Two strips of about one length; the stairs are the first slot of the south.
  std::pair<Strip, Strip> split(const std::vector<RoomRequest>& requests) {
    std::vector<Slot> slots;
    for (const RoomRequest& request : requests)
      slots.push_back({request, dice_.uniform(request.width_low, request.width_high)});
    const double stairs = options_.storeys > 1 ? kStairWidth + plan_.wall : 0;
    double best = 1e9;
    unsigned best_mask = 0;
    const unsigned turn = static_cast<unsigned>(dice_.integer(0, (1 << slots.size()) - 1));
    for (unsigned i = 0; i < 1u << slots.size(); ++i) {
      const unsigned mask = i ^ turn;
      double a = stairs, b = 0;
      for (size_t k = 0; k < slots.size(); ++k)
        (mask >> k & 1 ? a : b) += slots[k].width + plan_.wall;
      // A strip without a room would leave the hall's wall to the garden.
      if (a == 0 || b == 0) continue;
      if (std::abs(a - b) < best - 0.3) best = std::abs(a - b), best_mask = mask;
    }
    std::pair<Strip, Strip> out;
    for (size_t k = 0; k < slots.size(); ++k)
      (best_mask >> k & 1 ? out.first : out.second).push_back(slots[k]);
    for (Strip* strip : {&out.first, &out.second}) order(strip);
    if (stairs > 0)
      out.first.insert(out.first.begin(), {{"stairs", kStairWidth, kStairWidth}, kStairWidth});
    return out;
  }

  // Kitchen next to the living room, the rest as it falls.
  void order(Strip* strip) {
    dice_.shuffle(strip);
    const auto find = [&](const char* kind) {
      return std::find_if(strip->begin(), strip->end(),
                          [&](const Slot& s) { return s.request.kind == kind; });
    };
    const auto kitchen = find("kitchen"), living = find("living");
    if (kitchen == strip->end() || living == strip->end()) return;
    const auto beside = living + 1 != strip->end() ? living + 1 : living - 1;
    std::iter_swap(kitchen, beside);
  }

  std::string name_of(const std::string& kind) {
    const int number = ++count_[kind];
    return number == 1 ? kind : fmt::format("{}_{}", kind, number);
  }

  int add_room(const std::string& kind, int storey, const Rect& clear) {
    plan_.rooms.push_back({name_of(kind), kind, storey, clear});
    return static_cast<int>(plan_.rooms.size()) - 1;
  }

  // Rooms grow to fill the strip; the stairs and bathrooms keep their width while others can grow.
  void stretch(Strip* strip, double length) const {
    const double spare = length - width_of(*strip, plan_.wall);
    const auto elastic = [](const Slot& s) {
      return s.request.kind == "stairs"     ? 0.0
             : s.request.kind == "bathroom" ? 0.15 * s.width
                                            : s.width;
    };
    double sum = 0;
    for (const Slot& slot : *strip) sum += elastic(slot);
    for (Slot& slot : *strip) slot.width += sum > 0 ? spare * elastic(slot) / sum : spare;
  }

  void build(int storey, std::pair<Strip, Strip> strips, double length) {
    const double x0 = -length / 2, x1 = length / 2, y = hall_ / 2, t = plan_.wall;
    const int hall = add_room(storey == 0 ? "hall" : "landing", storey, {x0, -y, x1, y});
    for (const bool south : {true, false}) {
      Strip& strip = south ? strips.first : strips.second;
      stretch(&strip, length);
      double x = x0;
      int previous = -1;
      for (const Slot& slot : strip) {
        const Rect clear = south ? Rect{x, -y - t - south_, x + slot.width, -y - t}
                                 : Rect{x, y + t, x + slot.width, y + t + north_};
        x += slot.width + t;
        const int room = add_room(slot.request.kind, storey, clear);
        lead_to_hall(hall, room, south ? Side::kSouth : Side::kNorth);
        if (previous >= 0) join_living(previous, room);
        previous = room;
      }
    }
    if (storey == 0) {
      Opening entrance{OpeningKind::kEntrance, hall, -1, Side::kWest, 0, 0.96, 0, 2.1};
      plan_.openings.push_back(entrance);
    }
    if (!end_room_) return;
    const int living =
        add_room("living", storey, {x1 + t, -y - t - south_, x1 + t + end_width_, y + t + north_});
    plan_.openings.push_back(
        {OpeningKind::kArch, hall, living, Side::kEast, 0, hall_ - 0.3, 0, 2.2});
  }

  void lead_to_hall(int hall, int room, Side side) {
    const PlanRoom& to = plan_.rooms[static_cast<size_t>(room)];
    if (to.kind == "stairs") {
      if (to.storey == 0) plan_.stairwell = to.clear, plan_.stair_side = opposite(side);
      plan_.openings.push_back({OpeningKind::kArch, hall, room, side, to.clear.x(),
                                to.clear.width() - 0.02, 0, plan_.ceiling - 0.02});
      return;
    }
    Opening o{OpeningKind::kDoor, hall, room, side};
    o.width = std::max(0.86, options_.passage + 0.14);
    if (to.kind == "living" && dice_.chance(0.5)) {
      o.kind = OpeningKind::kArch;
      o.width = 1.5;
      o.head = 2.2;
    }
    // The leaf comes to rest along the wall that the hinge is next to.
    o.hinge_low = dice_.chance(0.5);
    const double edge = kDoorToCorner + o.width / 2;
    o.center = o.hinge_low ? to.clear.x0 + edge : to.clear.x1 - edge;
    plan_.openings.push_back(o);
  }

  void join_living(int a, int b) {
    const auto kind = [&](int room) { return plan_.rooms[static_cast<size_t>(room)].kind; };
    const bool both = (kind(a) == "living" && kind(b) == "kitchen") ||
                      (kind(a) == "kitchen" && kind(b) == "living");
    if (!both || !dice_.chance(0.6)) return;
    const Rect& r = plan_.rooms[static_cast<size_t>(a)].clear;
    plan_.openings.push_back(
        {OpeningKind::kArch, a, b, Side::kEast, r.y() + dice_.uniform(-0.3, 0.3), 1.2, 0, 2.2});
  }

  void add_window(int room, Side side, double center, double width, double sill, double head) {
    Opening o{OpeningKind::kWindow,
              room,
              -1,
              side,
              center,
              width,
              sill,
              std::min(head, plan_.ceiling - 0.22)};
    plan_.openings.push_back(o);
  }

  void add_windows() {
    const Rect& outline = plan_.outline;
    for (int i = 0; i < static_cast<int>(plan_.rooms.size()); ++i) {
      const PlanRoom room = plan_.rooms[static_cast<size_t>(i)];
      for (const Side side : {Side::kSouth, Side::kNorth, Side::kEast, Side::kWest}) {
        const Rect r = room.clear.grown(plan_.wall / 2 + 1e-6);
        const bool outside = side == Side::kSouth   ? r.y0 <= outline.y0
                             : side == Side::kNorth ? r.y1 >= outline.y1
                             : side == Side::kWest  ? r.x0 <= outline.x0
                                                    : r.x1 >= outline.x1;
        if (!outside || (room.storey == 0 && room.kind == "hall" && side == Side::kWest)) continue;
        const bool along_x = runs_along_x(side);
        const double from = along_x ? room.clear.x0 : room.clear.y0;
        const double span = along_x ? room.clear.width() : room.clear.depth();
        const bool is_end = !along_x;
        if (is_end && room.kind != "living" && room.kind != "hall" && room.kind != "landing" &&
            !dice_.chance(0.35))
          continue;
        if (room.kind == "bathroom" || room.kind == "utility" || room.kind == "stairs") {
          if (!is_end) add_window(i, side, from + span * 0.5, 0.7, 1.35, 2.1);
        } else if (span < 2.4) {
          add_window(i, side, from + span * 0.5, 0.8, 0.95, 2.1);
        } else if (room.kind == "living") {
          const int count = span > 4.4 ? 2 : 1;
          for (int k = 0; k < count; ++k)
            add_window(i, side, from + span * (k + 0.5) / count, std::min(1.7, span / count - 0.9),
                       0.45, 2.25);
        } else {
          const double sill = room.kind == "kitchen" ? 1.05 : 0.9;
          add_window(i, side, from + span * 0.5, std::min(1.5, span - 1.2), sill, 2.2);
        }
      }
    }
  }

  const HouseOptions& options_;
  Dice dice_;
  FloorPlan plan_;
  double hall_ = 0, south_ = 0, north_ = 0, end_width_ = 0;
  bool end_room_ = false;
  std::map<std::string, int> count_;
};

}  // namespace

FloorPlan plan_house(const HouseOptions& options) { return HousePlanner(options).plan(); }

}  // namespace gloam
