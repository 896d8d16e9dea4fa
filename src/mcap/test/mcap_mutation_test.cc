// Damaged logs: the reader and the recovery answer with an Error or with sound data.

#include <gtest/gtest.h>

#include "base/test/mutator.h"
#include "mcap/crc32.h"
#include "mcap/mcap_decode.h"
#include "mcap/mcap_describe.h"
#include "mcap/mcap_encode.h"
#include "mcap/test/mcap_test_log.h"

namespace gloam {
namespace {

LogBytes mutation_seed(int kind) {
  const auto bytes = std::make_shared<LogBytes>();
  McapWriter writer(std::make_unique<MemorySink>(bytes),
                    {.chunk_size = 600, .zstd_level = kind == 0 ? 0 : 1});
  Status status = declare_two(&writer);
  for (uint32_t i = 0; i < 60 && status.ok(); ++i) status = writer.add_message(view(numbered(i)));
  if (status.ok()) status = writer.add_attachment({1, 2, "a.txt", "text/plain", {1, 2, 3}});
  if (status.ok()) status = writer.add_metadata({"run", {{"seed", "7"}}});
  if (status.ok()) status = writer.finish();
  EXPECT_TRUE(status.ok());
  if (kind == 2) bytes->resize(bytes->size() - 40);  // without a summary
  return *bytes;
}

/// With the CRC of the summary made right again, so that damage gets further than to it.
LogBytes with_summary_crc(LogBytes log) {
  McapFooter footer;
  if (log.size() < 64 ||
      !decode(std::span<const uint8_t>(log).subspan(log.size() - 28, 20), &footer) ||
      footer.summary_start > log.size() - 37)
    return log;
  const auto covered = std::span<const uint8_t>(log).subspan(
      footer.summary_start, log.size() - 12 - footer.summary_start);
  const uint32_t crc = crc32_of(covered);
  for (size_t i = 0; i < 4; ++i) log[log.size() - 12 + i] = static_cast<uint8_t>(crc >> (8 * i));
  return log;
}

/// Reads everything; true if nothing was wrong. What comes out is checked.
bool read_damaged(const LogBytes& log) {
  bool fine = true;
  const Result<McapReader> reader = McapReader::open(make_memory_source(log, "damaged"));
  if (!reader) return false;
  fine = reader->damage().empty();
  (void)describe(*reader);
  std::string error;
  const std::vector<TestMessage> found = read_all(reader->messages(), &error);
  for (size_t i = 1; i < found.size(); ++i) EXPECT_LE(found[i - 1].log_time, found[i].log_time);
  for (const auto& index : reader->attachments()) fine &= reader->read_attachment(index).ok();
  for (const auto& index : reader->metadata()) fine &= reader->read_metadata(index).ok();
  const Recovered out = recover_bytes(log);
  if (out.report.ok()) {
    std::string again;
    EXPECT_EQ(read_log(out.bytes, &again).size(), out.report->messages);
    EXPECT_EQ(again, "") << "what was recovered is whole";
    fine &= out.report->whole;
  }
  return fine && error.empty() && out.report.ok();
}

TEST(McapMutations, AnErrorOrSoundData) {
  const std::vector<LogBytes> seeds = {mutation_seed(0), mutation_seed(1), mutation_seed(2)};
  EXPECT_TRUE(read_damaged(seeds[0]));
  EXPECT_TRUE(read_damaged(seeds[1]));
  const size_t count = mutation_count();
  size_t refused = 0;
  for (size_t i = 0; i < count; ++i) {
    const LogBytes& seed = seeds[i % 3];
    const std::string damaged = Mutator(i).mutate({seed.begin(), seed.end()});
    LogBytes log(damaged.begin(), damaged.end());
    if (i % 2 == 0) log = with_summary_crc(std::move(log));
    refused += read_damaged(log) ? 0 : 1;
    ASSERT_FALSE(HasFailure()) << "file " << i;
  }
  EXPECT_GT(refused, count / 3) << "no harm is done";
}

TEST(McapMutations, ClaimsAloneTakeNoMemory) {
  // A length of every record becomes huge.
  const LogBytes seed = mutation_seed(1);
  McapRecordCursor cursor(std::span<const uint8_t>(seed).subspan(8, seed.size() - 16));
  while (cursor.next()) {
    for (const uint64_t size : {uint64_t{1} << 30, uint64_t{1} << 40, ~uint64_t{0}}) {
      LogBytes log = seed;
      patch_u64(&log, 8 + cursor.offset() + 1, size);
      (void)read_damaged(log);
      (void)read_damaged(with_summary_crc(log));
    }
  }
}

}  // namespace
}  // namespace gloam
