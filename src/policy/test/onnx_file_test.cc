#include "policy/onnx/onnx_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "policy/test/linear_network.h"
#include "policy/test/onnx_bytes.h"

namespace gloam {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr int64_t kHuge = int64_t{1} << 40;

Result<OnnxFile> parse(const std::string& bytes, const fs::path& path = "p.onnx") {
  return parse_onnx({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, path);
}

std::string error_of(const std::string& bytes, const fs::path& path = "p.onnx") {
  const auto file = parse(bytes, path);
  return file.ok() ? "" : file.error().to_string();
}

TEST(OnnxFile, HasPortsResultsAndMetadata) {
  const std::string entry = wire_field(1, "joint_names") + wire_field(2, "hip,knee");
  const auto file = parse(onnx_model(onnx_linear(), wire_field(14, entry)));
  ASSERT_TRUE(file.ok()) << file.error().to_string();
  ASSERT_EQ(file->inputs.size(), 1u);
  EXPECT_EQ(file->inputs[0].name, "obs");
  EXPECT_EQ(file->inputs[0].dims, (std::vector<int64_t>{-1, 4}));
  EXPECT_EQ(file->outputs[0].dims, (std::vector<int64_t>{-1, 2}));
  EXPECT_EQ(file->results, std::vector<std::string>{"actions"});
  ASSERT_NE(file->find("joint_names"), nullptr);
  EXPECT_EQ(*file->find("joint_names"), "hip,knee");
}

TEST(OnnxFile, WeightsThatAreAlsoInputsAreNoInputs) {
  OnnxGraph graph = onnx_linear();
  graph.inputs.push_back(onnx_port("w", {4, 2}));
  const auto file = parse(onnx_model(graph));
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->inputs.size(), 1u);
}

TEST(OnnxFile, RejectsOtherFormatsByName) {
  EXPECT_THAT(error_of("PK\x03\x04 archive/data.pkl"), HasSubstr("torch.save"));
  EXPECT_THAT(error_of(std::string("\x80\x02}q\x00.", 6)), HasSubstr("a Python pickle"));
  EXPECT_THAT(error_of("\x89HDF\r\n"), HasSubstr("an HDF5 file"));
  EXPECT_THAT(error_of(""), HasSubstr("not an ONNX file"));
  EXPECT_THAT(error_of("joints = [1, 2]"), HasSubstr("not an ONNX file"));
}

TEST(OnnxFile, RejectsSizesBeforeTheyAreAllocated) {
  const auto with_tensor = [](const std::string& tensor) {
    OnnxGraph graph = onnx_linear();
    graph.tensors.push_back(tensor);
    return error_of(onnx_model(graph));
  };
  EXPECT_THAT(with_tensor(onnx_tensor("big", {kHuge, 4})), HasSubstr("tensor 'big' of size"));
  EXPECT_THAT(with_tensor(onnx_tensor("big", {int64_t{1} << 32, int64_t{1} << 32})),
              HasSubstr("tensor 'big' of size"));
  EXPECT_THAT(with_tensor(onnx_tensor("odd", {-5, 3})), HasSubstr("negative size"));
  OnnxGraph many = onnx_linear();
  for (int i = 0; i < 40; ++i) many.tensors.push_back(onnx_tensor("part", {1 << 22}));
  EXPECT_THAT(error_of(onnx_model(many)), HasSubstr("the tensors before it would take"));
  OnnxGraph wide = onnx_linear();
  wide.inputs = {onnx_port("obs", {-1, kHuge})};
  EXPECT_THAT(error_of(onnx_model(wide)), HasSubstr("tensor 'obs' of size"));
}

TEST(OnnxFile, ChecksTensorsOfAttributesAndInnerGraphs) {
  const std::string tensor = wire_field(1, "value") + wire_field(5, onnx_tensor("big", {kHuge}));
  OnnxGraph constant = onnx_linear();
  constant.nodes.push_back(onnx_node("Constant", {}, "c", tensor));
  EXPECT_THAT(error_of(onnx_model(constant)), HasSubstr("tensor 'big'"));
  const std::string inner = wire_field(5, onnx_tensor("inner", {kHuge}));
  OnnxGraph branch = onnx_linear();
  branch.nodes.push_back(onnx_node("If", {"c"}, "q", wire_field(1, "b") + wire_field(6, inner)));
  EXPECT_THAT(error_of(onnx_model(branch)), HasSubstr("tensor 'inner'"));
  std::string nested;
  for (int i = 0; i < 40; ++i)
    nested = wire_field(1, onnx_node("If", {"c"}, "q", wire_field(6, nested)));
  OnnxGraph deep = onnx_linear();
  deep.nodes.push_back(onnx_node("If", {"c"}, "q", wire_field(6, nested)));
  EXPECT_THAT(error_of(onnx_model(deep)), HasSubstr("nests graphs"));
}

TEST(OnnxFile, RejectsLoops) {
  OnnxGraph graph = onnx_linear();
  graph.nodes.push_back(onnx_node("Loop", {"n", "c"}, "z"));
  EXPECT_THAT(error_of(onnx_model(graph)), HasSubstr("has a Loop"));
}

TEST(OnnxFile, WeightsInOtherFilesMustBeInItsFolder) {
  const PolicyFolder folder;
  folder.write("policy.onnx", "x");
  folder.write("weights.bin", std::string(32, 'w'));
  const fs::path outside = folder.path("").parent_path().parent_path() / "gloam_secret.bin";
  std::ofstream(outside) << "secret";
  const auto with_location = [&](const std::string& location) {
    const std::string entry = wire_field(1, "location") + wire_field(2, location);
    OnnxGraph graph = onnx_linear();
    graph.tensors = {onnx_tensor("w", {4, 2}) + wire_field(13, entry)};
    return parse(onnx_model(graph), folder.path("policy.onnx"));
  };
  const auto inside = with_location("weights.bin");
  ASSERT_TRUE(inside.ok()) << inside.error().to_string();
  EXPECT_TRUE(inside->external.contains("weights.bin"));
  fs::create_symlink(outside, folder.path("link.bin"));
  for (const std::string& location :
       {std::string("../gloam_secret.bin"), outside.string(), std::string("missing.bin"),
        std::string("link.bin"), std::string("")})
    EXPECT_FALSE(with_location(location).ok()) << location;
  fs::remove(outside);
}

// Every prefix, and copies with random bytes exchanged: an error or bounded declarations.
TEST(OnnxFile, DamagedFilesAreReadSafely) {
  const std::string entry = wire_field(1, "kp") + wire_field(2, "[1, 2]");
  const std::string whole = onnx_model(onnx_linear(), wire_field(14, entry));
  for (size_t size = 0; size < whole.size(); ++size)
    static_cast<void>(parse(whole.substr(0, size)));
  for (uint64_t seed = 0; seed < 20'000; ++seed) {
    std::string damaged = whole;
    uint64_t x = seed * 0x9E3779B97F4A7C15ull + 1;
    for (int change = 0; change < 3; ++change) {
      x ^= x << 13, x ^= x >> 7, x ^= x << 17;
      damaged[x % damaged.size()] = static_cast<char>(x >> 32);
    }
    const auto file = parse(damaged);
    EXPECT_TRUE(file.ok() || !file.error().message.empty());
  }
}

}  // namespace
}  // namespace gloam
