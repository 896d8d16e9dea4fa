#pragma once
// msgpack of the bridge to ZeroMQ: one packer type, and names packed as keys.

#define MSGPACK_NO_BOOST
#include <msgpack.hpp>
#include <span>
#include <string>
#include <string_view>

#include "gloam/result.h"

namespace gloam::bridge::zeromq {

using PackBuffer = msgpack::sbuffer;
using Packer = msgpack::packer<PackBuffer>;

/// Packs a key and its value; the map's size is the caller's to announce.
template <class T>
void pack_pair(Packer& packer, std::string_view key, const T& value) {
  packer.pack(key);
  packer.pack(value);
}
/// Packs numbers as an array.
inline void pack_numbers(Packer& packer, std::span<const double> values) {
  packer.pack_array(static_cast<uint32_t>(values.size()));
  for (const double value : values) packer.pack_double(value);
}
inline void pack_bytes(Packer& packer, std::span<const uint8_t> bytes) {
  packer.pack_bin(static_cast<uint32_t>(bytes.size()));
  packer.pack_bin_body(reinterpret_cast<const char*>(bytes.data()),
                       static_cast<uint32_t>(bytes.size()));
}
/// With ? in the place of each byte that is no part of UTF-8: texts of strangers come back in
/// errors.
std::string valid_text(std::string_view text);
/// Packs {kind, message, remedy, where}: the form of every error on the wire.
void pack_error(Packer& packer, const Error& error);

}  // namespace gloam::bridge::zeromq
