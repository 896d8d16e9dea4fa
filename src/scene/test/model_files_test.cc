#include "scene/model_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string add_error(const fs::path& file, const FileAccess& access = {}) {
  ModelFiles files;
  const Status status = files.add_model(file, access);
  return status.ok() ? "" : status.error().to_string();
}

TEST(XmlScan, RemembersWhereFilesAreNamed) {
  const Result<XmlScan> scan = scan_model_xml(
      "<mujoco>\n<asset>\n<mesh file='a.stl'/>\n<texture fileup='up.png'\n filedown='d.png'/>\n"
      "</asset>\n<include file='b.xml'/></mujoco>",
      "m.xml");
  ASSERT_TRUE(scan.ok());
  EXPECT_EQ(scan->root, "mujoco");
  ASSERT_EQ(scan->references.size(), 4u);
  EXPECT_EQ(scan->references[0].value, "a.stl");
  EXPECT_EQ(scan->references[0].line, 3);
  EXPECT_EQ(scan->references[2].attribute, "filedown");
  EXPECT_EQ(scan->references[3].line, 7);
}

TEST(XmlScan, RefusesWhatWouldHurtMuJoCo) {
  const auto error_of = [](const std::string& text) {
    const Result<XmlScan> scan = scan_model_xml(text, "m.xml");
    return scan.ok() ? "" : scan.error().to_string();
  };
  EXPECT_THAT(error_of(""), HasSubstr("m.xml: the file is empty"));
  EXPECT_THAT(error_of("<mujoco>\n<a></b></mujoco>"), HasSubstr("m.xml:2: is not well-formed XML"));
  std::string deep = "<mujoco>";
  for (int i = 0; i < 100000; ++i) deep += "<body>";
  EXPECT_NE(error_of(deep), "");
  for (int i = 0; i < 100000; ++i) deep += "</body>";
  EXPECT_THAT(error_of(deep + "</mujoco>"), HasSubstr("nested more than 200 deep"));
  EXPECT_THAT(error_of("<mujoco>\n<replicate count='1000000000'/></mujoco>"),
              HasSubstr("m.xml:2: replicate count"));
  EXPECT_THAT(error_of("<m><flexcomp count='1000 1000 1000'/></m>"), HasSubstr("flexcomp count"));
  EXPECT_THAT(error_of("<m><texture width='1e9'/></m>"), HasSubstr("texture width"));
  EXPECT_THAT(error_of("<m><size memory='9P'/></m>"), HasSubstr("64G"));
  EXPECT_EQ(error_of("<m><size memory='100M'/><flexcomp count='10 10 10'/></m>"), "");
}

TEST(ModelFiles, CyclesAreNamed) {
  TempFolder folder;
  const fs::path a = folder.write("a.xml", "<mujoco>\n<include file='b.xml'/></mujoco>");
  folder.write("b.xml", "<mujoco>\n\n<include file='a.xml'/></mujoco>");
  EXPECT_THAT(add_error(a), HasSubstr("b.xml:3: 'a.xml' includes itself"));
  const fs::path self =
      folder.write("c.xml", "<mujoco><asset><model name='c' file='c.xml'/></asset></mujoco>");
  EXPECT_THAT(add_error(self), HasSubstr("includes itself"));
}

TEST(ModelFiles, MissingAndWrongFilesAreNamed) {
  TempFolder folder;
  EXPECT_THAT(add_error(folder.path() / "no.xml"), HasSubstr("no.xml' does not exist"));
  EXPECT_THAT(add_error(folder.write("i.xml", "<mujoco>\n<include file='no.xml'/></mujoco>")),
              HasSubstr("i.xml:2: 'no.xml' does not exist"));
  EXPECT_THAT(add_error(folder.write("t.xml", "hello")), HasSubstr("not well-formed"));
  EXPECT_THAT(add_error(folder.write("h.xml", "<html/>")), HasSubstr("neither MJCF nor URDF"));
  EXPECT_THAT(add_error(folder.write("s.xml",
                                     "<mujoco><asset>\n<mesh file='http://x.y/a.stl'/>"
                                     "</asset></mujoco>")),
              HasSubstr("s.xml:2: the file 'http://x.y/a.stl' of <mesh> is a network address"));
  EXPECT_THAT(add_error(folder.path()), HasSubstr("folder"));
}

class Confinement : public ::testing::Test {
 protected:
  bool readable(const fs::path& model, const fs::path& file, const FileAccess& access = {}) {
    ModelFiles files;
    EXPECT_TRUE(files.add_model(model, access).ok());
    return files.read(file).ok();
  }
  TempFolder folder_;
  fs::path model_ = folder_.write("model.xml", "<mujoco/>");
};

TEST_F(Confinement, FourLevelsUpAndNoFurther) {
  EXPECT_TRUE(readable(model_, folder_.write("mesh.stl", "x")));
  EXPECT_TRUE(readable(model_, folder_.write("../../../../mesh.stl", "x")));
  EXPECT_FALSE(readable(model_, "/etc/passwd"));
  EXPECT_FALSE(readable(model_, folder_.path() / "../../../../../../../../../etc/passwd"));
  const fs::path above = folder_.path().parent_path().parent_path().parent_path().parent_path();
  const fs::path beside = above.parent_path() / (above.filename().string() + "_beside");
  std::ofstream(beside) << "x";
  EXPECT_FALSE(readable(model_, beside));
  fs::remove(beside);
}

TEST_F(Confinement, PackageXmlIsTheRoot) {
  folder_.write("../package.xml", "<package><name>robot</name></package>");
  EXPECT_TRUE(readable(model_, folder_.write("../meshes/mesh.stl", "x")));
  EXPECT_FALSE(readable(model_, folder_.write("../../mesh.stl", "x")));
}

TEST_F(Confinement, StrictAndRoot) {
  FileAccess strict;
  strict.strict = true;
  EXPECT_TRUE(readable(model_, folder_.write("meshes/mesh.stl", "x"), strict));
  EXPECT_FALSE(readable(model_, folder_.write("../mesh.stl", "x"), strict));
  FileAccess root;
  root.root = folder_.path().parent_path();
  EXPECT_TRUE(readable(model_, folder_.write("../mesh.stl", "x"), root));
  EXPECT_FALSE(readable(model_, folder_.write("../../mesh.stl", "x"), root));
}

TEST_F(Confinement, HomeFoldersAreNeverRoots) {
  const char* const before = std::getenv("HOME");
  const std::string saved = before == nullptr ? "" : before;
  ::setenv("HOME", folder_.path().parent_path().c_str(), 1);
  EXPECT_TRUE(readable(model_, folder_.write("mesh.stl", "x")));
  EXPECT_FALSE(readable(model_, folder_.write("../private_key", "x")));
  ::setenv("HOME", saved.c_str(), 1);
}

TEST_F(Confinement, LinksDoNotLeadOut) {
  const fs::path secret = folder_.write("../../secret", "x");
  fs::create_symlink(secret, folder_.path() / "mesh.stl");
  EXPECT_FALSE(readable(model_, folder_.path() / "mesh.stl"));
  fs::create_symlink("/etc", folder_.path() / "etc");
  EXPECT_FALSE(readable(model_, folder_.path() / "etc" / "passwd"));
  fs::create_symlink(folder_.write("real.stl", "x"), folder_.path() / "inside.stl");
  EXPECT_TRUE(readable(model_, folder_.path() / "inside.stl"));
}

TEST(WhyNotAPath, NamesWithSchemes) {
  for (const char* bad : {"http://a/b", "https://a", "file:///etc/passwd", "package://a/b", ""})
    EXPECT_NE(why_not_a_path(bad), "") << bad;
  for (const char* good : {"a.stl", "../a/b.stl", "/abs/a.stl", "dir/a:b.stl", "ünïcode.stl"})
    EXPECT_EQ(why_not_a_path(good), "") << good;
  EXPECT_NE(why_not_a_path(std::string_view("a\0b", 3)), "");
  EXPECT_NE(why_not_a_path(std::string(5000, 'a')), "");
}

TEST(FindPackage, ByMapByNameAndByPackageXml) {
  TempFolder folder;
  folder.write("../package.xml", "<package><name>my_robot</name></package>");
  const fs::path urdf = folder.write("robot.urdf", "<robot/>");
  EXPECT_EQ(find_package("my_robot", urdf, {}), folder.path().parent_path());
  EXPECT_EQ(find_package("b", urdf, {}), folder.path().parent_path().parent_path());
  EXPECT_TRUE(find_package("other", urdf, {}).empty());
  FileAccess access;
  access.packages = {{"other", "/opt/other"}};
  EXPECT_EQ(find_package("other", urdf, access), "/opt/other");
}

}  // namespace
}  // namespace gloam
