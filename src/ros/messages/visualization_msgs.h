#pragma once
// Messages of ROS 2's package visualization_msgs, as of Humble.

#include "ros/messages/sensor_images.h"

namespace gloam::visualization_msgs {

inline constexpr std::string_view kPackage = "visualization_msgs/msg";

struct MeshFile {
  std::string filename;
  Bytes data;
  GLOAM_MESSAGE(MeshFile, filename, data)
};

struct UVCoordinate {
  float u = 0, v = 0;
  GLOAM_MESSAGE(UVCoordinate, u, v)
};

struct Marker {
  std_msgs::Header header;
  std::string ns;  ///< with `id` the marker's name
  int32_t id = 0, type = 0, action = 0;
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 scale;  ///< [m]
  std_msgs::ColorRGBA color;
  builtin_interfaces::Duration lifetime;  ///< 0 = for ever
  bool frame_locked = false;
  std::vector<geometry_msgs::Point> points;
  std::vector<std_msgs::ColorRGBA> colors;  ///< one a point, or none
  std::string texture_resource;
  sensor_msgs::CompressedImage texture;
  std::vector<UVCoordinate> uv_coordinates;
  std::string text, mesh_resource;
  MeshFile mesh_file;
  bool mesh_use_embedded_materials = false;
  GLOAM_CONSTANTS(int32, ARROW = 0, CUBE = 1, SPHERE = 2, CYLINDER = 3, LINE_STRIP = 4,
                  LINE_LIST = 5, CUBE_LIST = 6, SPHERE_LIST = 7, POINTS = 8, TEXT_VIEW_FACING = 9,
                  MESH_RESOURCE = 10, TRIANGLE_LIST = 11, ARROW_STRIP = 12, ADD = 0, MODIFY = 0,
                  DELETE = 2, DELETEALL = 3)
  GLOAM_MESSAGE(Marker, header, ns, id, type, action, pose, scale, color, lifetime, frame_locked,
                points, colors, texture_resource, texture, uv_coordinates, text, mesh_resource,
                mesh_file, mesh_use_embedded_materials)
};

struct MarkerArray {
  std::vector<Marker> markers;
  GLOAM_MESSAGE(MarkerArray, markers)
};

}  // namespace gloam::visualization_msgs
