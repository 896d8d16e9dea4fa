"""Whether two pictures of independent samples show the same light. Needs nothing but Python.

Each picture comes as means over blocks of 8 x 8 pixels in independent batches; the scatter of the batches gives the
standard error of a block's mean, and of the picture's (blocks of one batch may share sample points, so theirs is not
taken for granted). Three demands, each on all channels:

* Blocks. z = difference / sqrt(both errors squared); a block agrees if |z| <= 2.94 in every channel: the 1 % level, shared
  out among three channels (Bonferroni). At least 95 % must agree; of equal pictures some 99 % do.
* Chi-square. The mean of z squared is one for equal pictures (a little more, as errors from few batches are uncertain):
  at most 1.6. A single block that is wrong by many errors, or many that are wrong by two, break it.
* Picture. The means over the whole picture differ by at most 4 of their errors: this finds what is spread thin.

ROUNDING, relative, is added to every error: pictures without noise would otherwise be held to the last bit.
"""
import json
import math
from array import array
from dataclasses import dataclass

ROUNDING = 2e-4
BLOCK_Z, BLOCK_SHARE, CHI_SQUARE, PICTURE_Z = 2.94, 0.95, 1.6, 4.0
DARK = 0.02  # blocks darker than this share of the picture's mean need no small relative error


@dataclass
class Estimate:
    mean: list           # of each block and channel
    error: list          # standard errors
    picture: list        # means of the three channels
    picture_error: list


@dataclass
class Agreement:
    share: float         # of blocks that agree
    within_two: float    # of blocks with |z| <= 1.96 in the middle channel: about 95 % of equal ones
    chi_square: float    # mean of z squared
    picture_z: float     # of the channel that differs most
    difference: float    # of the picture's luminance, relative
    ours: float          # largest relative error of a block that is not dark
    theirs: float

    @property
    def agrees(self):
        return self.share >= BLOCK_SHARE and self.chi_square <= CHI_SQUARE and abs(self.picture_z) <= PICTURE_Z

    def __str__(self):
        return (f"{self.share:.1%} of blocks, chi-square {self.chi_square:.2f}, picture z {self.picture_z:+.1f}, "
                f"difference {100 * self.difference:+.3f} %, errors up to {100 * self.ours:.2f} and {100 * self.theirs:.2f} %")


def read(path):
    """(header, Estimate, picture as floats row by row) of a file of bench/path_blocks.cc or mitsuba_render.py."""
    head, raw = path.read_bytes().split(b"\n", 1)
    header, values = json.loads(head), array("f")
    values.frombytes(raw)
    size = header["width"] // header["block"] * (header["height"] // header["block"]) * 3
    batches = [values[i * size:(i + 1) * size] for i in range(header["batches"])]
    return header, estimate(batches), values[size * header["batches"]:]


def estimate(batches):
    mean, error = scatter(batches)
    picture, picture_error = scatter([[math.fsum(batch[c::3]) * 3 / len(batch) for c in range(3)] for batch in batches])
    return Estimate(mean, error, picture, picture_error)


def scatter(batches):
    """Mean and its standard error, of each column."""
    n = len(batches)
    means = [math.fsum(column) / n for column in zip(*batches)]
    return means, [math.sqrt(math.fsum((x - m) ** 2 for x in column) / (n * (n - 1))) for column, m in zip(zip(*batches), means)]


def exact(blocks):
    """Of a closed form: (red, green, blue) of each block."""
    mean = [c for block in blocks for c in block]
    picture = [math.fsum(mean[c::3]) * 3 / len(mean) for c in range(3)]
    return Estimate(mean, [0.0] * len(mean), picture, [0.0] * 3)


def z_score(a, error_a, b, error_b):
    width = math.hypot(error_a, error_b, ROUNDING * b)
    return (a - b) / width if width > 0 else (0.0 if a == b else math.inf)


def worst_relative(e):
    floor = [max(DARK * p, 1e-12) for p in e.picture]
    return max(error / max(mean, floor[i % 3]) for i, (mean, error) in enumerate(zip(e.mean, e.error)) if mean >= floor[i % 3])


def compare(ours, theirs):
    if len(ours.mean) != len(theirs.mean):
        raise ValueError("the pictures differ in size")
    z = [z_score(*values) for values in zip(ours.mean, ours.error, theirs.mean, theirs.error)]
    blocks = [z[i:i + 3] for i in range(0, len(z), 3)]
    picture = [z_score(*values) for values in zip(ours.picture, ours.picture_error, theirs.picture, theirs.picture_error)]
    weight = (0.2126, 0.7152, 0.0722)
    bright = [sum(w * c for w, c in zip(weight, e.picture)) for e in (ours, theirs)]
    return Agreement(share=sum(max(map(abs, block)) <= BLOCK_Z for block in blocks) / len(blocks),
                     within_two=sum(abs(block[1]) <= 1.96 for block in blocks) / len(blocks),
                     chi_square=math.fsum(x * x for x in z) / len(z), picture_z=max(picture, key=abs),
                     difference=bright[0] / bright[1] - 1, ours=worst_relative(ours), theirs=worst_relative(theirs))
