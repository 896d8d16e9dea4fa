"""Lamps without extent whose intensity is a function of direction, as a Mitsuba emitter: its own spot fades by another law."""
import json
import math

import drjit as dr
import mitsuba as mi


class Directed(mi.Emitter):
    """At `place`; `share(d)` of `intensity` goes into the unit direction d."""

    def __init__(self, props):
        mi.Emitter.__init__(self, props)
        self.m_flags = mi.EmitterFlags.DeltaPosition

    def sample_direction(self, it, sample, active=True):
        ds = dr.zeros(mi.DirectionSample3f)
        ds.p = mi.Point3f(self.place)
        to = ds.p - it.p
        square = dr.squared_norm(to)
        ds.dist = dr.sqrt(square)
        ds.d = to / ds.dist
        ds.n = -ds.d
        ds.time, ds.pdf, ds.delta = it.time, 1.0, True
        ds.emitter = mi.EmitterPtr(self)
        return ds, dr.select(active, mi.Color3f(self.intensity) * self.share(-ds.d) / square, 0)

    def pdf_direction(self, it, ds, active=True):
        return mi.Float(0)

    def eval_direction(self, it, ds, active=True):
        return self.sample_direction(it, mi.Point2f(0), active)[1]

    def eval(self, si, active=True):
        return mi.Color3f(0)

    def bbox(self):
        return mi.ScalarBoundingBox3f(self.place)

    def to_string(self):
        return f"{type(self).__name__}[]"


class Spot(Directed):
    """Full intensity up to the angle `inner`, none beyond `cutoff` [rad], a smooth step in the angle between (docs/light.md)."""

    def __init__(self, props):
        Directed.__init__(self, props)
        self.place = mi.ScalarPoint3f(props["position"])
        self.axis = mi.ScalarVector3f(props["direction"])
        self.intensity = mi.ScalarColor3f(props["intensity_rgb"])
        self.inner, self.cutoff = props["inner"], props["cutoff"]

    def share(self, d):
        angle = dr.acos(dr.clip(dr.dot(d, mi.Vector3f(self.axis)), -1, 1))
        x = dr.clip((self.cutoff - angle) / max(self.cutoff - self.inner, 1e-6), 0, 1)
        return x * x * (3 - 2 * x)


class Profile(Directed):
    """Candela bilinear between measured angles (Lamp.profile of description.py), as LM-63 has them."""

    def __init__(self, props):
        Directed.__init__(self, props)
        p = json.loads(props["parameters"])
        self.place, self.intensity = mi.ScalarPoint3f(p["position"]), mi.ScalarColor3f(p["scale"])
        self.axes = [mi.ScalarVector3f(column) for column in zip(*p["rotation"])]
        self.around, self.down = len(p["candela"]), len(p["candela"][0])
        self.candela = mi.Float([value for row in p["candela"] for value in row])

    def share(self, d):
        x, y, z = (dr.dot(d, mi.Vector3f(axis)) for axis in self.axes)
        down = dr.acos(dr.clip(-z, -1, 1)) * (2 / math.pi) * (self.down - 1)
        turn = dr.atan2(y, x) / (2 * math.pi) * self.around
        turn = dr.select(turn < 0, turn + self.around, turn)
        i, j = mi.UInt32(dr.minimum(down, self.down - 1.001)), mi.UInt32(dr.minimum(turn, self.around - 1e-3))
        a, b = dr.clip(down - i, 0, 1), turn - j

        def at(row, column):
            return dr.gather(mi.Float, self.candela, row * self.down + column)

        beside = dr.select(j + 1 == self.around, 0, j + 1)
        value = dr.lerp(dr.lerp(at(j, i), at(j, i + 1), a), dr.lerp(at(beside, i), at(beside, i + 1), a), b)
        return dr.select(down <= self.down - 1, value, 0)


mi.register_emitter("gloam_spot", Spot)
mi.register_emitter("gloam_profile", Profile)
