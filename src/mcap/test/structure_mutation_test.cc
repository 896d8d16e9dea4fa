// Logs whose records are damaged, but not the container: lengths, CRCs and indexes are right, so
// that damage gets behind their checks.

#include <gtest/gtest.h>

#include "mcap/mcap_describe.h"
#include "mcap/test/mcap_mutator.h"
#include "mcap/test/mcap_test_log.h"

namespace gloam {
namespace {

LogBytes seed_log(int zstd_level) {
  const auto bytes = std::make_shared<LogBytes>();
  McapWriter writer(std::make_unique<MemorySink>(bytes),
                    {.chunk_size = 600, .zstd_level = zstd_level});
  Status status = declare_two(&writer);
  for (uint32_t i = 0; i < 60 && status.ok(); ++i) status = writer.add_message(view(numbered(i)));
  if (status.ok()) status = writer.add_attachment({1, 2, "a.txt", "text/plain", {1, 2, 3}});
  if (status.ok()) status = writer.add_metadata({"run", {{"seed", "7"}}});
  if (status.ok()) status = writer.finish();
  EXPECT_TRUE(status.ok());
  return *bytes;
}

struct Read {
  bool opened = false;
  bool fine = false;
};

Read read_everything(const LogBytes& log) {
  const Result<McapReader> reader = McapReader::open(make_memory_source(log, "mutated"));
  if (!reader) return {};
  Read read{true, reader->damage().empty()};
  (void)describe(*reader);
  std::string error;
  const std::vector<TestMessage> found = read_all(reader->messages(), &error);
  for (size_t i = 1; i < found.size(); ++i) EXPECT_LE(found[i - 1].log_time, found[i].log_time);
  for (const auto& index : reader->attachments()) read.fine &= reader->read_attachment(index).ok();
  for (const auto& index : reader->metadata()) read.fine &= reader->read_metadata(index).ok();
  const Recovered out = recover_bytes(log);
  if (out.report.ok()) {
    std::string again;
    EXPECT_EQ(read_log(out.bytes, &again).size(), out.report->messages);
    EXPECT_EQ(again, "") << "a recovered log is whole";
  }
  read.fine &= error.empty();
  return read;
}

TEST(StructureMutations, TheTreeOfALogIsTheLog) {
  for (const int level : {0, 1}) {
    const LogBytes seed = seed_log(level);
    const McapTree tree = read_mcap_tree(std::span<const uint8_t>(seed).subspan(8));
    for (const bool has_summary : {false, true}) {
      std::string error;
      EXPECT_EQ(read_log(McapTreeWriter().write(tree, has_summary), &error).size(), 60u);
      EXPECT_EQ(error, "");
    }
  }
}

TEST(StructureMutations, LogsDoNoHarm) {
  const std::vector<LogBytes> seeds = {seed_log(0), seed_log(1)};
  const size_t count = mutation_count();
  size_t opened = 0, fine = 0;
  for (size_t i = 0; i < count; ++i) {
    const Read read = read_everything(McapMutator(i).mutate(seeds[i % seeds.size()]));
    opened += read.opened ? 1 : 0;
    fine += read.fine ? 1 : 0;
    ASSERT_FALSE(HasFailure()) << "file " << i;
  }
  RecordProperty("past the parser", std::to_string(opened));
  RecordProperty("read to the end", std::to_string(fine));
  EXPECT_GT(opened, count / 2) << "most mutants do not get past the container";
  EXPECT_LT(fine, count * 95 / 100) << "no harm is done";
}

}  // namespace
}  // namespace gloam
