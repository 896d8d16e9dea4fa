// A cache of their own for the tests of one run: light that an earlier build has kept would hide
// changes of the interactive tier.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace gloam {
namespace {

class OwnCache : public ::testing::Environment {
 public:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "gloam_render_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    setenv("GLOAM_CACHE", name.c_str(), 1);
  }
  void TearDown() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

 private:
  std::filesystem::path folder_;
};

const auto* const kOwnCache = ::testing::AddGlobalTestEnvironment(new OwnCache);

}  // namespace
}  // namespace gloam
