"""Materials of the room: (rgba, roughness, metallic, emission, texture layers, tile).

rgba multiplies the rgb layer. `tile` is the size in metres that the texture covers, None if the
mesh carries 0..1 coordinates. Emission is the luminance of a white surface in 100 cd/m².
"""

from dataclasses import dataclass, field


@dataclass
class Material:
    rgba: tuple
    roughness: float = 0.6
    metallic: float = 0.0
    emission: float = 0.0
    layers: dict = field(default_factory=dict)  # role -> texture
    tile: float | None = 1.0


def wood(rgba, roughness=1.0):
    layers = {"rgb": "wood_rgb", "normal": "wood_normal", "roughness": "wood_roughness"}
    return Material(rgba, roughness, layers=layers, tile=0.8)


def cloth(rgba, tile=0.16):
    return Material(rgba, 0.95, layers={"rgb": "weave_rgb", "normal": "weave_normal"}, tile=tile)


def paint(rgba, roughness=0.85):
    return Material(rgba, roughness, layers={"rgb": "plaster_rgb", "normal": "plaster_normal"})


def unit(texture, roughness):
    return Material((1, 1, 1), roughness, layers={"rgb": texture}, tile=None)


MATERIALS = {
    "floor_oak": Material(
        (1, 1, 1),
        1.0,
        tile=None,
        layers={"rgb": "floor_rgb", "normal": "floor_normal", "roughness": "floor_roughness"},
    ),
    "gap": Material((0.05, 0.035, 0.025), 0.9),
    "wall_paint": paint((0.90, 0.88, 0.84)),
    "accent_paint": paint((0.39, 0.50, 0.48)),
    "ceiling_paint": paint((0.94, 0.94, 0.93)),
    "painted_white": Material((0.85, 0.84, 0.81), 0.35),
    "oak": wood((0.80, 0.65, 0.47)),
    "walnut": wood((0.45, 0.31, 0.22)),
    "sofa_fabric": cloth((0.64, 0.62, 0.58)),
    "mustard_fabric": cloth((0.78, 0.57, 0.24), 0.12),
    "rust_fabric": cloth((0.62, 0.33, 0.24), 0.20),
    "cream_fabric": cloth((0.86, 0.80, 0.70), 0.30),
    "teal_fabric": cloth((0.10, 0.27, 0.29)),
    "curtain_linen": cloth((0.93, 0.90, 0.84), 0.22),
    "rug": Material((1, 1, 1), 0.97, tile=None, layers={"rgb": "rug_rgb", "normal": "rug_normal"}),
    "black_metal": Material((0.03, 0.03, 0.032), 0.45),
    "brass": Material((0.86, 0.66, 0.34), 0.32, 1.0),
    "steel": Material((0.72, 0.71, 0.69), 0.30, 1.0),
    "ceramic_white": Material((0.86, 0.84, 0.80), 0.22),
    "glazed_blue": Material((0.06, 0.16, 0.30), 0.18),
    "glazed_rust": Material((0.48, 0.17, 0.09), 0.25),
    "terracotta": Material((0.70, 0.36, 0.23), 0.8, layers={"normal": "plaster_normal"}, tile=0.4),
    "soil": Material((0.07, 0.05, 0.035), 0.98, layers={"normal": "plaster_normal"}, tile=0.1),
    "bark": Material((0.26, 0.19, 0.12), 0.85),
    "leaf": unit("leaf_rgb", 0.42),
    "rattan": Material(
        (0.66, 0.48, 0.28), 0.8, layers={"rgb": "weave_rgb", "normal": "weave_normal"}, tile=0.5
    ),
    "cardboard": Material(
        (1, 1, 1), 0.85, tile=0.25, layers={"rgb": "cardboard_rgb", "normal": "cardboard_normal"}
    ),
    "parcel_tape": Material((0.62, 0.46, 0.26), 0.25),
    "book_cloth": unit("book_rgb", 0.75),
    "paper": Material((0.86, 0.82, 0.73), 0.9),
    "black_plastic": Material((0.025, 0.025, 0.027), 0.4),
    "white_plastic": Material((0.82, 0.81, 0.78), 0.35),
    "radiator_white": Material((0.84, 0.83, 0.80), 0.30),
    "screen_glass": Material((0.012, 0.012, 0.014), 0.08),
    "orange_peel": Material((0.88, 0.42, 0.06), 0.4),
    "apple_red": Material((0.58, 0.08, 0.06), 0.25),
    "ball": unit("ball_rgb", 0.35),
    "art_hills": unit("art_hills", 0.8),
    "art_discs": unit("art_discs", 0.8),
    "art_bands": unit("art_bands", 0.8),
    "art_night": unit("art_night", 0.8),
    "toy_paint": Material((0.16, 0.40, 0.55), 0.35),
    "doormat": cloth((0.22, 0.19, 0.16), 0.5),
    "warm_shade": Material((1.0, 0.80, 0.58), 0.9, emission=4.5),
    "paper_lantern": Material((1.0, 0.95, 0.88), 0.9, emission=60),
    "lawn": Material((1, 1, 1), 0.95, layers={"rgb": "lawn_rgb"}, tile=2.0),
    "woods_near": Material((0.52, 0.58, 0.44), 0.95),
    "woods_middle": Material((0.64, 0.70, 0.64), 0.95),
    "woods_far": Material((0.76, 0.81, 0.84), 0.95),
} | {f"block_{k}": unit(f"block_{k}", 0.55) for k in "gloam"}
