"""KISS-ICP (Vizzo et al. 2023), odometry of LiDAR scans: kiss.py SEQUENCE OUT. Requires kiss-icp 1.3."""

from __future__ import annotations

import argparse

import numpy as np
from contract import LOST, TRACKED, Output, Sequence
from kiss_icp.config import KISSConfig
from kiss_icp.kiss_icp import KissICP

FEWEST_POINTS = 100  # of a scan that can be registered


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence")
    parser.add_argument("out")
    parser.add_argument("--max-range", type=float, default=100.0, help="[m]; default: %(default)s")
    parser.add_argument("--voxel", type=float, default=0.5, help="size of the map's voxels [m]; default: %(default)s, for buildings")
    given = parser.parse_args()
    config = KISSConfig()
    config.data.max_range, config.data.min_range, config.data.deskew = given.max_range, 0.3, True
    config.mapping.voxel_size = given.voxel
    config.registration.max_num_threads = 1  # its sums have another order with several
    odometry = KissICP(config=config)
    with Output(given.out) as output:
        for stamp, file in Sequence(given.sequence).files("scans"):
            scan = np.fromfile(file, np.float32).reshape(-1, 5).astype(np.float64)
            output.begin()
            if len(scan) < FEWEST_POINTS:  # blind: smoke, or nothing in range
                output.frame(stamp, LOST)
                continue
            longest = max(float(scan[:, 4].max()), 1e-9)
            odometry.register_frame(scan[:, :3], scan[:, 4] / longest)
            output.frame(stamp, TRACKED, odometry.last_pose)


if __name__ == "__main__":
    main()
