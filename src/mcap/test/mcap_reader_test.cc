// Order, seeking, filters, and logs that others write differently or that lie.

#include "mcap/mcap_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "mcap/crc32.h"
#include "mcap/mcap_decode.h"
#include "mcap/mcap_encode.h"
#include "mcap/test/mcap_test_log.h"

namespace gloam {
namespace {

/// Chunk record of given parts, which need not be true.
struct RawChunk {
  uint64_t start = 0, end = 0, uncompressed = 0;
  uint32_t crc = 0;
  std::string compression;
  LogBytes records;
};

void append_chunk(LogBytes* out, const RawChunk& chunk) {
  McapRecordScope record(out, McapOp::kChunk);
  record.put_u64(chunk.start);
  record.put_u64(chunk.end);
  record.put_u64(chunk.uncompressed);
  record.put_u32(chunk.crc);
  record.put_text(chunk.compression);
  record.put_u64(chunk.records.size());
  record.put_bytes(chunk.records);
}

LogBytes log_front() {
  LogBytes out;
  append_magic(&out);
  append_record(&out, McapHeader{"ros2", "someone"});
  append_record(&out, test_schema());
  append_record(&out, test_channel(1));
  append_record(&out, test_channel(2));
  return out;
}

/// DataEnd, a footer without a summary, magic.
LogBytes with_end(LogBytes log) {
  append_data_end(&log, 0);
  {
    McapRecordScope footer(&log, McapOp::kFooter);
    footer.put_u64(0);
    footer.put_u64(0);
    footer.put_u32(0);
  }
  append_magic(&log);
  return log;
}

LogBytes message_records(const std::vector<TestMessage>& messages) {
  LogBytes records;
  for (const TestMessage& m : messages) append_record(&records, view(m));
  return records;
}

LogBytes lz4_frame(const LogBytes& bytes, LZ4F_blockMode_t mode) {
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.blockMode = mode;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  LogBytes out(LZ4F_compressFrameBound(bytes.size(), &preferences));
  out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), &preferences));
  return out;
}

std::string open_error(const LogBytes& log) {
  std::string error;
  Result<McapReader> reader = McapReader::open(make_memory_source(log, "test.mcap"));
  if (!reader) return reader.error().to_string();
  (void)read_all(reader->messages(), &error);
  return error.empty() ? reader->damage() : error;
}

TEST(McapReader, MergesChunksThatOverlap) {
  std::vector<TestMessage> messages;
  for (uint32_t i = 0; i < 2000; ++i) {
    TestMessage m = numbered(i);
    // Delays of up to 64 ms, and pairs of equal times.
    m.log_time = 1000000 * uint64_t{i / 2} + 1000000 * (i * 7919u % 64);
    messages.push_back(m);
  }
  const LogBytes log = write_log(messages, {.chunk_size = 1500});
  std::string error;
  const std::vector<TestMessage> found = read_log(log, &error);
  EXPECT_EQ(error, "");
  std::stable_sort(messages.begin(), messages.end(),
                   [](const auto& a, const auto& b) { return a.log_time < b.log_time; });
  EXPECT_EQ(found.size(), messages.size());
  EXPECT_TRUE(is_prefix(found, messages)) << "by time, and within one time as written";
}

TEST(McapReader, FiltersByTopicAndTime) {
  const std::vector<TestMessage> messages = numbered_messages(1000);
  const LogBytes log = write_log(messages, {.chunk_size = 2000});
  std::string error;
  const auto found = read_log(log, &error, {{"/topic_2"}, 100000000, uint64_t{200000000}});
  EXPECT_EQ(error, "");
  ASSERT_EQ(found.size(), 50u);
  EXPECT_EQ(found.front().sequence, 101u);
  EXPECT_EQ(found.back().sequence, 199u) << "the end is not taken";
  EXPECT_TRUE(read_log(log, &error, {{"/nothing"}, 0, {}}).empty());
  EXPECT_TRUE(read_log(log, &error, {{}, 2000000000, {}}).empty());
  EXPECT_EQ(error, "");
}

TEST(McapReader, SeeksBackAndForthByTheChunksItNeeds) {
  const LogBytes log = write_log(numbered_messages(10000, 100), {.chunk_size = 10000});
  const Result<McapReader> reader = McapReader::open(make_memory_source(log));
  ASSERT_TRUE(reader.ok());
  ASSERT_GT(reader->pieces().size(), 100u);
  McapMessages messages = reader->messages();
  for (const uint32_t number : {9000u, 17u, 5000u, 9999u, 0u}) {
    const uint64_t before = messages.chunks_read();
    messages.seek(1000000 * uint64_t{number});
    const Result<const McapMessage*> next = messages.next();
    ASSERT_TRUE(next.ok() && *next != nullptr);
    EXPECT_EQ((*next)->sequence, number);
    EXPECT_LE(messages.chunks_read(), before + 2);
  }
  messages.seek(10000 * uint64_t{1000000});
  EXPECT_EQ(*messages.next(), nullptr);
}

TEST(McapReader, SkipsChunksWithoutTheTopic) {
  std::vector<TestMessage> messages = numbered_messages(1000);
  for (TestMessage& m : messages) m.channel = m.sequence == 500 ? 2 : 1;
  const LogBytes log = write_log(messages, {.chunk_size = 2000});
  const Result<McapReader> reader = McapReader::open(make_memory_source(log));
  ASSERT_TRUE(reader.ok());
  McapMessages found = reader->messages({{"/topic_2"}, 0, {}});
  EXPECT_EQ((*found.next())->sequence, 500u);
  EXPECT_EQ(*found.next(), nullptr);
  EXPECT_EQ(found.chunks_read(), 1u);
}

TEST(McapReader, ReadsEveryCompressionThatOthersWrite) {
  const std::vector<TestMessage> messages = numbered_messages(3000, 100);
  const LogBytes records = message_records(messages);
  LogBytes zstd(ZSTD_compressBound(records.size()));
  zstd.resize(ZSTD_compress(zstd.data(), zstd.size(), records.data(), records.size(), 3));
  const std::vector<std::pair<std::string, LogBytes>> kinds = {
      {"", records},
      {"zstd", zstd},
      {"lz4", lz4_frame(records, LZ4F_blockIndependent)},
      {"lz4", lz4_frame(records, LZ4F_blockLinked)}};
  for (const auto& [name, bytes] : kinds) {
    LogBytes log = log_front();
    append_chunk(&log, {0, 3000000000, records.size(), crc32_of(records), name, bytes});
    std::string error;
    const auto found = read_log(with_end(log), &error);
    EXPECT_EQ(error, "") << name;
    EXPECT_TRUE(found.size() == messages.size() && is_prefix(found, messages)) << name;
  }
}

TEST(McapReader, ReadsMessagesOutsideChunks) {
  const std::vector<TestMessage> messages = numbered_messages(500);
  LogBytes log = log_front();
  for (const TestMessage& m : messages) {
    append_record(&log, view(m));
    if (m.sequence == 100) append_record(&log, McapMetadata{"between", {{"a", "b"}}});
    if (m.sequence == 200) append_record(&log, test_channel(3));
  }
  std::string error;
  const auto found = read_log(with_end(log), &error);
  EXPECT_EQ(error, "");
  EXPECT_TRUE(found.size() == messages.size() && is_prefix(found, messages));
  const auto reader = McapReader::open(make_memory_source(with_end(log)));
  EXPECT_EQ(reader->damage(), "");
  EXPECT_EQ(reader->pieces().size(), 3u);
  EXPECT_EQ(reader->statistics().messages, 500u);
}

TEST(McapReader, AnswersALyingChunk) {
  const LogBytes records = message_records(numbered_messages(10));
  const uint64_t size = records.size();
  LogBytes bomb(ZSTD_compressBound(64 << 20));
  const LogBytes zeros(64 << 20, 0);
  bomb.resize(ZSTD_compress(bomb.data(), bomb.size(), zeros.data(), zeros.size(), 1));
  LogBytes zstd(ZSTD_compressBound(size));
  zstd.resize(ZSTD_compress(zstd.data(), zstd.size(), records.data(), size, 3));
  const uint32_t crc = crc32_of(records);
  const std::vector<std::pair<RawChunk, std::string>> cases = {
      {{0, 9000000, size, crc + 1, "", records}, "CRC of a chunk is wrong"},
      {{0, 9000000, size + 1, crc, "", records}, "but declares"},
      {{0, 9000000, size + 1, crc, "zstd", zstd}, "after decompression"},
      {{0, 9000000, size - 1, crc, "zstd", zstd}, "zstd: "},
      {{0, 9000000, size, crc, "zstd", records}, "zstd: "},
      {{0, 9000000, size, crc, "lz4", records}, "lz4: "},
      {{0, 9000000, size - 1, 0, "lz4", lz4_frame(records, LZ4F_blockIndependent)}, "lz4: "},
      {{0, 9000000, size + 1, 0, "lz4", lz4_frame(records, LZ4F_blockIndependent)}, "lz4: "},
      {{0, 9000000, size, crc, "bz2", records}, "unsupported compression 'bz2'"},
      {{0, 9000000, uint64_t{64} << 20, 0, "zstd", bomb}, "compressed bytes"},
      {{0, 9000000, uint64_t{1} << 40, 0, "zstd", zstd}, "the limit is"},
      {{0, 9000000, size - 1, 0, "", LogBytes(records.begin(), records.end() - 1)},
       "incomplete records"},
  };
  for (const auto& [chunk, cause] : cases) {
    LogBytes log = log_front();
    const size_t at = log.size();
    append_chunk(&log, chunk);
    const std::string error = open_error(with_end(log));
    EXPECT_THAT(error, testing::HasSubstr(cause));
    EXPECT_THAT(error, testing::HasSubstr("byte " + std::to_string(at))) << "where";
  }
}

TEST(McapReader, AnswersFilesThatAreNoLogs) {
  EXPECT_THAT(open_error({}), testing::HasSubstr("not an MCAP log"));
  EXPECT_THAT(open_error({'#', 'R', 'O', 'S', 'B', 'A', 'G', ' '}),
              testing::HasSubstr("test.mcap: byte 0: is not an MCAP log"));
  LogBytes later = write_log({});
  later[5] = '1';
  EXPECT_THAT(open_error(later), testing::HasSubstr("version 0"));
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / ("mcap_" + std::to_string(getpid()));
  fs::create_directories(folder);
  EXPECT_FALSE(McapReader::open(folder).ok());
  EXPECT_FALSE(McapReader::open(folder / "missing.mcap").ok());
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_FALSE(McapReader::open(folder / "pipe").ok());
  fs::remove_all(folder);
}

TEST(McapReader, UsesASummaryOnlyIfItTellsAll) {
  const std::vector<TestMessage> messages = numbered_messages(100);
  const LogBytes log = write_log(messages, {.chunk_size = 1000});
  McapFooter footer;
  ASSERT_TRUE(decode(std::span<const uint8_t>(log).subspan(log.size() - 28, 20), &footer));
  const auto begin = log.begin() + static_cast<long>(footer.summary_start);
  const auto end = log.begin() + static_cast<long>(footer.summary_offset_start);
  const LogBytes summary(begin, end);
  for (const McapOp left_out : {McapOp::kChannel, McapOp::kStatistics, McapOp::kChunkIndex}) {
    LogBytes other(log.begin(), begin);
    const size_t start = other.size();
    McapRecordCursor cursor(summary);
    while (cursor.next()) {
      if (cursor.op() != left_out) McapRecordScope(&other, cursor.op()).put_bytes(cursor.content());
    }
    append_footer(&other, {start, 0, 0}, start);
    append_magic(&other);
    const auto reader = McapReader::open(make_memory_source(other));
    ASSERT_TRUE(reader.ok());
    EXPECT_FALSE(reader->by_summary());
    std::string error;
    const auto found = read_all(reader->messages(), &error);
    EXPECT_TRUE(found.size() == messages.size() && is_prefix(found, messages)) << error;
  }
  LogBytes damaged = log;
  damaged[footer.summary_start + 12] ^= 1;
  const auto reader = McapReader::open(make_memory_source(damaged));
  ASSERT_TRUE(reader.ok());
  EXPECT_FALSE(reader->by_summary()) << "its CRC is wrong";
  EXPECT_EQ(reader->statistics().messages, 100u);
}

TEST(McapReader, BoundsWhatOverlapsInMemory) {
  std::vector<TestMessage> messages = numbered_messages(64, 1 << 16);
  for (TestMessage& m : messages) m.log_time = 0;
  const LogBytes log = write_log(messages, {.chunk_size = 1});
  const auto reader = McapReader::open(make_memory_source(log), {.open_bytes = uint64_t{1} << 19});
  std::string error;
  EXPECT_TRUE(read_all(reader->messages(), &error).empty());
  EXPECT_THAT(error, testing::HasSubstr("overlap in time"));
  // One after the other they need little.
  for (TestMessage& m : messages) m.log_time = m.sequence;
  const auto apart = McapReader::open(make_memory_source(write_log(messages, {.chunk_size = 1})),
                                      {.open_bytes = uint64_t{1} << 19});
  error.clear();
  EXPECT_EQ(read_all(apart->messages(), &error).size(), 64u);
  EXPECT_EQ(error, "");
}

TEST(McapReader, AnswersAnIndexOfOtherTimes) {
  const LogBytes log = write_log(numbered_messages(100), {.zstd_level = 0});
  McapFooter footer;
  ASSERT_TRUE(decode(std::span<const uint8_t>(log).subspan(log.size() - 28, 20), &footer));
  LogBytes other(log.begin(), log.begin() + static_cast<long>(footer.summary_start));
  const size_t start = other.size();
  McapRecordCursor cursor(std::span<const uint8_t>(log).subspan(
      footer.summary_start, footer.summary_offset_start - footer.summary_start));
  while (cursor.next()) {
    McapChunkIndex index;
    if (cursor.op() == McapOp::kChunkIndex && decode(cursor.content(), &index)) {
      index.start_time = 50;
      append_record(&other, index);
    } else {
      McapRecordScope(&other, cursor.op()).put_bytes(cursor.content());
    }
  }
  append_footer(&other, {start, 0, 0}, start);
  append_magic(&other);
  EXPECT_THAT(open_error(other), testing::HasSubstr("contains a message at 0 ns"));
}

}  // namespace
}  // namespace gloam
