#pragma once
// Values as bytes and back, for files that this machine wrote for itself: no byte order, no
// versions. What comes back may be damaged: every read is bounded.

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace gloam {

template <class T>
concept ArchivedAsBytes = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

/// Calls with values append them. Structs of a vector are visited by visit_parts(archive, struct).
class ArchiveWriter {
 public:
  std::vector<uint8_t> bytes;

  template <ArchivedAsBytes T>
  void operator()(const T& value) {
    append(&value, sizeof(T));
  }
  void operator()(const std::string& text) { put(text); }
  template <class T>
  void operator()(std::vector<T>& values) {
    if constexpr (ArchivedAsBytes<T>) {
      put(values);
    } else {
      (*this)(static_cast<uint64_t>(values.size()));
      for (T& value : values) visit_parts(*this, value);
    }
  }
  /// A block for the caller to fill; valid until the next call.
  std::span<uint8_t> block(uint64_t size) {
    (*this)(size);
    bytes.resize(bytes.size() + size);
    return std::span(bytes).last(size);
  }

 private:
  template <class Container>
  void put(const Container& values) {
    (*this)(static_cast<uint64_t>(values.size()));
    append(values.data(), values.size() * sizeof(values[0]));
  }
  void append(const void* from, size_t size) {
    const auto* begin = static_cast<const uint8_t*>(from);
    bytes.insert(bytes.end(), begin, begin + size);
  }
};

/// Reads in the same order. After the first read that fails all others fail and leave their value.
class ArchiveReader {
 public:
  explicit ArchiveReader(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  bool ok() const { return ok_; }
  bool is_done() const { return ok_ && bytes_.empty(); }
  void fail() { ok_ = false; }

  template <ArchivedAsBytes T>
  void operator()(T& value) {
    if (take(sizeof(T))) std::memcpy(&value, taken_.data(), sizeof(T));
  }
  void operator()(std::string& text) { get(text); }
  template <class T>
  void operator()(std::vector<T>& values) {
    if constexpr (ArchivedAsBytes<T>) {
      get(values);
    } else {
      uint64_t count = 0;
      (*this)(count);
      if (count > bytes_.size()) ok_ = false;  // each takes a byte at least
      for (uint64_t i = 0; i < count && ok_; ++i) visit_parts(*this, values.emplace_back());
    }
  }
  /// Bytes that block() wrote; empty on failure.
  std::span<const uint8_t> block() {
    uint64_t size = 0;
    (*this)(size);
    return take(size) ? taken_ : std::span<const uint8_t>();
  }

 private:
  template <class Container>
  void get(Container& values) {
    uint64_t count = 0;
    (*this)(count);
    const size_t size = sizeof(values[0]);
    if (!ok_ || count > bytes_.size() / size || !take(count * size)) {
      ok_ = false;
      return;
    }
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), taken_.data(), count * size);
  }
  bool take(uint64_t size) {
    if (!ok_ || size > bytes_.size()) return ok_ = false;
    taken_ = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return true;
  }

  std::span<const uint8_t> bytes_, taken_;
  bool ok_ = true;
};

/// Vectors of text.
template <class Archive>
void visit_parts(Archive& archive, std::string& text) {
  archive(text);
}

}  // namespace gloam
