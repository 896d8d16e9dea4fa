// MP4 boxes (ISO/IEC 14496-12) of a video's index.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "report/video_frames.h"

namespace gloam {
namespace {

constexpr size_t kMostSamples = 4'000'000;

using ByteSpan = std::span<const uint8_t>;

uint64_t big_endian(ByteSpan bytes, size_t at, size_t count) {
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i)
    value = value << 8 | (at + i < bytes.size() ? bytes[at + i] : 0);
  return value;
}

struct Mp4Box {
  std::string type;
  uint64_t offset = 0;  // of its content in `all`
  ByteSpan content;
};

// Boxes one behind the other; ends at the first that does not fit.
std::vector<Mp4Box> boxes_in(ByteSpan all, uint64_t base) {
  std::vector<Mp4Box> out;
  uint64_t at = 0;
  while (at + 8 <= all.size() && out.size() < kMostSamples * 2) {
    uint64_t size = big_endian(all, at, 4), head = 8;
    if (size == 1) {
      size = big_endian(all, at + 8, 8);
      head = 16;
    }
    if (size == 0) size = all.size() - at;
    if (size < head || size > all.size() - at) break;
    out.push_back({std::string(reinterpret_cast<const char*>(all.data()) + at + 4, 4),
                   base + at + head, all.subspan(at + head, size - head)});
    at += size;
  }
  return out;
}

// The first box at the end of a path of types; empty content = there is none.
Mp4Box box_at(ByteSpan all, std::initializer_list<const char*> path) {
  Mp4Box found{"", 0, all};
  for (const char* type : path) {
    const auto inside = boxes_in(found.content, found.offset);
    const auto next = std::find_if(inside.begin(), inside.end(),
                                   [&](const Mp4Box& box) { return box.type == type; });
    if (next == inside.end()) return {};
    found = *next;
  }
  return found;
}

void take_parameter_sets(ByteSpan stsd, VideoIndex* out) {
  // Sample entry avc1: 8 of the list, 8 of its head, 78 of its fields, then boxes.
  constexpr size_t kHead = 8 + 8 + 78;
  if (stsd.size() < kHead) return;
  const Mp4Box avcc = box_at(stsd.subspan(kHead), {"avcC"});
  const ByteSpan c = avcc.content;
  if (c.size() < 8 || (c[4] & 3) != 3) return;  // lengths of 4 bytes
  const size_t sps = big_endian(c, 6, 2);
  if (8 + sps + 3 > c.size()) return;
  out->sps.assign(c.begin() + 8, c.begin() + 8 + static_cast<std::ptrdiff_t>(sps));
  const size_t at = 8 + sps + 1, pps = big_endian(c, at, 2);
  if (at + 2 + pps > c.size()) return;
  out->pps.assign(c.begin() + static_cast<std::ptrdiff_t>(at + 2),
                  c.begin() + static_cast<std::ptrdiff_t>(at + 2 + pps));
}

// Sample tables of a finished file; chunks hold one sample each, as ours do.
void take_tables(ByteSpan stbl, double timescale, VideoIndex* out) {
  const ByteSpan sizes = box_at(stbl, {"stsz"}).content, places = box_at(stbl, {"co64"}).content;
  const ByteSpan durations = box_at(stbl, {"stts"}).content, keys = box_at(stbl, {"stss"}).content;
  const size_t count = std::min<uint64_t>(
      {big_endian(sizes, 8, 4), sizes.size() / 4, places.size() / 8, kMostSamples});
  double time = 0;
  size_t run = 0, left = big_endian(durations, 8, 4);
  for (size_t i = 0; i < count; ++i) {
    out->samples.push_back({big_endian(places, 8 + 8 * i, 8),
                            static_cast<uint32_t>(big_endian(sizes, 12 + 4 * i, 4)), time, false});
    if (left == 0 && 8 * (run + 2) + 8 <= durations.size())
      left = big_endian(durations, 8 + 8 * ++run, 4);
    time += static_cast<double>(big_endian(durations, 12 + 8 * run, 4)) / timescale;
    if (left > 0) --left;
  }
  const size_t key_count = std::min<uint64_t>(big_endian(keys, 4, 4), keys.size() / 4);
  for (size_t i = 0; i < key_count; ++i) {
    const uint64_t sample = big_endian(keys, 8 + 4 * i, 4);
    if (sample >= 1 && sample <= out->samples.size()) out->samples[sample - 1].key = true;
  }
}

// Fragments of a file that was cut: a moof and an mdat for each picture.
void take_fragments(const std::vector<Mp4Box>& boxes, double timescale, VideoIndex* out) {
  for (size_t i = 0; i + 1 < boxes.size() && out->samples.size() < kMostSamples; ++i) {
    if (boxes[i].type != "moof" || boxes[i + 1].type != "mdat") continue;
    const ByteSpan time = box_at(boxes[i].content, {"traf", "tfdt"}).content;
    const ByteSpan run = box_at(boxes[i].content, {"traf", "trun"}).content;
    const Mp4Box& data = boxes[i + 1];
    out->samples.push_back({data.offset, static_cast<uint32_t>(data.content.size()),
                            static_cast<double>(big_endian(time, 4, 8)) / timescale,
                            (big_endian(run, 16, 4) & 0x02000000) != 0});
  }
}

}  // namespace

Result<VideoIndex> index_video(ByteSpan file, const std::string& name) {
  const auto damaged = [&](const char* what) {
    return Error{ErrorKind::kInput, what, {name, 0, 0}};
  };
  const ByteSpan media = box_at(file, {"moov", "trak", "mdia"}).content;
  const ByteSpan stbl = box_at(media, {"minf", "stbl"}).content;
  const ByteSpan mdhd = box_at(media, {"mdhd"}).content;
  if (stbl.empty() || mdhd.empty()) return damaged("is not an MP4 file with a video track");
  const double timescale = static_cast<double>(big_endian(mdhd, mdhd[0] == 1 ? 20 : 12, 4));
  if (timescale < 1) return damaged("has no time scale");
  VideoIndex out;
  take_parameter_sets(box_at(stbl, {"stsd"}).content, &out);
  if (out.sps.empty() || out.pps.empty()) return damaged("is not H.264 with 4-byte lengths");
  take_tables(stbl, timescale, &out);
  if (out.samples.empty()) take_fragments(boxes_in(file, 0), timescale, &out);
  if (out.samples.empty()) return damaged("contains no frames");
  for (const VideoIndex::Sample& sample : out.samples)
    if (sample.offset > file.size() || sample.size > file.size() - sample.offset)
      return damaged("has frames beyond its end");
  out.samples[0].key = true;
  return out;
}

}  // namespace gloam
