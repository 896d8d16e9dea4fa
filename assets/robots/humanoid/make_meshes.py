#!/usr/bin/env python3
"""Makes the drawn meshes of the humanoid: meshes/*.obj, one file per link and material.

Run it in any folder: python3 make_meshes.py [OUTPUT_FOLDER]. Needs numpy only; the same input gives the same bytes.
Units: metres. Frames: the links' own in humanoid.xml (x ahead, y left, z up).
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
import arms  # noqa: E402
import legs  # noqa: E402
import torso  # noqa: E402
from mesh_parts import write_parts  # noqa: E402

PARTS = {**legs.CENTRE, **legs.LEFT, **torso.CENTRE, **arms.LEFT}

if __name__ == "__main__":
    write_parts(PARTS, HERE / "meshes", dict.fromkeys({**legs.LEFT, **arms.LEFT}, 2))
