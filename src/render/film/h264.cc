#include "render/film/h264.h"

#include <fmt/format.h>
#include <wels/codec_api.h>

#include <algorithm>
#include <span>

#include "base/check.h"
#include "base/memory.h"

namespace gloam {
namespace {

constexpr int kNalSps = 7, kNalPps = 8;

struct EncoderDeleter {
  void operator()(ISVCEncoder* encoder) const {
    encoder->Uninitialize();
    WelsDestroySVCEncoder(encoder);
  }
};

class OpenH264Encoder : public H264Encoder {
 public:
  OpenH264Encoder(std::unique_ptr<ISVCEncoder, EncoderDeleter> encoder, int width, int height)
      : encoder_(std::move(encoder)), width_(width), height_(height) {}

  Result<H264Picture> encode(const Yuv420& picture) override {
    GLOAM_CHECK(picture.width == width_ && picture.height == height_,
                "all images of a video must have the same size");
    SSourcePicture source = {};
    source.iColorFormat = videoFormatI420;
    source.iPicWidth = width_;
    source.iPicHeight = height_;
    source.iStride[0] = width_;
    source.iStride[1] = source.iStride[2] = width_ / 2;
    source.pData[0] = const_cast<uint8_t*>(picture.y.data());
    source.pData[1] = const_cast<uint8_t*>(picture.u.data());
    source.pData[2] = const_cast<uint8_t*>(picture.v.data());
    SFrameBSInfo info = {};
    const int encoded = encoder_->EncodeFrame(&source, &info);
    if (encoded == cmMallocMemeError) return no_memory_for("the H.264 encoder");
    if (encoded != cmResultSuccess || info.eFrameType == videoFrameTypeInvalid ||
        info.eFrameType == videoFrameTypeSkip)
      return Error{ErrorKind::kIo, "the H.264 encoder failed"};
    H264Picture out;
    out.key = info.eFrameType == videoFrameTypeIDR;
    for (int layer = 0; layer < info.iLayerNum; ++layer) {
      const SLayerBSInfo& bits = info.sLayerInfo[layer];
      const uint8_t* next = bits.pBsBuf;
      for (int i = 0; i < bits.iNalCount; ++i) {
        const size_t size = static_cast<size_t>(bits.pNalLengthInByte[i]);
        add_nal(next, size, &out.bytes);
        next += size;
      }
    }
    return out;
  }

  void request_key() override { encoder_->ForceIntraFrame(true); }

  const std::vector<uint8_t>& sps() const override { return sps_; }
  const std::vector<uint8_t>& pps() const override { return pps_; }

 private:
  // `nal` begins with a start code: 00 00 01 or 00 00 00 01.
  void add_nal(const uint8_t* nal, size_t size, std::vector<uint8_t>* out) {
    const size_t code = nal[2] == 1 ? 3 : 4;
    GLOAM_CHECK(size > code, "OpenH264 returned an empty NAL unit");
    const int type = nal[code] & 0x1f;
    if (type == kNalSps || type == kNalPps) {  // they go into the header of the file, once
      (type == kNalSps ? sps_ : pps_).assign(nal + code, nal + size);
      return;
    }
    const uint32_t length = static_cast<uint32_t>(size - code);
    for (int shift = 24; shift >= 0; shift -= 8)
      out->push_back(static_cast<uint8_t>(length >> shift));
    out->insert(out->end(), nal + code, nal + size);
  }

  std::unique_ptr<ISVCEncoder, EncoderDeleter> encoder_;
  int width_, height_;
  std::vector<uint8_t> sps_, pps_;
};

}  // namespace

Result<std::unique_ptr<H264Encoder>> H264Encoder::create(int width, int height, Rational rate,
                                                         int key_interval, int qp) {
  GLOAM_CHECK(width % 2 == 0 && height % 2 == 0, "4:2:0 video requires an even width and height");
  if (width < 16 || height < 16 || int64_t{width} * height > kMaxVideoPixels) {
    return Error{ErrorKind::kUnsupported,
                 fmt::format("H.264 video of {} x {} pixels is not supported: it must have at "
                             "least 16 x 16 and at most {} pixels",
                             width, height, kMaxVideoPixels),
                 {},
                 "change the resolution or record 'png' instead of 'video'"};
  }
  ISVCEncoder* raw = nullptr;
  if (WelsCreateSVCEncoder(&raw) != 0 || raw == nullptr) return no_memory_for("the H.264 encoder");
  std::unique_ptr<ISVCEncoder, EncoderDeleter> encoder(raw);
  int quiet = WELS_LOG_QUIET;
  raw->SetOption(ENCODER_OPTION_TRACE_LEVEL, &quiet);

  SEncParamExt p = {};
  raw->GetDefaultParams(&p);
  p.iUsageType = CAMERA_VIDEO_REAL_TIME;
  p.iPicWidth = width;
  p.iPicHeight = height;
  p.fMaxFrameRate = static_cast<float>(std::min(rate.value(), 60.0));
  p.iRCMode = RC_OFF_MODE;  // constant quantiser: quality, not size, is what is asked for
  p.iTargetBitrate = 50'000'000;
  p.iMaxBitrate = UNSPECIFIED_BIT_RATE;
  p.iMinQp = 0;
  p.iMaxQp = 51;
  p.iTemporalLayerNum = 1;
  p.iSpatialLayerNum = 1;
  p.iComplexityMode = HIGH_COMPLEXITY;
  p.uiIntraPeriod = static_cast<unsigned>(key_interval);
  p.iNumRefFrame = 1;
  p.eSpsPpsIdStrategy = CONSTANT_ID;
  p.bPrefixNalAddingCtrl = false;
  p.bEnableSSEI = false;
  p.iEntropyCodingModeFlag = 1;
  p.bEnableFrameSkip = false;
  p.iMultipleThreadIdc = 1;
  p.bUseLoadBalancing = false;
  p.bEnableDenoise = false;
  p.bEnableBackgroundDetection = false;
  p.bEnableAdaptiveQuant = false;
  p.bEnableSceneChangeDetect = false;
  p.bEnableFrameCroppingFlag = true;
  SSpatialLayerConfig& layer = p.sSpatialLayers[0];
  layer.iVideoWidth = width;
  layer.iVideoHeight = height;
  layer.fFrameRate = p.fMaxFrameRate;
  layer.iSpatialBitrate = p.iTargetBitrate;
  layer.iMaxSpatialBitrate = UNSPECIFIED_BIT_RATE;
  layer.uiProfileIdc = PRO_HIGH;
  layer.uiLevelIdc = LEVEL_UNKNOWN;  // chosen by the encoder
  layer.iDLayerQp = qp;
  layer.sSliceArgument.uiSliceMode = SM_SINGLE_SLICE;
  layer.bVideoSignalTypePresent = true;
  layer.uiVideoFormat = VF_UNDEF;
  layer.bFullRange = false;
  layer.bColorDescriptionPresent = true;
  layer.uiColorPrimaries = CP_BT709;
  layer.uiTransferCharacteristics = TRC_BT709;
  layer.uiColorMatrix = CM_BT709;
  const int initialized = raw->InitializeExt(&p);
  if (initialized == cmMallocMemeError) return no_memory_for("the H.264 encoder");
  if (initialized != cmResultSuccess)
    return Error{ErrorKind::kUnsupported,
                 fmt::format("the H.264 encoder rejected {} x {} pixels", width, height)};
  return std::unique_ptr<H264Encoder>(new OpenH264Encoder(std::move(encoder), width, height));
}

std::vector<uint8_t> annex_b(const H264Encoder& encoder, const H264Picture& picture) {
  std::vector<uint8_t> out;
  out.reserve(picture.bytes.size() + encoder.sps().size() + encoder.pps().size() + 8);
  const auto add = [&out](std::span<const uint8_t> nal) {
    out.insert(out.end(), {0, 0, 0, 1});
    out.insert(out.end(), nal.begin(), nal.end());
  };
  if (picture.key) {
    add(encoder.sps());
    add(encoder.pps());
  }
  std::span<const uint8_t> rest = picture.bytes;
  while (rest.size() >= 4) {
    const size_t length =
        size_t{rest[0]} << 24 | size_t{rest[1]} << 16 | size_t{rest[2]} << 8 | size_t{rest[3]};
    add(rest.subspan(4, length));
    rest = rest.subspan(4 + length);
  }
  return out;
}

}  // namespace gloam
