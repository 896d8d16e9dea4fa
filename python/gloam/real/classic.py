"""A program: images of MuJoCo's classic renderer. MODEL FOLDER WIDTH HEIGHT CAMERA…

It runs in the environment of `gloam real install mujoco`, without Gloam, and writes FOLDER/CAMERA.png.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

SCRIPT = Path(__file__)
_NEAR = 0.02  # [m]


def classic_python() -> Path:
    """The Python of the environment. GLOAM_REAL_ENVIRONMENTS names another folder of environments. Errors: gloam.UsageError."""
    import gloam

    folder = os.environ.get("GLOAM_REAL_ENVIRONMENTS") or gloam.home() / ".venv"
    python = Path(folder) / "real-mujoco" / "bin" / "python"
    if not python.is_file():
        raise gloam.UsageError("MuJoCo's renderer is not installed", hint="./gloam real install mujoco, or --variants without mujoco")
    return python


def main(arguments: list[str]) -> int:
    """The program."""
    model_file, folder, width, height, *cameras = arguments
    # MuJoCo chooses its window system when it is imported; a machine without a display has EGL or OSMesa.
    os.environ.setdefault("MUJOCO_GL", "egl")
    import mujoco
    from mujoco.rendering.classic.renderer import Renderer
    from PIL import Image

    model: Any = mujoco.MjModel.from_xml_path(model_file)
    model.vis.global_.offwidth = max(model.vis.global_.offwidth, int(width))
    model.vis.global_.offheight = max(model.vis.global_.offheight, int(height))
    # The default near plane, 1 % of the extent of a whole house with its garden, would cut furniture away.
    model.vis.map.znear = _NEAR / model.stat.extent
    data: Any = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    renderer: Any = Renderer(model, int(height), int(width))
    for camera in cameras:
        renderer.update_scene(data, camera=camera)
        part = Path(folder) / f".{camera}.part"
        Image.fromarray(renderer.render()).save(part, "PNG")
        part.replace(Path(folder) / f"{camera}.png")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
