#pragma once
// Signs of zeros in saved XML. MuJoCo's writer leaves out what equals a default, and -0 equals 0.

#include <mujoco/mujoco.h>

#include <filesystem>
#include <functional>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// While it lives, every -0 among the numbers of a spec is a negative number next to zero instead,
/// which the writer takes for different from 0 and writes.
class NegativeZeros {
 public:
  explicit NegativeZeros(mjSpec* spec);
  ~NegativeZeros();
  NegativeZeros(const NegativeZeros&) = delete;
  NegativeZeros& operator=(const NegativeZeros&) = delete;

  bool any() const { return !restore_.empty(); }
  /// Makes -0 of those numbers in a saved file. Errors: it cannot be read or written.
  static Status write_signs(const std::filesystem::path& file);

 private:
  void resolve_orientations(mjSpec* spec);
  void resolve(const mjsCompiler& compiler, double* quat, mjsOrientation* alt);
  void mark_vector(mjDoubleVec* values);

  std::vector<std::function<void()>> restore_;
};

}  // namespace gloam
