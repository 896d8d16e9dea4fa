// Files that others write, too, or take away.

#include "base/own_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace gloam {
namespace {

namespace fs = std::filesystem;

class OwnFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("gloam_own_" + std::to_string(::getpid()) + "_" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
    std::ofstream(file_ = folder_ / "a") << "0123456789";
    fd_ = ::open(file_.c_str(), O_WRONLY);
  }
  void TearDown() override {
    ::close(fd_);
    fs::remove_all(folder_);
  }
  static std::string says(const Status& status) {
    return status.ok() ? "ok" : status.error().message;
  }

  fs::path folder_, file_;
  int fd_ = -1;
};

TEST_F(OwnFile, IsWrittenByOneOnly) {
  ASSERT_TRUE(lock_for_writing(fd_, file_).ok());
  EXPECT_EQ(says(remove_unless_written(file_)), "is being written by another recording");
  EXPECT_TRUE(fs::exists(file_));
  ::close(fd_);
  fd_ = -1;
  EXPECT_EQ(says(remove_unless_written(file_)), "ok");
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_EQ(says(remove_unless_written(file_)), "ok") << "there is none";
  EXPECT_EQ(says(remove_unless_written(folder_)), "is a folder, not a file");
}

TEST_F(OwnFile, IsMissedWhenItIsTakenAway) {
  EXPECT_EQ(says(check_in_place(fd_, file_, 10)), "ok");
  EXPECT_EQ(says(check_not_cut(fd_, file_, 11)),
            "was truncated to 10 of 11 bytes while it was being written");
  fs::rename(file_, folder_ / "b");
  EXPECT_EQ(says(check_not_cut(fd_, file_, 10)), "ok");
  EXPECT_EQ(says(check_in_place(fd_, file_, 10)),
            "was moved or replaced while it was being written");
  std::ofstream(file_) << "other";
  EXPECT_EQ(says(check_in_place(fd_, file_, 10)),
            "was moved or replaced while it was being written");
  fs::remove(folder_ / "b");
  EXPECT_EQ(says(check_not_cut(fd_, file_, 10)), "was removed while it was being written");
}

TEST_F(OwnFile, FoldersAreWrittenIntoByOneOnly) {
  FolderLock first, second;
  ASSERT_TRUE(first.take(folder_).ok());
  EXPECT_EQ(says(second.take(folder_)), "is being written by another recording");
  EXPECT_TRUE(first.check().ok());
  first.release();
  EXPECT_EQ(says(second.take(folder_)), "ok");
  fs::remove_all(folder_);
  EXPECT_EQ(says(second.check()), "was removed while it was being written");
}

}  // namespace
}  // namespace gloam
