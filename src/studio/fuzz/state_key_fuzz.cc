// States that clients paste: an element is read or refused with a reason, and what was read
// survives being written.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "studio/state_key.h"

namespace {

/// Bit for bit, since NaN is not equal to itself.
bool is_same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gloam::studio;
  const auto key = parse_key({reinterpret_cast<const char*>(data), size});
  if (!key.ok()) {
    if (key.error().message.empty()) std::abort();
    return 0;
  }
  const auto again = parse_key(to_mjcf(*key));
  if (!again.ok() || !is_same(again->qpos, key->qpos) || !is_same(again->qvel, key->qvel) ||
      !is_same(again->ctrl, key->ctrl) || !is_same(again->mpos, key->mpos) ||
      !is_same(again->mquat, key->mquat))
    std::abort();
  return 0;
}
