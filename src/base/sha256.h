#pragma once
// SHA-256 (FIPS 180-4), where a standard asks for it; hash.h is faster for all else.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace gloam {

/// 64 lower-case hexadecimal digits.
std::string sha256_hex(std::span<const uint8_t> bytes);
std::string sha256_hex(std::string_view text);

}  // namespace gloam
