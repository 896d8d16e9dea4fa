"""Visual odometry with OpenCV: odometry.py SEQUENCE OUT --sensors mono|rgbd|stereo. Requires OpenCV.

ORB features (Rublee et al. 2011) of each frame are matched to the features of a keyframe, whose points give its pose (P3P in
RANSAC, then least squares). With depth or a right image, points come from one frame; with one camera, from two frames,
whose relative pose the essential matrix gives (Nistér 2004), so the unit of length is the first baseline. There is
neither a loop closure nor an optimisation over several frames: this is the least that a SLAM method must beat.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from contract import INITIALIZING, LOST, TRACKED, Array, Camera, Output, Sequence

FEATURES = 1500
FEWEST = 20  # points that agree, below which a pose is not trusted
RENEW = 0.5  # of a keyframe's points still in sight, below which the frame becomes the next keyframe
PARALLAX = 12.0  # median motion of features between two keyframes of one camera [px]
REPROJECTION = 2.5  # of points that agree [px]
FARTHEST = 15.0  # depth of points [m]
PATIENCE = 30  # lost frames after which the odometry begins again at its last pose


@dataclass
class View:
    """Features of an image: raw and undistorted pixels (n, 2), descriptors (n, 32), and their points in the camera's frame (n, 3),
    NaN if unknown."""

    raw: Array
    pixels: Array
    descriptors: np.ndarray
    points: Array


class Odometry:
    """Poses (4, 4) of the camera, frame by frame. The first keyframe is the world."""

    def __init__(self, camera: Camera, sensors: str) -> None:
        self._camera, self._sensors = camera, sensors
        self._distortion = np.array(camera.distortion or (0.0, 0.0, 0.0, 0.0))
        self._orb = cv2.ORB_create(FEATURES)
        self._matcher = cv2.BFMatcher(cv2.NORM_HAMMING)
        self._key: View | None = None
        self._key_pose = np.eye(4)  # of the keyframe in the world
        self._pose = np.eye(4)
        self._lost = 0
        self.used = np.zeros((0, 2))  # pixels of the features of the last frame that agree with its pose

    def track(self, images: tuple[Path, ...]) -> tuple[str, Array | None]:
        """State and pose of the next frame."""
        view = self._view(images)
        self.used = np.zeros((0, 2))
        if self._key is None:
            self._key = view
            return (INITIALIZING, None) if self._sensors == "mono" else (TRACKED, self._pose)
        matches = self._matches(self._key, view)
        if not np.isfinite(self._key.points).any():
            return self._initialize(view, matches)
        relative = self._solve(self._key, view, matches)
        if relative is None:
            return self._miss(view)
        self._lost = 0
        self._pose = self._key_pose @ relative[0]
        known = int(np.isfinite(self._key.points).all(1).sum())
        if relative[1] < max(RENEW * known, 3 * FEWEST):
            self._renew(view, matches, relative[0])
        return TRACKED, self._pose

    def _view(self, images: tuple[Path, ...]) -> View:
        gray = cv2.imread(str(images[0]), cv2.IMREAD_GRAYSCALE)
        keypoints, descriptors = self._orb.detectAndCompute(gray, None)
        raw = np.array([point.pt for point in keypoints], np.float64).reshape(-1, 2)
        pixels = raw
        if len(raw) and self._distortion.any():
            pixels = cv2.undistortPoints(raw[:, None], self._camera.matrix, self._distortion, P=self._camera.matrix)[:, 0]
        depth = np.full(len(raw), np.nan)
        if self._sensors == "rgbd" and len(raw):
            image = cv2.imread(str(images[1]), cv2.IMREAD_UNCHANGED).astype(np.float64) / self._camera.depth_scale
            column, row = np.rint(raw).astype(int).T
            depth = image[row.clip(0, image.shape[0] - 1), column.clip(0, image.shape[1] - 1)]
        elif self._sensors == "stereo" and len(raw):
            depth = self._stereo(gray, cv2.imread(str(images[1]), cv2.IMREAD_GRAYSCALE), raw)
        depth = np.where((depth > 0.1) & (depth < FARTHEST), depth, np.nan)
        empty = np.zeros((0, 32), np.uint8)
        return View(raw, pixels, empty if descriptors is None else descriptors, self._points(pixels, depth))

    def _stereo(self, left: np.ndarray, right: np.ndarray, raw: Array) -> Array:
        """Depth of pixels by optical flow along the rows."""
        found, status, _ = cv2.calcOpticalFlowPyrLK(left, right, raw.astype(np.float32)[:, None], None, winSize=(15, 15), maxLevel=4)
        move = raw - found[:, 0]
        good = (status[:, 0] == 1) & (np.abs(move[:, 1]) < 1.0) & (move[:, 0] > 0.5)
        return np.where(good, self._camera.fx * self._camera.baseline / np.where(good, move[:, 0], 1.0), np.nan)

    def _points(self, pixels: Array, depth: Array) -> Array:
        camera = self._camera
        ray = np.column_stack([(pixels[:, 0] - camera.cx) / camera.fx, (pixels[:, 1] - camera.cy) / camera.fy, np.ones(len(pixels))])
        return ray * depth[:, None]

    def _matches(self, key: View, view: View) -> np.ndarray:
        """(n, 2) rows of both views, by the ratio test (Lowe 2004)."""
        if len(key.descriptors) < 2 or len(view.descriptors) < 2:
            return np.zeros((0, 2), int)
        pairs = self._matcher.knnMatch(key.descriptors, view.descriptors, k=2)
        good = [(a.queryIdx, a.trainIdx) for a, b in (p for p in pairs if len(p) == 2) if a.distance < 0.8 * b.distance and a.distance < 64]
        return np.array(good, int).reshape(-1, 2)

    def _solve(self, key: View, view: View, matches: np.ndarray) -> tuple[Array, int] | None:
        """Pose of the view in the keyframe's camera, and the number of points that agree."""
        known = matches[np.isfinite(key.points[matches[:, 0]]).all(1)] if len(matches) else matches
        if len(known) < FEWEST:
            return None
        points, pixels = key.points[known[:, 0]], view.pixels[known[:, 1]]
        cv2.setRNGSeed(1)
        found, turn, move, inliers = cv2.solvePnPRansac(
            points, pixels, self._camera.matrix, None, iterationsCount=300, reprojectionError=REPROJECTION, confidence=0.999
        )
        if not found or inliers is None or len(inliers) < FEWEST:
            return None
        chosen = inliers[:, 0]
        self.used = view.raw[known[chosen, 1]]
        turn, move = cv2.solvePnPRefineLM(points[chosen], pixels[chosen], self._camera.matrix, None, turn, move)
        inverse = np.eye(4)
        inverse[:3, :3], inverse[:3, 3] = cv2.Rodrigues(turn)[0], move[:, 0]
        return np.linalg.inv(inverse), len(chosen)

    def _initialize(self, view: View, matches: np.ndarray) -> tuple[str, Array | None]:
        """Points of the first keyframe of one camera, once there is enough parallax."""
        assert self._key is not None
        if len(matches) < 2 * FEWEST:
            self._key = view
            return INITIALIZING, None
        first, second = self._key.pixels[matches[:, 0]], view.pixels[matches[:, 1]]
        if np.median(np.linalg.norm(first - second, axis=1)) < PARALLAX:
            return INITIALIZING, None
        cv2.setRNGSeed(1)
        essential, mask = cv2.findEssentialMat(first, second, self._camera.matrix, cv2.RANSAC, 0.999, 1.0)
        if essential is None or essential.shape != (3, 3):
            return INITIALIZING, None
        count, turn, move, mask = cv2.recoverPose(essential, first, second, self._camera.matrix, mask=mask)
        if count < 2 * FEWEST:
            return INITIALIZING, None
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = turn.T, -(turn.T @ move)[:, 0]
        points = self._triangulated(first, second, pose)
        points[mask[:, 0] == 0] = np.nan
        self._set_points(self._key, matches[:, 0], points)
        if np.isfinite(self._key.points).all(1).sum() < FEWEST:
            self._key.points[:] = np.nan
            return INITIALIZING, None
        self._pose = self._key_pose @ pose
        self.used = view.raw[matches[mask[:, 0] != 0, 1]]
        return TRACKED, self._pose

    def _triangulated(self, first: Array, second: Array, pose: Array) -> Array:
        """Points in the frame of the first camera, from pixels of both and the second one's pose in it; NaN where the rays are
        almost parallel, the point is behind a camera, or its pixels disagree."""
        inverse = np.linalg.inv(pose)
        left, right = self._camera.matrix @ np.eye(4)[:3], self._camera.matrix @ inverse[:3]
        homogeneous = cv2.triangulatePoints(left, right, first.T, second.T)
        points = (homogeneous[:3] / np.where(np.abs(homogeneous[3]) < 1e-12, 1e-12, homogeneous[3])).T
        there = points @ inverse[:3, :3].T + inverse[:3, 3]
        back = there @ self._camera.matrix.T
        error = np.linalg.norm(back[:, :2] / np.where(np.abs(back[:, 2:]) < 1e-9, 1e-9, back[:, 2:]) - second, axis=1)
        ray = points - pose[:3, 3]
        cosine = (points * ray).sum(1) / np.maximum(np.linalg.norm(points, axis=1) * np.linalg.norm(ray, axis=1), 1e-12)
        good = (points[:, 2] > 0) & (there[:, 2] > 0) & (error < REPROJECTION) & (cosine < np.cos(np.radians(1.0)))
        return np.where(good[:, None], points, np.nan)

    @staticmethod
    def _set_points(view: View, rows: np.ndarray, points: Array) -> None:
        known = np.isfinite(points).all(1)
        view.points[rows[known]] = points[known]

    def _renew(self, view: View, matches: np.ndarray, relative: Array) -> None:
        """The view becomes the keyframe. Known points move into its frame; with one camera, more are triangulated."""
        assert self._key is not None
        if self._sensors == "mono":
            motion = np.linalg.norm(self._key.pixels[matches[:, 0]] - view.pixels[matches[:, 1]], axis=1)
            if np.median(motion) < PARALLAX:
                return  # points of so short a baseline would be far off, and the unit of length would drift
            inverse = np.linalg.inv(relative)
            self._set_points(view, matches[:, 1], self._key.points[matches[:, 0]] @ inverse[:3, :3].T + inverse[:3, 3])
            fresh = matches[~np.isfinite(self._key.points[matches[:, 0]]).all(1)]
            if len(fresh):
                points = self._triangulated(self._key.pixels[fresh[:, 0]], view.pixels[fresh[:, 1]], relative)
                self._set_points(view, fresh[:, 1], points @ inverse[:3, :3].T + inverse[:3, 3])
            if np.isfinite(view.points).all(1).sum() < 2 * FEWEST:
                return
        self._key, self._key_pose = view, self._pose

    def _miss(self, view: View) -> tuple[str, Array | None]:
        self._lost += 1
        if self._lost >= PATIENCE:
            self._key, self._key_pose, self._lost = view, self._pose, 0
        return LOST, None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence")
    parser.add_argument("out")
    parser.add_argument("--sensors", choices=["mono", "stereo", "rgbd"], default="mono")
    given = parser.parse_args()
    sequence = Sequence(given.sequence)
    if sequence.camera is None:
        parser.error("the sequence has no camera")
    cv2.setNumThreads(1)  # so that repeated runs are equal
    odometry = Odometry(sequence.camera, given.sensors)
    kinds = {"mono": ("rgb",), "stereo": ("rgb", "right"), "rgbd": ("rgb", "depth")}[given.sensors]
    with Output(given.out) as output:
        for stamp, files in sequence.images(kinds):
            output.begin()
            state, pose = odometry.track(files)
            output.frame(stamp, state, pose, odometry.used)


if __name__ == "__main__":
    main()
