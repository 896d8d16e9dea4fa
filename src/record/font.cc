#include "record/font.h"

#include <string_view>

namespace gloam {
namespace {

// One glyph per printable ASCII character, from ' ' on. First its width, then strokes: l = straight
// lines, c = quadratic B-spline from the first to the last point, o = closed B-spline, d = dot.
// Points are two hexadecimal digits x, y: base line at y = 3, small letters up to 8, capitals to a,
// descenders to 0.
constexpr std::string_view kGlyphs[] = {
    "2",                                        // space
    "0 l0a06 d03",                              // !
    "2 l0a08 l2a28",                            // "
    "6 l132a l435a l0565 l0868",                // #
    "4 c494a0a0746430304 l2b22",                // $
    "6 l036a o08282a0a o43636545",              // %
    "6 c63181a4a4806034366",                    // &
    "0 l0a08",                                  // '
    "2 c2b090422",                              // (
    "2 c0b292402",                              // )
    "4 l2a26 l0947 l0749",                      // *
    "4 l0646 l2824",                            // +
    "1 l1301",                                  // ,
    "3 l0636",                                  // -
    "0 d03",                                    // .
    "4 l024b",                                  // /
    "4 o03434a0a",                              // 0
    "4 l082a23 l0343",                          // 1
    "4 c080a4a4603 l0343",                      // 2
    "4 c090a4a4717 c1747430304",                // 3
    "4 l333a0545",                              // 4
    "4 l4a0a07 c0748430304",                    // 5
    "4 o03434707 c050a4a49",                    // 6
    "4 l0a4a13",                                // 7
    "4 o03434707 o07474a0a",                    // 8
    "4 o06464a0a c48430304",                    // 9
    "0 d03 d07",                                // :
    "1 d17 l1301",                              // ;
    "4 l490643",                                // <
    "4 l0545 l0747",                            // =
    "4 l094603",                                // >
    "4 c080a4a472725 d23",                      // ?
    "6 o25454828 c4745656a0a0252",              // @
    "6 l033a63 l1555",                          // A
    "5 l030a c0a4a4707 c07575303",              // B
    "5 c585a0a035355",                          // C
    "5 l030a c0a5a5303",                        // D
    "4 l4a0a0343 l0737",                        // E
    "4 l4a0a03 l0737",                          // F
    "5 c585a0a035356 l5636",                    // G
    "5 l030a l535a l0757",                      // H
    "0 l030a",                                  // I
    "4 l4a46 c46430305",                        // J
    "4 l030a l4a06 l1743",                      // K
    "4 l0a0343",                                // L
    "6 l030a356a63",                            // M
    "5 l030a535a",                              // N
    "6 o03636a0a",                              // O
    "5 l030a c0a5a5606",                        // P
    "6 o03636a0a l3562",                        // Q
    "5 l030a c0a5a5606 l2653",                  // R
    "4 c494a0a0746430304",                      // S
    "6 l0a6a l3a33",                            // T
    "5 l0a06 c06035356 l565a",                  // U
    "6 l0a336a",                                // V
    "8 l0a2349638a",                            // W
    "5 l035a l0a53",                            // X
    "6 l0a366a l3633",                          // Y
    "5 l0a5a0353",                              // Z
    "2 l2b0b0222",                              // [
    "4 l0b42",                                  // backslash
    "2 l0b2b2202",                              // ]
    "4 l082a48",                                // ^
    "5 l0252",                                  // _
    "1 l0b19",                                  // `
    "4 o03434808 l4843",                        // a
    "4 l030a o03434808",                        // b
    "4 c474808034344",                          // c
    "4 o03434808 l4a43",                        // d
    "4 l0545 c454808034344",                    // e
    "3 c3a1a17 l1713 l0838",                    // f
    "4 o03434808 l4843 c43400001",              // g
    "4 l030a c06084846 l4643",                  // h
    "0 l0308 d0a",                              // i
    "1 l1812 c121000 d1a",                      // j
    "4 l030a l0538 l1643",                      // k
    "1 l0a05 c050313",                          // l
    "6 l0308 c06083836 l3633 c36386866 l6663",  // m
    "4 l0308 c06084846 l4643",                  // n
    "4 o03434808",                              // o
    "4 l0008 o03434808",                        // p
    "4 o03434808 l4048",                        // q
    "3 l0308 c050838",                          // r
    "4 c4748080645430304",                      // s
    "3 l1a15 c151333 l0838",                    // t
    "4 l0805 c05034345 l4843",                  // u
    "4 l082348",                                // v
    "6 l0823374368",                            // w
    "4 l0348 l0843",                            // x
    "4 l0823 l482310",                          // y
    "4 l08480343",                              // z
    "3 c3b1b1706 c06151232",                    // {
    "0 l0b02",                                  // |
    "3 c0b2b2736 c36252202",                    // }
    "5 c05184457",                              // ~
};
static_assert(sizeof(kGlyphs) / sizeof(kGlyphs[0]) == '~' - ' ' + 1);

constexpr float kBaseLine = 3;
constexpr int kPiecesPerCurve = 8;

float digit(char c) { return static_cast<float>(c <= '9' ? c - '0' : c - 'a' + 10); }

/// Quadratic B-spline: each control point is approached between the middles of its two edges.
void add_curve(const std::vector<Vec2f>& control, bool closed, std::vector<Vec2f>* out) {
  const size_t n = control.size();
  for (size_t i = closed ? 0 : 1; i + (closed ? 0 : 1) < n; ++i) {
    const Vec2f before = control[(i + n - 1) % n], here = control[i], after = control[(i + 1) % n];
    const bool first = !closed && i == 1, last = !closed && i + 2 == n;
    const Vec2f a = first ? before : (before + here) * 0.5f;
    const Vec2f b = last ? after : (here + after) * 0.5f;
    for (int k = 0; k <= kPiecesPerCurve; ++k) {
      const float t = static_cast<float>(k) / kPiecesPerCurve;
      out->push_back(a * sqr(1 - t) + here * (2 * t * (1 - t)) + b * sqr(t));
    }
  }
  if (closed) out->push_back(out->front());
}

}  // namespace

Glyph make_glyph(char c) {
  const std::string_view code = kGlyphs[c >= ' ' && c <= '~' ? c - ' ' : '?' - ' '];
  Glyph glyph;
  glyph.width = digit(code[0]);
  for (size_t i = 1; i < code.size();) {
    if (code[i] == ' ') {
      ++i;
      continue;
    }
    const char kind = code[i++];
    std::vector<Vec2f> points;
    for (; i + 1 < code.size() && code[i] != ' '; i += 2)
      points.push_back({digit(code[i]), digit(code[i + 1]) - kBaseLine});
    std::vector<Vec2f> line;
    if (kind == 'c' || kind == 'o') {
      add_curve(points, kind == 'o', &line);
    } else if (kind == 'd') {  // a very small cross: a little larger than the pen
      line = {points[0] + Vec2f{-0.15f, 0.15f}, points[0] + Vec2f{0.15f, 0.15f},
              points[0] + Vec2f{0.15f, 0.4f}, points[0] + Vec2f{-0.15f, 0.4f},
              points[0] + Vec2f{-0.15f, 0.15f}};
    } else {
      line = std::move(points);
    }
    glyph.lines.push_back(std::move(line));
  }
  return glyph;
}

}  // namespace gloam
