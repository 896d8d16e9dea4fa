// Grids of numbers: right files, wrong files, files that promise too much.

#include "geometry/volume_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "geometry/test/largest_request.h"
#include "geometry/test/npy_writer.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;

constexpr uint64_t kMost = 1000;

Result<VolumeFile> decode(const std::string& bytes, uint64_t most = kMost) {
  return decode_npy({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "smoke.npy",
                    most);
}
std::string message(const std::string& bytes) {
  const Result<VolumeFile> grid = decode(bytes);
  return grid.ok() ? "" : grid.error().to_string();
}

TEST(VolumeFile, ReadsEveryVersionInSinglesAndDoubles) {
  const std::vector<float> values{0, 1, 2, 3, 4, 5};
  const std::vector<double> doubles(values.begin(), values.end());
  for (const int version : {1, 2, 3}) {
    for (const bool wide : {false, true}) {
      const Result<VolumeFile> grid =
          decode(npy_file(npy_head("1, 2, 3", wide ? "<f8" : "<f4"),
                          wide ? npy_values(doubles) : npy_values(values), version));
      ASSERT_TRUE(grid.ok()) << grid.error().to_string();
      EXPECT_EQ(grid->nx, 3);
      EXPECT_EQ(grid->ny, 2);
      EXPECT_EQ(grid->nz, 1);
      EXPECT_EQ(grid->values, values);
    }
  }
}

TEST(VolumeFile, SaysWhatIsWrong) {
  const std::string one = npy_values(std::vector<float>{1});
  EXPECT_THAT(message(""), HasSubstr("is not an .npy file"));
  EXPECT_THAT(message("\x93NUMPY\1"), HasSubstr("is not an .npy file"));
  EXPECT_THAT(message(npy_file(npy_head("1, 1, 1"), one, 9)), HasSubstr("unknown version 9"));
  EXPECT_THAT(message(npy_file(npy_head("1, 1, 1", ">f4"), one)), HasSubstr("little-endian"));
  EXPECT_THAT(message(npy_file(npy_head("1, 1, 1", "<i4"), one)), HasSubstr("little-endian"));
  EXPECT_THAT(message(npy_file(npy_head("1, 1, 1", "|O"), one)), HasSubstr("little-endian"));
  EXPECT_THAT(message(npy_file(npy_head("1, 1, 1", "<f4", "True"), one)), HasSubstr("C order"));
  for (const char* shape : {"1,", "1, 1", "1, 1, 1, 1", "", "a, b, c", "-1, 1, 1"})
    EXPECT_THAT(message(npy_file(npy_head(shape), one)), HasSubstr("three axes")) << shape;
  EXPECT_THAT(message(npy_file(npy_head("1, 0, 1"), "")), HasSubstr("no voxels"));
  EXPECT_THAT(message(npy_file(npy_head("1, 1, 2"), one)), HasSubstr("its shape requires"));
  EXPECT_THAT(message(npy_file("{}", one)), HasSubstr("little-endian"));
  for (const float bad : {-1.0f, std::nanf(""), std::numeric_limits<float>::infinity()}) {
    EXPECT_THAT(message(npy_file(npy_head("1, 1, 1"), npy_values(std::vector<float>{bad}))),
                HasSubstr("finite and not negative"));
  }
  EXPECT_THAT(message(npy_file(npy_head("1, 1, 1", "<f8"), npy_values(std::vector<double>{1e300}))),
              HasSubstr("finite and not negative"));
}

TEST(VolumeFile, TakesNoMemoryForWhatAFilePromises) {
  for (const char* shape : {"4294967296, 4294967296, 1", "1, 1, 1001", "999, 999, 999",
                            "18446744073709551615, 18446744073709551615, 18446744073709551615"}) {
    largest_request = 0;
    EXPECT_THAT(message(npy_file(npy_head(shape), "1234")), HasSubstr("the limit is 1000"));
    EXPECT_LT(largest_request.load(), 100000u);
  }
}

TEST(VolumeFile, RefusesATooLargeFileBeforeReadingIt) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("gloam_npy_" + std::to_string(::getpid()));
  std::ofstream(path, std::ios::binary) << npy_file(npy_head("1024, 1024, 1024"), "");
  std::filesystem::resize_file(path, uint64_t{4} << 30);  // a hole: takes no room on the disk
  largest_request = 0;
  const Result<VolumeFile> grid = read_npy(path, uint64_t{1} << 28);
  std::filesystem::remove(path);
  ASSERT_FALSE(grid.ok());
  EXPECT_THAT(grid.error().to_string(), HasSubstr("1024 x 1024 x 1024 voxels"));
  EXPECT_LT(largest_request.load(), 1000000u);
}

}  // namespace
}  // namespace gloam
