#include "world/export/xml_zeros.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/files.h"
#include "places/writer/spec_edit.h"
#include "scene/mjcf/spec_fields.h"

namespace gloam {
namespace {

// Subnormal numbers, which models do not hold; float's stay apart from double's when printed.
constexpr double kMarkDouble = -1e-310;
constexpr float kMarkFloat = -1e-41f;

bool is_negative_zero(double value) { return value == 0 && std::signbit(value); }

// Also of a number that the writer has changed from degrees to radians or back.
bool is_mark(double value) {
  const auto is_near = [&](double mark) { return value < 0.01 * mark && value > 100 * mark; };
  return is_near(kMarkDouble) || is_near(static_cast<double>(kMarkFloat));
}

bool is_of_number(char c) { return (c >= '0' && c <= '9') || std::strchr("+-.e", c) != nullptr; }

}  // namespace

NegativeZeros::NegativeZeros(mjSpec* spec) {
  // Orientations first: a mark among Euler angles would reach every component of the quaternion.
  resolve_orientations(spec);
  const auto mark = [&](auto* value, auto number) {
    if (!is_negative_zero(static_cast<double>(*value))) return;
    *value = number;
    restore_.emplace_back([value] { *value = -0.0f; });
  };
  for (const SpecObject& object : spec_objects(spec)) {
    for (const SpecField& field : spec_fields_of(object.owner)) {
      // The list is of a const spec; this one is the caller's to change.
      char* address = static_cast<char*>(const_cast<void*>(object.address)) + field.offset;
      for (int i = 0; i < field.count; ++i) {
        if (field.type == SpecType::kDouble)
          mark(reinterpret_cast<double*>(address) + i, kMarkDouble);
        if (field.type == SpecType::kFloat) mark(reinterpret_cast<float*>(address) + i, kMarkFloat);
      }
      if (field.type == SpecType::kDoubles) mark_vector(*reinterpret_cast<mjDoubleVec**>(address));
    }
  }
}

void NegativeZeros::resolve_orientations(mjSpec* spec) {
  const auto each = [&](mjtObj type, auto&& f) {
    for (mjsElement* e = mjs_firstElement(spec, type); e != nullptr; e = mjs_nextElement(spec, e))
      f(e);
  };
  each(mjOBJ_BODY, [&](mjsElement* e) {
    mjsBody* body = mjs_asBody(e);
    resolve(*mjs_getCompiler(e), body->quat, &body->alt);
    resolve(*mjs_getCompiler(e), body->iquat, &body->ialt);
  });
  each(mjOBJ_FRAME, [&](mjsElement* e) {
    resolve(*mjs_getCompiler(e), mjs_asFrame(e)->quat, &mjs_asFrame(e)->alt);
  });
  each(mjOBJ_GEOM, [&](mjsElement* e) {
    resolve(*mjs_getCompiler(e), mjs_asGeom(e)->quat, &mjs_asGeom(e)->alt);
  });
  each(mjOBJ_SITE, [&](mjsElement* e) {
    resolve(*mjs_getCompiler(e), mjs_asSite(e)->quat, &mjs_asSite(e)->alt);
  });
  each(mjOBJ_CAMERA, [&](mjsElement* e) {
    resolve(*mjs_getCompiler(e), mjs_asCamera(e)->quat, &mjs_asCamera(e)->alt);
  });
}

void NegativeZeros::resolve(const mjsCompiler& compiler, double* quat, mjsOrientation* alt) {
  if (alt->type == mjORIENTATION_QUAT) return;
  std::array<double, 4> resolved;
  if (mjs_resolveOrientation(resolved.data(), compiler.degree, compiler.eulerseq, alt) != nullptr)
    return;  // the compiler says what is wrong with it
  std::array<double, 4> before;
  std::copy_n(quat, 4, before.begin());
  restore_.emplace_back([=, type = alt->type] {
    std::copy(before.begin(), before.end(), quat);
    alt->type = type;
  });
  std::copy(resolved.begin(), resolved.end(), quat);
  alt->type = mjORIENTATION_QUAT;
}

void NegativeZeros::mark_vector(mjDoubleVec* values) {
  int size = 0;
  const double* data = values != nullptr ? mjs_getDouble(values, &size) : nullptr;
  if (data == nullptr || std::none_of(data, data + size, is_negative_zero)) return;
  const std::vector<double> before(data, data + size);
  std::vector<double> marked = before;
  std::replace_if(marked.begin(), marked.end(), is_negative_zero, kMarkDouble);
  edit(mjs_setDouble, values, marked.data(), size);
  restore_.emplace_back([values, before] {
    edit(mjs_setDouble, values, before.data(), static_cast<int>(before.size()));
  });
}

NegativeZeros::~NegativeZeros() {
  while (!restore_.empty()) {  // the last change first
    restore_.back()();
    restore_.pop_back();
  }
}

Status NegativeZeros::write_signs(const std::filesystem::path& file) {
  constexpr uint64_t kLargest = uint64_t{1} << 30;  // [bytes]
  GLOAM_TRY(const std::string text, read_text_file(file, kLargest));
  std::string out;
  for (size_t at = 0; at < text.size();) {
    size_t end = at;
    const bool begins = at > 0 && (text[at - 1] == '"' || text[at - 1] == ' ');
    if (begins && text[at] == '-')
      while (end < text.size() && is_of_number(text[end])) ++end;
    if (end > at && is_mark(std::strtod(text.substr(at, end - at).c_str(), nullptr))) {
      out += "-0";
      at = end;
    } else {
      out += text[at++];
    }
  }
  return write_file_atomic(file, {reinterpret_cast<const uint8_t*>(out.data()), out.size()});
}

}  // namespace gloam
