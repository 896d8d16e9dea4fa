#include "report/video_frames.h"

#include <fmt/format.h>
#include <wels/codec_api.h>

#include <algorithm>

#include "base/files.h"
#include "geometry/image/image_file.h"

namespace gloam {
namespace {

constexpr uint64_t kMostVideoBytes = uint64_t{2} << 30;

struct DecoderDeleter {
  void operator()(ISVCDecoder* decoder) const {
    decoder->Uninitialize();
    WelsDestroyDecoder(decoder);
  }
};
using Decoder = std::unique_ptr<ISVCDecoder, DecoderDeleter>;

Result<Decoder> make_decoder() {
  ISVCDecoder* made = nullptr;
  if (WelsCreateDecoder(&made) != 0 || made == nullptr)
    return Error{ErrorKind::kIo, "cannot create the H.264 decoder"};
  Decoder decoder(made);
  int silent = WELS_LOG_QUIET;
  decoder->SetOption(DECODER_OPTION_TRACE_LEVEL, &silent);
  SDecodingParam parameters = {};
  parameters.eEcActiveIdc = ERROR_CON_DISABLE;
  parameters.sVideoProperty.eVideoBsType = VIDEO_BITSTREAM_AVC;
  if (decoder->Initialize(&parameters) != 0)
    return Error{ErrorKind::kIo, "cannot start the H.264 decoder"};
  return decoder;
}

void add_nal(std::span<const uint8_t> nal, std::vector<uint8_t>* out) {
  out->insert(out->end(), {0, 0, 0, 1});
  out->insert(out->end(), nal.begin(), nal.end());
}

// A sample, whose units follow their lengths, with start codes instead.
std::vector<uint8_t> with_start_codes(const VideoIndex& index, std::span<const uint8_t> sample,
                                      bool with_sets) {
  std::vector<uint8_t> out;
  if (with_sets) {
    add_nal(index.sps, &out);
    add_nal(index.pps, &out);
  }
  while (sample.size() > 4) {
    const size_t size = static_cast<size_t>(sample[0]) << 24 |
                        static_cast<size_t>(sample[1]) << 16 | static_cast<size_t>(sample[2]) << 8 |
                        sample[3];
    if (size > sample.size() - 4) break;
    add_nal(sample.subspan(4, size), &out);
    sample = sample.subspan(4 + size);
  }
  return out;
}

// BT.709, limited range, 4:2:0.
Image8 rgb_of(const SBufferInfo& info, uint8_t* const planes[3]) {
  const SSysMEMBuffer& memory = info.UsrData.sSystemBuffer;
  Image8 out{memory.iWidth, memory.iHeight, 3, ColorSpace::kSrgb, {}};
  out.texels.resize(static_cast<size_t>(out.width) * static_cast<size_t>(out.height) * 3);
  uint8_t* to = out.texels.data();
  const auto byte = [](float x) {
    return static_cast<uint8_t>(std::clamp(x, 0.0f, 255.0f) + 0.5f);
  };
  for (int row = 0; row < out.height; ++row)
    for (int column = 0; column < out.width; ++column) {
      const int chroma = row / 2 * memory.iStride[1] + column / 2;
      const float y =
          1.164384f * static_cast<float>(planes[0][row * memory.iStride[0] + column] - 16);
      const float u = static_cast<float>(planes[1][chroma] - 128);
      const float v = static_cast<float>(planes[2][chroma] - 128);
      *to++ = byte(y + 1.792741f * v);
      *to++ = byte(y - 0.213249f * u - 0.532909f * v);
      *to++ = byte(y + 2.112402f * u);
    }
  return out;
}

}  // namespace

Result<VideoReader> VideoReader::open(const std::filesystem::path& file) {
  VideoReader reader;
  reader.name_ = file.string();
  GLOAM_TRY(reader.bytes_, read_file(file, kMostVideoBytes));
  GLOAM_TRY(reader.index_, index_video(reader.bytes_, reader.name_));
  return reader;
}

Result<Image8> VideoReader::decode(size_t wanted) const {
  const Error failed{
      ErrorKind::kInput, fmt::format("frame {} cannot be decoded", wanted + 1), {name_, 0, 0}};
  if (wanted >= index_.samples.size()) return failed;
  size_t first = wanted;
  while (first > 0 && !index_.samples[first].key) --first;
  GLOAM_TRY(const Decoder decoder, make_decoder());
  // Pictures come out later than they go in, with the stamp that they went in with.
  uint8_t* planes[3] = {};
  SBufferInfo info = {};
  const auto is_wanted = [&] {
    return info.iBufferStatus == 1 && info.uiOutYuvTimeStamp == wanted + 1;
  };
  for (size_t i = first; i <= wanted + 1 && !is_wanted(); ++i) {
    std::vector<uint8_t>
        bytes;  // none after the last: the end of a picture is seen by what follows
    if (i <= wanted) {
      const VideoIndex::Sample& sample = index_.samples[i];
      bytes = with_start_codes(index_, std::span(bytes_).subspan(sample.offset, sample.size),
                               i == first);
      if (bytes.empty()) return failed;
    }
    info = {};
    info.uiInBsTimeStamp = i + 1;
    if (decoder->DecodeFrame2(bytes.empty() ? nullptr : bytes.data(),
                              static_cast<int>(bytes.size()), planes, &info) != dsErrorFree)
      return failed;
  }
  while (!is_wanted()) {
    info = {};
    if (decoder->FlushFrame(planes, &info) != dsErrorFree || info.iBufferStatus != 1) return failed;
  }
  const SSysMEMBuffer& memory = info.UsrData.sSystemBuffer;
  if (planes[0] == nullptr || memory.iWidth < 1 || memory.iHeight < 1 ||
      static_cast<uint64_t>(memory.iWidth) * static_cast<uint64_t>(memory.iHeight) >
          kMaxImagePixels)
    return failed;
  return rgb_of(info, planes);
}

}  // namespace gloam
