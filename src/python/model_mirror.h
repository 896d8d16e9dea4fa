#pragma once
// ModelMirror: the mjModel that the package `mujoco` shows of a simulation. Its arrays are its own,
// so that what Python writes into them reaches physics as Commands, which logs keep and a reset
// takes back.

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gloam/command.h"
#include "gloam/physics_memory.h"

struct mjOption_;

namespace gloam::python {

class ModelMirror {
 public:
  /// Mirrors the model of a simulation; its meshes, textures and bounding volumes are shared.
  explicit ModelMirror(std::shared_ptr<const mjModel_> physics);
  ~ModelMirror();

  /// A struct with the mirror's arrays, to be freed by mj_deleteModel, which finds no buffer in it.
  /// Once. Both the mirror and the struct have to live as long as somebody uses either.
  mjModel_* lend();
  /// The Commands for what was written since the last follow(). `all`: compares every array, else
  /// those of live fields alone. Error: a field that cannot change while the simulation runs; the
  /// mirror is then as it was.
  Result<std::vector<Command>> take_written(bool all);
  /// Shows the model as physics has it now; drops what was written and not taken. `all`: as above.
  void follow(bool all = false);
  /// Names of arrays that may be written.
  static std::vector<std::string> writable();

 private:
  struct LiveArray;

  void add_live_arrays();
  std::string written_option() const;
  std::string written_array() const;
  void copy_all();

  const std::shared_ptr<const mjModel_> physics_;
  std::vector<std::byte> storage_;
  std::unique_ptr<mjModel_> arrays_;  // the pointers of the mirror
  mjModel_* lent_ = nullptr;
  std::unique_ptr<mjOption_> seen_option_;
  std::vector<LiveArray> live_;
  bool is_taken_ = false;  // what was written has become Commands
};

/// The mirrors of a simulation's Worlds, by the model of physics. Any thread.
class ModelMirrors {
 public:
  std::shared_ptr<ModelMirror> make(const std::shared_ptr<mjModel_>& physics);
  std::shared_ptr<ModelMirror> of(const mjModel_* physics) const;

 private:
  mutable std::mutex mutex_;
  std::map<const mjModel_*, std::weak_ptr<ModelMirror>> mirrors_;
};

}  // namespace gloam::python
