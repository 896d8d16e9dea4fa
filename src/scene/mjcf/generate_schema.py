#!/usr/bin/env python3
"""Writes mjcf_schema_table.inc, with every element and attribute of MJCF in this MuJoCo, and a C++ class for each.

  generate_schema.py --library libmujoco.so --spec mujoco/mjspec.h --doc MUJOCO/doc --table mjcf_schema_table.inc --header mjcf_elements.h

The grammar (elements, attributes and how often each is allowed) is the library's own, printed by mj_printSchema. Types
and lengths come from its parser, which is given words and numbers for every attribute. Keywords, defaults and texts are
read from the manual's XMLreference.rst, units from XMLunits.rst. Without the manual (a MuJoCo of the system) the table
lacks these. Attributes that only mjSpec has are added from mjspec.h.
"""

import argparse
import ctypes
import itertools
import json
import re
import sys
from pathlib import Path

from parser_probe import UNBOUNDED, ask_parser
from properties import elements_header

INDENT = 3  # columns per level of what mj_printSchema prints
ATTRIBUTE_COLUMN = 30

# What the parser reads and mj_printSchema does not print: they stand for other elements, and are gone after parsing.
META_ELEMENTS = [
    ("mujoco/body/frame", "R", "name childclass pos quat axisangle xyaxes zaxis euler scale scaling massscale"),
    ("mujoco/body/replicate", "R", "count sep offset euler"),
    ("mujoco/include", "*", "file"),
]

# Of mjSpec's fields that no attribute of MJCF sets, those that are a user's to set: the element that has them here.
SPEC_ONLY = {
    "mujoco/size": ("mjSpec", ["nemax"]),
    "mujoco/asset/mesh": ("mjsMesh", ["needsdf", "octree_maxdepth", "userfacenormal", "userfacetexcoord", "usernode", "usertet"]),
    "mujoco/asset/texture": ("mjsTexture", ["data"]),
    "mujoco/deformable/flex/elasticity": ("mjsFlex", ["elastic3d"]),
}
SPEC_TYPES = {  # type, least, most, keywords
    "mjtBool": ("kKeyword", 1, 1, ["false", "true"]),
    "int": ("kInt", 1, 1, []),
    "mjIntVec*": ("kInt", 0, UNBOUNDED, []),
    "mjByteVec*": ("kInt", 0, UNBOUNDED, []),
    "mjDoubleVec*": ("kReal", 0, UNBOUNDED, []),
}


def spec_attributes(path, header):
    """Attributes out of mjspec.h, with its comments."""
    owner, names = SPEC_ONLY.get(path, ("", []))
    struct = re.search(rf"typedef struct {owner}_ \{{(.*?)\n\}} {owner};", header, re.S) if owner else None
    for name in names:
        field = re.search(rf"^ +(\S+) +{name}; *// (.*)$", struct[1], re.M) if struct else None
        if field is None:
            sys.exit(f"mjspec.h has no {owner}.{name}: SPEC_ONLY names it")
        kind, least, most, words = SPEC_TYPES[field[1]]
        yield {"name": name, "type": kind, "least": least, "most": most, "keywords": words, "required": False, "default": "",
               "unit": "", "doc": field[2], "owner": owner}


# Defaults that the manual tells otherwise than the library has them (a test holds all others to it); "" = it depends.
LIBRARYS_DEFAULTS = {"damper/kv": "0", "flexcomp/flatskin": ""}  # a flexcomp's: is it a box?


def print_schema(library):
    size = 1 << 20
    text = ctypes.create_string_buffer(size)
    if ctypes.CDLL(str(library)).mj_printSchema(None, text, size, 0, 0) <= 0:
        sys.exit(f"{library}: mj_printSchema printed nothing")
    return text.value.decode()


def read_grammar(text):
    """[(path, cardinality, [attribute])] in the order of the grammar; the path begins with "mujoco"."""
    elements, above = [], []
    for line in filter(str.strip, text.splitlines()):
        match = re.match(r"( *)(\S+) \((.)\)(.*)", line)
        if match and len(match[1]) < ATTRIBUTE_COLUMN:
            depth = len(match[1]) // INDENT
            above = above[:depth] + [match[2].replace("(world)", "")]
            elements.append(("/".join(above), match[3], match[4].split()))
        else:
            elements[-1][2].extend(line.split())
    return elements + [(path, cardinality, names.split()) for path, cardinality, names in META_ELEMENTS]


def read_reference(text):
    """label -> {"type", "default", "doc"}: as in :at-val:`[a, b], "a"`; None where the manual says neither."""
    found, labels, lines = {}, [], text.splitlines()
    for i, line in enumerate(lines):
        label = re.match(r"\.\. _([\w-]+):$", line)
        if label:
            labels.append(label[1])
        elif line.startswith(":at:`"):
            names = re.findall(r":at:`(\w+)`", line)
            value = re.search(r":at-val:`(.*?)`", line)
            parts = re.match(r"(\[.*?\]|[^,]*)(?:,\s*(.*))?$", value[1]) if value else (None, None, None)
            body = list(itertools.takewhile(lambda more: not more.startswith((".. _", ":at:")), lines[i + 1:]))
            first = itertools.takewhile(lambda more: more.startswith("   "), body)
            about = {"type": parts[1], "default": parts[2], "doc": plain(" ".join(first)), "body": " ".join(body)}
            for label in labels:
                if any(label.endswith("-" + name) for name in names):
                    found[label] = about
            labels = []
        elif line.strip() and not line.startswith((".. ", "   ")):  # a film's box may stand between
            labels = []
    return found


def read_units(text):
    """label -> unit, as "kg m^2"; words where there is no formula."""
    rows = re.findall(r"\* - :ref:`[^`<]+<([^>]+)>`\n     - (.+)", text)
    return {label: unit_of(formula) for label, formula in rows}


def unit_of(formula):
    """MuJoCo's dimensions (lengths, masses, times) in SI. Q is m or rad, F is N or N m, after what moves."""
    if "*" in formula:
        return formula.strip("* ")
    symbols = {"L": "m", "M": "kg", "T": "s", "A": "rad", "Q": "m|rad", "F": "N|N m", "1": "1"}

    def term(text):
        words = []
        for factor in filter(None, re.split(r"\\,", text.strip())):
            base, _, power = factor.partition("^")
            power = power.strip("{}")
            unit = symbols[base.strip()]
            words.append(f"({unit})^{power}" if power and " " in unit + unit.replace("|", " ") and "|" in unit
                         else unit + (f"^{power}" if power else ""))
        return " ".join(words)

    forms = []
    for form in re.findall(r":math:`([^`]*)`", formula):
        forms.append(", ".join(term(part) for part in re.split(r",\\ ", form)))
    return " or ".join(forms)


def plain(text):
    """Restructured text as plain text."""
    text = re.sub(r":(?:ref|el|at|at-val|doc|math):`([^`<]*?)\s*(?:<[^>]*>)?`", r"\1", text)
    text = re.sub(r"`([^`<]*?)\s*<[^>]*>`__?", r"\1", text)
    text = re.sub(r"\*\*(.*?)\*\*|``(.*?)``|\*(.*?)\*", lambda m: m[1] or m[2] or m[3], text)
    return re.sub(r"\s+", " ", re.sub(r"\|\w+\||\\[,;]?", " ", text)).strip()


def labels_of(path, attribute):
    """Places where the manual may describe it: it omits elements that only contain others."""
    parts = path.split("/")[1:]
    for first in range(len(parts)):
        yield "-".join(parts[first:] + [attribute])
    if not parts:
        yield "mujoco-" + attribute


def same_as(path):
    """Elements whose attributes of the same name are the same, in the order in which to ask."""
    parts = path.split("/")
    name, above = parts[-1], parts[1:-1]
    if above == ["default"]:
        for section in ("body", "asset", "actuator", "contact", "equality", "tendon"):
            yield f"mujoco/{section}/{name}"
        yield {"tendon": "mujoco/tendon/spatial", "equality": "mujoco/equality/connect"}.get(name, "")
    if above[:1] == ["default"] and name == "layer":
        yield "mujoco/asset/material/layer"
    if "flexcomp" in above or "flex" in above:
        yield f"mujoco/deformable/flex/{name}"
        yield f"mujoco/body/flexcomp/{name}"
        yield "mujoco/body/geom"
    if name == "flex" or name == "flexcomp":
        yield "mujoco/deformable/flex"
        yield "mujoco/body/flexcomp"
    if above == ["actuator"] or (above == ["default"]):
        yield "mujoco/actuator/general"
        yield "mujoco/actuator/position"
    if above == ["sensor"]:
        yield "mujoco/sensor"
        yield "mujoco/sensor/framepos"
        yield "mujoco/sensor/plugin"
        yield "mujoco/sensor/distance"
    if above == ["equality"]:
        yield "mujoco/equality/connect"
    if name == "fixed":
        yield "mujoco/tendon/spatial"
    if name == "skin" or "skin" in above:
        yield "mujoco/deformable/skin" + ("/bone" if name == "bone" else "")
        yield "mujoco/asset/skin" + ("/bone" if name == "bone" else "")
    if name == "plugin":
        yield "mujoco/body/plugin"
    if name in ("config", "instance"):
        yield "mujoco/extension/plugin/instance" + ("/config" if name == "config" else "")


def describe(path, attribute, reference):
    """Its description in the manual, or that of the same attribute of another element."""
    about = {"type": None, "default": None, "doc": "", "body": ""}
    for where in [path, *filter(None, same_as(path))]:
        for label in labels_of(where, attribute):
            more = reference.get(label, {})
            for key, value in more.items():
                if value and (not about[key] or key in ("doc", "body") and about["doc"].startswith("See ")):
                    about[key] = value
    return about


def keywords(about):
    """Words that may be its keywords; the parser decides which ones are."""
    kind = about["type"] or ""
    if kind.startswith("["):
        return [word.strip() for word in kind.strip("[]").split(",")]
    said = re.findall(r'"([\w ]+)"|:at-val:`(\w+)`|``(\w+)``', about["body"])
    return list(dict.fromkeys(["false", "true", "none"] + " ".join(map(" ".join, said)).split()))


def unit(path, attribute, units):
    for where in [path, *filter(None, same_as(path))]:
        for label in labels_of(where, attribute):
            if label in units:
                return units[label]
    return ""


def quote(text):
    return json.dumps(text, ensure_ascii=False) + "sv"


def table_rows(elements):
    for element in elements:
        yield f"GLOAM_ELEMENT({quote(element['path'])}, '{element['times']}', {len(element['attributes'])})\n"
        for a in element["attributes"]:
            yield (f"GLOAM_ATTRIBUTE({quote(a['name'])}, {a['type']}, {a['least']}, {a['most']}, {quote(' '.join(a['keywords']))}, "
                   f"{str(a['required']).lower()}, {quote(a['default'])}, {quote(a['unit'])}, {quote(a['doc'])}, {quote(a['owner'])})\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--library", type=Path, required=True)
    parser.add_argument("--spec", type=Path, required=True)
    parser.add_argument("--doc", type=Path, required=True)
    parser.add_argument("--table", type=Path, required=True)
    parser.add_argument("--header", type=Path, required=True)
    options = parser.parse_args()
    pages = {name: options.doc / name for name in ("XMLreference.rst", "modeling.rst", "XMLunits.rst")}
    pages = {name: page.read_text(encoding="utf-8") if page.exists() else "" for name, page in pages.items()}
    reference = {**read_reference(pages["modeling.rst"]), **read_reference(pages["XMLreference.rst"])}
    units = read_units(pages["XMLunits.rst"])
    spec = options.spec.read_text(encoding="utf-8")
    grammar = read_grammar(print_schema(options.library))
    taken = ask_parser(options.library, grammar, lambda path, name: keywords(describe(path, name, reference)))
    elements = []
    for path, times, names in grammar:
        attributes = []
        for name in names:
            about = describe(path, name, reference)
            default = about["default"] or ""
            default = default.split('"')[1] if default.startswith('"') else ""
            attributes.append({"name": name, **taken[path]["attributes"][name], "required": name in taken[path]["required"],
                               "default": LIBRARYS_DEFAULTS.get(f"{path.split('/')[-1]}/{name}", default),
                               "unit": unit(path, name, units), "doc": about["doc"], "owner": ""})
        attributes += spec_attributes(path, spec)
        elements.append({"path": path, "times": times, "attributes": attributes})
    options.table.write_text("".join(table_rows(elements)), encoding="utf-8")
    options.header.write_text(elements_header(elements), encoding="utf-8")


if __name__ == "__main__":
    main()
