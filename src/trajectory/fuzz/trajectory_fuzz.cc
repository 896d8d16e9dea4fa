// A trajectory file: what is read can be compared with itself, without an error that is not one.

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "gloam/trajectory.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto read = gloam::parse_trajectory(text, "fuzz");
  if (!read.ok()) {
    if (read.error().to_string().find('\n') != std::string::npos) std::abort();
    return 0;
  }
  if (read->size() == 0 || read->rotations.size() != read->size()) std::abort();
  auto pair = gloam::associate(*read, *read);
  if (!pair.ok() || pair->reference.size() != read->size()) std::abort();
  for (const auto part : {gloam::ErrorPart::kTranslation, gloam::ErrorPart::kFull})
    if (const auto errors = gloam::absolute_errors(*pair, part);
        !errors.ok() || !std::isfinite(errors->statistics.rmse))
      std::abort();
  (void)gloam::align(gloam::Alignment::kSim3, &*pair).ok();
  for (const auto unit : {gloam::DeltaUnit::kFrames, gloam::DeltaUnit::kMeters,
                          gloam::DeltaUnit::kSeconds, gloam::DeltaUnit::kRadians})
    (void)gloam::relative_errors(*pair, gloam::ErrorPart::kAngle, {.unit = unit, .all_pairs = true})
        .ok();
  return 0;
}
