#include "bridge/ros2/services/simulation_values.h"

#include <re2/re2.h>

#include <algorithm>
#include <cmath>

#include "bridge/operations/pose_math.h"

namespace gloam::bridge {
namespace {

namespace si = simulation_interfaces;
using ResultCode = si::Result;

constexpr size_t kLongestFilter = 1000;
constexpr int64_t kFilterMemory = 1 << 20;  // [bytes]

struct CategoryRow {
  EntityKind kind;
  uint8_t category;
};
constexpr CategoryRow kCategories[] = {
    {EntityKind::kObject, si::EntityCategory::CATEGORY_OBJECT},
    {EntityKind::kRobot, si::EntityCategory::CATEGORY_ROBOT},
    {EntityKind::kHuman, si::EntityCategory::CATEGORY_HUMAN},
    {EntityKind::kDynamic, si::EntityCategory::CATEGORY_DYNAMIC_OBJECT},
    {EntityKind::kStatic, si::EntityCategory::CATEGORY_STATIC_OBJECT}};

/// Test of a filter's bounds, for boxes along the world's axes.
class BoundsTest {
 public:
  static Result<BoundsTest> make(const si::Bounds& bounds) {
    BoundsTest test;
    test.type_ = bounds.type;
    if (bounds.type == si::Bounds::TYPE_EMPTY) return test;
    if (bounds.type != si::Bounds::TYPE_BOX && bounds.type != si::Bounds::TYPE_SPHERE)
      return Error{ErrorKind::kUnsupported, "only boxes and spheres are supported as bounds"};
    if (bounds.points.size() != 2) return Error{ErrorKind::kInput, "bounds must have two points"};
    const Vec3 a = vec_from_ros(bounds.points[0]), b = vec_from_ros(bounds.points[1]);
    if (!is_finite(a) || !is_finite(b)) return Error{ErrorKind::kInput, "bounds are not finite"};
    test.low_ = {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
    test.high_ = {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
    test.centre_ = a;
    test.radius_ = b.x;
    return test;
  }
  bool is_any() const { return type_ == si::Bounds::TYPE_EMPTY; }
  bool overlaps(const Box& box) const {
    if (type_ == si::Bounds::TYPE_SPHERE) {
      const Vec3 nearest = {std::clamp(centre_.x, box.low.x, box.high.x),
                            std::clamp(centre_.y, box.low.y, box.high.y),
                            std::clamp(centre_.z, box.low.z, box.high.z)};
      return length(difference(nearest, centre_)) <= radius_;
    }
    return box.low.x <= high_.x && box.high.x >= low_.x && box.low.y <= high_.y &&
           box.high.y >= low_.y && box.low.z <= high_.z && box.high.z >= low_.z;
  }

 private:
  uint8_t type_ = 0;
  Vec3 low_, high_, centre_;
  double radius_ = 0;
};

Status keep_matching(const std::string& filter, std::vector<Entity>* entities) {
  if (filter.empty()) return {};
  RE2::Options options(RE2::POSIX);
  options.set_log_errors(false);
  options.set_max_mem(kFilterMemory);
  const RE2 pattern(filter.size() > kLongestFilter ? "(" : filter, options);
  if (!pattern.ok())
    return Error{ErrorKind::kInput,
                 "the filter is not a valid regular expression: " + pattern.error()};
  std::erase_if(*entities, [&](const Entity& e) { return !RE2::PartialMatch(e.name, pattern); });
  return {};
}

}  // namespace

si::Result result_ok() { return result_of(ResultCode::RESULT_OK, ""); }

si::Result result_of(int code, std::string message) {
  si::Result result;
  result.result = static_cast<uint8_t>(code);
  result.error_message = std::move(message);
  return result;
}

si::Result result_of(const Status& status, int wrong_state) {
  if (status.ok()) return result_ok();
  const Error& error = status.error();
  const std::string text = error.to_string();
  switch (error.kind) {
    case ErrorKind::kUnsupported:
      return result_of(ResultCode::RESULT_FEATURE_UNSUPPORTED, text);
    case ErrorKind::kInput:
      return result_of(ResultCode::RESULT_NOT_FOUND, text);
    case ErrorKind::kUsage:
      return result_of(wrong_state, text);
    default:
      return result_of(ResultCode::RESULT_OPERATION_FAILED, text);
  }
}

geometry_msgs::Pose ros_pose_of(const Pose& pose) {
  return {{pose.p.x, pose.p.y, pose.p.z}, {pose.q.x, pose.q.y, pose.q.z, pose.q.w}};
}

Pose pose_from_ros(const geometry_msgs::Pose& pose) {
  const auto& [p, q] = pose;
  return {{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}};
}

Vec3 vec_from_ros(const geometry_msgs::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

builtin_interfaces::Time ros_time_of(double time) {
  const double seconds = std::floor(time);
  builtin_interfaces::Time stamp;
  stamp.sec = static_cast<int32_t>(seconds);
  stamp.nanosec = static_cast<uint32_t>(std::llround((time - seconds) * 1e9));
  if (stamp.nanosec >= 1000000000u) {
    ++stamp.sec;
    stamp.nanosec = 0;
  }
  return stamp;
}

si::EntityState state_message(const EntityState& state, double time) {
  const auto vector = [](const Vec3& v) { return geometry_msgs::Vector3{v.x, v.y, v.z}; };
  si::EntityState message;
  message.header.frame_id = "world";
  message.header.stamp = ros_time_of(time);
  message.pose = ros_pose_of(state.X_WE);
  message.twist = {vector(state.velocity), vector(state.angular_velocity)};
  message.acceleration = {vector(state.acceleration), vector(state.angular_acceleration)};
  return message;
}

uint8_t category_message(EntityKind kind) {
  return std::ranges::find(kCategories, kind, &CategoryRow::kind)->category;
}

bool kind_from_message(uint8_t category, EntityKind* kind) {
  const auto* row = std::ranges::find(kCategories, category, &CategoryRow::category);
  if (row == std::end(kCategories)) return false;
  *kind = row->kind;
  return true;
}

si::EntityInfo info_message(const Entity& entity) {
  si::EntityInfo message;
  message.category.category = category_message(entity.category());
  message.description = entity.description;
  message.tags = entity.tags;
  return message;
}

si::Bounds box_message(const Box& box) {
  si::Bounds message;
  if (box.is_empty()) return message;
  message.type = si::Bounds::TYPE_BOX;
  message.points = {{box.high.x, box.high.y, box.high.z}, {box.low.x, box.low.y, box.low.z}};
  return message;
}

uint8_t state_message(RunState state) {
  switch (state) {
    case RunState::kStopped:
      return si::SimulationState::STATE_STOPPED;
    case RunState::kPlaying:
      return si::SimulationState::STATE_PLAYING;
    case RunState::kNoWorld:
      return si::SimulationState::STATE_NO_WORLD;
    case RunState::kLoading:
      return si::SimulationState::STATE_LOADING_WORLD;
    default:
      return si::SimulationState::STATE_PAUSED;
  }
}

int spawn_code(SpawnFailure failure) {
  using Code = si::SpawnResult;
  switch (failure) {
    case SpawnFailure::kNone:
      return ResultCode::RESULT_OK;
    case SpawnFailure::kNameTaken:
      return Code::NAME_NOT_UNIQUE;
    case SpawnFailure::kNameInvalid:
      return Code::NAME_INVALID;
    case SpawnFailure::kUnsupportedFormat:
      return Code::UNSUPPORTED_FORMAT;
    case SpawnFailure::kNoResource:
      return Code::NO_RESOURCE;
    case SpawnFailure::kNamespaceInvalid:
      return Code::NAMESPACE_INVALID;
    case SpawnFailure::kParse:
      return Code::RESOURCE_PARSE_ERROR;
    case SpawnFailure::kMissingAssets:
      return Code::MISSING_ASSETS;
    case SpawnFailure::kUnsupportedAssets:
      return Code::UNSUPPORTED_ASSETS;
    case SpawnFailure::kPoseInvalid:
      return Code::INVALID_POSE;
    default:
      return ResultCode::RESULT_OPERATION_FAILED;
  }
}

bool has_tags(const std::vector<std::string>& tags, const si::TagsFilter& filter) {
  if (filter.tags.empty()) return true;
  const auto has = [&](const std::string& tag) {
    return std::ranges::find(tags, tag) != tags.end();
  };
  return filter.filter_mode == si::TagsFilter::FILTER_MODE_ALL
             ? std::ranges::all_of(filter.tags, has)
             : std::ranges::any_of(filter.tags, has);
}

Result<std::vector<Entity>> filter_entities(const Operator& operations,
                                            const si::EntityFilters& filters) {
  GLOAM_TRY(const BoundsTest bounds, BoundsTest::make(filters.bounds));
  std::vector<Entity> entities = operations.entities();
  GLOAM_TRY_STATUS(keep_matching(filters.filter, &entities));
  std::erase_if(entities, [&](const Entity& entity) {
    const uint8_t category = category_message(entity.category());
    const bool is_of_kind = filters.categories.empty() ||
                            std::ranges::any_of(filters.categories, [&](const auto& asked) {
                              return asked.category == category;
                            });
    return !is_of_kind || !has_tags(entity.tags, filters.tags);
  });
  if (bounds.is_any()) return entities;
  GLOAM_TRY(const std::vector<Box> boxes, operations.entity_bounds(entities));
  std::vector<Entity> inside;
  for (size_t i = 0; i < entities.size(); ++i)
    if (!boxes[i].is_empty() && bounds.overlaps(boxes[i])) inside.push_back(entities[i]);
  return inside;
}

}  // namespace gloam::bridge
