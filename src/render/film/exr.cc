#include "render/film/exr.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>

#include <cstring>
#include <stdexcept>

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

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::span<const uint8_t> bytes) : Imf::IStream("memory"), bytes_(bytes) {}
  bool read(char c[], int n) override {
    if (n < 0 || position_ > bytes_.size() || bytes_.size() - position_ < static_cast<size_t>(n))
      throw std::runtime_error("unexpected end");
    std::memcpy(c, bytes_.data() + position_, static_cast<size_t>(n));
    position_ += static_cast<size_t>(n);
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = position; }

 private:
  std::span<const uint8_t> bytes_;
  uint64_t position_ = 0;
};

// Halves need a copy: OpenEXR converts on reading but not on writing.
struct HalfPlane {
  std::vector<Imath::half> values;
};

}  // namespace

const std::vector<float>* ExrImage::find(const std::string& name) const {
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return &planes[i];
  return nullptr;
}

Result<std::vector<uint8_t>> encode_exr(int width, int height,
                                        std::span<const ExrChannel> channels) {
  GLOAM_CHECK(width > 0 && height > 0 && !channels.empty(), "an EXR needs a size and a channel");
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

Result<ExrImage> decode_exr(std::span<const uint8_t> bytes, const std::string& name,
                            uint64_t max_values) {
  const auto bad = [&name](const std::string& what) {
    return Error{
        ErrorKind::kInput, fmt::format("not a readable EXR picture: {}", what), {name, 0, 0}};
  };
  try {
    MemoryInput in(bytes);
    Imf::InputFile file(in);
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1;
    const int64_t height = int64_t{window.max.y} - window.min.y + 1;
    if (width <= 0 || height <= 0 || width > (1 << 16) || height > (1 << 16))
      return bad(fmt::format("its size is {} x {}", width, height));
    ExrImage image;
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    const Imf::ChannelList& channels = file.header().channels();
    for (auto it = channels.begin(); it != channels.end(); ++it) {
      if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
        return bad(fmt::format("channel '{}' is subsampled", it.name()));
      image.names.emplace_back(it.name());
    }
    const uint64_t values = static_cast<uint64_t>(width * height) * image.names.size();
    if (values == 0 || values > max_values)
      return bad(fmt::format("it has {} values; the limit is {}", values, max_values));
    image.planes.resize(image.names.size());
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < image.names.size(); ++c) {
      image.planes[c].resize(static_cast<size_t>(width * height));
      const size_t x_bytes = sizeof(float), y_bytes = x_bytes * static_cast<size_t>(width);
      const int64_t origin = -(window.min.x * static_cast<int64_t>(x_bytes) +
                               window.min.y * static_cast<int64_t>(y_bytes));
      frame.insert(image.names[c],
                   Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(image.planes[c].data()) + origin,
                              x_bytes, y_bytes));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return image;
  } catch (const std::exception& e) {
    return bad(e.what());
  }
}

}  // namespace gloam
