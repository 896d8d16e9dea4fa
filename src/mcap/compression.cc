#include "mcap/compression.h"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <cstring>

#include "base/check.h"
#include "base/text.h"

namespace gloam {
namespace {

// A frame asks for a window of at most what the output holds, so the context stays small: with the
// whole output in one piece zstd decodes into it directly.
std::string decompress_zstd(std::span<const uint8_t> bytes, std::span<uint8_t> out) {
  const std::unique_ptr<ZSTD_DCtx, size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(),
                                                                   ZSTD_freeDCtx);
  GLOAM_CHECK(context != nullptr, "no memory for zstd");
  const size_t size =
      ZSTD_decompressDCtx(context.get(), out.data(), out.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0) return fmt::format("zstd: {}", ZSTD_getErrorName(size));
  if (size != out.size())
    return fmt::format("it has {} bytes after decompression, but declares {}", size, out.size());
  return {};
}

std::string decompress_lz4(std::span<const uint8_t> bytes, std::span<uint8_t> out) {
  LZ4F_dctx* raw = nullptr;
  GLOAM_CHECK(LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) == 0,
              "no memory for lz4");
  const std::unique_ptr<LZ4F_dctx, size_t (*)(LZ4F_dctx*)> context(raw,
                                                                   LZ4F_freeDecompressionContext);
  LZ4F_decompressOptions_t options{};
  options.stableDst = 1;  // blocks refer to earlier output, which stays where it is
  size_t read = 0, written = 0;
  while (read < bytes.size()) {
    size_t in = bytes.size() - read, made = out.size() - written;
    const size_t left = LZ4F_decompress(context.get(), out.data() + written, &made,
                                        bytes.data() + read, &in, &options);
    if (LZ4F_isError(left) != 0) return fmt::format("lz4: {}", LZ4F_getErrorName(left));
    read += in;
    written += made;
    if (left == 0 && read == bytes.size() && written == out.size()) return {};
    if (in == 0 && made == 0) break;
  }
  if (out.empty() && bytes.empty()) return {};
  return "lz4: the frame does not end at the declared size";
}

}  // namespace

struct ZstdCompressor::Context {
  ZSTD_CCtx* zstd = ZSTD_createCCtx();
  ~Context() { ZSTD_freeCCtx(zstd); }
};

ZstdCompressor::ZstdCompressor(int level) : context_(std::make_unique<Context>()), level_(level) {
  GLOAM_CHECK(context_->zstd != nullptr, "no memory for zstd");
}
ZstdCompressor::~ZstdCompressor() = default;

bool ZstdCompressor::append(std::span<const uint8_t> bytes, size_t most,
                            std::vector<uint8_t>* out) {
  const size_t begin = out->size();
  out->resize(begin + most);
  const size_t size = ZSTD_compressCCtx(context_->zstd, out->data() + begin, most, bytes.data(),
                                        bytes.size(), level_);
  const bool fits = ZSTD_isError(size) == 0;  // the only error there is here: it does not fit
  out->resize(begin + (fits ? size : 0));
  return fits;
}

std::string decompress(const std::string& compression, std::span<const uint8_t> bytes,
                       std::span<uint8_t> out) {
  if (compression.empty()) {
    if (bytes.size() != out.size())
      return fmt::format("it has {} bytes, but declares {}", bytes.size(), out.size());
    if (!bytes.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    return {};
  }
  if (compression == "zstd") return decompress_zstd(bytes, out);
  if (compression == "lz4") return decompress_lz4(bytes, out);
  return fmt::format("unsupported compression '{}' (expected zstd or lz4)",
                     as_utf8(compression.substr(0, 40)));
}

}  // namespace gloam
