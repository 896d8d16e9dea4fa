#!/usr/bin/env python3
"""Makes the drawn meshes of the mobile manipulator: meshes/*.obj, one file per link and material.

Run it in any folder: python3 make_meshes.py [OUTPUT_FOLDER]. Needs numpy only; the same input gives the same bytes.
Units: metres. Frames: the links' own in mobile_manipulator.xml (x ahead, y left, z up).
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
import arm  # noqa: E402
import gripper  # noqa: E402
import legs  # noqa: E402
import trunk  # noqa: E402
from mesh_parts import write_parts  # noqa: E402

PARTS = {**trunk.PARTS, **legs.PARTS, **arm.PARTS, **gripper.PARTS}
DRAWN = {**dict.fromkeys(legs.PARTS, 4), "finger_dark": 2, "finger_steel": 2, "finger_rubber": 2}

if __name__ == "__main__":
    write_parts(PARTS, HERE / "meshes", DRAWN)
