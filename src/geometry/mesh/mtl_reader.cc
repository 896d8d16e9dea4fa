// MTL, its keywords in any case, with the physically based keys that exporters have agreed on (Pr
// Pm Ps Pc Pcr aniso anisor norm, map_*). Meaning of the older keys:
//   Kd base colour; Ks: black = no specular layer, else one of index Ni; Ns: Blinn's exponent, of
//   which alpha² = 2 / (Ns + 2) and roughness = sqrt(alpha); Ke x 100 cd/m² (docs/light.md: full
//   white); d or 1 - Tr opacity; illum 4, 6, 7, 9 with d < 1 or Tf: glass coloured by Tf.

#include "geometry/mesh/mtl_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/path_readings.h"
#include "base/plain_text.h"
#include "base/text.h"
#include "geometry/mesh/text_lines.h"

namespace gloam {
namespace {

constexpr float kFullWhite = 100;  // [cd/m²]

// Keys that describe light which is simulated here instead.
bool is_needless(std::string_view key) {
  return key == "ka" || key == "map_ka" || key == "sharpness" || key == "map_aat";
}

// The material at hand with what decides how its older keys are read.
struct Now {
  ImportedMaterial m;
  std::optional<float> exponent;          // Ns
  std::optional<float> roughness;         // Pr
  std::optional<Vec3f> specular, filter;  // Ks, Tf
  int illum = 2;
};

class MtlParser {
 public:
  MtlParser(const ModelSource& source, std::string file, MemoryBudget* budget, ModelFile* model)
      : source_(source), file_(std::move(file)), budget_(budget), model_(model) {}

  Status parse(std::string_view text) {
    while (!text.empty()) {
      std::string_view line = take_line(&text);
      ++line_;
      if (line.size() > kMaxLine) return bad("the line is too long");
      const std::string_view written = take_word(&line);
      if (written.empty() || written[0] == '#') continue;
      const std::string key = lower_case(written.substr(0, kMaxName));
      if (key == "newmtl") {
        finish();
        if (model_->materials.size() >= source_.options->limits.materials)
          return bad("there are too many materials");
        now_.emplace();
        now_->m.name = std::string(trim(line).substr(0, kMaxName));
      } else if (now_) {
        GLOAM_TRY_STATUS(parse_key(key, line));
      }
    }
    finish();
    return {};
  }

 private:
  Error bad(std::string message) const {
    return {ErrorKind::kInput, std::move(message), {file_, line_, 0}, "repair the library"};
  }

  Status parse_key(std::string_view key, std::string_view line) {
    ImportedMaterial& m = now_->m;
    struct Scalar {
      std::string_view key;
      float* value;
      float high;
    };
    const Scalar scalars[] = {{"pm", &m.metallic, 1},
                              {"pc", &m.coat_weight, 1},
                              {"pcr", &m.coat_roughness, 1},
                              {"ps", &m.fuzz_weight, 1},
                              {"aniso", &m.anisotropy, 1},
                              {"ni", &m.ior, 10},
                              {"anisor", &m.anisotropy_rotation, 1},
                              {"d", &m.opacity, 1}};
    if (key == "d") line = without_halo(line);
    for (const Scalar& scalar : scalars)
      if (key == scalar.key) return read_number(line, scalar.value, scalar.high);
    if (key == "tr") {
      float t = 0;
      GLOAM_TRY_STATUS(read_number(line, &t, 1));
      m.opacity = 1 - t;
      return {};
    }
    if (key == "ns") return read_number(line, &now_->exponent.emplace(), 1e6f);
    if (key == "pr") return read_number(line, &now_->roughness.emplace(), 1);
    if (key == "kd") return read_color(line, &m.base_color);
    if (key == "ke") return read_color(line, &m.emission);
    if (key == "ks") return read_color(line, &now_->specular.emplace());
    if (key == "tf") return read_color(line, &now_->filter.emplace());
    if (key == "illum") {
      if (!parse_integer(take_word(&line), &now_->illum)) return bad("illum is not an integer");
      return {};
    }
    return parse_map(key, line);
  }

  Status parse_map(std::string_view key, std::string_view line) {
    ImportedMaterial& m = now_->m;
    struct Map {
      std::string_view key;
      TextureRef* texture;
      TextureChannel channel;
      ColorSpace space;
    };
    constexpr auto kColor = TextureChannel::kColor, kRed = TextureChannel::kRed;
    constexpr auto kLinear = ColorSpace::kLinear, kSrgb = ColorSpace::kSrgb;
    const Map maps[] = {{"map_kd", &m.base_color_texture, kColor, kSrgb},
                        {"map_ke", &m.emission_texture, kColor, kSrgb},
                        {"map_ks", &m.specular_color_texture, kColor, kSrgb},
                        {"map_pr", &m.roughness_texture, kRed, kLinear},
                        {"map_pm", &m.metallic_texture, kRed, kLinear},
                        {"map_pc", &m.coat_weight_texture, kRed, kLinear},
                        {"map_pcr", &m.coat_roughness_texture, kRed, kLinear},
                        {"map_d", &m.opacity_texture, kRed, kLinear},
                        {"norm", &m.normal_texture, kColor, kLinear},
                        {"map_kn", &m.normal_texture, kColor, kLinear},
                        {"map_bump", &m.bump_texture, kRed, kLinear},
                        {"bump", &m.bump_texture, kRed, kLinear}};
    for (const Map& map : maps) {
      if (key != map.key) continue;
      map.texture->channel = map.channel;
      map.texture->color_space = map.space;
      return read_texture(line, map.texture);
    }
    if (!is_needless(key))
      add_note(model_, fmt::format("'{:.40}' in the material library is ignored", key));
    return {};
  }

  // "d -halo 0.5": opacity that depends on the angle; its number is taken as that of all angles.
  static std::string_view without_halo(std::string_view line) {
    std::string_view rest = line;
    return lower_case(take_word(&rest)) == "-halo" ? rest : line;
  }

  Status read_number(std::string_view line, float* out, float high) {
    const std::string_view word = take_word(&line);
    if (!parse_number(word, out) || !std::isfinite(*out))
      return bad(fmt::format("'{}' is not a finite number", word.substr(0, 40)));
    *out = std::clamp(*out, 0.0f, high);
    return {};
  }

  Status read_color(std::string_view line, Vec3f* out) {
    if (trim(line).starts_with("spectral") || trim(line).starts_with("xyz")) {
      add_note(model_, "spectral and XYZ colours are ignored");
      return {};
    }
    GLOAM_TRY_STATUS(read_number(line, &out->x, 1e6f));
    (void)take_word(&line);
    if (trim(line).empty()) {  // one number stands for three
      out->y = out->z = out->x;
      return {};
    }
    GLOAM_TRY_STATUS(read_number(line, &out->y, 1e6f));
    (void)take_word(&line);
    return read_number(line, &out->z, 1e6f);
  }

  // Up to three numbers after -o, -s, -t.
  static std::array<float, 3> take_numbers(std::string_view* line, float otherwise) {
    std::array<float, 3> out = {otherwise, otherwise, otherwise};
    for (float& value : out) {
      std::string_view rest = *line;
      float number;
      if (!parse_number(take_word(&rest), &number) || !std::isfinite(number)) break;
      value = number;
      *line = rest;
    }
    return out;
  }

  static bool is_map_option(std::string_view option) {
    constexpr std::string_view kOptions[] = {"-blendu", "-blendv", "-boost",
                                             "-cc",     "-texres", "-type"};
    return std::ranges::find(kOptions, option) != std::end(kOptions);
  }

  // Selects the channel of an image that provides a single value.
  void choose_channel(std::string_view word, TextureRef* texture) const {
    if (texture->channel == TextureChannel::kColor) return;
    if (word == "r") texture->channel = TextureChannel::kRed;
    if (word == "g") texture->channel = TextureChannel::kGreen;
    if (word == "b") texture->channel = TextureChannel::kBlue;
    if (word == "m") texture->channel = TextureChannel::kAlpha;
    if (word == "l" || word == "z")
      add_note(model_, "the red channel is used for '-imfchan l' and 'z'");
  }

  Status read_texture(std::string_view line, TextureRef* texture) {
    std::array<float, 3> scale = {1, 1, 1}, offset = {0, 0, 0};
    for (;;) {
      std::string_view rest = line;
      const std::string option = lower_case(take_word(&rest));
      if (option.size() < 2 || option[0] != '-') break;
      line = rest;
      if (option == "-s") {
        scale = take_numbers(&line, 1);
      } else if (option == "-o") {
        offset = take_numbers(&line, 0);
      } else if (option == "-t") {
        (void)take_numbers(&line, 0);
      } else if (option == "-bm") {
        now_->m.bump_scale = take_numbers(&line, 1)[0];
      } else if (option == "-mm") {
        (void)take_word(&line);
        (void)take_word(&line);
      } else if (option == "-clamp") {
        if (lower_case(take_word(&line)) == "on")
          texture->wrap_u = texture->wrap_v = TextureWrap::kClamp;
      } else if (option == "-imfchan") {
        choose_channel(lower_case(take_word(&line)), texture);
      } else {
        (void)take_word(&line);  // -blendu, -blendv, -boost, -cc, -texres, -type: one word each
        if (!is_map_option(option))
          add_note(model_, fmt::format("image option '{:.40}' is ignored", option));
      }
    }
    // MTL scales and moves with v upwards; UvTransform has it downwards: 1 - (s v + o).
    texture->transform.scale = {scale[0], scale[1]};
    texture->transform.offset = {offset[0], 1 - scale[1] - offset[1]};
    return find_image(without_foreign_folder(trim(line)), &texture->image);
  }

  Status find_image(const std::string& name, int* image) {
    const auto known = std::find_if(model_->images.begin(), model_->images.end(),
                                    [&](const ImportedImage& i) { return i.name == name; });
    if (known != model_->images.end()) {
      *image = static_cast<int>(known - model_->images.begin());
      return {};
    }
    if (source_.folder == nullptr) {
      add_note(model_, fmt::format("image '{}' was not loaded: the model has no folder", name));
      return {};
    }
    Result<std::vector<uint8_t>> bytes =
        source_.folder->read(name, {file_, line_, 0}, source_.options->limits);
    if (!bytes.ok() && bytes.error().kind == ErrorKind::kIo) {
      add_note(model_, fmt::format("image '{}' is missing", name.substr(0, kMaxName)));
      return {};
    }
    if (!bytes.ok()) return std::move(bytes).error();
    if (!budget_->take(bytes->size(), 1)) return bad("the images exceed the size limit");
    *image = static_cast<int>(model_->images.size());
    model_->images.push_back({name, std::move(*bytes)});
    return {};
  }

  void finish() {
    if (!now_) return;
    ImportedMaterial& m = now_->m;
    if (now_->roughness)
      m.roughness = *now_->roughness;
    else if (now_->exponent)
      m.roughness = std::pow(2 / (*now_->exponent + 2), 0.25f);
    if (m.metallic_texture.ok() && m.metallic == 0) m.metallic = 1;  // a texture multiplies it
    if (now_->specular && max_component(*now_->specular) == 0 && !m.specular_color_texture.ok() &&
        !now_->roughness)
      m.specular_weight = 0;
    m.double_sided = true;  // MTL has no sides
    if (m.ior < 1) m.ior = 1.5f;
    m.anisotropy_rotation *= 2 * kPi;
    m.emission = m.emission * kFullWhite;
    if (m.emission_texture.ok() && max_component(m.emission) == 0)
      m.emission = {kFullWhite, kFullWhite, kFullWhite};
    const int illum = now_->illum;
    const bool is_glass = (illum == 4 || illum == 6 || illum == 7 || illum == 9) &&
                          (m.opacity < 1 || now_->filter.has_value());
    if (is_glass) {
      m.transmission_weight = m.opacity < 1 ? 1 - m.opacity : 1;
      m.base_color = now_->filter.value_or(Vec3f{1, 1, 1});
      m.opacity = 1;
    } else if (m.opacity < 1 || m.opacity_texture.ok()) {
      m.alpha_mode = AlphaMode::kBlend;
    }
    model_->materials.push_back(std::move(m));
    now_.reset();
  }

  const ModelSource& source_;
  std::string file_;
  MemoryBudget* budget_;
  ModelFile* model_;
  int line_ = 0;
  std::optional<Now> now_;
};

}  // namespace

Status parse_mtl(const ModelSource& source, std::string_view text, const std::string& file,
                 MemoryBudget* budget, ModelFile* model) {
  return MtlParser(source, file, budget, model).parse(text);
}

Status read_mtl_library(const ModelSource& source, const std::string& name, const SourceLoc& loc,
                        MemoryBudget* budget, ModelFile* model) {
  if (source.folder == nullptr) return {};
  Result<std::vector<uint8_t>> text = source.folder->read(name, loc, source.options->limits);
  if (text.ok()) {
    GLOAM_TRY(const std::optional<std::string> plain, plain_text(as_text(*text), name));
    return parse_mtl(source, plain ? *plain : as_text(*text), name, budget, model);
  }
  if (text.error().kind != ErrorKind::kIo) return std::move(text).error();
  add_note(model, fmt::format("material library '{}' is missing", name.substr(0, kMaxName)));
  return {};
}

}  // namespace gloam
