#pragma once
// Messages of Foxglove's package foxglove_msgs.

#include "ros/messages/geometry_msgs.h"

namespace gloam::foxglove_msgs {

inline constexpr std::string_view kPackage = "foxglove_msgs/msg";

/// One frame of a video.
struct CompressedVideo {
  builtin_interfaces::Time timestamp;
  std::string frame_id;
  Bytes data;          ///< h264: Annex B, one picture, SPS and PPS with every key frame
  std::string format;  ///< "h264", "h265", "vp9", "av1"
  GLOAM_MESSAGE(CompressedVideo, timestamp, frame_id, data, format)
};

struct Color {
  double r = 0, g = 0, b = 0, a = 0;  ///< [0, 1]
  GLOAM_MESSAGE(Color, r, g, b, a)
};

struct KeyValuePair {
  std::string key, value;
  GLOAM_MESSAGE(KeyValuePair, key, value)
};

/// Points along +X of its pose.
struct ArrowPrimitive {
  geometry_msgs::Pose pose;
  double shaft_length = 0, shaft_diameter = 0, head_length = 0, head_diameter = 0;  ///< [m]
  Color color;
  GLOAM_MESSAGE(ArrowPrimitive, pose, shaft_length, shaft_diameter, head_length, head_diameter,
                color)
};

struct CubePrimitive {
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 size;  ///< lengths of its edges [m]
  Color color;
  GLOAM_MESSAGE(CubePrimitive, pose, size, color)
};

struct SpherePrimitive {
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 size;  ///< diameters [m]
  Color color;
  GLOAM_MESSAGE(SpherePrimitive, pose, size, color)
};

/// A cylinder along Z of its pose, a truncated cone by other scales.
struct CylinderPrimitive {
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 size;             ///< of the box around it [m]
  double bottom_scale = 1, top_scale = 1;  ///< [0, 1]
  Color color;
  GLOAM_MESSAGE(CylinderPrimitive, pose, size, bottom_scale, top_scale, color)
};

struct LinePrimitive {
  uint8_t type = 0;
  geometry_msgs::Pose pose;
  double thickness = 0;  ///< [m], or [px] if scale_invariant
  bool scale_invariant = false;
  std::vector<geometry_msgs::Point> points;
  Color color;
  std::vector<Color> colors;      ///< one a point, or none
  std::vector<uint32_t> indices;  ///< of points; none = in their order
  GLOAM_CONSTANTS(uint8, LINE_STRIP = 0, LINE_LOOP = 1, LINE_LIST = 2)
  GLOAM_MESSAGE(LinePrimitive, type, pose, thickness, scale_invariant, points, color, colors,
                indices)
};

struct TriangleListPrimitive {
  geometry_msgs::Pose pose;
  std::vector<geometry_msgs::Point> points;
  Color color;
  std::vector<Color> colors;      ///< one a point, or none
  std::vector<uint32_t> indices;  ///< three a triangle; none = points in their order
  GLOAM_MESSAGE(TriangleListPrimitive, pose, points, color, colors, indices)
};

struct TextPrimitive {
  geometry_msgs::Pose pose;
  bool billboard = false;  ///< it faces the camera
  double font_size = 0;    ///< height of a line [m], or [px] if scale_invariant
  bool scale_invariant = false;
  Color color;
  std::string text;
  GLOAM_MESSAGE(TextPrimitive, pose, billboard, font_size, scale_invariant, color, text)
};

/// A model's file, at an address or within.
struct ModelPrimitive {
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 scale;
  Color color;
  bool override_color = false;
  std::string url, media_type;
  Bytes data;
  GLOAM_MESSAGE(ModelPrimitive, pose, scale, color, override_color, url, media_type, data)
};

struct SceneEntityDeletion {
  builtin_interfaces::Time timestamp;
  uint8_t type = 0;
  std::string id;
  GLOAM_CONSTANTS(uint8, MATCHING_ID = 0, ALL = 1)
  GLOAM_MESSAGE(SceneEntityDeletion, timestamp, type, id)
};

/// Primitives in one frame; replaces the entity of the same id.
struct SceneEntity {
  builtin_interfaces::Time timestamp;
  std::string frame_id, id;
  builtin_interfaces::Duration lifetime;  ///< 0 = until it is replaced or deleted
  bool frame_locked = false;              ///< moves with its frame
  std::vector<KeyValuePair> metadata;
  std::vector<ArrowPrimitive> arrows;
  std::vector<CubePrimitive> cubes;
  std::vector<SpherePrimitive> spheres;
  std::vector<CylinderPrimitive> cylinders;
  std::vector<LinePrimitive> lines;
  std::vector<TriangleListPrimitive> triangles;
  std::vector<TextPrimitive> texts;
  std::vector<ModelPrimitive> models;
  GLOAM_MESSAGE(SceneEntity, timestamp, frame_id, id, lifetime, frame_locked, metadata, arrows,
                cubes, spheres, cylinders, lines, triangles, texts, models)
};

struct SceneUpdate {
  std::vector<SceneEntityDeletion> deletions;
  std::vector<SceneEntity> entities;
  GLOAM_MESSAGE(SceneUpdate, deletions, entities)
};

}  // namespace gloam::foxglove_msgs
