#pragma once
// Furniture of rooms, by kind of room.

#include "places/plan/room_layout.h"

namespace gloam {

struct FurnishOptions {
  double passage = 0.7;  ///< [m]
  double clutter = 0.5;  ///< 0 … 1
  double loose = 0.1;    ///< fraction of what could move that does
};

/// A stretch of wall without doors.
struct KitchenWall {
  Side side;
  double from, to;
  bool window = false;
  double length() const { return to - from; }
};

/// A unit of a kitchen's row.
struct KitchenPiece {
  const char* kind;
  double width;
  bool is_tall = false;
};

/// One room on its way to being lived in: the layout, and making things for it.
class Furnisher {
 public:
  Furnisher(const FloorPlan& plan, int room, const FurnishOptions& options, uint64_t seed,
            Place* place);

  /// Furnishes by the room's kind.
  void furnish();

 private:
  // Makes a prop of the catalogue, in a size or in its own; the same in every call for one seed.
  int make(const std::string& kind, std::optional<Vec3> size = {},
           std::optional<uint64_t> seed = {});
  const Prop& prop(int index) const { return place_->prop(index); }
  double height() const { return plan_.ceiling; }
  bool is_loose(int index);
  std::optional<int> at_wall(int index, const RoomLayout::Score& score);
  std::optional<int> in_corner(int index);
  /// A table with chairs on its long sides, where all of it fits.
  std::optional<int> dining_set(const Vec3& table_size, const std::string& table = "dining_table",
                                const std::string& chair = "chair",
                                const RoomLayout::Score& preference = {});
  /// Screen, keyboard, lamp and the rest on a desk, and a chair before it.
  void workplace(int desk, const Spot& spot);
  void light(const std::string& kind, double spacing);
  /// A grid of lamps in the ceiling.
  void panels(double spacing);
  // Beside the doors, before anything else takes the wall.
  void switches();
  void sockets();
  void pictures(int count);
  void curtains();
  void radiators();
  void floor_clutter(const std::vector<std::string>& kinds);
  void tidy(int placement, const std::vector<std::string>& kinds, double many);
  const Placement& placed(int index) const {
    return place_->placements()[static_cast<size_t>(index)];
  }

  void living();
  void kitchen();
  void kitchen_rows(const std::vector<KitchenWall>& walls, const KitchenWall& first);
  void kitchen_row(Side side, double from, const std::vector<KitchenPiece>& row);
  void tiles_behind(Side side, double low, double high, const std::vector<Opening>& windows);
  void bedroom();
  void bathroom();
  void study();
  void utility();
  void hall();
  // Furnishing of offices (furnish_office.cc).
  void corridor();
  void open_office();
  void office();
  void meeting();
  void copy();

  const FloorPlan& plan_;
  const FurnishOptions options_;
  Place* place_;
  RoomLayout layout_;
  Dice& dice_;
};

}  // namespace gloam
