// Any bytes as the TOML of a policy: they are rejected with a reason, or the spec is bounded.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "policy/policy_spec.h"
#include "scene/toml/toml_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto table = gloam::parse_toml(text, "fuzz.toml");
  if (!table.ok()) return 0;
  const auto spec = gloam::build_policy_spec(*table, "fuzz.toml");
  if (!spec.ok() && spec.error().message.empty()) std::abort();
  if (spec.ok() && spec->networks.size() > 1000) std::abort();
  return 0;
}
