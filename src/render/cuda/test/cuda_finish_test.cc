// Pictures that the card finishes: the same as the host makes of the card's film.

#include "render/cuda/test/cuda_cases.h"
#include "render/film/denoise.h"
#include "render/film/tone_map.h"

namespace gloam {
namespace {

class CudaFinish : public OnCard {};

/// Values of 8 bits that differ, and that differ by more than one.
struct Difference {
  size_t any = 0, much = 0;
};

Difference compare(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  Difference out;
  EXPECT_EQ(a.size(), b.size());
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    out.any += a[i] != b[i];
    out.much += std::abs(a[i] - b[i]) > 1;
  }
  return out;
}

TEST_F(CudaFinish, DisplayValuesAreTheHosts) {
  const Case c = cases().front();
  const auto card = on_card(c);
  RenderSettings settings{.exact_channels = false};
  Film light, shown;
  card->render(c.view, settings, &light);
  settings.finish = {.to_display = true, .tone = {.ev100 = 3}};
  ASSERT_TRUE(card->finishes(settings));
  card->render(c.view, settings, &shown);
  EXPECT_TRUE(shown.radiance.empty());
  std::vector<uint8_t> by_host;
  tone_map(light.radiance, kWidth, kHeight, settings.finish.tone, &by_host);
  const Difference d = compare(shown.rgb, by_host);
  std::printf("%zu of %zu values differ, %zu by more than one\n", d.any, by_host.size(), d.much);
  EXPECT_LE(d.any, by_host.size() / 100);  // powers round otherwise
  EXPECT_EQ(d.much, 0u);
}

/// Fireflies, borders, the network, restored light: few samples of lamps that are hard to find.
TEST_F(CudaFinish, PicturesWithoutNoiseAreTheHosts) {
  const auto host = make_oidn_denoiser({.device = DenoiseDevice::kCuda});
  if (!host.ok()) GTEST_SKIP() << host.error().to_string();
  for (const size_t row : {0u, 3u, 5u}) {
    const Case c = cases()[row];
    const auto card = on_card(c);
    RenderSettings settings{.spp = 4, .exact_channels = false};
    Film noisy, clean, shown;
    card->render(c.view, settings, &noisy);
    settings.finish = {.denoise = true};
    ASSERT_TRUE(card->finishes(settings));
    card->render(c.view, settings, &clean);
    settings.finish = {.denoise = true, .to_display = true, .tone = {.ev100 = 3}};
    card->render(c.view, settings, &shown);
    std::vector<Vec3f> light;
    ASSERT_TRUE((*host)->denoise(noisy, &light).ok());
    double difference = 0, sum = 0;
    for (size_t i = 0; i < light.size(); ++i) {
      difference += length(clean.radiance[i] - light[i]);
      sum += length(light[i]);
    }
    std::vector<uint8_t> by_host;
    tone_map(light, kWidth, kHeight, settings.finish.tone, &by_host);
    const Difference d = compare(shown.rgb, by_host);
    std::printf("%s: light differs by %.2g, %zu of %zu display values, %zu by more than one\n",
                c.name, difference / sum, d.any, by_host.size(), d.much);
    EXPECT_LT(difference / sum, 2e-3) << c.name;
    EXPECT_LE(d.much, by_host.size() / 1000) << c.name;
  }
}

TEST_F(CudaFinish, GuidesAtEdgesAreTheCpus) {
  for (const size_t row : {0u, 2u, 5u}) {
    const Case c = cases()[row];
    RenderSettings settings{.tier = RenderTier::kDirect, .spp = 1, .guide_samples = 4};
    Film card, cpu;
    on_card(c)->render(c.view, settings, &card);
    on_cpu(c)->render(c.view, settings, &cpu);
    size_t unlike = 0;
    for (size_t i = 0; i < card.pixel_count(); ++i) {
      unlike += length(card.albedo[i] - cpu.albedo[i]) > 1e-3f ||
                length(card.normal[i] - cpu.normal[i]) > 1e-3f;
    }
    std::printf("%s: %zu of %zu pixels have other guides\n", c.name, unlike, card.pixel_count());
    EXPECT_LE(unlike, card.pixel_count() / 200) << c.name;  // rays that graze an edge
  }
}

}  // namespace
}  // namespace gloam
