// Photometric files: closed forms, symmetries, wrong and damaged files.

#include "world/lights/ies_profile.h"
#include "base/angle.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "base/test/mutator.h"

namespace gloam {
namespace {

std::vector<double> range(double first, double last, double step) {
  std::vector<double> angles;
  for (int i = 0; first + i * step <= last + 1e-9; ++i) angles.push_back(first + i * step);
  return angles;
}

/// A file of type 1 (C), 2 (B) or 3 (A) with the intensities f(vertical, horizontal).
std::string ies_file(int type, const std::vector<double>& vertical,
                     const std::vector<double>& horizontal,
                     const std::function<double(double, double)>& f,
                     const std::string& header = "IESNA:LM-63-1995\n[TEST] own\nTILT=NONE\n",
                     const std::string& factors = "1 1 10") {
  std::string text = header + fmt::format("1 1000 1 {} {} {} 2 0.1 0.1 0\n{}\n", vertical.size(),
                                          horizontal.size(), type, factors);
  for (const double v : vertical) text += fmt::format("{} ", v);
  text += '\n';
  for (const double h : horizontal) text += fmt::format("{},", h);
  for (const double h : horizontal) {
    text += '\n';
    for (const double v : vertical) text += fmt::format("{:.6f}\r\n", f(v, h));
  }
  return text;
}

IesProfile profile_of(const std::string& text) {
  Result<IesProfile> profile = parse_ies(text, "lamp.ies");
  EXPECT_TRUE(profile.ok()) << profile.error().to_string();
  return profile.ok() ? std::move(*profile) : IesProfile{2, 1, {0, 0}};
}
std::string message(const std::string& text) {
  const Result<IesProfile> profile = parse_ies(text, "lamp.ies");
  return profile.ok() ? std::string() : profile.error().to_string();
}

/// `theta` from -Z, `phi` from +X [degrees].
Vec3f toward(double theta, double phi) {
  return {static_cast<float>(std::sin(theta * kDegree) * std::cos(phi * kDegree)),
          static_cast<float>(std::sin(theta * kDegree) * std::sin(phi * kDegree)),
          static_cast<float>(-std::cos(theta * kDegree))};
}

TEST(IesProfile, EvenLightHasItsFlux) {
  const IesProfile p =
      profile_of(ies_file(1, range(0, 180, 10), {0}, [](double, double) { return 100; }));
  EXPECT_NEAR(p.flux, 400 * M_PI, 1e-3);
  EXPECT_EQ(p.columns, 1);
  for (double theta = 0; theta <= 180; theta += 7) {
    EXPECT_NEAR(p.intensity(toward(theta, 3 * theta)), 100, 1e-3);
  }
}

TEST(IesProfile, LambertDownlightHasItsFlux) {
  const auto lambert = [](double v, double) { return 300 * std::max(0.0, std::cos(v * kDegree)); };
  const IesProfile p = profile_of(ies_file(1, range(0, 90, 2.5), {0}, lambert));
  EXPECT_NEAR(p.flux, 300 * M_PI, 1e-3 * 300 * M_PI);
  EXPECT_FLOAT_EQ(p.most, 300);
  for (double theta = 0; theta <= 180; theta += 3) {
    EXPECT_NEAR(p.intensity(toward(theta, 40)), lambert(theta, 0), 0.1) << theta;
  }
}

TEST(IesProfile, FactorsMultiply) {
  const auto one = [](double, double) { return 10; };
  const std::string tilt = "TILT=NONE\n";
  const auto most = [&](const std::string& header) {
    return profile_of(ies_file(1, {0, 90}, {0}, one, header + tilt, "0.5 3 10")).most;
  };
  EXPECT_FLOAT_EQ(most("IESNA91\n"), 15);
  EXPECT_FLOAT_EQ(most(""), 15);
  EXPECT_FLOAT_EQ(most("IESNA:LM-63-2002\n"), 5);
}

TEST(IesProfile, TiltTablesAreReadPast) {
  const std::string header = "IESNA91\nTILT=INCLUDE\n1\n3\n0 45 90\n1 0.9\n0.8\n";
  const IesProfile p =
      profile_of(ies_file(1, range(0, 180, 30), {0}, [](double, double) { return 7; }, header));
  EXPECT_NEAR(p.flux, 28 * M_PI, 1e-3);
}

TEST(IesProfile, SymmetriesAreUnfolded) {
  const auto by_angle = [](double v, double h) { return v > 0 && v < 180 ? 10 + h : 10; };
  struct Case {
    double first, last;
    std::function<double(double)> folded;  // of an angle from 0 to 360
  };
  const Case cases[] = {
      {0, 90,
       [](double phi) {
         const double half = phi > 180 ? 360 - phi : phi;
         return half > 90 ? 180 - half : half;
       }},
      {0, 180, [](double phi) { return phi > 180 ? 360 - phi : phi; }},
      {90, 270,
       [](double phi) {
         if (phi < 90) return 180 - phi;
         return phi > 270 ? 540 - phi : phi;
       }},
  };
  for (const Case& c : cases) {
    const IesProfile p =
        profile_of(ies_file(1, range(0, 180, 15), range(c.first, c.last, 15), by_angle));
    for (double phi = 0; phi < 360; phi += 7.5) {
      EXPECT_NEAR(p.intensity(toward(90, phi)), 10 + c.folded(phi), 0.01) << c.last << " " << phi;
    }
  }
  // All around: the last angle may be 360, or be left out.
  const auto wave = [](double v, double h) {
    return 50 + std::sin(v * kDegree) * 40 * std::cos(h * kDegree);
  };
  for (const double last : {360.0, 345.0}) {
    const IesProfile p = profile_of(ies_file(1, range(0, 180, 15), range(0, last, 15), wave));
    for (double phi = 0; phi < 360; phi += 15) {
      EXPECT_NEAR(p.intensity(toward(75, phi)), wave(75, phi), 0.01) << last << " " << phi;
    }
    EXPECT_NEAR(p.flux, 200 * M_PI, 0.1);
  }
}

TEST(IesProfile, FloodlightTypesLieAcross) {
  // A matt emitter that faces -Z, measured on both kinds of flat goniometer: the cosine of both
  // angles' product.
  const auto lambert = [](double v, double h) {
    return 100 * std::max(0.0, std::cos(v * kDegree) * std::cos(h * kDegree));
  };
  for (const int type : {2, 3}) {
    for (const double first : {-90.0, 0.0}) {
      const std::vector<double> angles = range(first, 90, 5);
      const IesProfile p = profile_of(ies_file(type, angles, angles, lambert));
      EXPECT_NEAR(p.flux, 100 * M_PI, 0.5) << type;
      EXPECT_NEAR(p.intensity(toward(0, 0)), 100, 0.1);
      EXPECT_NEAR(p.intensity(toward(60, 90)), 50, 0.5);
      EXPECT_EQ(p.intensity(toward(120, 0)), 0);
    }
  }
  // Which way angles grow, and which axis is the pole: at (40, 20) the two types part.
  const auto spot = [](double v, double h) { return v == 40 && h == 20 ? 100.0 : 0.0; };
  const std::vector<double> angles = range(-90, 90, 5);
  const double v = 40 * kDegree, h = 20 * kDegree;
  const Vec3f b{static_cast<float>(std::sin(h)), static_cast<float>(std::cos(h) * std::sin(v)),
                static_cast<float>(-std::cos(h) * std::cos(v))};
  const Vec3f a{static_cast<float>(std::cos(v) * std::sin(h)), static_cast<float>(std::sin(v)),
                static_cast<float>(-std::cos(v) * std::cos(h))};
  const IesProfile of_b = profile_of(ies_file(2, angles, angles, spot));
  const IesProfile of_a = profile_of(ies_file(3, angles, angles, spot));
  EXPECT_GT(of_b.intensity(b), 70);
  EXPECT_GT(of_a.intensity(a), 70);
  EXPECT_LT(of_b.intensity(a), of_b.intensity(b));
}

TEST(IesProfile, WrongFilesSayWhereAndWhy) {
  const auto one = [](double, double) { return 1; };
  const std::string good = ies_file(1, {0, 45, 90}, {0}, one);
  ASSERT_EQ(message(good), "");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return message(text.replace(at, from.size(), to));
  };
  using testing::AllOf;
  using testing::HasSubstr;
  EXPECT_THAT(message(""), HasSubstr("no TILT= line"));
  EXPECT_THAT(message("\x89PNG\r\n"), HasSubstr("photometric file"));
  EXPECT_THAT(changed("NONE", "lamp.tlt"), AllOf(HasSubstr("lamp.ies:3"), HasSubstr("'lamp.tlt'")));
  EXPECT_THAT(changed("0 45 90", "0 x5 90"),
              AllOf(HasSubstr("lamp.ies:6"), HasSubstr("'x5' instead of a vertical angle")));
  EXPECT_THAT(changed("0 45 90", "0 95 90"), HasSubstr("90 is not greater than 95"));
  EXPECT_THAT(changed("0 45 90", "0 45 nan"), HasSubstr("'nan'"));
  EXPECT_THAT(changed("0 45 90", "-9 45 90"), HasSubstr("vertical angles of type C from -9"));
  EXPECT_THAT(changed(" 3 1 1 2", " 3 1 4 2"), HasSubstr("photometric type is 4"));
  EXPECT_THAT(changed(" 3 1 1 2", " 2.5 1 1 2"), HasSubstr("number of vertical angles is 2.5"));
  EXPECT_THAT(changed(" 3 1 1 2", " 16000 16000 1 2"), HasSubstr("the limit is"));
  EXPECT_THAT(changed(" 3 1 1 2", " 3 1 2 2"),
              HasSubstr("horizontal angles of type B from 0 to 0"));
  EXPECT_THAT(changed("1.000000\r\n1.0", "1.000000\r\n-1.0"),
              AllOf(HasSubstr("lamp.ies:9"), HasSubstr("intensity of -1")));
  EXPECT_THAT(message(good.substr(0, good.size() - 12)),
              HasSubstr("the file ends before an intensity"));
  EXPECT_THAT(message(ies_file(1, {0, 90}, {0, 45, 135}, one)),
              AllOf(HasSubstr("lamp.ies:7"), HasSubstr("from 0 to 135")));
  EXPECT_FALSE(read_ies("no/such/file.ies").ok());
}

TEST(Mutations, IesFilesDoNoHarm) {
  const std::string seeds[] = {
      ies_file(1, range(0, 90, 15), range(0, 90, 30), [](double v, double h) { return v + h; }),
      ies_file(
          2, range(-90, 90, 30), range(0, 90, 30), [](double v, double) { return 90 + v; },
          "TILT=INCLUDE\n1\n2\n0 90\n1 1\n")};
  const size_t count = mutation_count();
  size_t read = 0;
  for (size_t i = 0; i < count; ++i) {
    const std::string text = Mutator(i).mutate(seeds[i % 2]);
    const Result<IesProfile> profile = parse_ies(text, "damaged.ies");
    if (!profile.ok()) {
      EXPECT_EQ(profile.error().to_string().rfind("damaged.ies:", 0), 0u) << text;
      continue;
    }
    ++read;
    EXPECT_TRUE(std::isfinite(profile->flux)) << text;
    for (const float candela : profile->candela) {
      ASSERT_TRUE(candela >= 0 && candela <= profile->most) << text;
    }
  }
  if (count >= 200) {
    EXPECT_GT(read, count / 50) << "hardly a damaged file is read to its end";
  }
}

}  // namespace
}  // namespace gloam
