"""Values that MuJoCo's own parser accepts for each attribute, found by parsing documents with one element."""

import ctypes
import json
import os
import re
import tempfile

MOST_NUMBERS = 40  # the longest of bounded length has 31
UNBOUNDED = -1

# What an element has to have beside itself to be read, where the parser's complaint does not say it.
NEEDED = {
    "mujoco/default/material/layer": {"role": "rgb"},
    "mujoco/default/dcmotor": {"motorconst": "1 1", "resistance": "1"},
    "mujoco/asset/material/layer": {"role": "rgb", "texture": "t"},
    "mujoco/asset/model": {"name": "m", "file": "m.xml"},
    "mujoco/body/flexcomp": {"name": "f", "type": "grid", "count": "3 3 3", "spacing": "1 1 1", "dim": "3", "mass": "1"},
    "mujoco/equality/connect": {"body1": "b", "anchor": "0 0 0"},
    "mujoco/equality/weld": {"body1": "b"},
    "mujoco/actuator/dcmotor": {"motorconst": "1 1", "resistance": "1"},
    "mujoco/sensor/rangefinder": {"site": "s"},
    "mujoco/sensor/distance": {"geom1": "g", "geom2": "h"},
    "mujoco/sensor/normal": {"geom1": "g", "geom2": "h"},
    "mujoco/sensor/fromto": {"geom1": "g", "geom2": "h"},
    "mujoco/custom/numeric": {"name": "n", "size": "1"},
    "mujoco/custom/text": {"name": "n", "data": "d"},
    "mujoco/custom/tuple/element": {"objtype": "body", "objname": "b"},
    "mujoco/body/attach": {"prefix": "p"},
}


# Without these MuJoCo 4.0.1 ends the process instead of complaining.
FATAL_WITHOUT = {"mujoco/asset/model": ["file"]}


class Parser:
    def __init__(self, library):
        self.mujoco = ctypes.CDLL(str(library))
        self.mujoco.mj_parseXMLString.restype = ctypes.c_void_p
        self.mujoco.mj_parseXMLString.argtypes = [ctypes.c_char_p, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int]
        self.mujoco.mj_deleteSpec.argtypes = [ctypes.c_void_p]

    def complaint(self, text):
        """None, or the reason why MuJoCo rejects it."""
        error = ctypes.create_string_buffer(2000)
        spec = self.mujoco.mj_parseXMLString(text.encode(), None, error, len(error))
        if spec:
            self.mujoco.mj_deleteSpec(spec)
            return None
        return error.value.decode(errors="replace")


def tag(name, attributes):
    name = "worldbody" if name == "body" else name
    return name, "<" + name + "".join(f' {key}="{value}"' for key, value in attributes.items())


def document(path, attributes, needed):
    """MJCF with one element of this path; the elements above it have all that they need."""
    parts = path.split("/")
    if len(parts) == 1:
        return tag("mujoco", attributes)[1] + "/>"
    start, end = "", ""
    for depth, name in enumerate(parts[:-1]):
        name, opened = tag(name, needed.get("/".join(parts[:depth + 1]), {}))
        start, end = start + opened + ">", f"</{name}>" + end
        if parts[depth] == "body":  # the world itself has neither joints nor mass
            start, end = start + '<body name="b">', "</body>" + end
    if parts[-1] == "body":
        return start + "<worldbody>" + tag("body", attributes)[1].replace("<worldbody", "<body") + "/></worldbody>" + end
    return start + tag(parts[-1], attributes)[1] + "/>" + end


def required_attributes(parser, path, needed):
    """Adds the attributes that the parser reports as missing until it accepts the element."""
    attributes = dict(NEEDED.get(path, {}))
    required = list(FATAL_WITHOUT.get(path, []))
    for _ in range(12):
        complaint = parser.complaint(document(path, attributes, needed))
        missing = re.search(r"required attribute missing: '(\w+)'", complaint or "")
        short = re.search(r"attribute '(\w+)' does not have enough data", complaint or "")
        if missing:
            attributes[missing[1]] = "body" if missing[1] == "objtype" else "1"
            required.append(missing[1])
        elif short and short[1] in attributes:
            attributes[short[1]] += " 1"
        else:
            break
    return attributes, required


def take(parser, path, name, base, needed, words):
    """{"type", "least", "most", "keywords"} of one attribute."""
    others = {key: value for key, value in base.items() if key != name}

    def complaint(value):
        return parser.complaint(document(path, {**others, name: value}, needed)) or ""

    def is_no_number(value):
        no = complaint(value)
        return f"bad format in attribute '{name}'" in no or f"problem reading attribute '{name}'" in no

    no = complaint("zz")
    if "invalid keyword" in no:
        known = [word for word in words if "invalid keyword" not in complaint(word)]
        several = any("invalid keyword" not in complaint(f"{a} {b}") for a, b in zip(known, known[1:]))
        return {"type": "kKeyword", "least": 1, "most": len(known) if several else 1, "keywords": known}
    if not is_no_number("zz"):
        return {"type": "kString", "least": 1, "most": 1, "keywords": []}
    kind = "kInt" if is_no_number("1.5") else "kReal"
    least, most = 0, UNBOUNDED
    for count in range(1, MOST_NUMBERS + 1):
        no = complaint(" ".join(["1"] * count))
        if f"attribute '{name}' has too much data" in no or f"problem reading attribute '{name}'" in no:
            most = count - 1
            break
        if f"attribute '{name}' does not have enough data" in no:
            least = count + 1
    return {"type": kind, "least": max(least, 1) if most != UNBOUNDED else least, "most": most, "keywords": []}


def in_a_child(work, folder):
    """work() in a process of its own, as MuJoCo ends the process at some documents; None if it did. Its log goes to `folder`."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.chdir(folder)
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 1)
        os.dup2(null, 2)
        with os.fdopen(writing, "w") as out:
            json.dump(work(), out)
            out.flush()
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as answer:
        text = answer.read()
    os.waitpid(child, 0)
    return json.loads(text) if text else None


def ask_parser(library, grammar, words_of):
    """{path: {"required": [attribute], "attributes": {attribute: take(…)}}}; words_of(path, attribute) are its keywords."""
    needed, found = {}, {}
    library = library.resolve()
    with tempfile.TemporaryDirectory() as folder:
        ask_all(library, grammar, words_of, needed, found, folder)
    return found


def ask_all(library, grammar, words_of, needed, found, folder):
    for path, _, names in grammar:
        def work(path=path, names=names):
            parser = Parser(library)
            base, required = required_attributes(parser, path, needed)
            return {"base": base, "required": required,
                    "attributes": {name: take(parser, path, name, base, needed, words_of(path, name)) for name in names}}
        answer = in_a_child(work, folder)
        if answer is None:
            raise SystemExit(f"MuJoCo terminated the process that probed <{path}>: add an entry to parser_probe.NEEDED")
        needed[path] = answer["base"]
        found[path] = answer
