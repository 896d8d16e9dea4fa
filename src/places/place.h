#pragma once
// A generated place: what stands where, before anything of MuJoCo's. Walls and floors are props
// like all else, made for the place instead of by the catalogue.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/height_field_parts.h"
#include "gloam/scene.h"
#include "places/catalogue.h"

namespace gloam {

struct Placement {
  int prop = 0;
  std::string name;  ///< unique: "kitchen/chair_2"
  Pose X_WP = {};
  bool loose = false;   ///< moves freely
  bool driven = false;  ///< each part is a mocap body
  SourceLoc loc = {};
};

/// Many of one prop, all of one body: what is drawn alone, without parts or colliders.
struct Scatter {
  int prop = 0;
  std::string name;  ///< name of the body: "grass"
  std::vector<Pose> poses;
};

/// Uneven ground as a height field: a collider that is not drawn.
struct Ground {
  std::string name;  ///< name of its geom
  HeightField field;
  double friction = 1;  ///< sliding
};

class Place {
 public:
  explicit Place(std::string name) : name(std::move(name)) {}

  std::string name;
  Style style;
  MaterialSet materials;
  std::vector<Ground> grounds;
  std::vector<Region> regions;         ///< floors that can be walked on
  std::optional<SkyOptions> sky = {};  ///< sky for a scene that has none of its own
  std::optional<double> ev100 = {};    ///< exposure by which its rooms look well, likewise

  /// Can doors and drawers of things of the catalogue be opened? Set it before make().
  bool openable = true;

  /// One of the catalogue; the same request gives the same prop.
  Result<int> make(const PropRequest& request);
  /// One made for this place; its parts and label are complete.
  int add(Prop prop);
  /// Puts it there under `room`/LABEL_N. Returns its index in placements().
  int put(int prop, const std::string& room, const Pose& X_WP, bool loose = false);
  void put_named(Placement placement) { placements_.push_back(std::move(placement)); }

  /// Many of one, for the eye alone: grass, pebbles.
  void scatter(int prop, std::string name, std::vector<Pose> poses) {
    scatters_.push_back({prop, std::move(name), std::move(poses)});
  }

  const Prop& prop(int index) const { return props_[static_cast<size_t>(index)]; }
  const std::vector<Prop>& props() const { return props_; }
  const std::vector<Placement>& placements() const { return placements_; }
  const std::vector<Scatter>& scatters() const { return scatters_; }

  /// Hash of the whole place: the key of the model compiled from it.
  uint64_t hash() const;

 private:
  std::vector<Prop> props_;
  struct Made {
    PropRequest request;
    bool openable;
    int index;
  };
  std::vector<Made> made_;
  std::vector<Placement> placements_;
  std::vector<Scatter> scatters_;
  std::map<std::string, int> numbers_;  // counts of names given so far
};

}  // namespace gloam
