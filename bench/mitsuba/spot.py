"""Lamps without extent whose intensity is a function of direction, as a Mitsuba emitter: its own spot fades by another law."""
import drjit as dr
import mitsuba as mi


class Spot(mi.Emitter):
    """Full intensity up to the angle `inner`, none beyond `cutoff` [rad], a smooth step in the angle between (docs/light.md)."""

    def __init__(self, props):
        mi.Emitter.__init__(self, props)
        self.place = mi.ScalarPoint3f(props["position"])
        self.axis = mi.ScalarVector3f(props["direction"])
        self.intensity = mi.ScalarColor3f(props["intensity_rgb"])
        self.inner, self.cutoff = props["inner"], props["cutoff"]
        self.m_flags = mi.EmitterFlags.DeltaPosition

    def sample_direction(self, it, sample, active=True):
        ds = dr.zeros(mi.DirectionSample3f)
        ds.p = mi.Point3f(self.place)
        to = ds.p - it.p
        square = dr.squared_norm(to)
        ds.dist = dr.sqrt(square)
        ds.d = to / ds.dist
        ds.n = mi.Normal3f(self.axis)
        ds.time, ds.pdf, ds.delta = it.time, 1.0, True
        ds.emitter = mi.EmitterPtr(self)
        angle = dr.acos(dr.clip(-dr.dot(ds.d, mi.Vector3f(self.axis)), -1, 1))
        x = dr.clip((self.cutoff - angle) / max(self.cutoff - self.inner, 1e-6), 0, 1)
        share = x * x * (3 - 2 * x)
        return ds, dr.select(active, mi.Color3f(self.intensity) * share / square, 0)

    def pdf_direction(self, it, ds, active=True):
        return mi.Float(0)

    def eval_direction(self, it, ds, active=True):
        return self.sample_direction(it, mi.Point2f(0), active)[1]

    def eval(self, si, active=True):
        return mi.Color3f(0)

    def bbox(self):
        return mi.ScalarBoundingBox3f(self.place)

    def to_string(self):
        return "Spot[]"


mi.register_emitter("gloam_spot", Spot)
