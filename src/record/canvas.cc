#include "record/canvas.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/check.h"
#include "record/font.h"

namespace gloam {
namespace {

constexpr float kStrokeWidth = 0.125f,
                kBoldStrokeWidth = 0.185f;  // width of a stroke, in heights of a capital

float distance_to_segment(Vec2f p, Vec2f a, Vec2f b) {
  const Vec2f ab = b - a, ap = p - a;
  const float along = ab.x * ab.x + ab.y * ab.y;
  const float t = along > 0 ? clamp((ap.x * ab.x + ap.y * ab.y) / along, 0, 1) : 0.0f;
  const Vec2f d = ap - ab * t;
  return std::sqrt(d.x * d.x + d.y * d.y);
}

}  // namespace

Canvas::Canvas(int width, int height, Rgb8 background) : width_(width), height_(height) {
  GLOAM_CHECK(width > 0 && height > 0, "a canvas has a size");
  pixels_.resize(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
  fill(0, 0, width, height, background);
}

void Canvas::fill(int x, int y, int width, int height, Rgb8 color) {
  const int x1 = std::min(x + width, width_), y1 = std::min(y + height, height_);
  for (int v = std::max(y, 0); v < y1; ++v) {
    for (int u = std::max(x, 0); u < x1; ++u) {
      const size_t i =
          3 * (static_cast<size_t>(v) * static_cast<size_t>(width_) + static_cast<size_t>(u));
      std::copy(color.begin(), color.end(), pixels_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

void Canvas::paste(int x, int y, int width, int height, std::span<const uint8_t> rgb) {
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const size_t i =
          3 * (static_cast<size_t>(v) * static_cast<size_t>(width) + static_cast<size_t>(u));
      fill(x + u, y + v, 1, 1, {rgb[i], rgb[i + 1], rgb[i + 2]});
    }
  }
}

void Canvas::stroke(std::span<const Polyline> lines, float width, Rgb8 color) {
  float left = 1e9f, top = 1e9f, right = -1e9f, bottom = -1e9f;
  for (const Polyline& line : lines) {
    for (const Vec2f p : line) {
      left = min(left, p.x);
      right = max(right, p.x);
      top = min(top, p.y);
      bottom = max(bottom, p.y);
    }
  }
  const float reach = width / 2 + 1;
  const int x0 = std::max(0, static_cast<int>(std::floor(left - reach)));
  const int y0 = std::max(0, static_cast<int>(std::floor(top - reach)));
  const int x1 = std::min(width_, static_cast<int>(std::ceil(right + reach)) + 1);
  const int y1 = std::min(height_, static_cast<int>(std::ceil(bottom + reach)) + 1);
  if (x0 >= x1 || y0 >= y1) return;
  const auto cell = [&](int x, int y) {
    return static_cast<size_t>(y - y0) * static_cast<size_t>(x1 - x0) + static_cast<size_t>(x - x0);
  };
  std::vector<float> cover(static_cast<size_t>(x1 - x0) * static_cast<size_t>(y1 - y0), 0.0f);
  for (const Polyline& line : lines) {
    for (size_t i = 0; i + 1 < line.size(); ++i) {
      const Vec2f a = line[i], b = line[i + 1];
      const int u0 = std::max(x0, static_cast<int>(min(a.x, b.x) - reach));
      const int u1 = std::min(x1, static_cast<int>(max(a.x, b.x) + reach) + 1);
      const int v0 = std::max(y0, static_cast<int>(min(a.y, b.y) - reach));
      const int v1 = std::min(y1, static_cast<int>(max(a.y, b.y) + reach) + 1);
      for (int v = v0; v < v1; ++v) {
        for (int u = u0; u < u1; ++u) {
          const Vec2f p{static_cast<float>(u) + 0.5f, static_cast<float>(v) + 0.5f};
          const float c = clamp(width / 2 + 0.5f - distance_to_segment(p, a, b), 0, 1);
          cover[cell(u, v)] = max(cover[cell(u, v)], c * min(width, 1));
        }
      }
    }
  }
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const float c = cover[cell(x, y)];
      if (c <= 0) continue;
      uint8_t* pixel = pixels_.data() + 3 * (static_cast<size_t>(y) * static_cast<size_t>(width_) +
                                             static_cast<size_t>(x));
      for (size_t k = 0; k < 3; ++k)
        pixel[k] = static_cast<uint8_t>(lerp(pixel[k], color[k], c) + 0.5f);
    }
  }
}

float text_width(std::string_view text, float size) {
  float units = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;  // rest of a UTF-8 character
    units += make_glyph(c).width + kFontSpacing;
  }
  return text.empty() ? 0 : (units - kFontSpacing) * size / kFontCapHeight;
}

float Canvas::text(float x, float y, std::string_view text, float size, Rgb8 color, Align align,
                   bool bold) {
  const float scale = size / kFontCapHeight, width = text_width(text, size);
  if (align == Align::kCenter) x -= width / 2;
  if (align == Align::kRight) x -= width;
  std::vector<Polyline> lines;
  float at = x;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;
    const Glyph glyph = make_glyph(c);
    for (const std::vector<Vec2f>& line : glyph.lines) {
      Polyline placed;
      for (const Vec2f p : line) placed.push_back({at + p.x * scale, y - p.y * scale});
      lines.push_back(std::move(placed));
    }
    at += (glyph.width + kFontSpacing) * scale;
  }
  stroke(lines, max(1.1f, size * (bold ? kBoldStrokeWidth : kStrokeWidth)), color);
  return width;
}

std::string fit_text(std::string_view text, float size, float width) {
  if (text_width(text, size) <= width) return std::string(text);
  std::string cut(text);
  while (!cut.empty() && text_width(cut + "..", size) > width) cut.pop_back();
  return cut + "..";
}

}  // namespace gloam
