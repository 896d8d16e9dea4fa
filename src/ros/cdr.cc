#include "ros/cdr.h"

#include <fmt/format.h>

#include <limits>

#include "base/check.h"

namespace gloam {

CdrWriter::CdrWriter(std::vector<uint8_t>* bytes) : bytes_(bytes) {
  constexpr uint8_t kHead[kCdrHead] = {0x00, 0x01, 0x00, 0x00};
  append(kHead, kCdrHead);
  body_ = bytes->size();
}

void CdrWriter::write_string(std::string_view text) {
  write_count(text.size() + 1);
  append(text.data(), text.size());
  bytes_->push_back(0);
}

void CdrWriter::write_count(size_t count) {
  GLOAM_CHECK(count <= std::numeric_limits<uint32_t>::max(),
              "the number of elements exceeds 32 bits");
  write(static_cast<uint32_t>(count));
}

CdrReader::CdrReader(std::span<const uint8_t> message) {
  if (message.size() < kCdrHead) {
    fail("shorter than the header of four bytes");
    return;
  }
  body_ = message.subspan(kCdrHead);
  swap_ = message[1] == 0;
  if (message[0] != 0 || message[1] > 1) {
    fail(fmt::format("the header {:02x} {:02x} is not a plain CDR header (00 00 or 00 01)",
                     message[0], message[1]));
  }
}

const uint8_t* CdrReader::take(size_t size, size_t count) {
  if (!ok()) return nullptr;
  const size_t padding = (size - (at_ & (size - 1))) & (size - 1);
  if (padding > left() || count > (left() - padding) / size) {
    fail("the message is truncated");
    return nullptr;
  }
  const uint8_t* from = body_.data() + at_ + padding;
  at_ += padding + count * size;
  return from;
}

bool CdrReader::read_count(size_t* count, size_t least_size) {
  uint32_t declared = 0;
  if (!read(&declared)) return false;
  if (declared > left() / least_size) {
    return fail(
        fmt::format("{} elements do not fit into the remaining {} bytes", declared, left()));
  }
  *count = declared;
  return true;
}

bool CdrReader::read_string(std::string_view* text, size_t bound) {
  size_t length = 0;
  if (!read_count(&length, 1)) return false;
  if (length == 0) {  // some writers leave the zero of empty strings away
    *text = {};
    return true;
  }
  const auto* from = reinterpret_cast<const char*>(take(1, length));
  if (from[length - 1] != 0) return fail("a string is not zero-terminated");
  if (bound != 0 && length - 1 > bound) {
    return fail(
        fmt::format("a string of {} characters exceeds its bound of {}", length - 1, bound));
  }
  *text = std::string_view(from, length - 1);
  return true;
}

bool CdrReader::read_string(std::string* text, size_t bound) {
  std::string_view view;
  if (!read_string(&view, bound)) return false;
  text->assign(view);
  return true;
}

bool CdrReader::fail(std::string_view why) {
  if (ok()) {
    failure_ = why;
    failed_at_ = offset();
  }
  return false;
}

void CdrReader::add_place(std::string_view name) {
  place_ = place_.empty() ? std::string(name) : fmt::format("{}.{}", name, place_);
}

Error CdrReader::error() const {
  const std::string where = place_.empty() ? "" : fmt::format(" in {}", place_);
  return Error{.message = fmt::format("CDR, byte {}{}: {}", failed_at_, where, failure_),
               .hint = "the message is damaged or has another type"};
}

}  // namespace gloam
