"""The camera of a photograph from pairs: exact, noisy, with wrong pairs, and pairs that determine none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from match_scenes import drawn, looking

from gloam.errors import InputError
from gloam.match.camera import Array, Camera, Lens
from gloam.match.refine import Unknowns, refine, slopes
from gloam.match.solve import Solution, solve
from gloam.match.start import three_point_poses

FOCAL = Unknowns.FOCAL
ALL = FOCAL | Unknowns.CENTRE | Unknowns.K1 | Unknowns.K2
BENT = Lens(1280, 960, 800.0, 652.0, 471.0, -0.2, 0.03)


def unknown_lens(lens: Lens) -> Lens:
    """Only the image's size: no parameter of the lens is known."""
    return Lens.centred(lens.width, lens.height, 1.0)


def errors(solution: Solution, camera: Camera) -> Array:
    """Differences of position [m], axes, and lens."""
    lens, true = solution.camera.lens, camera.lens
    of_lens = [lens.f - true.f, lens.cx - true.cx, lens.cy - true.cy, lens.k1 - true.k1, lens.k2 - true.k2]
    return np.abs(np.concatenate([solution.camera.p - camera.p, (solution.camera.R - camera.R).ravel(), of_lens]))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    ("count", "unknowns", "lens", "flat"),
    [(4, Unknowns.POSE, None, False), (5, FOCAL, None, False), (6, FOCAL, None, True), (12, FOCAL | Unknowns.K1 | Unknowns.K2, 1, False),
     (14, ALL, BENT, False)],
)  # fmt: skip
def test_exact_pairs_give_the_exact_camera(seed: int, count: int, unknowns: Unknowns, lens: Lens | int | None, flat: bool) -> None:
    used = replace(BENT, cx=640.0, cy=480.0) if isinstance(lens, int) else lens
    camera, points, pixels = drawn(seed, count, lens=used, flat=flat)
    given = camera.lens if unknowns == Unknowns.POSE else unknown_lens(camera.lens)
    solution = solve(pixels, points, given, unknowns)
    assert errors(solution, camera).max() < 1e-6
    assert solution.used.all() and solution.rms < 1e-6


def test_three_points_have_their_true_pose_among_the_solutions() -> None:
    for seed in range(20):
        camera, points, _ = drawn(seed, 3)
        seen = (points - camera.p) @ camera.R.T
        bearings = seen / np.linalg.norm(seen, axis=1, keepdims=True)
        R, p = three_point_poses(bearings[None], points[None])
        assert 1 <= len(R) <= 4
        assert min(np.abs(p - camera.p).max(axis=1)) < 1e-6
        for rotation, position in zip(R, p, strict=True):
            again = (points - position) @ rotation.T
            np.testing.assert_allclose(again / np.linalg.norm(again, axis=1, keepdims=True), bearings, atol=1e-6)


def test_the_jacobian_is_the_derivative_of_the_projection() -> None:
    camera, points, _ = drawn(3, 6, lens=BENT)
    found = slopes(camera, points, ALL)
    assert found.shape == (12, ALL.count)
    step = 1e-6
    for column in range(ALL.count):
        sides = []
        for sign in (1, -1):
            w, place, lens = np.zeros(3), camera.p.copy(), camera.lens
            if column < 3:
                w[column] = sign * step
            elif column < 6:
                place[column - 3] += sign * step
            else:
                name = ALL.lens_names[column - 6]
                lens = replace(lens, **{name: getattr(lens, name) + sign * step})
            from scipy.spatial.transform import Rotation

            sides.append(Camera(lens, Rotation.from_rotvec(w).as_matrix() @ camera.R, place).project(points)[0])
        np.testing.assert_allclose(found[:, column], ((sides[0] - sides[1]) / (2 * step)).ravel(), rtol=1e-5, atol=1e-5)


def test_errors_have_the_predicted_covariance() -> None:
    """The squared error, weighed with the predicted covariance, is on average the number of unknowns: as an F distribution with
    the degrees of freedom of the fit, because the noise is estimated too."""
    camera, points, pixels = drawn(11, 20)
    squares = []
    for seed in range(200):
        noisy = pixels + np.random.default_rng(seed).normal(0, 0.8, pixels.shape)
        fit = refine(camera, noisy, points, FOCAL)
        turn = fit.camera.R @ camera.R.T
        w = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / 2
        error = np.concatenate([w, fit.camera.p - camera.p, [fit.camera.lens.f - camera.lens.f]])
        squares.append(error @ np.linalg.solve(fit.sigma**2 * fit.cofactor(), error))
    freedom = 2 * len(points) - 7
    mean = 7 * freedom / (freedom - 2)
    deviation = mean * np.sqrt(2 * (7 + freedom - 2) / (7 * (freedom - 4)))
    assert abs(np.mean(squares) - mean) < 4 * deviation / np.sqrt(len(squares))


def test_solved_errors_lie_within_the_standard_errors() -> None:
    """From the pairs alone, without a start: 90 % of the errors within two standard errors, for 30 cameras."""
    within = []
    for seed in range(30):
        camera, points, pixels = drawn(seed, 12)
        solution = solve(pixels + np.random.default_rng(seed + 500).normal(0, 0.7, pixels.shape), points, unknown_lens(camera.lens))
        within += list(np.abs(solution.camera.p - camera.p) < 2 * solution.position_error)
        within.append(abs(solution.camera.lens.f - camera.lens.f) < 2 * solution.focal_error)
    assert np.mean(within) > 0.9


@pytest.mark.parametrize(("count", "wrong", "least"), [(8, 1, 14), (10, 2, 14), (12, 3, 13)])
def test_wrong_pairs_are_found(count: int, wrong: int, least: int) -> None:
    found = 0
    for seed in range(15):
        camera, points, pixels = drawn(seed, count)
        rng = np.random.default_rng(seed + 1000)
        pixels = pixels + rng.normal(0, 0.7, pixels.shape)
        bad = rng.permutation(count)[:wrong]
        angle = rng.uniform(0, 2 * np.pi, wrong)
        pixels[bad] += rng.uniform(40, 300, wrong)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        solution = solve(np.clip(pixels, 0, [1280, 960]), points, unknown_lens(camera.lens))
        found += set(np.flatnonzero(~solution.used)) == set(bad)
    assert found >= least


def test_right_pairs_are_not_called_wrong() -> None:
    """The threshold leaves one set in a hundred with a false alarm."""
    alarms = 0
    for seed in range(25):
        camera, points, pixels = drawn(seed, 9)
        noisy = pixels + np.random.default_rng(seed + 77).normal(0, 1.0, pixels.shape)
        alarms += not solve(noisy, points, unknown_lens(camera.lens)).used.all()
    assert alarms <= 2


def test_a_wrong_pair_is_taken_back_when_the_fit_explains_it() -> None:
    """Pairs whose residuals differ only by noise stay in use, also if one of them looks worst at the start."""
    camera, points, pixels = drawn(5, 8)
    pixels[3] += [2.0, 0.0]
    pixels += np.random.default_rng(2).normal(0, 1.0, pixels.shape)
    assert solve(pixels, points, unknown_lens(camera.lens)).used.all()


@pytest.mark.parametrize(("unknowns", "fewest"), [(Unknowns.POSE, 4), (FOCAL, 5), (FOCAL | Unknowns.K1, 8), (FOCAL | Unknowns.K1 | Unknowns.K2, 9), (ALL, 11)])
def test_too_few_pairs_are_rejected(unknowns: Unknowns, fewest: int) -> None:
    assert unknowns.fewest_pairs == fewest
    camera, points, pixels = drawn(1, fewest)
    with pytest.raises(InputError, match=f"need {fewest} different pairs, got {fewest - 1}"):
        solve(pixels[:-1], points[:-1], camera.lens, unknowns)
    points[-1], pixels[-1] = points[0], pixels[0]
    with pytest.raises(InputError, match="share a pixel or a point"):
        solve(pixels, points, camera.lens, unknowns)


def test_points_on_a_line_are_rejected() -> None:
    camera = looking(Lens.centred(1280, 960, 900), np.array([0.0, -5, 1.5]), np.zeros(3))
    points = np.linspace(-1, 1, 8)[:, None] * np.array([[1.0, 0.4, 0.3]])
    with pytest.raises(InputError, match="scene points lie on a line"):
        solve(camera.project(points)[0], points, camera.lens)


def test_pixels_on_a_line_are_rejected() -> None:
    """Points in a plane through the camera."""
    camera = looking(Lens.centred(1280, 960, 900), np.array([0.0, -5, 0.0]), np.zeros(3))
    points = np.random.default_rng(0).uniform(-1, 1, (8, 3)) * [1, 1, 0]
    with pytest.raises(InputError, match="pixels lie on a line"):
        solve(camera.project(points)[0], points, camera.lens)


def test_a_plane_that_the_camera_faces_leaves_the_focal_length_open() -> None:
    camera = looking(Lens.centred(1280, 960, 900), np.array([0.0, -5, 0.0]), np.zeros(3))
    points = np.random.default_rng(0).uniform(-1, 1, (10, 3)) * [1, 0, 1]
    pixels = camera.project(points)[0] + np.random.default_rng(1).normal(0, 0.3, (10, 2))
    with pytest.raises(InputError, match="focal length is not determined.*plane"):
        solve(pixels, points, camera.lens)
    solution = solve(pixels, points, camera.lens, Unknowns.POSE)
    assert np.linalg.norm(solution.camera.p - camera.p) < 5 * np.linalg.norm(solution.position_error)


def test_two_cameras_that_explain_the_pairs_are_rejected() -> None:
    """Four points of a small plane far away: tilted one way or the other, they look the same."""
    camera = looking(Lens.centred(1280, 960, 900), np.array([0.0, -60.0, 8.0]), np.zeros(3))
    points = np.array([[-0.5, 0.3, -0.5], [0.5, 0.3, -0.5], [0.5, -0.3, 0.5], [-0.5, -0.3, 0.5]])
    with pytest.raises(InputError, match="two cameras explain the pairs|not determined"):
        solve(camera.project(points)[0], points, camera.lens, Unknowns.POSE)


def test_mirrored_pairs_do_not_pass_as_a_camera() -> None:
    """Pixels from left to right: no camera in front of the points sees them so."""
    camera, points, pixels = drawn(4, 9)
    pixels[:, 0] = 1280 - pixels[:, 0]
    try:
        solution = solve(pixels, points, camera.lens)
    except InputError:
        return
    assert solution.rms > 5 or not solution.used.all()


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_not_finite_are_rejected(bad: float) -> None:
    camera, points, pixels = drawn(1, 8)
    for array in (points, pixels):
        broken = array.copy()
        broken[2, 1] = bad
        with pytest.raises(InputError, match="not finite"):
            solve(broken if array is pixels else pixels, broken if array is points else points, camera.lens)


def test_pixels_outside_the_photograph_are_rejected() -> None:
    camera, points, pixels = drawn(1, 8)
    pixels[4] = [1280.5, 10]
    with pytest.raises(InputError, match=r"pair 5: pixel \(1280.5, 10\) is outside the photograph of 1280 x 960"):
        solve(pixels, points, camera.lens)


def test_many_pairs_are_solved() -> None:
    """With a third of them wrong."""
    camera, points, pixels = drawn(6, 150)
    rng = np.random.default_rng(0)
    pixels[:50] = rng.uniform(0, [1280, 960], (50, 2))
    pixels[50:] += rng.normal(0, 0.5, (100, 2))
    solution = solve(np.clip(pixels, 0, [1280, 960]), points, unknown_lens(camera.lens))
    assert solution.used[50:].sum() >= 98 and solution.used[:50].sum() <= 2
    assert np.linalg.norm(solution.camera.p - camera.p) < 5 * np.linalg.norm(solution.position_error)


def test_the_same_pairs_give_the_same_camera() -> None:
    camera, points, pixels = drawn(9, 10)
    first, second = (solve(pixels, points, unknown_lens(camera.lens)) for _ in range(2))
    assert np.array_equal(first.camera.p, second.camera.p) and first.camera.lens == second.camera.lens
