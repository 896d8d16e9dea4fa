"""Statistics of single images, SSIM and FLIP on images whose numbers are known."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.ndimage
from gloam.real.appearance import describe, grey_of
from gloam.real.flip import lab, linear
from gloam.real.likeness import common_size, compare, ssim
from gloam.real.reasons import STATISTICS, differences
from gloam.real.sets import ImageSet, Picture
from real_fixtures import picture

RANDOM = np.random.default_rng(5)


def flat(level: float, size: tuple[int, int] = (40, 30)) -> np.ndarray:
    return np.full((size[1], size[0], 3), level, np.uint8)


def test_one_grey_level() -> None:
    numbers, histograms = describe(flat(119))  # L* = 50
    assert numbers["lightness"] == pytest.approx(50.0, abs=0.1) and numbers["chroma"] == pytest.approx(0, abs=0.02)
    for key in ("lightness_spread", "rms_contrast", "michelson", "dynamic_range", "noise", "laplacian", "gradient_mean"):
        assert numbers[key] == pytest.approx(0, abs=1e-6), key
    assert np.isnan(numbers["spectral_slope"]) and set(numbers) == {one.key for one in STATISTICS}
    assert all(values.sum() == pytest.approx(1) for values in histograms.values())
    assert describe(flat(255))[0]["clipped_bright"] == 1 and describe(flat(0))[0]["clipped_dark"] == 1


def test_colours_are_cielab() -> None:
    red = np.zeros((20, 20, 3), np.uint8)
    red[..., 0] = 255
    numbers, _ = describe(red)
    assert (numbers["lightness"], numbers["green_red"], numbers["blue_yellow"]) == pytest.approx((53.24, 80.09, 67.20), abs=0.05)
    assert lab(linear(np.ones(3))) == pytest.approx([100, 0, 0], abs=1e-3)


@pytest.mark.parametrize("sigma", [2.0, 8.0])
def test_noise_is_measured_beside_edges_and_shading(sigma: float) -> None:
    base = np.add.outer(np.linspace(60, 120, 120), np.linspace(0, 60, 160))
    base[30:60, 40:90] += 40
    noisy = base + sigma * RANDOM.standard_normal(base.shape)
    image = np.repeat(np.clip(noisy, 0, 255).round().astype(np.uint8)[:, :, None], 3, 2)
    assert describe(image)[0]["noise"] == pytest.approx(np.hypot(sigma, 1 / np.sqrt(12)), rel=0.06)


def test_blur_softens_and_contrast_shrinks() -> None:
    image = picture(3, (128, 96), noise=10)
    soft = scipy.ndimage.gaussian_filter(image.astype(float), (1.5, 1.5, 0)).round().astype(np.uint8)
    sharp_numbers, soft_numbers = describe(image)[0], describe(soft)[0]
    for key in ("laplacian", "gradient_mean", "spectral_slope", "noise"):
        assert soft_numbers[key] < sharp_numbers[key], key
    hazy = (0.5 * image + 100).astype(np.uint8)
    assert describe(hazy)[0]["michelson"] < describe(image)[0]["michelson"]
    assert describe(hazy)[0]["dynamic_range"] < describe(image)[0]["dynamic_range"]


def test_the_slope_of_a_known_spectrum() -> None:
    frequency = np.hypot(np.fft.fftfreq(256)[:, None], np.fft.fftfreq(256)[None])
    frequency[0, 0] = 1
    field = np.real(np.fft.ifft2(np.fft.fft2(RANDOM.standard_normal((256, 256))) / frequency))  # power falls as f^-2
    image = np.repeat((128 + 30 * (field - field.mean()) / field.std()).clip(0, 255).round().astype(np.uint8)[:, :, None], 3, 2)
    assert describe(image)[0]["spectral_slope"] == pytest.approx(-2, abs=0.15)


def ssim_formula(a: np.ndarray, b: np.ndarray) -> float:
    def blur(x: np.ndarray) -> np.ndarray:
        return scipy.ndimage.gaussian_filter(x, 1.5, truncate=10 / 3)[5:-5, 5:-5]

    c1, c2 = 6.5025, 58.5225
    ma, mb = blur(a), blur(b)
    va, vb, c = blur(a * a) - ma**2, blur(b * b) - mb**2, blur(a * b) - ma * mb
    return float(((2 * ma * mb + c1) * (2 * c + c2) / ((ma**2 + mb**2 + c1) * (va + vb + c2))).mean())


def test_ssim_equals_its_formula() -> None:
    a = grey_of(picture(1))
    b = np.clip(a + 12 * RANDOM.standard_normal(a.shape), 0, 255)
    assert ssim(a, b) == pytest.approx(ssim_formula(a, b), rel=1e-9) and ssim(a, a) == 1
    assert ssim(a, np.clip(a + 1, 0, 255)) > 0.99 > 0.8 > ssim(a, b)


def test_pairs_of_other_sizes() -> None:
    image = picture(2, (128, 96))
    same, _ = compare(image, image)
    assert (same.flip, same.ssim) == (0, 1)
    half = common_size(image, picture(2, (64, 48)))
    assert not isinstance(half, str) and half[0].shape == half[1].shape == (48, 64, 3)
    odd, difference = compare(image, picture(2, (100, 100)))
    assert odd.flip is None and odd.ssim is None and difference is None
    assert odd.reason == "128 x 96 and 100 x 100 pixels have different aspect ratios"
    black_white, _ = compare(flat(0), flat(255))
    assert black_white.flip == pytest.approx(0.97, abs=0.02) and black_white.ssim == pytest.approx(0, abs=0.01)


def test_large_images_are_reduced_for_flip() -> None:
    large = np.repeat(picture(4), 20, 1)
    found, difference = compare(large, large)
    assert difference is not None and max(difference.shape) == 768 and found.flip == 0


def image_set(images: list[np.ndarray]) -> ImageSet:
    described = [describe(image) for image in images]
    pictures = [Picture(f"{k}", f"{k:04}", image.shape[1], image.shape[0], numbers)
                for k, (image, (numbers, _)) in enumerate(zip(images, described, strict=True))]  # fmt: skip
    return ImageSet(None, tuple(pictures), {}, (), 0)  # type: ignore[arg-type]


def test_reasons_name_the_difference_and_its_direction() -> None:
    real = image_set([picture(k) for k in range(30)])
    found = differences(real, image_set([picture(100 + k, noise=0) for k in range(30)]))
    assert found[0].statistic.key in ("noise", "laplacian") and found[0].delta.value == -1
    sentences = {one.statistic.key: one.sentence for one in found}
    assert "less noisy" in sentences["noise"] and "[camera.imager.pixel]" in sentences["noise"]
    assert sentences["lightness"] == "No clear difference of lightness."
    dark = differences(real, image_set([picture(100 + k, brightness=-40) for k in range(30)]))
    assert any(one.statistic.key == "lightness" and "darker" in one.sentence for one in dark[:4])
    deltas = [abs(one.delta.value or 0) for one in dark]
    assert deltas == sorted(deltas, reverse=True)
    small = differences(real, image_set([picture(100 + k, (32, 24)) for k in range(5)]))
    assert all("resolution" in one.sentence or "No clear" in one.sentence for one in small if one.statistic.per_pixel)


def test_reasons_of_one_image_and_of_equal_sets() -> None:
    one = image_set([picture(1)])
    assert all(found.standardised is None and found.delta.low is None for found in differences(one, image_set([picture(2)])))
    assert all(found.delta.value == 0 and found.sentence.startswith("No clear") for found in differences(one, one))
