#include <gtest/gtest.h>
#include <unistd.h>
#include <wels/codec_api.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/files.h"
#include "render/film/video.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

/// A sink into memory.
class MemorySink : public ByteSink {
 public:
  explicit MemorySink(std::vector<uint8_t>* bytes) : bytes_(bytes) {}
  Status append(std::span<const uint8_t> more) override {
    bytes_->insert(bytes_->end(), more.begin(), more.end());
    return {};
  }
  Status overwrite(uint64_t offset, std::span<const uint8_t> with) override {
    EXPECT_LE(offset + with.size(), bytes_->size());
    std::copy(with.begin(), with.end(), bytes_->begin() + static_cast<std::ptrdiff_t>(offset));
    return {};
  }
  Status truncate(uint64_t size) override {
    bytes_->resize(size);
    return {};
  }
  Status close() override { return {}; }

 private:
  std::vector<uint8_t>* bytes_;
};

// --- a reader of MP4, independent of the writer: boxes by their sizes and types ---

struct Box {
  std::string type;
  size_t start, body, end;
};

uint64_t number(const std::vector<uint8_t>& b, size_t at, size_t bytes) {
  uint64_t x = 0;
  for (size_t i = 0; i < bytes; ++i) x = (x << 8) | b.at(at + i);
  return x;
}

/// The complete boxes in [begin, end).
std::vector<Box> boxes_in(const std::vector<uint8_t>& b, size_t begin, size_t end) {
  std::vector<Box> out;
  while (begin + 8 <= end) {
    uint64_t size = number(b, begin, 4);
    size_t header = 8;
    if (size == 1 && begin + 16 <= end) {
      size = number(b, begin + 8, 8);
      header = 16;
    }
    if (size < header || size > end - begin) break;
    out.push_back({std::string(b.begin() + static_cast<std::ptrdiff_t>(begin) + 4,
                               b.begin() + static_cast<std::ptrdiff_t>(begin) + 8),
                   begin, begin + header, begin + size});
    begin += size;
  }
  return out;
}

std::optional<Box> find_box(const std::vector<uint8_t>& b, std::vector<Box> level,
                            std::initializer_list<const char*> path) {
  std::optional<Box> found;
  for (const char* type : path) {
    found.reset();
    for (const Box& box : level)
      if (box.type == type) found = box;
    if (!found) return {};
    level = boxes_in(b, found->body, found->end);
  }
  return found;
}

struct Movie {
  std::vector<std::pair<size_t, size_t>> samples;  // offset, size
  std::vector<uint64_t> durations;
  std::vector<size_t> keys;  // from 1
  uint64_t timescale = 0, duration = 0;
  std::vector<uint8_t> parameter_sets;  // with start codes
};

void read_avcc(const std::vector<uint8_t>& b, const Box& moov, Movie* movie) {
  const auto stsd =
      find_box(b, boxes_in(b, moov.body, moov.end), {"trak", "mdia", "minf", "stbl", "stsd"});
  ASSERT_TRUE(stsd);
  const std::vector<Box> entries = boxes_in(b, stsd->body + 8, stsd->end);
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].type, "avc1");
  const auto avcc = find_box(b, boxes_in(b, entries[0].body + 78, entries[0].end), {"avcC"});
  ASSERT_TRUE(avcc);
  size_t at = avcc->body + 5;
  for (int set = 0; set < 2; ++set) {
    EXPECT_EQ(b[at] & 0x1f, 1);
    const size_t size = number(b, at + 1, 2);
    movie->parameter_sets.insert(movie->parameter_sets.end(), {0, 0, 0, 1});
    movie->parameter_sets.insert(movie->parameter_sets.end(),
                                 b.begin() + static_cast<std::ptrdiff_t>(at + 3),
                                 b.begin() + static_cast<std::ptrdiff_t>(at + 3 + size));
    at += 3 + size;
  }
}

/// An ordinary MP4: everything from the index at the end.
Movie read_indexed(const std::vector<uint8_t>& b) {
  Movie movie;
  const std::vector<Box> top = boxes_in(b, 0, b.size());
  EXPECT_EQ(top.size(), 3u);
  if (top.size() != 3) return movie;
  EXPECT_EQ(top[0].type, "ftyp");
  EXPECT_EQ(top[1].type, "mdat");
  EXPECT_EQ(top[2].type, "moov");
  EXPECT_EQ(top[2].end, b.size());
  read_avcc(b, top[2], &movie);
  const std::vector<Box> mdia = boxes_in(b, find_box(b, top, {"moov", "trak", "mdia"})->body,
                                         find_box(b, top, {"moov", "trak", "mdia"})->end);
  const Box mdhd = *find_box(b, mdia, {"mdhd"});
  movie.timescale = number(b, mdhd.body + 20, 4);
  movie.duration = number(b, mdhd.body + 24, 8);
  const Box stts = *find_box(b, mdia, {"minf", "stbl", "stts"});
  for (uint64_t i = 0; i < number(b, stts.body + 4, 4); ++i)
    for (uint64_t k = 0; k < number(b, stts.body + 8 + 8 * i, 4); ++k)
      movie.durations.push_back(number(b, stts.body + 12 + 8 * i, 4));
  const Box stsz = *find_box(b, mdia, {"minf", "stbl", "stsz"});
  const Box co64 = *find_box(b, mdia, {"minf", "stbl", "co64"});
  const uint64_t n = number(b, stsz.body + 8, 4);
  EXPECT_EQ(number(b, co64.body + 4, 4), n);
  for (uint64_t i = 0; i < n; ++i)
    movie.samples.push_back(
        {number(b, co64.body + 8 + 8 * i, 8), number(b, stsz.body + 12 + 4 * i, 4)});
  const Box stss = *find_box(b, mdia, {"minf", "stbl", "stss"});
  for (uint64_t i = 0; i < number(b, stss.body + 4, 4); ++i)
    movie.keys.push_back(number(b, stss.body + 8 + 4 * i, 4));
  return movie;
}

/// As read_indexed(), for files that may hold no picture and so no key pictures.
Movie read_indexed_or_empty(const std::vector<uint8_t>& b, int pictures) {
  return pictures == 0 ? Movie() : read_indexed(b);
}

/// A file that was cut off: header and complete fragments.
Movie read_fragments(const std::vector<uint8_t>& b) {
  Movie movie;
  const std::vector<Box> top = boxes_in(b, 0, b.size());
  for (size_t i = 0; i < top.size(); ++i) {
    if (top[i].type == "moov") read_avcc(b, top[i], &movie);
    if (top[i].type != "moof" || i + 1 >= top.size()) continue;
    EXPECT_EQ(top[i + 1].type, "mdat");
    const Box trun = *find_box(b, boxes_in(b, top[i].body, top[i].end), {"traf", "trun"});
    const size_t offset = number(b, trun.body + 8, 4), size = number(b, trun.body + 12, 4);
    EXPECT_EQ(top[i].start + offset, top[i + 1].body);
    EXPECT_EQ(top[i + 1].end - top[i + 1].body, size);
    movie.samples.push_back({top[i].start + offset, size});
  }
  return movie;
}

/// Decodes with OpenH264's decoder; returns the luma planes.
std::vector<std::vector<uint8_t>> decode(const std::vector<uint8_t>& b, const Movie& movie,
                                         int width, int height) {
  ISVCDecoder* decoder = nullptr;
  EXPECT_EQ(WelsCreateDecoder(&decoder), 0);
  SDecodingParam parameters = {};
  parameters.sVideoProperty.eVideoBsType = VIDEO_BITSTREAM_AVC;
  EXPECT_EQ(decoder->Initialize(&parameters), 0);
  std::vector<std::vector<uint8_t>> out;
  uint8_t* planes[3] = {};
  SBufferInfo info = {};
  const auto take = [&] {
    if (info.iBufferStatus != 1) return;
    EXPECT_EQ(info.UsrData.sSystemBuffer.iWidth, width);
    EXPECT_EQ(info.UsrData.sSystemBuffer.iHeight, height);
    std::vector<uint8_t> luma;
    for (int y = 0; y < height; ++y) {
      const uint8_t* row = planes[0] + y * info.UsrData.sSystemBuffer.iStride[0];
      luma.insert(luma.end(), row, row + width);
    }
    out.push_back(std::move(luma));
  };
  for (size_t i = 0; i < movie.samples.size(); ++i) {
    std::vector<uint8_t> stream = i == 0 ? movie.parameter_sets : std::vector<uint8_t>();
    size_t at = movie.samples[i].first;
    const size_t end = at + movie.samples[i].second;
    while (at < end) {
      const size_t size = number(b, at, 4);
      EXPECT_LE(at + 4 + size, end);
      stream.insert(stream.end(), {0, 0, 0, 1});
      stream.insert(stream.end(), b.begin() + static_cast<std::ptrdiff_t>(at + 4),
                    b.begin() + static_cast<std::ptrdiff_t>(at + 4 + size));
      at += 4 + size;
    }
    EXPECT_EQ(
        decoder->DecodeFrameNoDelay(stream.data(), static_cast<int>(stream.size()), planes, &info),
        dsErrorFree)
        << "picture " << i;
    take();
  }
  // This decoder keeps one picture back in case pictures come out of order.
  info = {};
  decoder->FlushFrame(planes, &info);
  take();
  decoder->Uninitialize();
  WelsDestroyDecoder(decoder);
  return out;
}

/// A textured floor that turns under a moving ball: edges, gradients, motion.
std::vector<uint8_t> test_picture(int width, int height, int index) {
  std::vector<uint8_t> rgb;
  const float t = static_cast<float>(index) * 0.05f;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(width) - 0.5f;
      const float v = static_cast<float>(y) / static_cast<float>(height) - 0.5f;
      const float a = u * std::cos(t) - v * std::sin(t), b = u * std::sin(t) + v * std::cos(t);
      float r = 120 + 60 * std::sin(25 * a), g = 110 + 50 * std::sin(31 * b), blue = 90 + 60 * u;
      const float d = (u - 0.3f * std::sin(t)) * (u - 0.3f * std::sin(t)) + v * v;
      if (d < 0.02f) {
        r = 220 - 4000 * d;
        g = 180 - 4000 * d;
        blue = 60;
      }
      for (const float c : {r, g, blue})
        rgb.push_back(static_cast<uint8_t>(std::fmin(std::fmax(c, 0), 255)));
    }
  }
  return rgb;
}

std::vector<uint8_t> make_video(int width, int height, int pictures, bool finish = true,
                                Rational rate = {20, 1}) {
  std::vector<uint8_t> bytes;
  Result<VideoWriter> writer = VideoWriter::start(std::make_unique<MemorySink>(&bytes),
                                                  {.width = width, .height = height, .rate = rate});
  EXPECT_TRUE(writer.ok());
  for (int i = 0; i < pictures; ++i)
    EXPECT_TRUE(writer->add(i, test_picture(width, height, i)).ok());
  if (finish) {
    EXPECT_TRUE(writer->finish().ok());
  }
  return bytes;
}

double luma_psnr(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return 10 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / std::fmax(sum, 1e-9));
}

TEST(Video, FinishedFileIsAnOrdinaryMp4WithEveryPictureVisuallyClean) {
  const int n = 45;
  const std::vector<uint8_t> file = make_video(320, 240, n);
  const Movie movie = read_indexed(file);
  ASSERT_EQ(movie.samples.size(), static_cast<size_t>(n));
  EXPECT_EQ(movie.keys, (std::vector<size_t>{1, 21, 41}));  // one a second
  EXPECT_EQ(movie.duration * 20, movie.timescale * n);
  for (const uint64_t d : movie.durations) EXPECT_EQ(d * 20, movie.timescale);
  const auto luma = decode(file, movie, 320, 240);
  ASSERT_EQ(luma.size(), static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) {
    Yuv420 source;
    rgb_to_yuv420(320, 240, test_picture(320, 240, i), &source);
    EXPECT_GT(luma_psnr(luma[static_cast<size_t>(i)], source.y), 40) << "picture " << i;
  }
}

TEST(Video, IsReadableWhereverItIsCutOff) {
  const int n = 12;
  const std::vector<uint8_t> unfinished = make_video(160, 120, n, false);
  const Movie whole = read_fragments(unfinished);
  ASSERT_EQ(whole.samples.size(), static_cast<size_t>(n));
  for (size_t cut = whole.samples[0].first; cut <= unfinished.size(); cut += 97) {
    size_t complete = 0;
    while (complete < whole.samples.size() &&
           whole.samples[complete].first + whole.samples[complete].second <= cut)
      ++complete;
    const std::vector<uint8_t> prefix(unfinished.begin(),
                                      unfinished.begin() + static_cast<std::ptrdiff_t>(cut));
    const Movie movie = read_fragments(prefix);
    ASSERT_EQ(movie.samples.size(), complete) << "cut at " << cut;
    EXPECT_EQ(decode(prefix, movie, 160, 120).size(), complete) << "cut at " << cut;
  }
}

/// Takes half of the n-th append and then fails once, as a disk does that is full for a while.
class FailingSink : public MemorySink {
 public:
  FailingSink(std::vector<uint8_t>* bytes, int n) : MemorySink(bytes), left_(n) {}
  Status append(std::span<const uint8_t> more) override {
    if (left_-- != 0) return MemorySink::append(more);
    (void)MemorySink::append(more.first(more.size() / 2));
    return Error{ErrorKind::kIo, "disk full"};
  }

 private:
  int left_;
};

TEST(Video, FinishesCleanlyAfterAFailedWrite) {
  for (int n = 0; n < 8; ++n) {
    std::vector<uint8_t> bytes;
    Result<VideoWriter> writer =
        VideoWriter::start(std::make_unique<FailingSink>(&bytes, n), {.width = 64, .height = 48});
    ASSERT_TRUE(writer.ok());
    int added = 0;
    while (added < 5 && writer->add(added, test_picture(64, 48, added)).ok()) ++added;
    EXPECT_EQ(added, std::min(std::max(n - 1, 0), 5));  // the first append is the header
    const Status finished = writer->finish();
    if (n == 0) continue;  // not even a header
    // Append 6 is the index of all 5 pictures: then the file stays a fragmented one.
    EXPECT_EQ(finished.ok(), n != 6);
    const Movie movie = n == 6 ? read_fragments(bytes) : read_indexed_or_empty(bytes, added);
    EXPECT_EQ(movie.samples.size(), static_cast<size_t>(added));
    EXPECT_EQ(decode(bytes, movie, 64, 48).size(), static_cast<size_t>(added));
  }
}

TEST(Video, SameBytesEveryTime) { EXPECT_EQ(make_video(160, 120, 30), make_video(160, 120, 30)); }

TEST(Video, RatesAreExactAndMissingPicturesKeepTheTime) {
  const std::vector<uint8_t> ntsc = make_video(64, 48, 5, true, {30000, 1001});
  const Movie movie = read_indexed(ntsc);
  for (const uint64_t d : movie.durations) EXPECT_EQ(d * 30000, movie.timescale * 1001);

  std::vector<uint8_t> bytes;
  Result<VideoWriter> writer =
      VideoWriter::start(std::make_unique<MemorySink>(&bytes), {.width = 64, .height = 48});
  ASSERT_TRUE(writer.ok());
  for (const int i : {3, 4, 9}) ASSERT_TRUE(writer->add(i, test_picture(64, 48, i)).ok());
  ASSERT_TRUE(writer->finish().ok());
  const Movie gaps = read_indexed(bytes);
  const uint64_t one = gaps.timescale / 20;
  EXPECT_EQ(gaps.durations, (std::vector<uint64_t>{one, 5 * one, one}));
  EXPECT_EQ(gaps.duration, 7 * one);
}

TEST(Video, OddSizesAreExtendedAndImpossibleOnesRefused) {
  const std::vector<uint8_t> file = make_video(33, 21, 3);
  EXPECT_EQ(decode(file, read_indexed(file), 34, 22).size(), 3u);
  std::vector<uint8_t> bytes;
  for (const auto& [w, h] : {std::pair{8, 8}, {16384, 16384}}) {
    const Result<VideoWriter> refused =
        VideoWriter::start(std::make_unique<MemorySink>(&bytes), {.width = w, .height = h});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().kind, ErrorKind::kUnsupported);
    EXPECT_FALSE(refused.error().hint.empty());
  }
}

/// Output of a command; empty if it is not installed.
std::string output_of(const std::string& command) {
  std::string out;
  FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return out;
  char buffer[65536];
  for (size_t n; (n = fread(buffer, 1, sizeof(buffer), pipe)) > 0;) out.append(buffer, n);
  pclose(pipe);
  return out;
}

TEST(Video, OtherProgramsReadItWholeAndCut) {
  if (output_of("ffprobe -version").empty()) GTEST_SKIP() << "ffprobe is not installed";
  const fs::path path =
      fs::path(testing::TempDir()) / ("gloam_video_" + std::to_string(getpid()) + ".mp4");
  const auto probe = [&](const std::vector<uint8_t>& bytes, const std::string& entries) {
    EXPECT_TRUE(write_file_atomic(path, bytes).ok());
    return output_of("ffprobe -v error -count_frames -of csv=p=0 -show_entries stream=" + entries +
                     " " + path.string());
  };
  const std::vector<uint8_t> file = make_video(160, 120, 25);
  EXPECT_EQ(probe(file,
                  "codec_name,profile,width,height,pix_fmt,color_range,color_space,"
                  "color_transfer,color_primaries,r_frame_rate,nb_frames,nb_read_frames"),
            "h264,High,160,120,yuv420p,tv,bt709,bt709,bt709,20/1,25,25\n");
  Yuv420 source;
  const std::string decoded =
      output_of("ffmpeg -v error -i " + path.string() + " -f rawvideo -pix_fmt yuv420p -");
  ASSERT_EQ(decoded.size(), 25u * 160 * 120 * 3 / 2);
  for (int i = 0; i < 25; ++i) {
    rgb_to_yuv420(160, 120, test_picture(160, 120, i), &source);
    const auto* first = reinterpret_cast<const uint8_t*>(decoded.data()) +
                        static_cast<size_t>(i) * 160 * 120 * 3 / 2;
    EXPECT_GT(luma_psnr({first, first + 160 * 120}, source.y), 40);
    EXPECT_GT(luma_psnr({first + 160 * 120, first + 160 * 120 * 5 / 4}, source.u), 40);
  }
  const std::vector<uint8_t> unfinished = make_video(160, 120, 25, false);
  const Movie whole = read_fragments(unfinished);
  for (const size_t i : {size_t{0}, size_t{7}, size_t{24}}) {
    const size_t cut = whole.samples[i].first + whole.samples[i].second;
    const std::string frames =
        probe({unfinished.begin(), unfinished.begin() + static_cast<std::ptrdiff_t>(cut)},
              "nb_read_frames");
    EXPECT_EQ(frames, std::to_string(i + 1) + "\n");
  }
  fs::remove(path);
}

}  // namespace
}  // namespace gloam
