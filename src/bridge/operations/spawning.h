#pragma once
// Spawning: requests of clients for new entities, and what can be had.

#include <cstdint>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam::bridge {

struct SpawnRequest {
  std::string name = {};        ///< letters, digits, _ - .; empty = the resource's own
  bool allow_renaming = false;  ///< NAME_2 … where NAME is taken
  /// Resource: a path or file:// address of MJCF or URDF (a [[robot]]) or of a mesh (an
  /// [[object]]), "gloam://prop/KIND" (a [[prop]]), "gloam://assets/…" (a file that comes with
  /// Gloam).
  std::string uri = {};
  std::string text = {};  ///< MJCF or URDF itself, instead of `uri`
  /// Namespace of the robot's topics, "/fleet/a"; empty = "/NAME".
  std::string ns = {};
  std::string frame = {};  ///< body that the pose is relative to; empty or "world" = the world
  Pose X_FE = {};
};

/// Cause of a refusal to spawn.
enum class SpawnFailure : uint8_t {
  kNone,
  kNameTaken,
  kNameInvalid,
  kUnsupportedFormat,
  kNoResource,  ///< neither address nor text, or no such file
  kNamespaceInvalid,
  kParse,              ///< the model or the scene with it does not compile
  kMissingAssets,      ///< a file that the model names is not there or may not be read
  kUnsupportedAssets,  ///< a file that the model names is of a format that is not read
  kPoseInvalid,
  kOther,  ///< the simulation has failed, too many entities, a bare model
};

struct SpawnResult {
  SpawnFailure failure = SpawnFailure::kNone;
  std::string name = {};  ///< of the new entity
  Error error = {};       ///< of a failure
  bool ok() const { return failure == SpawnFailure::kNone; }
};

/// A resource that clients may spawn.
struct Spawnable {
  std::string uri, description;
  Vec3 size = {};  ///< of a prop: depth, width, height [m]; else 0
};

/// A scene that clients may load.
struct WorldFile {
  std::string name;  ///< "demo"
  std::string uri;   ///< "file:///…/examples/demo.toml"; empty = from text
  std::string description;
};

}  // namespace gloam::bridge
