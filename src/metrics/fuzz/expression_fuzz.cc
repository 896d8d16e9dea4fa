// Any bytes as an expression: they are refused with a reason and a place, or have a value.

#include <cstdint>
#include <cstdlib>
#include <vector>

#include "metrics/expression.h"

namespace {

class Names final : public gloam::QuantityNames {
 public:
  gloam::Result<gloam::QuantitySlot> find(std::span<const gloam::NameStep> name) override {
    if (name.empty() || name[0].word.empty()) std::abort();
    if (name[0].word == "none")
      return gloam::Error{gloam::ErrorKind::kInput, "there is none", name[0].loc};
    return name.size() > 1 ? gloam::QuantitySlot{0, 3} : gloam::QuantitySlot{3, 1};
  }
  std::vector<std::string> words() const override { return {"body", "time", "none"}; }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Names names;
  auto expression = gloam::Expression::parse(text, names);
  if (!expression.ok()) {
    const gloam::Error& error = expression.error();
    if (error.message.empty() || error.loc.line < 1 || error.loc.column < 1) std::abort();
    return 0;
  }
  const std::vector<double> inputs = {1, -2, 3, 0.5};
  (void)expression->evaluate(inputs);
  return 0;
}
