#pragma once
// Logs for tests: sinks in memory, some of which fail, and messages whose content follows from
// their number.

#include <memory>
#include <string>
#include <vector>

#include "mcap/log_sink.h"
#include "mcap/log_source.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_recover.h"
#include "mcap/mcap_writer.h"

namespace gloam {

using LogBytes = std::vector<uint8_t>;

/// Keeps what is written. From write number `fails_at` on it is a full or broken disk.
class MemorySink final : public LogSink {
 public:
  enum class Failure : uint8_t { kNoSpace, kIo, kShortWrite };

  explicit MemorySink(std::shared_ptr<LogBytes> bytes, int fails_at = -1,
                      Failure failure = Failure::kNoSpace)
      : bytes_(std::move(bytes)), fails_at_(fails_at), failure_(failure) {}

  Status write(std::span<const uint8_t> bytes) override {
    if (fails_at_ >= 0 && writes_++ >= fails_at_) {
      const size_t part = failure_ == Failure::kShortWrite ? bytes.size() / 2 : 0;
      bytes_->insert(bytes_->end(), bytes.begin(), bytes.begin() + static_cast<long>(part));
      return Error{ErrorKind::kIo,
                   failure_ == Failure::kIo ? "cannot write: Input/output error"
                                            : "cannot write: No space left on device",
                   {"memory", 0, 0},
                   {}};
    }
    bytes_->insert(bytes_->end(), bytes.begin(), bytes.end());
    return {};
  }
  Status sync() override {
    ++syncs;
    return {};
  }
  Status close() override { return {}; }

  int syncs = 0;

 private:
  std::shared_ptr<LogBytes> bytes_;
  int fails_at_, writes_ = 0;
  Failure failure_;
};

/// Every other byte is noise, so that the payload compresses to about half.
LogBytes test_payload(uint32_t number, size_t size);

McapSchema test_schema(uint16_t id = 1);

McapChannel test_channel(uint16_t id, uint16_t schema = 1);

struct TestMessage {
  uint16_t channel = 1;
  uint32_t sequence = 0;
  uint64_t log_time = 0;
  LogBytes data;
};

McapMessage view(const TestMessage& m);

/// Message `number` of a simple log: two channels in turn, 1 ms apart.
TestMessage numbered(uint32_t number, size_t size = 40);

/// Declares schema 1 and channels 1 and 2.
Status declare_two(McapWriter* writer);

/// A whole log of `messages`.
LogBytes write_log(const std::vector<TestMessage>& messages, const McapWriterOptions& options = {});

std::vector<TestMessage> numbered_messages(uint32_t count, size_t size = 40);

/// All messages; an error is appended to `error` and ends it.
std::vector<TestMessage> read_all(McapMessages messages, std::string* error);

std::vector<TestMessage> read_log(const LogBytes& bytes, std::string* error,
                                  const McapQuery& query = {});

/// True if `found` are the first messages of `expected`.
bool is_prefix(const std::vector<TestMessage>& found, const std::vector<TestMessage>& expected);

struct Recovered {
  LogBytes bytes;
  Result<McapRecovery> report = McapRecovery();
};

Recovered recover_bytes(const LogBytes& damaged);

}  // namespace gloam
