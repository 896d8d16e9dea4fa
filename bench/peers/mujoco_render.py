"""Times MuJoCo's own renderers on a model.

    mujoco_render.py MODEL CAMERA classic|filament|truth WIDTH HEIGHT COUNT [PICTURE.png]

prints "WALL ms CPU ms": medians of update + render + read-back of an RGB picture, after a step of physics that is
not timed. truth: of the classic renderer's depth pass and its segmentation pass.
"""
import collections.abc
import ctypes
import os
import pathlib
import sys
import time

os.environ.setdefault("MUJOCO_GL", "egl")
if not hasattr(collections.abc, "Buffer"):  # Python 3.11: the Filament renderer imports a name of 3.12
    collections.abc.Buffer = memoryview

import mujoco  # noqa: E402
import numpy  # noqa: E402


def classic(model, data, camera, width, height):
    model.vis.global_.offwidth = max(model.vis.global_.offwidth, width)
    model.vis.global_.offheight = max(model.vis.global_.offheight, height)
    from mujoco.rendering.classic.renderer import Renderer
    renderer = Renderer(model, height, width)

    def render():
        renderer.update_scene(data, camera=camera)
        return renderer.render()
    return render


def truth(model, data, camera, width, height):
    from mujoco.rendering.classic.renderer import Renderer
    renderer = Renderer(model, height, width)

    def render():
        renderer.enable_depth_rendering()
        renderer.update_scene(data, camera=camera)
        depth = renderer.render()
        renderer.disable_depth_rendering()
        renderer.enable_segmentation_rendering()
        renderer.update_scene(data, camera=camera)
        renderer.render()
        renderer.disable_segmentation_rendering()
        return depth
    return render


class FilamentAssets:
    """Serves 'filament:NAME' from the wheel's folder: the library that draws does not find it by itself."""

    def __init__(self):
        class Resource(ctypes.Structure):
            _fields_ = [("name", ctypes.c_char_p), ("data", ctypes.c_void_p)]
        opener = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(Resource))
        reader = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(Resource), ctypes.POINTER(ctypes.c_void_p))
        closer = ctypes.CFUNCTYPE(None, ctypes.POINTER(Resource))

        class Provider(ctypes.Structure):
            _fields_ = [("prefix", ctypes.c_char_p), ("open", opener), ("read", reader), ("close", closer),
                        ("unused", ctypes.c_void_p * 5)]
        folder = pathlib.Path(mujoco.__file__).parent / "studio" / "assets"
        files = {}

        def find(resource):
            name = resource.contents.name.decode().split(":", 1)[1]
            path = folder / name
            if not path.is_file():
                return 0
            files[name] = ctypes.create_string_buffer(path.read_bytes(), path.stat().st_size)
            return 1

        def read(resource, buffer):
            data = files[resource.contents.name.decode().split(":", 1)[1]]
            buffer[0] = ctypes.addressof(data)
            return len(data)
        self.keep = (files, Provider(b"filament", opener(find), reader(read), closer(lambda resource: None)))
        library = ctypes.CDLL(str(next(pathlib.Path(mujoco.__file__).parent.glob("libmujoco.so*"))))
        library.mjp_registerProvider(ctypes.byref(self.keep[1]))


def filament(model, data, name, width, height):
    from mujoco import mjrf
    from mujoco.rendering.filament import model_scene, renderer as filament_renderer
    assets = FilamentAssets()
    context = mjrf.Context(mjrf.ContextConfig())
    renderer = filament_renderer.Renderer(context)
    scene = model_scene.ModelScene(context, model, renderer.scene("main"))
    picture = numpy.zeros((height, width, 3), numpy.uint8)
    renderer.target("main", memoryview(picture))
    abstract = mujoco.MjvScene(model, 20000)
    camera = mujoco.MjvCamera()
    camera.type, camera.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, model.camera(name).id
    option, perturb = mujoco.MjvOption(), mujoco.MjvPerturb()

    def render():
        mujoco.mjv_updateScene(model, data, option, perturb, camera, mujoco.mjtCatBit.mjCAT_ALL, abstract)
        view = mujoco.mjv_averageCamera(abstract.camera[0], abstract.camera[1])
        half = 0.5 * (view.frustum_top - view.frustum_bottom) * width / height
        eye = mjrf.Camera(pos=view.pos, forward=view.forward, up=view.up, frustum_bottom=view.frustum_bottom,
                          frustum_top=view.frustum_top, frustum_near=view.frustum_near, frustum_far=view.frustum_far)
        for name, value in (("frustum_center", 0.0), ("frustum_width", half)):
            if hasattr(eye, name):
                setattr(eye, name, value)
        scene.update(data)
        renderer.render([filament_renderer.View("main", "main", camera=eye)])
        return picture
    render.assets = assets
    return render


def main():
    path, camera, kind = sys.argv[1:4]
    width, height, count = (int(word) for word in sys.argv[4:7])
    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    render = {"classic": classic, "filament": filament, "truth": truth}[kind](model, data, camera, width, height)
    walls, cpus = [], []
    for _ in range(count + 2):
        mujoco.mj_step(model, data)
        wall, cpu = time.perf_counter(), time.process_time()
        picture = render()
        walls.append(time.perf_counter() - wall)
        cpus.append(time.process_time() - cpu)
    if numpy.asarray(picture).std() < (1e-3 if kind == "truth" else 1):
        sys.exit("the picture is empty")
    if len(sys.argv) > 7:
        from PIL import Image
        Image.fromarray(numpy.asarray(picture)).save(sys.argv[7])
    print(f"{1e3 * numpy.median(walls[2:]):.3f} ms {1e3 * numpy.median(cpus[2:]):.3f} ms")


if __name__ == "__main__":
    main()
