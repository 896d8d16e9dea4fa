#pragma once
// Entities: what clients see of a World: robots, people and vehicles, and each named body that
// stands directly in the world.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/snapshot.h"
#include "gloam/types.h"
#include "gloam/world.h"

namespace gloam::bridge {

enum class EntityKind : uint8_t {
  kObject,   ///< can be moved: loose things, things with joints
  kRobot,    ///< has actuators or joints
  kHuman,    ///< a person that walks by itself
  kDynamic,  ///< moves by itself or is moved from outside: vehicles, mocap bodies
  kStatic,   ///< fixed to the world
};

struct Entity {
  std::string name;  ///< unique
  EntityKind kind = EntityKind::kObject;
  Body body;                                ///< root of it
  int joint = -1;                           ///< free joint of its root; -1 = none
  bool is_mocap = false;                    ///< its root is a mocap body that nobody else moves
  bool is_agent = false;                    ///< moves by itself
  bool is_spawned = false;                  ///< came by Operator::spawn
  std::string description = {};             ///< for people; clients may change it
  std::vector<std::string> tags = {};       ///< of clients
  std::optional<EntityKind> shown_as = {};  ///< kind that a client has given it

  EntityKind category() const { return shown_as.value_or(kind); }
};

/// Root of an entity at an instant, world axes.
struct EntityState {
  Pose X_WE;
  Vec3 velocity = {}, angular_velocity = {};  ///< of its origin [m/s], [rad/s]
  /// Accelerations of its origin, without gravity [m/s²], [rad/s²].
  Vec3 acceleration = {}, angular_acceleration = {};
};

/// Frame of a box.
enum class BoxFrame : uint8_t {
  kWorld,
  kEntity,  ///< the entity's own, which turns with it
};
/// A box along the axes of a frame [m]; empty: low > high.
struct Box {
  Vec3 low = {1, 1, 1}, high = {};
  bool is_empty() const { return low.x > high.x; }
};

/// A place in a World by name: regions of generated places, [[goal]]s.
struct NamedPose {
  std::string name, description;
  std::vector<std::string> tags;
  Pose X_WP;
  Box box;            ///< of a region
  double radius = 0;  ///< of a goal [m]
};

/// Entities of a World in the order of its bodies, as it makes them; `instant` is any of it.
Result<std::vector<Entity>> list_entities(const World& world, const Instant& instant);
/// States of entities, and boxes around their geoms, at an instant.
Result<EntityState> read_state(const Instant& instant, const Entity& entity);
Result<std::vector<Box>> read_boxes(const Instant& instant, const std::vector<Entity>& entities,
                                    BoxFrame frame);
std::vector<NamedPose> list_named_poses(const World& world);

}  // namespace gloam::bridge
