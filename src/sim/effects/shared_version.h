#pragma once
// Versions of a field that an effect publishes and Snapshots hold: one that no Snapshot holds any
// more is written again, so that nothing is allocated in the loop of steps.

#include <memory>

namespace gloam {

/// Whether its owner alone holds `version`. lock() sees what the last reader did before it let go;
/// use_count() alone need not.
template <class T>
bool is_free(const std::shared_ptr<T>& version) {
  return version.use_count() == 1 && std::weak_ptr<T>(version).lock() != nullptr;
}

}  // namespace gloam
