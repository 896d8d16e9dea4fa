#include "mcap/mcap_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "mcap/mcap_decode.h"

namespace gloam {
namespace {

constexpr uint64_t kWindow = 64 * 1024;
constexpr uint64_t kLargestHeader = 1 << 20;

/// Small reads out of one larger one.
class SourceWindow {
 public:
  explicit SourceWindow(const LogSource& source) : source_(source) {}

  /// Bytes that are in the source, valid until the next call. Large ones are read directly.
  Result<std::span<const uint8_t>> read(uint64_t offset, uint64_t size) {
    if (offset < begin_ || offset + size > begin_ + bytes_.size()) {
      bytes_.resize(std::max(size, std::min(kWindow, source_.size() - offset)));
      begin_ = offset;
      if (Status status = source_.read(offset, bytes_); !status) {
        bytes_.clear();
        return std::move(status).error();
      }
    }
    return std::span<const uint8_t>(bytes_).subspan(offset - begin_, size);
  }

 private:
  const LogSource& source_;
  uint64_t begin_ = 0;
  std::vector<uint8_t> bytes_;
};

bool is_whole(std::span<const uint8_t> records) {
  McapRecordCursor cursor(records);
  while (cursor.next()) {
    if (McapMessage message; cursor.op() == McapOp::kMessage && !decode(cursor.content(), &message))
      return false;
  }
  return cursor.whole();
}

/// Cause alone of an error that says "byte N: cause".
std::string without_place(const std::string& message) {
  const size_t colon = message.find(": ");
  return colon == std::string::npos ? message : message.substr(colon + 2);
}

class Scan {
 public:
  Scan(const LogSource& source, const McapLimits& limits, std::span<const uint64_t> restarts,
       McapVisitor* visitor)
      : source_(source), limits_(limits), restarts_(restarts), visitor_(visitor), window_(source) {}

  Result<McapScanResult> run() {
    GLOAM_TRY(result_.header, read_header(source_, &at_));
    while (!ended_) GLOAM_TRY_STATUS(step());
    result_.end = at_;
    return result_;
  }

 private:
  /// One record, or damage.
  Status step() {
    const uint64_t left = source_.size() - at_;
    if (left == 0) return stop("the log ends without an end record");
    if (left < kMcapRecordHead) return skip_to_restart("the log is truncated");
    GLOAM_TRY(const auto head, window_.read(at_, kMcapRecordHead));
    McapDecoder in(head);
    McapRecordPlace place{static_cast<McapOp>(in.u8()), at_, 0};
    const uint64_t content = in.u64();
    if (place.op == McapOp{0}) return skip_to_restart("no record starts here");
    if (content > left - kMcapRecordHead) {
      return skip_to_restart(fmt::format("a record has {} bytes, of which only {} are present",
                                         content, left - kMcapRecordHead));
    }
    place.length = kMcapRecordHead + content;
    // Nothing is read twice, so the time is that of the log's size whatever restarts are claimed.
    if (next_restart(at_) < at_ + place.length)
      return damaged(place, "a chunk starts within a record");
    if (place.op == McapOp::kDataEnd || place.op == McapOp::kFooter) return end_data(place);
    if (place.op == McapOp::kChunk) return chunk(place);
    return other(place);
  }

  Status chunk(const McapRecordPlace& place) {
    Result<McapChunkHead> head =
        load_chunk(source_, place.offset, place.length, limits_, &buffers_);
    if (!head && head.error().kind == ErrorKind::kIo) return std::move(head).error();
    if (!head) return damaged(place, without_place(head.error().message));
    if (!is_whole(buffers_.records)) return damaged(place, "a chunk contains incomplete records");
    GLOAM_TRY_STATUS(visitor_->visit_chunk(place, *head, buffers_.records));
    at_ += place.length;
    return {};
  }

  Status other(const McapRecordPlace& place) {
    if (place.op == McapOp::kAttachment) {
      GLOAM_TRY_STATUS(visitor_->visit_attachment(place));
    } else if (place.length > limits_.chunk_bytes) {
      return damaged(place, fmt::format("a record of {} bytes is too large", place.length));
    } else {
      GLOAM_TRY(const auto record, window_.read(place.offset, place.length));
      GLOAM_TRY_STATUS(visitor_->visit_record(place, record.subspan(kMcapRecordHead)));
    }
    at_ += place.length;
    return {};
  }

  Status end_data(const McapRecordPlace& place) {
    if (place.op == McapOp::kFooter && at_ + place.length + kMcapMagic.size() != source_.size())
      return skip_to_restart("a footer is not at the end of the log");
    ended_ = true;
    result_.whole = !broken_;
    if (place.op != McapOp::kDataEnd || broken_) return {};
    if (place.length < kMcapRecordHead + 4 || place.length > kWindow)
      return stop("a DataEnd record has a wrong size");
    GLOAM_TRY(const auto record, window_.read(place.offset, place.length));
    const uint32_t crc = McapDecoder(record.subspan(kMcapRecordHead)).u32();
    if (crc == 0) return {};
    GLOAM_TRY(const uint32_t found, crc_of_range(source_, 0, at_));
    if (crc == found) return {};
    visitor_->visit_damage({place.op, at_, 0}, "the CRC of the data section is wrong");
    result_.whole = false;
    return {};
  }

  /// A record whose content is not whole: behind it the log goes on, unless chunks that are known
  /// begin inside it, which shows that its length is wrong.
  Status damaged(McapRecordPlace place, const std::string& cause) {
    place.length = std::min(place.length, next_restart(place.offset) - place.offset);
    visitor_->visit_damage(place, cause);
    result_.whole = false;
    broken_ = true;
    at_ += place.length;
    return {};
  }

  Status skip_to_restart(const std::string& cause) {
    const uint64_t next = next_restart(at_);
    return next >= source_.size() ? stop(cause) : damaged({McapOp{0}, at_, next - at_}, cause);
  }

  uint64_t next_restart(uint64_t offset) const {
    const auto next = std::upper_bound(restarts_.begin(), restarts_.end(), offset);
    return next == restarts_.end() ? UINT64_MAX : *next;
  }

  Status stop(const std::string& cause) {
    visitor_->visit_damage({McapOp{0}, at_, source_.size() - at_}, cause);
    ended_ = true;
    result_.whole = false;
    return {};
  }

  const LogSource& source_;
  const McapLimits& limits_;
  std::span<const uint64_t> restarts_;
  McapVisitor* visitor_;
  SourceWindow window_;
  McapChunkBuffers buffers_;
  McapScanResult result_;
  uint64_t at_ = 0;
  bool ended_ = false, broken_ = false;
};

}  // namespace

Result<McapHeader> read_header(const LogSource& source, uint64_t* end) {
  const uint64_t first = kMcapMagic.size() + kMcapRecordHead;
  std::vector<uint8_t> bytes(std::min(source.size(), first));
  GLOAM_TRY_STATUS(source.read(0, bytes));
  if (bytes.size() < kMcapMagic.size() ||
      !std::equal(kMcapMagic.begin(), kMcapMagic.end(), bytes.begin()))
    return mcap_error(source, 0, "is not an MCAP log of version 0");
  if (bytes.size() < first) return mcap_error(source, kMcapMagic.size(), "the log ends here");
  McapDecoder in(std::span<const uint8_t>(bytes).subspan(kMcapMagic.size()));
  const auto op = static_cast<McapOp>(in.u8());
  const uint64_t length = in.u64();
  if (op != McapOp::kHeader || length > source.size() - first || length > kLargestHeader)
    return mcap_error(source, kMcapMagic.size(), "the header is damaged");
  bytes.resize(length);
  GLOAM_TRY_STATUS(source.read(first, bytes));
  McapHeader header;
  if (!decode(bytes, &header))
    return mcap_error(source, kMcapMagic.size(), "the header is damaged");
  *end = first + length;
  return header;
}

Result<McapScanResult> scan_log(const LogSource& source, const McapLimits& limits,
                                std::span<const uint64_t> restarts, McapVisitor* visitor) {
  return Scan(source, limits, restarts, visitor).run();
}

}  // namespace gloam
