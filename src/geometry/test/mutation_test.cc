// Damaged files of every kind: readers must answer, within their memory.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include <jpeglib.h>

#include "base/test/mutator.h"
#include "geometry/image/image_file.h"
#include "geometry/mesh/mtl_reader.h"
#include "geometry/mesh/text_lines.h"
#include "geometry/test/gltf_builder.h"
#include "geometry/test/image_writer.h"
#include "geometry/test/largest_request.h"
#include "geometry/test/npy_writer.h"
#include "geometry/test/read_helper.h"
#include "geometry/volume_file.h"

namespace gloam {
namespace {

std::string gltf_seed(bool binary) {
  GltfBuilder file;
  const int p = file.add_positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}});
  const int n = file.add_accessor(std::vector<Vec3f>(4, {0, 0, 1}), "VEC3", 5126, 4);
  const int uv =
      file.add_accessor(std::vector<uint16_t>{0, 1, 2, 3, 4, 5, 6, 7}, "VEC2", 5123, 4, true);
  const int i = file.add_accessor(std::vector<uint8_t>{0, 1, 2, 3}, "SCALAR", 5121, 4);
  const int sparse_at = file.add_view(std::vector<uint8_t>{1});
  const int sparse_of = file.add_view(std::vector<Vec3f>{{2, 2, 2}});
  file.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", sparse_at}, {"componentType", 5121}}},
      {"values", {{"bufferView", sparse_of}}}};
  file.json["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
  file.json["samplers"] = {{{"wrapS", 33071}}};
  file.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  file.json["materials"] = {{{"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                             {"extensions",
                              {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}}},
                               {"KHR_materials_volume", {{"attenuationColor", {0.5, 0.25, 1}}}}}}}};
  const int mesh =
      file.add_mesh({{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", uv}}},
                     {"indices", i},
                     {"material", 0},
                     {"mode", 5}});
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}}}}};
  file.json["nodes"] = {{{"mesh", mesh}, {"rotation", {0, 0, 0, 1}}},
                        {{"children", {0}}, {"scale", {1, 2, 3}}},
                        {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  file.json["scenes"] = {{{"nodes", {1, 2}}}};
  file.json["extensionsRequired"] = {"KHR_lights_punctual"};
  return binary ? file.glb() : file.gltf();
}

std::string stl_seed(bool binary) {
  if (!binary) {
    std::string out = "solid a\n";
    for (int i = 0; i < 4; ++i)
      out += fmt::format(
          "facet normal 0 0 1\nouter loop\nvertex {} 0 0\nvertex 1 {} 0\nvertex 0 0 1\nendloop\n"
          "endfacet\n",
          i, i);
    return out + "endsolid\n";
  }
  std::string out(80, 'h');
  out += raw(uint32_t{4});
  for (int i = 0; i < 4; ++i) {
    const float triangle[12] = {0, 0, 1, 0, 0, 0, 1, static_cast<float>(i), 0, 0, 0, 1};
    out += raw(triangle) + raw(uint16_t{0});
  }
  return out;
}

std::string dae_seed() {
  return R"(<COLLADA version='1.4.1'><asset><unit meter='0.5'/><up_axis>X_UP</up_axis></asset>
<library_effects><effect id='e'><profile_COMMON><technique><phong><diffuse><color>1 0 0 1</color>
</diffuse><shininess><float>20</float></shininess></phong></technique></profile_COMMON></effect>
</library_effects><library_materials><material id='m'><instance_effect url='#e'/></material>
</library_materials><library_geometries><geometry id='g'><mesh><source id='p'>
<float_array id='a' count='12'>0 0 0 1 0 0 1 1 0 0 1 0</float_array><technique_common>
<accessor source='#a' count='4' stride='3'/></technique_common></source><vertices id='v'>
<input semantic='POSITION' source='#p'/></vertices><polylist material='m'>
<input semantic='VERTEX' source='#v' offset='0'/><input semantic='COLOR' source='#p' offset='1'/>
<vcount>4</vcount><p>0 0 1 1 2 2 3 3</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id='s'><node id='n'><matrix>1 0 0 0 0 1 0 0 0 0 1 3 0 0 0 1
</matrix><rotate>0 0 1 90</rotate><instance_geometry url='#g'/><node><instance_node url='#n2'/>
</node></node><node id='n2'/></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url='#s'/></scene></COLLADA>)";
}

std::string ply_seed(bool binary) {
  std::string out = fmt::format(
      "ply\nformat {} 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n",
      binary ? "binary_little_endian" : "ascii");
  if (!binary) return out + "0 0 0\n2 0 0\n2 2 0\n1 0.5 0\n0 2 0\n5 0 1 2 3 4\n3 0 1 2\n";
  const float positions[15] = {0, 0, 0, 2, 0, 0, 2, 2, 0, 1, 0.5f, 0, 0, 2, 0};
  const int32_t first[5] = {0, 1, 2, 3, 4}, second[3] = {0, 1, 2};
  return out + raw(positions) + raw(uint8_t{5}) + raw(first) + raw(uint8_t{3}) + raw(second);
}

/// Noise of 24 x 20 pixels, so that every kind of a JPEG's segments is there.
std::string jpeg_seed(int channels, bool progressive) {
  jpeg_compress_struct info = {};
  jpeg_error_mgr errors = {};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = 24;
  info.image_height = 20;
  info.input_components = channels;
  info.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&info);
  info.restart_interval = 2;
  if (progressive) jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  std::vector<uint8_t> row(static_cast<size_t>(24 * channels));
  for (uint32_t y = 0; y < 20; ++y) {
    for (size_t i = 0; i < row.size(); ++i) row[i] = static_cast<uint8_t>((y + 3) * i * 37);
    JSAMPROW at = row.data();
    jpeg_write_scanlines(&info, &at, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::string out(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
  return out;
}

/// A PNG whose chunks have the checksums of their contents again, so that damage gets further than
/// to the first of them.
std::string with_checksums(std::string png) {
  const auto be32 = [&](size_t at) {
    uint32_t v = 0;
    for (size_t k = 0; k < 4; ++k) v = v << 8 | static_cast<uint8_t>(png[at + k]);
    return size_t{v};
  };
  for (size_t at = 8; at + 12 <= png.size();) {
    const size_t length = be32(at);
    if (length > png.size() - at - 12) break;
    uint32_t crc = 0xffffffffu;
    for (size_t i = at + 4; i < at + 8 + length; ++i) {
      crc ^= static_cast<uint8_t>(png[i]);
      for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320u : 0u);
    }
    for (size_t k = 0; k < 4; ++k)
      png[at + 8 + length + k] = static_cast<char>(~crc >> (24 - 8 * k));
    at += 12 + length;
  }
  return png;
}

struct Reader {
  const char* name;
  std::vector<std::string> seeds;
  std::function<bool(const std::string&)> read;  // whether the file was fine
};

std::vector<Reader> all_readers() {
  static ModelFileOptions options;
  options.limits.decoded_bytes = 16 << 20;
  const auto model = [](Result<ModelFile> (*read)(const ModelSource&)) {
    return [read](const std::string& text) {
      return read({"mutated", as_bytes(text), nullptr, &options}).ok();
    };
  };
  std::vector<uint8_t> texels;
  for (int i = 0; i < 40 * 4; ++i) texels.push_back(static_cast<uint8_t>(i < 80 ? 7 : i));
  return {
      {"glTF", {gltf_seed(false)}, model(read_gltf)},
      {"GLB", {gltf_seed(true)}, model(read_glb)},
      {"OBJ",
       {"mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nvt 0 1\nvn 0 0 1\n"
        "usemtl a\nf 1/1/1 2/1/1 3//1 4 5\ng b\nf -3 -2 -1\nusemtl c\nf 1 2 \\\n 4\n"},
       model(read_obj)},
      {"MTL",
       {"newmtl a\nKd 0.5 0.5 0.5\nNs 20\nKe 1 0 0\nPr 0.5\nmap_Kd -s 2 2 1 -o 0 1 a.png\n"
        "newmtl b\nd 0.5\nillum 6\nTf 1 0 1\nmap_Bump -bm 2 b.png\n"},
       [](const std::string& text) {
         ModelFile out;
         MemoryBudget budget(16 << 20);
         return parse_mtl({"mutated", {}, nullptr, &options}, text, "mutated", &budget, &out).ok();
       }},
      {"STL", {stl_seed(false), stl_seed(true)}, model(read_stl)},
      {"COLLADA", {dae_seed()}, model(read_collada)},
      {"PLY", {ply_seed(false), ply_seed(true)}, model(read_ply)},
      {"HDR",
       {hdr_file(20, 2, texels, HdrPacking::kNone), hdr_file(20, 2, texels, HdrPacking::kOld),
        hdr_file(20, 2, texels, HdrPacking::kNew)},
       [](const std::string& text) {
         return decode_float_image(as_bytes(text), "mutated", 1 << 20).ok();
       }},
      {"EXR",
       {exr_file(3, 2, {"B", "G", "R"},
                 {{1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 6}})},
       [](const std::string& text) {
         return decode_float_image(as_bytes(text), "mutated", 1 << 20).ok();
       }},
      {"PNG",
       {png_file(5, 4, 3, std::vector<uint8_t>(60, 9), true),
        png_file(3, 2, 2, std::vector<uint8_t>(12, 200))},
       [](const std::string& text) {
         const std::string whole = with_checksums(text);
         const bool fine = decode_png(as_bytes(text), "mutated", 1 << 20).ok();
         (void)decode_png16(as_bytes(whole), "mutated", 1 << 20).ok();
         return decode_png(as_bytes(whole), "mutated", 1 << 20).ok() && fine;
       }},
      {"JPEG",
       {jpeg_seed(3, false), jpeg_seed(3, true), jpeg_seed(1, false)},
       [](const std::string& text) {
         return decode_jpeg(as_bytes(text), "mutated", 1 << 20).ok();
       }},
      {"KTX",
       {ktx_file(0x1401, 0x1907, 0x8C41, 3, 2, {"abcdefghi...jklmnopqr..."}),
        ktx_file(0x8C3B, 0x1907, 0x8C3A, 1, 1, {"abcd", "abcd", "abcd", "abcd", "abcd", "abcd"})},
       [](const std::string& text) { return decode_ktx(as_bytes(text), "mutated", 1 << 20).ok(); }},
      {"NPY",
       {npy_file(npy_head("1, 2, 2"), npy_values(std::vector<float>{0, 1, 2, 3})),
        npy_file(npy_head("2, 1, 1", "<f8"), npy_values(std::vector<double>{4, 5}), 2)},
       [](const std::string& text) { return decode_npy(as_bytes(text), "mutated", 1 << 20).ok(); }},
  };
}

class EveryReader : public testing::TestWithParam<Reader> {};

TEST_P(EveryReader, AnswersDamagedFiles) {
  const Reader& reader = GetParam();
  for (const std::string& seed : reader.seeds)
    ASSERT_TRUE(reader.read(seed)) << "the file is not fine to begin with";
  const size_t count = mutation_count();
  size_t refused = 0;
  for (size_t i = 0; i < count; ++i) {
    const std::string file = Mutator(i).mutate(reader.seeds[i % reader.seeds.size()]);
    largest_request = 0;
    refused += reader.read(file) ? 0 : 1;
    ASSERT_LT(largest_request, size_t{16} << 20) << "file " << i;
  }
  RecordProperty("files", std::to_string(count));
  // The rows of a JPEG are read whatever they hold.
  EXPECT_GT(refused, count / (std::string(reader.name) == "JPEG" ? 50 : 10)) << "no harm is done";
}

INSTANTIATE_TEST_SUITE_P(Mutations, EveryReader, testing::ValuesIn(all_readers()),
                         [](const auto& info) { return std::string(info.param.name); });

// Files that claim much and hold nothing.
TEST(Mutations, ClaimsAloneTakeNoMemory) {
  const auto with = [](std::string file, const std::string& from, const std::string& to) {
    file.replace(file.find(from), from.size(), to);
    return file;
  };
  std::string many_triangles = stl_seed(true);
  std::memset(many_triangles.data() + 80, 0x7f, 4);
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.gltf", with(gltf_seed(false), "\"count\":4", "\"count\":1099511627776")},
      {"a.gltf", with(gltf_seed(false), "\"count\":4", "\"count\":80000000")},
      {"a.ply", with(ply_seed(true), "vertex 5", "vertex 1099511627776")},
      {"a.ply", with(ply_seed(false), "vertex 5", "vertex 1099511627776")},
      {"a.ply", with(ply_seed(true), "face 2", "face 1099511627776")},
      {"a.stl", many_triangles},
      {"a.obj", "v 0 0 0\nf 1 1 1099511627776\n"},
  };
  for (const auto& [name, text] : files) {
    largest_request = 0;
    EXPECT_FALSE(read_text(text, name).ok()) << name;
    EXPECT_LT(largest_request, size_t{1} << 20) << name;
  }
}

}  // namespace
}  // namespace gloam
