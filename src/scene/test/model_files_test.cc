#include "scene/files/model_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/files/mujoco_guard.h"
#include "scene/files/urdf_text.h"
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

// MuJoCo compares each attribute with all before it, and walks up from each link.
TEST(XmlScan, RefusesWhatTakesMuJoCoLong) {
  std::string wide = "<mujoco>\n<worldbody>\n<geom ";
  for (int i = 0; i < 100'000; ++i) wide += "a" + std::to_string(i) + "='1' ";
  const Result<XmlScan> scan = scan_model_xml(wide + "/></worldbody></mujoco>", "m.xml");
  ASSERT_FALSE(scan.ok());
  EXPECT_EQ(scan.error().to_string(), "m.xml:3: an element has more than 1000 attributes");
}

std::string chain_of_links(int joints) {
  std::string text = "<robot name='r'>\n<link name='0'/>\n";
  for (int i = 1; i <= joints; ++i) {
    const std::string name = std::to_string(i);
    text += "<link name='" + name + "'/><joint name='j" + name + "' type='fixed'><parent link='" +
            std::to_string(i - 1) + "'/><child link='" + name + "'/></joint>\n";
  }
  return text + "</robot>";
}

TEST(UrdfText, BoundsTheDepthOfLinks) {
  const TempFolder folder;
  const auto error_of = [&](int joints) {
    const fs::path file = folder.write("r.urdf", "");
    const auto text =
        prepare_urdf(chain_of_links(joints), file, {}, [](const fs::path&) { return true; });
    return text.ok() ? "" : text.error().to_string();
  };
  EXPECT_EQ(error_of(511), "");
  EXPECT_THAT(error_of(2000), HasSubstr("the chain of links is more than 512 deep"));
  EXPECT_THAT(error_of(2000), HasSubstr("r.urdf:514"));
}

TEST(XmlScan, RefusesWhatEndsMuJoCosProcess) {
  const auto error_of = [](const std::string& text) {
    const Result<XmlScan> scan = scan_model_xml("<mujoco>\n" + text + "</mujoco>", "m.xml");
    return scan.ok() ? "" : scan.error().to_string();
  };
  EXPECT_EQ(error_of("<asset><model name='a'/></asset>"), "m.xml:2: <model> is missing 'file'");
  EXPECT_EQ(error_of("<equality><connect body1='b' anchor=' '/></equality>"),
            "m.xml:2: <connect> has an empty 'anchor': it takes 3 numbers");
  EXPECT_EQ(error_of("<worldbody><flexcomp><plugin plugin=''/></flexcomp></worldbody>"),
            "m.xml:2: <plugin> of a <flexcomp> has an empty 'plugin'");
  for (const char* layers : {"0", "-1", "zz"})
    EXPECT_EQ(
        error_of(std::string("<flexcomp><contact activelayers='") + layers + "'/></flexcomp>"),
        "m.xml:2: 'activelayers' of <contact> is less than 1");
  EXPECT_EQ(error_of("<flexcomp><contact activelayers='2'/><plugin instance='i'/></flexcomp>"), "");
  EXPECT_EQ(error_of("<connect site1='a' site2='b'/><asset><model file='a.xml'/></asset>"), "");
}

TEST(XmlScan, FindsTheReplicateThatTakesLong) {
  const auto slowest = [](const std::string& inside) {
    return scan_model_xml("<mujoco><worldbody>\n" + inside + "</worldbody></mujoco>", "m.xml")
        ->slowest;
  };
  EXPECT_EQ(slowest("<light/>").seconds, 0);
  const Replicate row = slowest("<geom/>\n<replicate count='50000'><light/></replicate>");
  EXPECT_EQ(row.line, 3);
  EXPECT_EQ(row.copies, 50000);
  EXPECT_NEAR(row.seconds, 95, 50) << "as measured";
  const auto nested = [&](const char* outer, const char* inner) {
    return slowest(std::string("<replicate count='") + outer + "'><replicate count='" + inner +
                   "'><light/></replicate></replicate>");
  };
  EXPECT_LT(nested("316", "316").seconds, 2);
  EXPECT_NEAR(nested("1000", "100").seconds, 3, 2);
  EXPECT_EQ(nested("10", "50000").copies, 50000) << "the inner one";
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
  EXPECT_THAT(add_error(folder.write("h.xml", "<other/>")), HasSubstr("neither MJCF nor URDF"));
  EXPECT_THAT(add_error(folder.write("s.xml",
                                     "<mujoco><asset>\n<mesh file='http://x.y/a.stl'/>"
                                     "</asset></mujoco>")),
              HasSubstr("s.xml:2: the path 'http://x.y/a.stl' of <mesh> is a network address"));
  EXPECT_THAT(add_error(folder.path()), HasSubstr("folder"));
}

// The paths MuJoCo itself makes of what the XML says must all come back to the same door.
TEST(ModelFiles, MuJoCoItselfReadsNothingOutside) {
  TempFolder folder;
  const fs::path outside =
      fs::temp_directory_path() / ("gloam_outside_" + std::to_string(::getpid()) + ".obj");
  std::ofstream(outside) << tetrahedron_obj();
  std::string up;
  for (int i = 0; i < 40; ++i) up += "../";
  std::string backslashes = up;
  std::replace(backslashes.begin(), backslashes.end(), '/', '\\');
  const std::string inner = outside.string().substr(1);
  const auto model = [](const std::string& compiler, const std::string& file) {
    return "<mujoco><compiler " + compiler + "/><asset><mesh name='m' file='" + file +
           "'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>";
  };
  const std::string texts[] = {
      model("", outside.string()),
      model("", up + inner),
      model("", "/../" + inner),
      model("", "/../../" + inner),
      model("", "//" + inner),
      model("", "/./" + inner),
      model("", backslashes + inner),
      model("meshdir='/'", inner),
      model("meshdir='/../'", inner),
      model("meshdir='" + up + "'", inner),
      model("meshdir='" + outside.parent_path().string() + "'", outside.filename().string()),
      model("assetdir='c:/'", up + inner),
  };
  for (const std::string& text : texts) {
    const fs::path file = folder.write("m.xml", text);
    ModelFiles files;
    if (!files.add_model(file, {}).ok()) continue;  // refused even earlier
    char error[1000] = "";
    mjModel* loaded = mj_loadXML(file.c_str(), files.vfs(), error, sizeof(error));
    EXPECT_EQ(loaded, nullptr) << text;
    mj_deleteModel(loaded);
    mj_clearCache(mj_getCache());
  }
  fs::remove(outside);
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
  // A model right in the home folder reaches the folders beside it but nothing hidden.
  ::setenv("HOME", folder_.path().c_str(), 1);
  EXPECT_TRUE(readable(model_, folder_.write("meshes/mesh.stl", "x")));
  EXPECT_FALSE(readable(model_, folder_.write(".ssh/id", "x")));
  EXPECT_FALSE(readable(model_, folder_.write("../mesh.stl", "x")));
  ::setenv("HOME", saved.c_str(), 1);
}

TEST(ModelRootTest, AModelInTheTopFolderReadsOnlyWhatLiesBesideIt) {
  const Result<ModelRoot> root = find_model_root("/model.xml", {});
  ASSERT_TRUE(root.ok());
  EXPECT_EQ(why_not_readable("/mesh.stl", {*root}), "");
  EXPECT_NE(why_not_readable("/etc/passwd", {*root}), "");
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
  for (const char* bad : {"http://a/b", "https://a", "file:///etc/passwd", "package://a/b",
                          "c:\\a.stl", "c:a.stl", ""})
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
