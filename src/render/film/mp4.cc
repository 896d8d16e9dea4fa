#include "render/film/mp4.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "base/check.h"

namespace gloam {
namespace {

constexpr uint32_t kSyncSample = 0x02000000;   // sample_depends_on = 2 (no other)
constexpr uint32_t kOtherSample = 0x01010000;  // depends on others, is not a sync sample

/// Builds nested boxes: big-endian fields, sizes filled in when a box ends.
class BoxWriter {
 public:
  class Box {
   public:
    Box(BoxWriter* writer, const char* type) : writer_(writer), start_(writer->bytes.size()) {
      writer->u32(0);
      writer->text(type);
    }
    Box(BoxWriter* writer, const char* type, uint32_t version_and_flags) : Box(writer, type) {
      writer->u32(version_and_flags);
    }
    ~Box() { writer_->patch32(start_, static_cast<uint32_t>(writer_->bytes.size() - start_)); }
    Box(const Box&) = delete;
    Box& operator=(const Box&) = delete;

   private:
    BoxWriter* writer_;
    size_t start_;
  };

  Box box(const char* type) { return {this, type}; }
  Box full_box(const char* type, uint8_t version, uint32_t flags) {
    return {this, type, (uint32_t{version} << 24) | flags};
  }
  void u8(uint32_t x) { bytes.push_back(static_cast<uint8_t>(x)); }
  void u16(uint32_t x) {
    u8(x >> 8);
    u8(x);
  }
  void u32(uint32_t x) {
    u16(x >> 16);
    u16(x);
  }
  void u64(uint64_t x) {
    u32(static_cast<uint32_t>(x >> 32));
    u32(static_cast<uint32_t>(x));
  }
  void text(const char* characters) {
    for (; *characters != 0; ++characters) u8(static_cast<uint8_t>(*characters));
  }
  void zeros(size_t count) { bytes.insert(bytes.end(), count, 0); }
  void raw(std::span<const uint8_t> more) { bytes.insert(bytes.end(), more.begin(), more.end()); }
  void matrix() {  // identity, 16.16 and 2.30 fixed point
    for (const uint32_t x : {0x10000u, 0u, 0u, 0u, 0x10000u, 0u, 0u, 0u, 0x40000000u}) u32(x);
  }
  void patch32(size_t at, uint32_t x) {
    for (size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<uint8_t>(x >> (24 - 8 * i));
  }

  std::vector<uint8_t> bytes;
};

void write_sample_entry(const Mp4Track& track, BoxWriter* w) {
  const auto stsd = w->box("stsd");
  w->u32(0);
  w->u32(1);
  const auto avc1 = w->box("avc1");
  w->zeros(6);
  w->u16(1);  // data reference
  w->zeros(16);
  w->u16(static_cast<uint32_t>(track.width));
  w->u16(static_cast<uint32_t>(track.height));
  w->u32(0x00480000);  // 72 dpi
  w->u32(0x00480000);
  w->u32(0);
  w->u16(1);  // frames per sample
  w->zeros(32);
  w->u16(24);
  w->u16(0xffff);
  {
    const auto avcc = w->box("avcC");
    w->u8(1);
    w->u8(track.sps[1]);  // profile, constraints, level
    w->u8(track.sps[2]);
    w->u8(track.sps[3]);
    w->u8(0xff);  // lengths have 4 bytes
    w->u8(0xe1);
    w->u16(static_cast<uint32_t>(track.sps.size()));
    w->raw(track.sps);
    w->u8(1);
    w->u16(static_cast<uint32_t>(track.pps.size()));
    w->raw(track.pps);
    if (track.sps[1] >= 100 && track.sps[1] != 244) {  // High profiles: 4:2:0, 8 bits
      w->u8(0xfc | 1);
      w->u8(0xf8);
      w->u8(0xf8);
      w->u8(0);
    }
  }
  const auto colr = w->box("colr");
  w->text("nclx");
  w->u16(1);  // BT.709 primaries, transfer, matrix
  w->u16(1);
  w->u16(1);
  w->u8(0);  // limited range
}

void write_movie_times(uint32_t timescale, uint64_t duration, BoxWriter* w) {
  const auto mvhd = w->full_box("mvhd", 1, 0);
  w->zeros(16);  // times of creation and change: left out, so that equal runs give equal files
  w->u32(timescale);
  w->u64(duration);
  w->u32(0x10000);  // rate 1
  w->u16(0x100);    // volume 1
  w->zeros(10);
  w->matrix();
  w->zeros(24);
  w->u32(2);  // next track
}

void write_track_header(const Mp4Track& track, uint64_t duration, BoxWriter* w) {
  const auto tkhd = w->full_box("tkhd", 1, 3);  // enabled, in the movie
  w->zeros(16);
  w->u32(1);
  w->u32(0);
  w->u64(duration);
  w->zeros(16);
  w->matrix();
  w->u32(static_cast<uint32_t>(track.width) << 16);
  w->u32(static_cast<uint32_t>(track.height) << 16);
}

void write_media_headers(uint32_t timescale, uint64_t duration, BoxWriter* w) {
  {
    const auto mdhd = w->full_box("mdhd", 1, 0);
    w->zeros(16);
    w->u32(timescale);
    w->u64(duration);
    w->u16(0x55c4);  // language "und"
    w->u16(0);
  }
  const auto hdlr = w->full_box("hdlr", 0, 0);
  w->u32(0);
  w->text("vide");
  w->zeros(12);
  w->text("Gloam");
  w->u8(0);
}

void write_media_information(BoxWriter* w) {
  {
    const auto vmhd = w->full_box("vmhd", 0, 1);
    w->zeros(8);
  }
  const auto dinf = w->box("dinf");
  const auto dref = w->full_box("dref", 0, 0);
  w->u32(1);
  const auto url = w->full_box("url ", 0, 1);  // in this file
}

void write_sample_durations(std::span<const Mp4Sample> samples, uint32_t duration, BoxWriter* w) {
  const auto stts = w->full_box("stts", 0, 0);
  std::vector<std::array<uint32_t, 2>> runs;  // (pictures, duration of each)
  for (size_t i = 0; i < samples.size(); ++i) {
    const int64_t steps = i + 1 < samples.size() ? samples[i + 1].index - samples[i].index : 1;
    const uint32_t lasts = static_cast<uint32_t>(steps) * duration;
    if (runs.empty() || runs.back()[1] != lasts) runs.push_back({0, lasts});
    ++runs.back()[0];
  }
  w->u32(static_cast<uint32_t>(runs.size()));
  for (const auto& run : runs) {
    w->u32(run[0]);
    w->u32(run[1]);
  }
}

void write_key_samples(std::span<const Mp4Sample> samples, BoxWriter* w) {
  const auto stss = w->full_box("stss", 0, 0);
  const size_t count = w->bytes.size();
  w->u32(0);
  uint32_t keys = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (!samples[i].key) continue;
    w->u32(static_cast<uint32_t>(i + 1));
    ++keys;
  }
  w->patch32(count, keys);
}

void write_sample_places(std::span<const Mp4Sample> samples, BoxWriter* w) {
  const auto n = static_cast<uint32_t>(samples.size());
  {
    const auto stsc = w->full_box("stsc", 0, 0);  // every chunk holds one picture
    w->u32(n > 0 ? 1 : 0);
    if (n > 0) {
      w->u32(1);
      w->u32(1);
      w->u32(1);
    }
  }
  {
    const auto stsz = w->full_box("stsz", 0, 0);
    w->u32(0);
    w->u32(n);
    for (const Mp4Sample& sample : samples) w->u32(sample.size);
  }
  const auto co64 = w->full_box("co64", 0, 0);
  w->u32(n);
  for (const Mp4Sample& sample : samples) w->u64(sample.offset);
}

void write_fragment_defaults(uint32_t duration, BoxWriter* w) {
  const auto mvex = w->box("mvex");
  const auto trex = w->full_box("trex", 0, 0);
  w->u32(1);
  w->u32(1);
  w->u32(duration);
  w->u32(0);
  w->u32(kOtherSample);
}

}  // namespace

Result<Mp4Writer> Mp4Writer::start(std::unique_ptr<ByteSink> sink, const Mp4Track& track) {
  GLOAM_CHECK(track.sps.size() >= 4 && !track.pps.empty(), "an MP4 file needs parameter sets");
  GLOAM_CHECK(track.rate.num > 0 && track.rate.den > 0, "the frame rate must be positive");
  Mp4Writer writer(std::move(sink), track);
  // Some players keep time badly with coarse scales, so the rate is expressed in units of at least
  // 1/10000 s, exactly.
  const int64_t multiple = std::max<int64_t>(1, (10000 + track.rate.num - 1) / track.rate.num);
  constexpr int64_t kMax = std::numeric_limits<uint32_t>::max();
  if (track.rate.num > kMax / multiple || track.rate.den > kMax / multiple)
    return Error{ErrorKind::kInput, fmt::format("the frame rate {}/{} is out of range",
                                                track.rate.num, track.rate.den)};
  writer.timescale_ = static_cast<uint32_t>(track.rate.num * multiple);
  writer.duration_ = static_cast<uint32_t>(track.rate.den * multiple);

  BoxWriter w;
  {
    const auto ftyp = w.box("ftyp");
    w.text("isom");
    w.u32(0x200);
    w.text("isomiso6avc1mp41");
  }
  writer.free_box_ = w.bytes.size();
  {
    const auto free = w.box("free");
    w.zeros(8);  // room for a 64-bit size
  }
  w.raw(writer.movie_header(false));
  GLOAM_TRY_STATUS(writer.append(w.bytes));
  return writer;
}

Status Mp4Writer::append(std::span<const uint8_t> bytes) {
  GLOAM_TRY_STATUS(sink_->append(bytes));
  end_ += bytes.size();
  return {};
}

std::vector<uint8_t> Mp4Writer::movie_header(bool indexed) const {
  const uint64_t pictures =
      samples_.empty() ? 0
                       : static_cast<uint64_t>(samples_.back().index - samples_.front().index + 1);
  const uint64_t duration = indexed ? pictures * duration_ : 0;
  BoxWriter w;
  {
    const auto moov = w.box("moov");
    write_movie_times(timescale_, duration, &w);
    {
      const auto trak = w.box("trak");
      write_track_header(track_, duration, &w);
      const auto mdia = w.box("mdia");
      write_media_headers(timescale_, duration, &w);
      const auto minf = w.box("minf");
      write_media_information(&w);
      const auto stbl = w.box("stbl");
      write_sample_entry(track_, &w);
      const std::span<const Mp4Sample> listed =
          indexed ? std::span<const Mp4Sample>(samples_) : std::span<const Mp4Sample>();
      write_sample_durations(listed, duration_, &w);
      if (!listed.empty()) write_key_samples(listed, &w);
      write_sample_places(listed, &w);
    }
    if (!indexed) write_fragment_defaults(duration_, &w);
  }
  return std::move(w.bytes);
}

Status Mp4Writer::add(int64_t index, bool key, std::span<const uint8_t> sample) {
  GLOAM_CHECK(samples_.empty() || index > samples_.back().index, "frames must be added in order");
  const int64_t first = samples_.empty() ? index : samples_.front().index;
  BoxWriter w;
  size_t data_offset = 0;
  {
    const auto moof = w.box("moof");
    {
      const auto mfhd = w.full_box("mfhd", 0, 0);
      w.u32(static_cast<uint32_t>(samples_.size() + 1));
    }
    const auto traf = w.box("traf");
    {
      const auto tfhd = w.full_box("tfhd", 0, 0x020000);  // offsets count from this moof
      w.u32(1);
    }
    {
      const auto tfdt = w.full_box("tfdt", 1, 0);
      w.u64(static_cast<uint64_t>(index - first) * duration_);
    }
    const auto trun = w.full_box("trun", 0, 0x000601);  // data offset; size and flags per sample
    w.u32(1);
    data_offset = w.bytes.size();
    w.u32(0);
    w.u32(static_cast<uint32_t>(sample.size()));
    w.u32(key ? kSyncSample : kOtherSample);
  }
  w.patch32(data_offset, static_cast<uint32_t>(w.bytes.size() + 8));
  w.u32(static_cast<uint32_t>(sample.size() + 8));
  w.text("mdat");
  const uint64_t offset = end_ + w.bytes.size();
  w.raw(sample);
  GLOAM_TRY_STATUS(append(w.bytes));
  samples_.push_back({offset, static_cast<uint32_t>(sample.size()), index, key});
  return {};
}

Status Mp4Writer::finish() {
  const uint64_t index_offset = end_;
  GLOAM_TRY_STATUS(sink_->truncate(index_offset));  // without what a failed add() may have left
  const std::vector<uint8_t> index = movie_header(true);
  if (Status status = append(index); !status.ok()) {
    (void)sink_->truncate(index_offset);  // still a good fragmented file
    return status;
  }
  // One box now spans header and fragments: readers see plain media data and the index behind it.
  BoxWriter w;
  w.u32(1);
  w.text("mdat");
  w.u64(index_offset - free_box_);
  GLOAM_TRY_STATUS(sink_->overwrite(free_box_, w.bytes));
  return sink_->close();
}

}  // namespace gloam
