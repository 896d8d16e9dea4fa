#pragma once
// Kinds of models that clients name or send, without reading them whole.

#include <cstdint>
#include <string>
#include <string_view>

namespace gloam::bridge {

/// Extensions of files by what they are, in lower case with their dot.
bool is_model_extension(const std::string& extension);  ///< MJCF, URDF, a model in TOML
bool is_mesh_extension(const std::string& extension);

enum class ModelText : uint8_t { kMjcf, kUrdf, kSdf, kUsd, kOther };

/// By the first element that is no comment.
ModelText model_text_of(std::string_view text);

/// Attribute of the first element of a tag; empty = it has none.
std::string attribute_of(std::string_view text, const std::string& tag, const std::string& name);

/// ROS fixes a robot to the world by a link of that name; others stand freely, as in Gazebo.
bool is_fixed_urdf(std::string_view text);

}  // namespace gloam::bridge
