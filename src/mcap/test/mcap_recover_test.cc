// Logs that are cut, damaged, or whose disk failed: what comes out is whole, checked and in order.

#include "mcap/mcap_recover.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "base/files.h"
#include "base/rng.h"
#include "mcap/test/mcap_test_log.h"

namespace gloam {
namespace {

/// The recovered log opens by its summary, and its messages are the first of `expected`; how many.
size_t check_prefix(const LogBytes& damaged, const std::vector<TestMessage>& expected) {
  const Recovered out = recover_bytes(damaged);
  if (!out.report) {
    // Only a log without its header is beyond help.
    EXPECT_LT(damaged.size(), 64u) << out.report.error().to_string();
    return 0;
  }
  const Result<McapReader> reader = McapReader::open(make_memory_source(out.bytes));
  EXPECT_TRUE(reader.ok() && reader->by_summary());
  std::string error;
  const std::vector<TestMessage> found = read_all(reader->messages(), &error);
  EXPECT_EQ(error, "");
  EXPECT_TRUE(is_prefix(found, expected));
  EXPECT_EQ(found.size(), out.report->messages);
  return found.size();
}

TEST(McapRecover, AWholeLogStaysWhole) {
  const std::vector<TestMessage> messages = numbered_messages(1000);
  const Recovered out = recover_bytes(write_log(messages, {.chunk_size = 3000}));
  ASSERT_TRUE(out.report.ok());
  EXPECT_TRUE(out.report->whole);
  EXPECT_EQ(out.report->messages, 1000u);
  EXPECT_EQ(out.report->messages_lost, 0u);
  EXPECT_TRUE(out.report->counted);
  EXPECT_EQ(out.report->bytes_lost, 0u);
  std::string error;
  EXPECT_EQ(read_log(out.bytes, &error).size(), 1000u);
}

TEST(McapRecover, CutAtEveryByteOfASmallLog) {
  const std::vector<TestMessage> messages = numbered_messages(60, 30);
  const LogBytes log = write_log(messages, {.chunk_size = 500});
  size_t before = 0;
  for (size_t size = 0; size <= log.size(); ++size) {
    const size_t found =
        check_prefix({log.begin(), log.begin() + static_cast<long>(size)}, messages);
    ASSERT_GE(found, before) << "more of the log has fewer messages";
    ASSERT_FALSE(HasFailure()) << "cut at byte " << size;
    before = found;
  }
  EXPECT_EQ(before, messages.size());
}

TEST(McapRecover, CutAtEverySixtyFourth) {
  const std::vector<TestMessage> messages = numbered_messages(20000, 100);
  const LogBytes log = write_log(messages, {.chunk_size = 20000});
  for (size_t part = 1; part < 64; ++part) {
    const size_t size = log.size() * part / 64;
    const size_t found =
        check_prefix({log.begin(), log.begin() + static_cast<long>(size)}, messages);
    ASSERT_FALSE(HasFailure()) << part;
    EXPECT_NEAR(static_cast<double>(found), 20000.0 * static_cast<double>(part) / 64, 700);
  }
}

TEST(McapRecover, EachOfTheFirst500WritesMayFail) {
  using Failure = MemorySink::Failure;
  const std::vector<TestMessage> messages = numbered_messages(1100, 20);
  for (const Failure failure : {Failure::kNoSpace, Failure::kIo, Failure::kShortWrite}) {
    for (int fails_at = 0; fails_at < 500; ++fails_at) {
      const auto bytes = std::make_shared<LogBytes>();
      McapWriter writer(std::make_unique<MemorySink>(bytes, fails_at, failure),
                        {.chunk_size = 100});
      Status status = declare_two(&writer);
      size_t accepted = 0;
      for (; status.ok() && accepted < messages.size(); ++accepted)
        status = writer.add_message(view(messages[accepted]));
      ASSERT_FALSE(status.ok());
      EXPECT_THAT(status.error().message,
                  testing::HasSubstr(failure == Failure::kIo ? "Input/output error" : "No space"));
      EXPECT_THAT(status.error().message, testing::HasSubstr(std::to_string(writer.safe_bytes()) +
                                                             " bytes of the log are safe"));
      const size_t size = bytes->size();
      EXPECT_FALSE(writer.add_message(view(messages[0])).ok()) << "it refuses what follows";
      EXPECT_FALSE(writer.flush().ok());
      EXPECT_FALSE(writer.finish().ok());
      EXPECT_EQ(bytes->size(), size) << "and writes nothing more";
      const size_t found = check_prefix(*bytes, messages);
      // Messages that were accepted are there, all but those of the chunk that failed.
      EXPECT_GE(found + 4, accepted);
      ASSERT_FALSE(HasFailure()) << "write " << fails_at;
    }
  }
}

TEST(McapRecover, ADamagedChunkLosesItsOwnMessagesAlone) {
  const std::vector<TestMessage> messages = numbered_messages(1000, 100);
  const LogBytes log = write_log(messages, {.chunk_size = 10000});
  const auto reader = McapReader::open(make_memory_source(log));
  const McapChunkIndex& chunk = reader->pieces()[3].index;
  for (const bool with_summary : {true, false}) {
    LogBytes damaged = log;
    damaged[chunk.offset + chunk.length / 2] ^= 0x10;
    if (!with_summary) damaged.resize(damaged.size() - 10);
    const Recovered out = recover_bytes(damaged);
    ASSERT_TRUE(out.report.ok());
    EXPECT_FALSE(out.report->whole);
    EXPECT_EQ(out.report->chunks_lost, 1u);
    EXPECT_EQ(out.report->counted, with_summary);
    EXPECT_EQ(out.report->messages + out.report->messages_lost, 1000u);
    EXPECT_GE(out.report->bytes_lost, chunk.length);
    ASSERT_FALSE(out.report->damage.empty());
    EXPECT_THAT(out.report->damage[0], testing::HasSubstr("byte " + std::to_string(chunk.offset)));
    std::string error;
    const auto found = read_log(out.bytes, &error);
    EXPECT_EQ(error, "");
    EXPECT_EQ(found.size(), out.report->messages);
    EXPECT_EQ(found.back().sequence, 999u) << "what stands behind it is kept";
  }
}

TEST(McapRecover, GoesOnBehindALostLengthByTheSummary) {
  const LogBytes log = write_log(numbered_messages(1000, 100), {.chunk_size = 10000});
  const auto reader = McapReader::open(make_memory_source(log));
  LogBytes damaged = log;
  damaged[reader->pieces()[3].index.offset + 2] ^= 0xFF;  // of its length
  damaged[reader->pieces()[7].index.offset] = 0;          // no opcode
  const Recovered out = recover_bytes(damaged);
  ASSERT_TRUE(out.report.ok());
  EXPECT_TRUE(out.report->counted);
  EXPECT_EQ(out.report->messages + out.report->messages_lost, 1000u);
  EXPECT_GT(out.report->messages, 800u);
  EXPECT_LT(out.report->messages, 900u);
  std::string error;
  EXPECT_EQ(read_log(out.bytes, &error).back().sequence, 999u);
}

TEST(McapRecover, TakesALostChannelFromTheSummary) {
  const std::vector<TestMessage> messages = numbered_messages(10);
  LogBytes log = write_log(messages);
  const std::string topic = "/topic_2";
  const auto at = std::search(log.begin(), log.end(), topic.begin(), topic.end());
  *(at - 17) = 0x44;  // opcode of its own record, not of that in the summary
  const Recovered out = recover_bytes(log);
  ASSERT_TRUE(out.report.ok());
  EXPECT_EQ(out.report->messages, 10u);
}

TEST(McapRecover, RefusesWhatIsNoLogAndKeepsFilesThatAreThere) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / ("recover_" + std::to_string(getpid()));
  fs::create_directories(folder);
  ASSERT_TRUE(write_text_file_atomic(folder / "text", "not a log").ok());
  EXPECT_FALSE(recover_log_file(folder / "text", folder / "out").ok());
  EXPECT_FALSE(fs::exists(folder / "out"));
  ASSERT_TRUE(write_file_atomic(folder / "log.mcap", write_log(numbered_messages(5))).ok());
  EXPECT_FALSE(recover_log_file(folder / "log.mcap", folder / "text").ok());
  EXPECT_EQ(*read_text_file(folder / "text"), "not a log");
  const auto report = recover_log_file(folder / "log.mcap", folder / "out");
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->messages, 5u);
  EXPECT_TRUE(McapReader::open(folder / "out")->by_summary());
  fs::remove_all(folder);
}

/// Child of the kill test: writes numbered messages for ever and flushes each 50 ms.
[[noreturn]] void write_until_killed(const std::filesystem::path& path,
                                     std::atomic<uint32_t>* flushed) {
  Result<std::unique_ptr<LogSink>> sink = FileSink::create(path);
  if (!sink) _exit(1);
  McapWriter writer(std::move(*sink), {.chunk_size = 64 * 1024});
  if (!declare_two(&writer).ok()) _exit(1);
  auto last = std::chrono::steady_clock::now();
  for (uint32_t number = 0;; ++number) {
    if (!writer.add_message(view(numbered(number, 200))).ok()) _exit(1);
    if (const auto now = std::chrono::steady_clock::now();
        now - last >= std::chrono::milliseconds(50)) {
      if (!writer.flush().ok()) _exit(1);
      flushed->store(number + 1);
      last = now;
    }
  }
}

void kill_and_recover(int times) {
  namespace fs = std::filesystem;
  void* shared = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  auto* flushed = new (shared) std::atomic<uint32_t>(0);
  const fs::path folder = fs::path(testing::TempDir()) / ("kill_" + std::to_string(getpid()));
  fs::create_directories(folder);
  for (int round = 0; round < times; ++round) {
    const fs::path log = folder / "log.mcap", whole = folder / "whole.mcap";
    fs::remove(log);
    fs::remove(whole);
    flushed->store(0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) write_until_killed(log, flushed);
    const uint32_t wait = RandomStream{99, 3}.draw(static_cast<uint64_t>(round), 0).v[0] % 60;
    std::this_thread::sleep_for(std::chrono::milliseconds(60 + wait));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child ended by itself";
    if (!fs::exists(log) || fs::file_size(log) < 64) continue;  // killed before it began
    const Result<McapRecovery> report = recover_log_file(log, whole);
    ASSERT_TRUE(report.ok()) << report.error().to_string();
    EXPECT_GE(report->messages, flushed->load()) << "what was flushed is lost";
    const Result<McapReader> reader = McapReader::open(whole);
    ASSERT_TRUE(reader.ok());
    McapMessages messages = reader->messages();
    uint32_t number = 0;
    for (auto next = messages.next(); next.ok() && *next != nullptr; next = messages.next())
      ASSERT_EQ((*next)->sequence, number++);
    EXPECT_EQ(number, report->messages);
  }
  fs::remove_all(folder);
  ::munmap(shared, 4096);
}

TEST(McapKill, LosesAtMostTheLastFlushIntervalInTwentyKills) { kill_and_recover(20); }
TEST(McapKill, DISABLED_SweepLosesAtMostTheLastFlushIntervalIn200Kills) { kill_and_recover(200); }

}  // namespace
}  // namespace gloam
