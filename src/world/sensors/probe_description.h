#pragma once
// The scene file's [[probe]] tables on the compiled model, without MuJoCo types.

#include <string_view>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene.h"

namespace gloam {

struct CompiledWorld;
struct ProbeQuantity;  // scene/options/probe_quantities.h

struct ProbeDescription {
  ProbeOptions options;
  const ProbeQuantity* quantity = nullptr;
  int body = 0;                  ///< body that a place moves with, 0 = world
  Vec3 p_B, n_B = {0, 0, 1};     ///< place [m] and normal (unit) in its frame
  std::vector<int> bodies = {};  ///< bodies that it is measured on, rising; empty = a place
  std::vector<int> geoms = {};   ///< their geoms, rising

  bool is_fixed() const { return body == 0 && bodies.empty(); }
};

/// After all other parts of the World are described. Errors: a body, agent or camera that there is
/// not, a sensor's name, a quantity that the scene has nowhere, a place outside of it.
Result<std::vector<ProbeDescription>> describe_probes(const CompiledWorld& world);

/// True if a probe of the World reads the quantity.
bool has_probe(const CompiledWorld& world, std::string_view quantity);

}  // namespace gloam
