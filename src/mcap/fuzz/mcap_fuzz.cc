#include "base/test/custom_mutator.h"
#include "mcap/mcap_describe.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_recover.h"
#include "mcap/test/mcap_mutator.h"

namespace {

/// Takes everything and keeps nothing.
class NullSink final : public gloam::LogSink {
 public:
  gloam::Status write(std::span<const uint8_t>) override { return {}; }
  gloam::Status sync() override { return {}; }
  gloam::Status close() override { return {}; }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  gloam::McapLimits limits;
  limits.chunk_bytes = 1 << 20;
  limits.any_ratio_bytes = 1 << 18;
  const auto source = gloam::make_memory_source({data, data + size}, "fuzz.mcap");
  gloam::McapWriter writer(std::make_unique<NullSink>(), {.zstd_level = 0});
  (void)gloam::recover_log(*source, limits, &writer).ok();
  const gloam::Result<gloam::McapReader> reader = gloam::McapReader::open(source, limits);
  if (!reader) return 0;
  (void)gloam::describe(*reader);
  for (const auto& index : reader->attachments()) (void)reader->read_attachment(index).ok();
  for (const auto& index : reader->metadata()) (void)reader->read_metadata(index).ok();
  gloam::McapMessages messages = reader->messages();
  for (auto next = messages.next(); next.ok() && *next != nullptr; next = messages.next()) {
  }
  messages.seek(reader->statistics().end_time / 2);
  (void)messages.next().ok();
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned seed) {
  return gloam::mutate_structure(
      data, size, max_size, seed, [](const std::string& log, unsigned seed) {
        const gloam::McapBytes out = gloam::McapMutator(seed).mutate({log.begin(), log.end()});
        return std::string(out.begin(), out.end());
      });
}
