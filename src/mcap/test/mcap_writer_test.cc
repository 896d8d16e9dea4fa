// Logs of our own: their bytes, and what a reader makes of them.

#include "mcap/mcap_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mcap/crc32.h"
#include "mcap/mcap_decode.h"
#include "mcap/mcap_describe.h"
#include "mcap/test/mcap_test_log.h"

namespace gloam {
namespace {

std::vector<uint8_t> as_log_bytes(std::string_view text) { return {text.begin(), text.end()}; }

/// Opcodes of the records after the magic.
std::vector<int> opcodes(const LogBytes& log) {
  std::vector<int> out;
  McapRecordCursor cursor(std::span<const uint8_t>(log).subspan(8, log.size() - 16));
  while (cursor.next()) out.push_back(static_cast<int>(cursor.op()));
  EXPECT_TRUE(cursor.whole());
  return out;
}

TEST(McapCrc, IsThatOfIeee8023) {
  // Check value of CRC-32/ISO-HDLC in the catalogue of parametrised CRC algorithms.
  EXPECT_EQ(crc32_of(as_log_bytes("123456789")), 0xCBF43926u);
  EXPECT_EQ(crc32_of({}), 0u);
  const LogBytes a = as_log_bytes("1234"), b = as_log_bytes("56789");
  EXPECT_EQ(crc32_of(b, crc32_of(a)), 0xCBF43926u);
  EXPECT_EQ(crc32_join(crc32_of(a), crc32_of(b), b.size()), 0xCBF43926u);
}

TEST(McapWriter, WritesTheBytesOfTheSpecification) {
  const auto bytes = std::make_shared<LogBytes>();
  McapWriter writer(std::make_unique<MemorySink>(bytes), {.library = "lib", .zstd_level = 0});
  ASSERT_TRUE(writer.add_channel({7, 0, "t", "cdr", {{"k", "v"}}}).ok());
  const LogBytes data = {0xAB};
  ASSERT_TRUE(writer.add_message({7, 3, 5, 6, data}).ok());
  ASSERT_TRUE(writer.flush().ok());
  const std::string front(
      "\x89MCAP0\r\n"
      "\x01\x0F\0\0\0\0\0\0\0\4\0\0\0ros2\3\0\0\0lib"                                   // Header
      "\x04\x1E\0\0\0\0\0\0\0\7\0\0\0\1\0\0\0t\3\0\0\0cdr\x0A\0\0\0\1\0\0\0k\1\0\0\0v"  // Channel
      "\x06\x48\0\0\0\0\0\0\0\5\0\0\0\0\0\0\0\5\0\0\0\0\0\0\0\x20\0\0\0\0\0\0\0",       // Chunk
      8 + 24 + 39 + 9 + 24);
  ASSERT_GT(bytes->size(), front.size());
  EXPECT_EQ(std::string(bytes->begin(), bytes->begin() + static_cast<long>(front.size())), front);
  const std::string message(
      "\x05\x17\0\0\0\0\0\0\0\7\0\3\0\0\0\5\0\0\0\0\0\0\0\6\0\0\0\0\0\0\0\xAB", 32);
  const std::string index("\x07\x16\0\0\0\0\0\0\0\7\0\x10\0\0\0\5\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0",
                          31);
  const std::string end(bytes->end() - static_cast<long>(message.size() + index.size()),
                        bytes->end());
  EXPECT_EQ(end, message + index);
  const LogBytes chunk = as_log_bytes(message);
  McapDecoder crc(std::span<const uint8_t>(*bytes).subspan(front.size()));
  EXPECT_EQ(crc.u32(), crc32_of(chunk));
}

TEST(McapWriter, EndsWithSummaryOffsetsAndChecksums) {
  const LogBytes log = write_log(numbered_messages(3), {.zstd_level = 0});
  EXPECT_THAT(opcodes(log),
              testing::ElementsAre(1, 3, 4, 4, 6, 7, 7, 15, 3, 4, 4, 11, 8, 14, 14, 14, 14, 2));
  EXPECT_TRUE(std::equal(kMcapMagic.begin(), kMcapMagic.end(), log.end() - 8));
  McapFooter footer;
  ASSERT_TRUE(decode(std::span<const uint8_t>(log).subspan(log.size() - 28, 20), &footer));
  const auto covered = std::span<const uint8_t>(log).subspan(
      footer.summary_start, log.size() - 12 - footer.summary_start);
  EXPECT_EQ(footer.summary_crc, crc32_of(covered));
  EXPECT_EQ(log[footer.summary_start], 3);
  EXPECT_EQ(log[footer.summary_offset_start], 14);
  // DataEnd stands in front of the summary; its CRC covers all before it.
  const uint64_t data_end = footer.summary_start - 13;
  McapDecoder in(std::span<const uint8_t>(log).subspan(data_end + 9));
  EXPECT_EQ(in.u32(), crc32_of(std::span<const uint8_t>(log).first(data_end)));
}

TEST(McapWriter, AnEmptyLogIsWhole) {
  const auto bytes = std::make_shared<LogBytes>();
  McapWriter writer(std::make_unique<MemorySink>(bytes));
  ASSERT_TRUE(writer.finish().ok());
  const Result<McapReader> reader = McapReader::open(make_memory_source(*bytes));
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(reader->by_summary());
  EXPECT_EQ(reader->header().profile, "ros2");
  EXPECT_EQ(reader->header().library.substr(0, 6), "gloam ");
  std::string error;
  EXPECT_TRUE(read_all(reader->messages(), &error).empty());
  EXPECT_EQ(error, "");
}

TEST(McapWriter, RoundTripsWithEveryOption) {
  const std::vector<TestMessage> messages = numbered_messages(1000, 300);
  for (const int level : {0, 1, 3}) {
    for (const uint64_t chunk : {uint64_t{1}, uint64_t{5000}, uint64_t{1} << 20}) {
      const LogBytes log = write_log(messages, {.chunk_size = chunk, .zstd_level = level});
      std::string error;
      const std::vector<TestMessage> found = read_log(log, &error);
      EXPECT_EQ(error, "");
      EXPECT_EQ(found.size(), messages.size());
      EXPECT_TRUE(is_prefix(found, messages)) << level << " " << chunk;
    }
  }
}

TEST(McapWriter, AMessageMayBeLargerThanAChunk) {
  std::vector<TestMessage> messages = numbered_messages(3);
  messages[1].data.assign(5 << 20, 9);
  std::string error;
  const LogBytes log = write_log(messages);
  EXPECT_TRUE(is_prefix(read_log(log, &error), messages));
  EXPECT_EQ(error, "");
  EXPECT_EQ(McapReader::open(make_memory_source(log))->statistics().chunks, 3u);
}

TEST(McapWriter, ZerosByTheHundredMegabytesAreReadAgain) {
  std::vector<TestMessage> messages = numbered_messages(1);
  messages[0].data.assign(40 << 20, 0);  // as zstd it would look like a decompression bomb
  std::string error;
  EXPECT_TRUE(is_prefix(read_log(write_log(messages), &error), messages));
  EXPECT_EQ(error, "");
}

TEST(McapWriter, TakesAllIdsThatThereAre) {
  const auto bytes = std::make_shared<LogBytes>();
  McapWriter writer(std::make_unique<MemorySink>(bytes));
  ASSERT_TRUE(writer.add_schema(test_schema(65535)).ok());
  const LogBytes data = {1, 2};
  for (uint32_t id = 0; id < 65535; ++id)
    ASSERT_TRUE(writer.add_channel(test_channel(static_cast<uint16_t>(id), 65535)).ok());
  for (uint32_t id = 0; id < 65535; ++id)
    ASSERT_TRUE(writer.add_message({static_cast<uint16_t>(id), id, id, id, data}).ok());
  ASSERT_TRUE(writer.finish().ok());
  const Result<McapReader> reader = McapReader::open(make_memory_source(*bytes));
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(reader->by_summary());
  EXPECT_EQ(reader->channels().size(), 65535u);
  EXPECT_EQ(describe(*reader).topics.size(), 65535u);
  std::string error;
  EXPECT_EQ(read_all(reader->messages(), &error).size(), 65535u);
  EXPECT_EQ(error, "");
  // Without the summary, too.
  LogBytes cut(*bytes);
  cut.resize(cut.size() - 1);
  EXPECT_EQ(McapReader::open(make_memory_source(cut))->channels().size(), 65535u);
}

TEST(McapWriter, KeepsAttachmentsMetadataAndPrivateRecords) {
  const auto bytes = std::make_shared<LogBytes>();
  McapWriter writer(std::make_unique<MemorySink>(bytes));
  const McapAttachment file{5, 4, "map.png", "image/png", {1, 2, 3}};
  ASSERT_TRUE(writer.add_attachment(file).ok());
  ASSERT_TRUE(writer.add_metadata({"run", {{"seed", "7"}, {"scene", "demo"}}}).ok());
  ASSERT_TRUE(writer.add_private(McapOp{0x99}, file.data).ok());
  EXPECT_FALSE(writer.add_private(McapOp{0x10}, file.data).ok());
  ASSERT_TRUE(writer.finish().ok());
  for (const size_t cut : {0, 1}) {  // with the summary and without
    LogBytes log(bytes->begin(), bytes->end() - static_cast<long>(cut));
    const Result<McapReader> reader = McapReader::open(make_memory_source(log));
    ASSERT_TRUE(reader.ok());
    EXPECT_EQ(reader->by_summary(), cut == 0);
    ASSERT_EQ(reader->attachments().size(), 1u);
    const Result<McapAttachment> read = reader->read_attachment(reader->attachments()[0]);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read->data, file.data);
    EXPECT_EQ(read->name, "map.png");
    EXPECT_EQ(read->log_time, 5u);
    ASSERT_EQ(reader->metadata().size(), 1u);
    EXPECT_EQ(reader->read_metadata(reader->metadata()[0])->values.at("seed"), "7");
    EXPECT_THAT(opcodes(recover_bytes(log).bytes), testing::Contains(0x99));
  }
}

TEST(McapWriter, RefusesWhatWouldBeNoLog) {
  const auto bytes = std::make_shared<LogBytes>();
  McapWriter writer(std::make_unique<MemorySink>(bytes));
  EXPECT_FALSE(writer.add_schema(test_schema(0)).ok());
  EXPECT_FALSE(writer.add_channel(test_channel(1)).ok()) << "its schema is unknown";
  const LogBytes data = {1};
  EXPECT_FALSE(writer.add_message({9, 0, 0, 0, data}).ok());
  ASSERT_TRUE(declare_two(&writer).ok());
  EXPECT_TRUE(declare_two(&writer).ok()) << "the same again";
  McapChannel other = test_channel(1);
  other.topic = "/other";
  EXPECT_FALSE(writer.add_channel(other).ok());
  EXPECT_TRUE(writer.add_message({1, 0, 0, 0, data}).ok()) << "after refusals it goes on";
  EXPECT_TRUE(writer.finish().ok());
}

TEST(McapWriter, SyncsEachChunkWhereItIsToBeDurable) {
  for (const bool durable : {false, true}) {
    auto sink = std::make_unique<MemorySink>(std::make_shared<LogBytes>());
    MemorySink* seen = sink.get();
    McapWriter writer(std::move(sink), {.chunk_size = 1, .durable = durable});
    ASSERT_TRUE(declare_two(&writer).ok());
    const int before = seen->syncs;
    for (uint32_t i = 0; i < 10; ++i) ASSERT_TRUE(writer.add_message(view(numbered(i))).ok());
    EXPECT_EQ(seen->syncs - before, durable ? 10 : 0);
  }
}

TEST(McapWriter, DescribesTheLog) {
  const McapInfo info =
      describe(*McapReader::open(make_memory_source(write_log(numbered_messages(101, 1000)))));
  EXPECT_EQ(info.messages, 101u);
  EXPECT_DOUBLE_EQ(info.duration, 0.1);
  ASSERT_EQ(info.topics.size(), 2u);
  EXPECT_EQ(info.topics[0].topic, "/topic_1");
  EXPECT_EQ(info.topics[0].type, "test_msgs/msg/Blob");
  EXPECT_EQ(info.topics[0].messages, 51u);
  EXPECT_NEAR(info.topics[0].rate, 500, 1e-9);
  EXPECT_EQ(info.chunks_by_compression.at("zstd"), 1u);
  EXPECT_GT(info.compression_ratio, 1.3);
}

}  // namespace
}  // namespace gloam
