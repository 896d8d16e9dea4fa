#include "render/film/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>

#include <cstring>

#include "base/check.h"

namespace gloam {
namespace {

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : Imf::OStream("memory") {}
  void write(const char c[], int n) override {
    const size_t end = position_ + static_cast<size_t>(n);
    if (end > bytes.size()) bytes.resize(end);
    std::memcpy(bytes.data() + position_, c, static_cast<size_t>(n));
    position_ = end;
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }

  std::vector<uint8_t> bytes;

 private:
  size_t position_ = 0;
};

// Halves need a copy: OpenEXR converts on reading but not on writing.
struct HalfPlane {
  std::vector<Imath::half> values;
};

}  // namespace

Result<std::vector<uint8_t>> encode_exr(int width, int height,
                                        std::span<const ExrChannel> channels) {
  GLOAM_CHECK(width > 0 && height > 0 && !channels.empty(),
              "an EXR image needs a positive size and at least one channel");
  const size_t n = static_cast<size_t>(width) * static_cast<size_t>(height);
  try {
    Imf::Header header(width, height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer frame;
    std::vector<HalfPlane> halves(channels.size());
    for (size_t c = 0; c < channels.size(); ++c) {
      const ExrChannel& channel = channels[c];
      const Imf::PixelType type = channel.half ? Imf::HALF : Imf::FLOAT;
      header.channels().insert(channel.name, Imf::Channel(type));
      size_t x_bytes = sizeof(float) * static_cast<size_t>(channel.stride);
      char* base = reinterpret_cast<char*>(const_cast<float*>(channel.data));
      if (channel.half) {
        halves[c].values.resize(n);
        for (size_t i = 0; i < n; ++i)
          halves[c].values[i] = channel.data[i * static_cast<size_t>(channel.stride)];
        x_bytes = sizeof(Imath::half);
        base = reinterpret_cast<char*>(halves[c].values.data());
      }
      frame.insert(channel.name,
                   Imf::Slice(type, base, x_bytes, x_bytes * static_cast<size_t>(width)));
    }
    MemoryOutput out;
    {
      Imf::OutputFile file(out, header);  // its destructor writes the table of offsets
      file.setFrameBuffer(frame);
      file.writePixels(height);
    }
    return std::move(out.bytes);
  } catch (const std::exception& e) {
    return Error{ErrorKind::kIo, fmt::format("EXR encoding failed: {}", e.what())};
  }
}

}  // namespace gloam
