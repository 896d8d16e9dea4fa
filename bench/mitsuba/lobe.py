"""Gloam's surface as it is published, as a Mitsuba BSDF: the formulas stand at the top of src/render/kernel/bsdf/bsdf.h and
layered_bsdf.h. Distribution, masking, Fresnel and sampling of microfacets are Mitsuba's own; tables are lobe_tables.py's.

It takes one string property, `parameters`: JSON of the fields below. `scales` multiplies what a lobe reflects or lets
through and leaves the rest as it is: that is how the mutation test scales one lobe.
"""
import json

import drjit as dr
import lobe_tables
import mitsuba as mi

LOBES = ("diffuse", "layer", "metal", "coat", "fuzz", "reflection", "transmission", "beyond")


def as_data(color):
    """Data, so that another value needs no kernel of its own."""
    return mi.Color3f(*(dr.opaque(mi.Float, c) for c in color))


class Table:
    """Values over a cosine from 0 to 1, linear in between."""

    def __init__(self, values):
        self._values, self._size = mi.Float(list(values)), len(values)

    def __call__(self, cosine):
        x = dr.clip(cosine, 0, 1) * (self._size - 1)
        low = mi.UInt32(dr.minimum(x, self._size - 1.001))
        share = x - mi.Float(low)
        return dr.lerp(dr.gather(mi.Float, self._values, low), dr.gather(mi.Float, self._values, low + 1), share)


def widths(roughness, anisotropy=0.0):
    """GGX widths (OpenPBR 1.1)."""
    across = 1 - anisotropy
    along = roughness**2 * ((2 / (1 + across**2)) ** 0.5 if anisotropy > 0 else 1)
    return max(along, 1e-3), max(along * across, 1e-3)


def ggx(roughness, anisotropy=0.0):
    return mi.MicrofacetDistribution(mi.MicrofacetType.GGX, *widths(roughness, anisotropy), True)


def shadowing(distribution, v, l, h):
    """Height-correlated Smith from Mitsuba's separable terms: 1 / G2 = 1 / G1(v) + 1 / G1(l) - 1."""
    a, b = distribution.smith_g1(v, h), distribution.smith_g1(l, h)
    return dr.select((a > 0) & (b > 0), a * b / (a + b - a * b), 0)


def schlick(cosine):
    return dr.clip(1 - cosine, 0, 1) ** 5


def under_coat(roughness, coat_roughness, coat):
    """OpenPBR 1.1, "Roughening"."""
    both = min(roughness**4 + 2 * coat_roughness**4, 1) ** 0.25
    return roughness + coat * (both - roughness)


class Lobe(mi.BSDF):
    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        p = json.loads(props["parameters"])
        scales = {name: 1.0 for name in LOBES} | p["scales"]
        unknown = set(scales) - set(LOBES)
        if unknown:
            raise ValueError(f"there are no lobes {unknown}")
        self.scale = {name: dr.opaque(mi.Float, scale) for name, scale in scales.items()}
        color = as_data(p["color"])
        self.color, self.metallic, self.f90 = color, p["metallic"], min(2 * p["specular"], 1)
        self.ior = p.get("ior", 1.5)
        self.f0 = ((self.ior - 1) / (self.ior + 1)) ** 2 * self.f90
        self.coat, self.fuzz = p.get("coat_weight", 0), p.get("fuzz_weight", 0)
        self.roughness = under_coat(p["roughness"], p.get("coat_roughness", 0), self.coat)
        self.base = ggx(self.roughness, p.get("anisotropy", 0))
        self.turn = 2 * dr.pi * p.get("anisotropy_rotation", 0)
        a, b = lobe_tables.layer_columns(self.roughness)
        self.a, self.b = Table(a), Table(b)
        if self.coat > 0:
            self.coat_ggx, self.coat_color = ggx(p.get("coat_roughness", 0)), as_data(p.get("coat_color", [1, 1, 1]))
            ior = p.get("coat_ior", 1.6)
            self.coat_f0 = ((ior - 1) / (ior + 1)) ** 2
            a, b = lobe_tables.layer_columns(p.get("coat_roughness", 0))
            self.coat_a, self.coat_b = Table(a), Table(b)
        if self.fuzz > 0:
            rough = p.get("fuzz_roughness", 0.5)
            self.fuzz_power = 1 / max(rough**2, 1e-2)
            self.fuzz_color = as_data([c * self.fuzz for c in p.get("fuzz_color", [1, 1, 1])])
            self.fuzz_top = dr.opaque(mi.Float, max(p.get("fuzz_color", [1, 1, 1])) * self.fuzz)
            self.fuzz_albedo = Table(lobe_tables.fuzz_columns(rough))
        self.glass, self.thin = p.get("transmission_weight", 0), p.get("thin_walled", False)
        self.tint = as_data(p.get("transmission_color", [1, 1, 1]) if p.get("transmission_depth", 0) == 0 else [1, 1, 1])
        if self.glass > 0 and not self.thin:
            self.glass_albedo = [Table(lobe_tables.glass_columns(self.roughness, eta)) for eta in (self.ior, 1 / self.ior)]
        self.subsurface = p.get("subsurface_weight", 0)
        self.inside = as_data([c * (0.5 if self.thin else 1) for c in p.get("subsurface_color", [0.8, 0.8, 0.8])])
        opaque = 1 - self.glass
        weights = {"cosine": 0.5 * opaque + 0.1 * (self.fuzz > 0), "base": (0.3 + 0.7 * self.metallic) * opaque + 1e-3,
                   "coat": 0.5 * (self.coat > 0), "glass": self.glass, "beyond": 0.5 * (self.thin and self.subsurface > 0)}
        self.chance = {name: weight / sum(weights.values()) for name, weight in weights.items() if weight > 0}
        flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.GlossyTransmission | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [flags]
        self.m_flags = flags

    def _frame(self, v, l):
        """Both directions as seen by a viewer above; whether that is outside; index beyond / here."""
        outside = v.z > 0
        c, s = dr.cos(self.turn), dr.sin(self.turn)

        def turned(w):
            return mi.Vector3f(c * w.x + s * w.y, c * w.y - s * w.x, dr.select(outside, w.z, -w.z))

        eta = mi.Float(self.ior) if self.thin else dr.select(outside, mi.Float(self.ior), 1 / self.ior)
        return turned(v), turned(l), outside, eta

    def _reflects(self, cosine, eta):
        share = mi.fresnel(cosine, eta)[0]
        return 2 * share / (1 + share) if self.thin else share

    def _glass(self, v, l, eta):
        """Half vector, its share of reflected light, whether light goes through, Jacobian of l about it, possible."""
        through = l.z < 0
        if self.thin:
            mirrored = mi.Vector3f(l.x, l.y, dr.abs(l.z))
            h = dr.normalize(v + mirrored)
            jacobian = 1 / (4 * dr.dot(mirrored, h))
        else:
            h = dr.normalize(v + l * dr.select(through, eta, 1))
            h = dr.select(h.z < 0, -h, h)
            vh, lh = dr.dot(v, h), dr.dot(l, h)
            jacobian = dr.select(through, eta**2 * dr.abs(lh) / (vh + eta * lh) ** 2, 1 / (4 * dr.abs(lh)))
            through_ok = dr.select(through, lh < 0, lh > 0)
        vh = dr.dot(v, h)
        possible = (vh > 0) & (dr.abs(l.z) > 1e-6)
        if not self.thin:
            possible &= through_ok
        return h, self._reflects(vh, eta), through, jacobian, possible

    def _darkening(self, cosine):
        """OpenPBR 1.1, "Darkening", of the base that is no glass."""
        ior = (1 + self.coat_f0**0.5) / (1 - self.coat_f0**0.5)
        matt = 1 - (1 - (self.coat_f0 + (1 - self.coat_f0) / 21)) / ior**2
        diffuse = dr.lerp(self.color, self.inside * (2 if self.thin else 1), self.subsurface)
        albedo = dr.lerp(dr.lerp(diffuse, mi.Color3f(1), self.f0), self.color, self.metallic)
        smooth = self.f0 + self.metallic * (1 - self.f0)
        back = dr.lerp(dr.lerp(mi.Float(self.coat_f0), 1, schlick(cosine)), matt, 1 + smooth * (self.roughness - 1))
        back = dr.minimum(back, 0.999)
        return dr.lerp(mi.Color3f(1), (1 - back) / (1 - albedo * back), self.coat)

    def _value(self, v, l, outside, eta):
        """f times the cosine of l."""
        above, below = (v.z > 0) & (l.z > 0), (v.z > 0) & (l.z < 0)
        value, under = mi.Color3f(0), mi.Color3f(1)
        h = dr.normalize(v + l)
        vh = dr.dot(v, h)
        if self.fuzz > 0:
            under -= dr.select(outside, self.fuzz_top * self.fuzz_albedo(v.z), 0)
            sin_h = dr.safe_sqrt(1 - h.z**2)
            charlie = (2 + self.fuzz_power) * sin_h**self.fuzz_power / (2 * dr.pi) / (4 * (v.z + l.z - v.z * l.z))
            value += dr.select(above & outside, self.fuzz_color * charlie * l.z * self.scale["fuzz"], 0)
        if self.coat > 0:
            a, b = self.coat_a(v.z), self.coat_b(v.z)
            single = dr.maximum(a + b, 1e-3)
            gain = 1 + self.coat_f0 * (1 - single) / single
            f = dr.lerp(mi.Float(self.coat_f0), 1, schlick(vh)) * gain * self.coat
            lobe = f * self.coat_ggx.eval(h) * shadowing(self.coat_ggx, v, l, h) / (4 * v.z)
            value += dr.select(above & outside, under * lobe * self.scale["coat"], 0)
            passes = dr.lerp(mi.Color3f(1), self.coat_color, self.coat) * (1 - self.coat * (self.coat_f0 * a + b) * gain)
            under *= dr.select(outside, passes, 1)
            dark = dr.select(outside, self._darkening(v.z), 1)
        else:
            dark = mi.Color3f(1)
        a, b = self.a(v.z), self.b(v.z)
        single = dr.maximum(a + b, 1e-3)
        missing = (1 - single) / single
        dielectric, gain = (1 - self.metallic) * (1 - self.glass), 1 + self.f0 * missing
        left = dielectric * (1 - (self.f0 * a + self.f90 * b) * gain)  # of light, below the layer
        base = dr.lerp(self.color, self.inside, self.subsurface) * left * self.scale["diffuse"] * l.z * dr.inv_pi
        f = schlick(vh)
        layer = dr.lerp(mi.Float(self.f0), self.f90, f) * gain * dielectric * self.scale["layer"]
        metal = dr.lerp(self.color, mi.Color3f(1), f) * (1 + self.color * missing) * self.metallic * self.scale["metal"]
        base += (metal + layer) * self.base.eval(h) * shadowing(self.base, v, l, h) / (4 * v.z)
        value += dr.select(above, under * dark * base, 0)
        if self.thin and self.subsurface > 0:
            value += dr.select(below, under * dark * self.inside * self.subsurface * left * self.scale["beyond"] * -l.z * dr.inv_pi, 0)
        if self.glass > 0:
            h, reflects, through, jacobian, possible = self._glass(v, l, eta)
            single = dr.maximum(a + b, 1e-3) if self.thin else \
                dr.maximum(dr.select(outside, self.glass_albedo[0](v.z), self.glass_albedo[1](v.z)), 1e-3)
            lobe = self.base.eval(h) * shadowing(self.base, v, mi.Vector3f(l.x, l.y, dr.abs(l.z)), mi.Normal3f(0, 0, 1)) * \
                dr.dot(v, h) * jacobian / v.z
            squeezed = mi.Float(1) if self.thin else 1 / eta**2  # radiance where it enters glass
            share = dr.select(through, self.tint * (1 - reflects) * squeezed * self.scale["transmission"],
                              mi.Color3f(reflects * self.scale["reflection"]))
            value += dr.select(possible & (above | below), under * share * lobe * self.glass * (1 - self.metallic) / single, 0)
        return value

    def _density(self, v, l, eta):
        above, below = (v.z > 0) & (l.z > 0), (v.z > 0) & (l.z < 0)
        h = dr.normalize(v + l)
        density = mi.Float(0)
        for name, chance in self.chance.items():
            if name == "cosine":
                density += dr.select(above, chance * l.z * dr.inv_pi, 0)
            elif name == "beyond":
                density += dr.select(below, -chance * l.z * dr.inv_pi, 0)
            elif name == "glass":
                half, reflects, through, jacobian, possible = self._glass(v, l, eta)
                share = dr.select(through, 1 - reflects, reflects)
                density += dr.select(possible & (v.z > 0), chance * self.base.pdf(v, half) * share * jacobian, 0)
            else:
                distribution = self.base if name == "base" else self.coat_ggx
                density += dr.select(above, chance * distribution.pdf(v, h) / (4 * dr.dot(l, h)), 0)
        return density

    def _direction(self, v, eta, pick, u):
        l, left = mi.Vector3f(0), mi.Float(pick)
        open_ = mi.Bool(True)
        for name, chance in self.chance.items():
            mine = open_ & (left < chance)
            if name in ("cosine", "beyond"):
                way = mi.warp.square_to_cosine_hemisphere(u)
                way = -way if name == "beyond" else way
            else:
                distribution = self.coat_ggx if name == "coat" else self.base
                h = distribution.sample(v, u)[0]
                way = mi.reflect(v, h)
                if name == "glass":
                    _, cos_t, _, eta_ti = mi.fresnel(dr.dot(v, h), eta)
                    bent = mi.Vector3f(way.x, way.y, -way.z) if self.thin else mi.refract(v, h, cos_t, eta_ti)
                    mirrors = left < chance * self._reflects(dr.dot(v, h), eta)
                    way = dr.select(mirrors, way, bent)
                    mine &= dr.select(mirrors, way.z > 0, way.z < 0)
                else:
                    mine &= way.z > 0  # below, others have a density
            l = dr.select(mine, way, l)
            open_ &= ~(left < chance)
            left -= chance
        return l

    def eval_pdf(self, ctx, si, wo, active=True):
        v, l, outside, eta = self._frame(si.wi, wo)
        possible = active & (v.z > 0) & (l.z != 0)
        return (dr.select(possible, self._value(v, l, outside, eta), 0), dr.select(possible, self._density(v, l, eta), 0))

    def eval(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[1]

    def sample(self, ctx, si, sample1, sample2, active=True):
        v, _, outside, eta = self._frame(si.wi, si.wi)
        l = self._direction(v, eta, sample1, sample2)
        density = self._density(v, l, eta)
        possible = active & (density > 1e-12) & (l.z != 0) & (v.z > 0)
        out = dr.zeros(mi.BSDFSample3f)
        c, s = dr.cos(self.turn), dr.sin(self.turn)
        out.wo = mi.Vector3f(c * l.x - s * l.y, c * l.y + s * l.x, dr.select(outside, l.z, -l.z))
        out.pdf = dr.select(possible, density, 0)
        out.eta = 1.0
        out.sampled_type = mi.UInt32(+mi.BSDFFlags.GlossyReflection)
        out.sampled_component = mi.UInt32(0)
        return out, dr.select(possible, self._value(v, l, outside, eta) / density, 0)

    def to_string(self):
        return f"Lobe[roughness = {self.roughness}]"


mi.register_bsdf("gloam_lobe", Lobe)
