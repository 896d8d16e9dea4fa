#pragma once
// Writes PNG, HDR, EXR and KTX files for tests.

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace gloam {

inline std::string raw(const void* data, size_t size) {
  return {static_cast<const char*>(data), size};
}
template <class T>
std::string raw(const T& value) {
  return raw(&value, sizeof(T));
}

/// PNG of 8 bits with 1 to 4 channels, rows from the top, in one block that is not compressed.
/// `srgb` adds that chunk.
inline std::string png_file(int width, int height, int channels, const std::vector<uint8_t>& texels,
                            bool srgb = false) {
  const auto be32 = [](uint32_t v) {
    return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16),
                       static_cast<char>(v >> 8), static_cast<char>(v)};
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    uint32_t crc = 0xffffffffu;
    for (const char c : type + data) {
      crc ^= static_cast<uint8_t>(c);
      for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320u : 0u);
    }
    return be32(static_cast<uint32_t>(data.size())) + type + data + be32(~crc);
  };
  const auto stride = static_cast<size_t>(width * channels);
  std::string rows;
  for (size_t y = 0; y < static_cast<size_t>(height); ++y)
    rows += '\0' + raw(texels.data() + y * stride, stride);
  uint32_t a = 1, b = 0;
  for (const char c : rows) {
    a = (a + static_cast<uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto n = static_cast<uint16_t>(rows.size());
  const auto m = static_cast<uint16_t>(~n);
  const std::string zlib = "\x78\x01\x01" + raw(n) + raw(m) + rows + be32((b << 16) | a);
  constexpr char kColorTypes[] = {0, 4, 2, 6};
  const std::string kind{8, kColorTypes[channels - 1], 0, 0, 0};
  return std::string("\x89PNG\r\n\x1a\n", 8) +
         chunk("IHDR",
               be32(static_cast<uint32_t>(width)) + be32(static_cast<uint32_t>(height)) + kind) +
         (srgb ? chunk("sRGB", std::string(1, '\0')) : "") + chunk("IDAT", zlib) +
         chunk("IEND", "");
}

enum class HdrPacking { kNone, kOld, kNew };

/// `texels`: four bytes each.
inline std::string hdr_file(int width, int height, const std::vector<uint8_t>& texels,
                            HdrPacking packing, const std::string& head = {},
                            const std::string& y = "-Y") {
  std::string out = "#?RADIANCE\n# by hand\nFORMAT=32-bit_rle_rgbe\n" + head + "\n" + y + " " +
                    std::to_string(height) + " +X " + std::to_string(width) + "\n";
  const auto w = static_cast<size_t>(width);
  for (size_t row = 0; row < static_cast<size_t>(height); ++row) {
    const uint8_t* t = texels.data() + 4 * w * row;
    if (packing == HdrPacking::kNone) out += raw(t, 4 * w);
    if (packing == HdrPacking::kOld) {
      for (size_t x = 0; x < w;) {
        size_t run = 1;
        while (x + run < w && std::memcmp(t + 4 * x, t + 4 * (x + run), 4) == 0) ++run;
        out += raw(t + 4 * x, 4);
        for (size_t rest = run - 1; rest > 0; rest >>= 8)  // low byte first
          out += std::string("\1\1\1") + static_cast<char>(rest & 255);
        x += run;
      }
    }
    if (packing == HdrPacking::kNew) {
      out += std::string("\2\2") + static_cast<char>(w >> 8) + static_cast<char>(w & 255);
      for (size_t c = 0; c < 4; ++c) {
        for (size_t x = 0; x < w;) {
          size_t run = 1;
          while (x + run < w && run < 127 && t[4 * x + c] == t[4 * (x + run) + c]) ++run;
          if (run > 2) {
            out += static_cast<char>(128 + run);
            out += static_cast<char>(t[4 * x + c]);
          } else {
            out += static_cast<char>(run);
            for (size_t i = 0; i < run; ++i) out += static_cast<char>(t[4 * (x + i) + c]);
          }
          x += run;
        }
      }
    }
  }
  return out;
}

/// Uncompressed scan lines of 32-bit floats, planes in the order of the names (sorted).
inline std::string exr_file(int width, int height, const std::vector<std::string>& names,
                            const std::vector<std::vector<float>>& planes) {
  const auto attribute = [](const std::string& name, const std::string& type,
                            const std::string& value) {
    return name + '\0' + type + '\0' + raw(static_cast<int32_t>(value.size())) + value;
  };
  std::string channels;
  for (const std::string& name : names)
    channels += name + '\0' + raw(int32_t{2}) + raw(int32_t{0}) + raw(int32_t{1}) + raw(int32_t{1});
  channels += '\0';
  const std::string window = raw(int32_t{0}) + raw(int32_t{0}) + raw(width - 1) + raw(height - 1);
  std::string out = raw(uint32_t{20000630}) + raw(uint32_t{2}) +
                    attribute("channels", "chlist", channels) +
                    attribute("compression", "compression", std::string(1, '\0')) +
                    attribute("dataWindow", "box2i", window) + '\0';
  const size_t row = names.size() * static_cast<size_t>(width) * 4;
  for (int y = 0; y < height; ++y)
    out +=
        raw(out.size() + 8 * static_cast<size_t>(height - y) + static_cast<size_t>(y) * (row + 8));
  for (int y = 0; y < height; ++y) {
    out += raw(y) + raw(static_cast<uint32_t>(row));
    for (const std::vector<float>& plane : planes)
      out += raw(plane.data() + static_cast<size_t>(y) * static_cast<size_t>(width),
                 static_cast<size_t>(width) * 4);
  }
  return out;
}

/// KTX 1 of one level. `faces`: the rows of each, padded to four bytes.
inline std::string ktx_file(uint32_t type, uint32_t format, uint32_t internal, uint32_t width,
                            uint32_t height, const std::vector<std::string>& faces,
                            const std::string& metadata = {}) {
  std::string out("\xABKTX 11\xBB\r\n\x1A\n", 12);
  for (const uint32_t v :
       {0x04030201u, type, type == 0x1401 ? 1u : 4u, format, internal, format, width, height, 0u,
        0u, static_cast<uint32_t>(faces.size()), 1u, static_cast<uint32_t>(metadata.size())})
    out += raw(v);
  out += metadata + raw(static_cast<uint32_t>(faces.at(0).size()));
  for (const std::string& face : faces) out += face;
  return out;
}

}  // namespace gloam
