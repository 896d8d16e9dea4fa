// OBJ with MTL, STL and PLY, value by value.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstring>

#include "geometry/mesh/triangulate.h"
#include "geometry/test/read_helper.h"

namespace gloam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

ModelFile read_ok(const std::string& content, const std::string& name) {
  Result<ModelFile> model = read_text(content, name);
  EXPECT_TRUE(model.ok()) << error_of(model);
  return model.ok() ? std::move(*model) : ModelFile{};
}

std::string error_for(const std::string& content, const std::string& name) {
  return error_of(read_text(content, name));
}

// --- OBJ ---

TEST(Obj, CornersBecomeVerticesOncePerPositionUvAndNormal) {
  const ModelFile model = read_ok(
      "# a square of two triangles whose uvs differ at vertex 2\n"
      "v 0 0 0\nv 1 0 0\r\nv 0 1 0\nv 1 1 -2.5e-1\n"
      "vt 0 0\nvt 1 0\nvt 0.5\nvn 0 0 1\n"
      "f 1/1/1 2/2/1 3/3/1\n"
      "f -2/3/-1 -3/1/-1 -1/2/-1\n",
      "a.obj");
  ASSERT_EQ(model.meshes.size(), 1u);
  const TriangleMesh& mesh = model.meshes[0];
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0},
                                          Vec3f{1, 0, 0}, Vec3f{1, 1, -0.25f}));
  EXPECT_THAT(mesh.uvs,
              ElementsAre(Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{0.5f, 0}, Vec2f{0, 0}, Vec2f{1, 0}));
  EXPECT_EQ(mesh.normals, std::vector<Vec3f>(5, Vec3f{0, 0, 1}));
  EXPECT_THAT(mesh.indices, ElementsAre(0, 1, 2, 2, 3, 4));
}

TEST(Obj, GroupsAndMaterialsMakeMeshes) {
  const ModelFile model = read_ok(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
      "g left\nusemtl red\nf 1 2 3\n"
      "usemtl blue\nf 1 2 4\n"
      "g right\nf 2 3 4\n"
      "g left\nusemtl red\nf 1 3 4\n",
      "a.obj");
  ASSERT_EQ(model.instances.size(), 3u);
  EXPECT_EQ(model.instances[0].name, "left");
  EXPECT_EQ(model.instances[1].name, "left");
  EXPECT_EQ(model.instances[2].name, "right");
  EXPECT_EQ(model.meshes[0].triangle_count(), 2u);
  EXPECT_EQ(model.materials.at(static_cast<size_t>(model.instances[0].material)).name, "red");
  EXPECT_EQ(model.materials.at(static_cast<size_t>(model.instances[1].material)).name, "blue");
  EXPECT_EQ(model.instances[1].material, model.instances[2].material);
  EXPECT_THAT(model.notes, ElementsAre(HasSubstr("'red'"), HasSubstr("'blue'")));
}

TEST(Obj, RelativeIndicesCountAcrossPieces) {
  // More text than one piece: every face names its own three vertices backwards.
  std::string text;
  const int count = 60000;
  for (int i = 0; i < count; ++i)
    text += fmt::format("v {0} 0 0\nv {0} 1 0\nv {0} 0 1\nf -3 -2 -1\n", i);
  ASSERT_GT(text.size(), size_t{2} << 20);
  const ModelFile model = read_ok(text, "a.obj");
  ASSERT_EQ(model.meshes.at(0).triangle_count(), static_cast<size_t>(count));
  for (uint32_t i = 0; i < 3 * count; ++i) ASSERT_EQ(model.meshes[0].indices[i], i);
  EXPECT_EQ(model.meshes[0].positions[3 * 59999 + 2], (Vec3f{59999, 0, 1}));
}

TEST(Obj, LinesMayGoOnAfterABackslash) {
  const ModelFile model = read_ok("v 0 0 0\nv 1 0 \\\n 0\nv 0 1 0\nf 1 \\\r\n2 3\n", "a.obj");
  EXPECT_EQ(model.meshes.at(0).triangle_count(), 1u);
}

double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (size_t i = 0; i < mesh.triangle_count(); ++i) {
    const auto at = [&](size_t k) { return mesh.positions[mesh.indices[3 * i + k]]; };
    sum += 0.5 * cross(at(1) - at(0), at(2) - at(0)).z;  // negative where the winding flipped
  }
  return sum;
}

TEST(Obj, ConcavePolygonsKeepTheirAreaAndWinding) {
  // An L, a star and a comb of 40 teeth, in both senses and seen from every side.
  std::vector<std::vector<Vec2f>> shapes = {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
  shapes.emplace_back();
  for (int i = 0; i < 10; ++i) {
    const float r = i % 2 == 0 ? 1.0f : 0.25f, a = static_cast<float>(i) * kPi / 5;
    shapes.back().push_back({r * std::cos(a), r * std::sin(a)});
  }
  shapes.push_back({{40, -1}, {40, 0}});
  for (int i = 39; i >= 0; --i) {
    shapes.back().push_back({static_cast<float>(i) + 0.5f, 3});
    shapes.back().push_back({static_cast<float>(i), 0});
  }
  shapes.back().push_back({0, -1});
  for (const std::vector<Vec2f>& shape : shapes) {
    double area = 0;  // by the shoelace formula
    std::string text, face = "f";
    for (size_t i = 0; i < shape.size(); ++i) {
      const Vec2f a = shape[i], b = shape[(i + 1) % shape.size()];
      area += 0.5 * (double{a.x} * b.y - double{b.x} * a.y);
      text += fmt::format("v {} {} 0\n", a.x, a.y);
      face += fmt::format(" {}", i + 1);
    }
    const ModelFile model = read_ok(text + face + "\n", "a.obj");
    EXPECT_EQ(model.meshes.at(0).triangle_count(), shape.size() - 2);
    EXPECT_NEAR(area_of(model.meshes[0]), area, 1e-5);
    for (size_t i = 0; i < model.meshes[0].triangle_count(); ++i) {
      TriangleMesh one = model.meshes[0];
      one.indices = {one.indices[3 * i], one.indices[3 * i + 1], one.indices[3 * i + 2]};
      EXPECT_GE(area_of(one), -1e-6) << "a triangle is turned over";
    }
  }
}

TEST(Obj, MaterialsAndPicturesComeFromTheLibrary) {
  const TestFolder folder;
  folder.write("tex/wood.png", "wood");
  folder.write(
      "m.mtl",
      "newmtl plain\nKd 0.5 0.25 0.125\nNs 30\nKs 0 0 0\n"
      "newmtl modern\nPr 0.25\nPm 0.75\nPc 0.5\nPcr 0.125\nPs 0.5\naniso 0.25\nanisor 0.5\n"
      "Ke 2 1 0\nmap_Kd -s 2 3 1 -o 0.5 0.25 tex\\wood.png\nmap_Pr -clamp on tex/wood.png\n"
      "norm tex/gone.png\nmap_Bump -bm 0.5 tex/wood.png\n"
      "newmtl glass\nd 0.25\nillum 6\nNi 1.33\nTf 0.5 1 0.5\n"
      "newmtl veil\nTr 0.25\n");
  const auto path =
      folder.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl modern\nf 1 2 3\n");
  const Result<ModelFile> model = read_model_file(path);
  ASSERT_TRUE(model.ok()) << error_of(model);
  ASSERT_EQ(model->materials.size(), 4u);
  EXPECT_EQ(model->instances[0].material, 1);

  const ImportedMaterial& plain = model->materials[0];
  EXPECT_EQ(plain.base_color, (Vec3f{0.5f, 0.25f, 0.125f}));
  EXPECT_FLOAT_EQ(plain.roughness, 0.5f);  // (2 / 32)^(1/4)
  EXPECT_EQ(plain.specular_weight, 0);
  EXPECT_EQ(plain.metallic, 0);

  const ImportedMaterial& modern = model->materials[1];
  EXPECT_EQ(modern.roughness, 0.25f);
  EXPECT_EQ(modern.metallic, 0.75f);
  EXPECT_EQ(modern.coat_weight, 0.5f);
  EXPECT_EQ(modern.coat_roughness, 0.125f);
  EXPECT_EQ(modern.fuzz_weight, 0.5f);
  EXPECT_EQ(modern.anisotropy, 0.25f);
  EXPECT_FLOAT_EQ(modern.anisotropy_rotation, kPi);
  EXPECT_EQ(modern.emission, (Vec3f{200, 100, 0}));
  EXPECT_EQ(modern.base_color_texture.color_space, ColorSpace::kSrgb);
  EXPECT_EQ(modern.base_color_texture.image, 0);
  EXPECT_EQ(modern.roughness_texture.image, 0);
  EXPECT_EQ(modern.roughness_texture.wrap_u, TextureWrap::kClamp);
  EXPECT_EQ(modern.roughness_texture.channel, TextureChannel::kRed);
  EXPECT_EQ(modern.bump_scale, 0.5f);
  EXPECT_FALSE(modern.normal_texture.ok());
  const Vec2f uv = transform_uv(modern.base_color_texture.transform, {0.25f, 0.5f});
  EXPECT_FLOAT_EQ(uv.x, 2 * 0.25f + 0.5f);
  EXPECT_FLOAT_EQ(uv.y, 3 * 0.5f + 0.25f);
  EXPECT_THAT(model->notes, ElementsAre("image 'tex/gone.png' is missing"));
  ASSERT_EQ(model->images.size(), 1u);
  EXPECT_EQ(model->images[0].bytes, (std::vector<uint8_t>{'w', 'o', 'o', 'd'}));

  const ImportedMaterial& glass = model->materials[2];
  EXPECT_EQ(glass.transmission_weight, 0.75f);
  EXPECT_EQ(glass.ior, 1.33f);
  EXPECT_EQ(glass.base_color, (Vec3f{0.5f, 1, 0.5f}));
  EXPECT_EQ(glass.opacity, 1);
  EXPECT_EQ(model->materials[3].alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(model->materials[3].opacity, 0.75f);

  folder.write("m.mtl", "newmtl a\nmap_Kd ../../etc/passwd\n");
  EXPECT_THAT(error_of(read_model_file(path)), HasSubstr("m.mtl:2: the file name"));
  std::filesystem::remove(folder.path / "m.mtl");
  const Result<ModelFile> without = read_model_file(path);
  ASSERT_TRUE(without.ok()) << error_of(without);
  EXPECT_THAT(without->notes, testing::Contains("material library 'm.mtl' is missing"));
}

TEST(Obj, ErrorsNameTheLine) {
  const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_THAT(error_for(start + "f 1 2 4\n", "a.obj"), HasSubstr("a.obj:4: the face uses"));
  EXPECT_THAT(error_for(start + "f 1 2 -4\n", "a.obj"), HasSubstr("a.obj:4: the face uses"));
  EXPECT_THAT(error_for(start + "f 1/1 2/1 3/1\n", "a.obj"), HasSubstr("there are 3, 0 and 0"));
  EXPECT_THAT(error_for(start + "f 0 1 2\n", "a.obj"), HasSubstr("'0' is not a valid face corner"));
  EXPECT_THAT(error_for(start + "f 1 2 99999999999\n", "a.obj"),
              HasSubstr("not a valid face corner"));
  EXPECT_THAT(error_for(start + "v 1 x 2\n", "a.obj"), HasSubstr("a.obj:4: 'x' is not a number"));
  EXPECT_THAT(error_for(start + "v 1 2\n", "a.obj"), HasSubstr("expected 3 numbers"));
  EXPECT_THAT(error_for("v nan 0 0\n" + start + "f 1 2 3\n", "a.obj"),
              HasSubstr("position of vertex 0 is not finite"));
  EXPECT_THAT(error_for("v 1e99 0 0\n" + start + "f 1 2 3\n", "a.obj"), HasSubstr("not finite"));
  std::string points, polygon = "f";
  for (int i = 0; i < 3000; ++i) {  // the edge of a saw
    points += fmt::format("v {} {} 0\n", i, i == 0 || i == 2999 ? -9 : i % 2);
    polygon += fmt::format(" {}", 3000 - i);
  }
  EXPECT_THAT(error_for(points + polygon + "\n", "a.obj"),
              HasSubstr("concave and has 3000 corners"));
  const ModelFile flat = read_ok(start + "v 2 0 0\nf 1 2 4\nf 1 2\nf 1 2 3\n", "a.obj");
  EXPECT_EQ(flat.dropped_triangles, 2u);
  EXPECT_EQ(flat.meshes.at(0).triangle_count(), 1u);
}

// --- STL ---

const std::vector<Vec3f> kTetra = {{0, 0, 0}, {1, 0, 0},     {0, 1, 0}, {0, 0, 0},
                                   {0, 0, 1}, {1, 0, 0},     {1, 0, 0}, {0, 0, 1},
                                   {0, 1, 0}, {-0.0f, 1, 0}, {0, 0, 1}, {0, 0, 0}};

std::string binary_stl(const std::vector<Vec3f>& corners, std::string header = {}) {
  header.resize(80, ' ');
  const auto count = static_cast<uint32_t>(corners.size() / 3);
  std::string out = header + std::string(reinterpret_cast<const char*>(&count), 4);
  for (size_t i = 0; i < count; ++i) {
    out += std::string(12, '\0');
    out.append(reinterpret_cast<const char*>(&corners[3 * i]), 36);
    out += std::string(2, '\0');
  }
  return out;
}

std::string ascii_stl(const std::vector<Vec3f>& corners) {
  std::string out = "solid part one\n";
  for (size_t i = 0; i < corners.size(); ++i) {
    if (i % 3 == 0) out += " facet normal 0 0 1\n  outer loop\n";
    out += fmt::format("   vertex {} {} {}\n", corners[i].x, corners[i].y, corners[i].z);
    if (i % 3 == 2) out += "  endloop\n endfacet\n";
  }
  return out + "endsolid part one\n";
}

TEST(Stl, BothKindsAreWeldedAlike) {
  // A binary header that begins with "solid" is common.
  for (const std::string& file :
       {binary_stl(kTetra), binary_stl(kTetra, "solid by a program"), ascii_stl(kTetra)}) {
    for (const char* name : {"a.stl", "unnamed"}) {
      const ModelFile model = read_ok(file, name);
      ASSERT_EQ(model.meshes.size(), 1u);
      EXPECT_THAT(model.meshes[0].positions,
                  ElementsAre(kTetra[0], kTetra[1], kTetra[2], kTetra[4]));
      EXPECT_THAT(model.meshes[0].indices, ElementsAre(0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0));
      EXPECT_THAT(model.meshes[0].normals, IsEmpty());
    }
  }
  EXPECT_EQ(read_ok(ascii_stl(kTetra), "a.stl").instances[0].name, "part one");
}

TEST(Stl, LongTextsReadThePiecesInOrder) {
  std::vector<Vec3f> corners;
  for (int i = 0; i < 20000; ++i) {
    const float x = static_cast<float>(i);
    corners.insert(corners.end(), {{x, 0, 0}, {x, 1, 0}, {x, 0, 1}});
  }
  const std::string text = ascii_stl(corners);
  ASSERT_GT(text.size(), size_t{2} << 20);
  EXPECT_EQ(read_ok(text, "a.stl").meshes.at(0).positions, corners);
}

TEST(Stl, DamageIsNamed) {
  const std::string whole = binary_stl(kTetra);
  EXPECT_THAT(error_for(whole.substr(0, 100), "a.stl"),
              HasSubstr("declares 4 triangles, but it has room for 0"));
  std::string huge = whole;
  std::memset(huge.data() + 80, 0xff, 4);
  EXPECT_THAT(error_for(huge, "a.stl"), HasSubstr("declares 4294967295 triangles"));
  std::string text = ascii_stl(kTetra);
  EXPECT_THAT(error_for(text.substr(0, text.find("endloop")), "a.stl"), HasSubstr("ends within"));
  EXPECT_THAT(error_for("solid\nfacet\nouter loop\nvertex 1 2 z\n", "a.stl"),
              HasSubstr("a.stl:4: 'z' is not a number"));
  EXPECT_THAT(error_for("solid\nfacet\nouter loop\nvertex 1 2 3\nendloop\n", "a.stl"),
              HasSubstr("has 1 corners, not 3"));
  std::vector<Vec3f> bad = kTetra;
  bad[4].y = std::numeric_limits<float>::infinity();
  EXPECT_THAT(error_for(binary_stl(bad), "a.stl"), HasSubstr("is not finite"));
}

// --- PLY ---

// Writes numbers of any type, little- or big-endian.
class Bytes {
 public:
  explicit Bytes(bool big) : big_(big) {}
  template <class T>
  Bytes& put(T value) {
    std::string raw(reinterpret_cast<const char*>(&value), sizeof(T));
    if (big_) std::reverse(raw.begin(), raw.end());
    text += raw;
    return *this;
  }
  std::string text;

 private:
  bool big_;
};

const char* kPlyBody =
    " 1.0\ncomment made by hand\nobj_info x\n"
    "element camera 1\nproperty list uchar short a\nproperty float f\n"
    "element vertex 4\nproperty double x\nproperty float y\nproperty short z\n"
    "property uchar red\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property float s\nproperty float t\n"
    "element face 2\nproperty uchar flags\nproperty list uchar int vertex_indices\nend_header\n";

void expect_ply(const ModelFile& model) {
  ASSERT_EQ(model.meshes.size(), 1u);
  const TriangleMesh& mesh = model.meshes[0];
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{0, 0, -3}, Vec3f{0.5f, 0, -3}, Vec3f{0.5f, 1, -3},
                                          Vec3f{0, 1, -3}));
  EXPECT_EQ(mesh.normals, std::vector<Vec3f>(4, Vec3f{0, 0, 1}));
  EXPECT_THAT(mesh.uvs,
              ElementsAre(Vec2f{0, 0.25f}, Vec2f{1, 0.25f}, Vec2f{2, 0.25f}, Vec2f{3, 0.25f}));
  EXPECT_THAT(mesh.indices, ElementsAre(0, 1, 2, 0, 2, 3, 0, 2, 1));
}

const double kX[4] = {0, 0.5, 0.5, 0};
const float kY[4] = {0, 0, 1, 1};

std::string binary_ply(bool big) {
  Bytes out(big);
  out.put(uint8_t{2}).put(int16_t{7}).put(int16_t{8}).put(1.0f);
  for (int i = 0; i < 4; ++i) {
    out.put(kX[i]).put(kY[i]).put(int16_t{-3}).put(uint8_t{200});
    out.put(0.0f).put(0.0f).put(1.0f).put(static_cast<float>(i)).put(0.25f);
  }
  out.put(uint8_t{9}).put(uint8_t{4}).put(0).put(1).put(2).put(3);
  out.put(uint8_t{9}).put(uint8_t{3}).put(0).put(2).put(1);
  return fmt::format("ply\nformat binary_{}_endian{}", big ? "big" : "little", kPlyBody) + out.text;
}

std::string ascii_ply() {
  std::string out = fmt::format("ply\nformat ascii{}", kPlyBody) + "2 7 8 1.0\n";
  for (int i = 0; i < 4; ++i) out += fmt::format("{} {} -3 200 0 0 1 {} 0.25\n", kX[i], kY[i], i);
  return out + "9 4 0 1 2 3\n\n9 3 0 2 1\n";
}

TEST(Ply, EveryFormatHoldsTheSame) {
  expect_ply(read_ok(binary_ply(false), "a.ply"));
  expect_ply(read_ok(binary_ply(true), "a.ply"));
  expect_ply(read_ok(ascii_ply(), "a.ply"));
}

TEST(Ply, DamageIsNamed) {
  const std::string whole = binary_ply(false), text = ascii_ply();
  for (size_t n = 4; n < whole.size(); ++n)
    EXPECT_FALSE(read_text(whole.substr(0, n), "a.ply").ok()) << n;
  for (size_t n = 4; n + 7 < text.size(); ++n)
    EXPECT_FALSE(read_text(text.substr(0, n), "a.ply").ok()) << n;
  const auto with = [](std::string file, const std::string& from, const std::string& to) {
    file.replace(file.find(from), from.size(), to);
    return error_for(file, "a.ply");
  };
  EXPECT_THAT(with(whole, "vertex 4", "vertex 1099511627776"),
              HasSubstr("declares 1099511627776 elements 'vertex'"));
  EXPECT_THAT(with(text, "vertex 4", "vertex 1099511627776"), HasSubstr("bytes follow its header"));
  EXPECT_THAT(with(text, "0 2 1\n", "0 2 4\n"), HasSubstr("a.ply:29: the face uses vertex '4'"));
  EXPECT_THAT(with(text, "0.5 0 -3", "0.5 nan -3"), HasSubstr("vertex 1 is not finite"));
  EXPECT_THAT(with(text, "0.5 0 -3", "0.5 q -3"), HasSubstr("a.ply:24: 'q' is not a number"));
  EXPECT_THAT(with(text, "property short z", "property short w"), HasSubstr("no x, y and z"));
  EXPECT_THAT(with(text, "property short z", "property real z"), HasSubstr("'real' is unknown"));
  EXPECT_THAT(with(text, "format ascii", "format utf8"), HasSubstr("'utf8' is unknown"));
  EXPECT_THAT(with(text, "end_header", "end"), HasSubstr("unexpected 'end' in the header"));
}

// --- all ---

TEST(ModelFile, TheFormatIsToldByContent) {
  EXPECT_EQ(read_ok(ascii_ply(), "wrong.obj").meshes.size(), 1u);
  EXPECT_THAT(error_for("hello", "a.txt"),
              HasSubstr("is not a glTF, GLB, COLLADA, OBJ, STL or PLY file"));
  EXPECT_THAT(error_of(read_model_file("/no/such/file.glb")), HasSubstr("no such file"));
}

TEST(ModelFile, ProgressGrowsToOne) {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += fmt::format("v {0} 0 0\nv {0} 1 0\nf 1 2 -1\n", i);
  std::vector<double> shares;
  ModelFileOptions options;
  options.progress = [&](double share) { shares.push_back(share); };
  ASSERT_TRUE(read_text(text, "a.obj", options).ok());
  ASSERT_FALSE(shares.empty());
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1);
}

}  // namespace
}  // namespace gloam
