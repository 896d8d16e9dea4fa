"""Writes gloam/mjcf_elements.h: a class for each element of MJCF, with a property for each attribute."""

import re
import textwrap

BODY = "mujoco/body"
GROUPS = {BODY + "/frame", BODY + "/replicate"}  # they hold what bodies hold
ENDINGS = {"actuator": "Actuator", "sensor": "Sensor", "equality": "Equality", "tendon": "Tendon"}
SHORT = {"body", "asset", "deformable", "custom", "keyframe"}  # their elements need no more than their own names
RESERVED = {"class": "class_"}
SHARED = {("false", "true", "auto"): "AutoFlag"}
FLAGS = {("false", "true"), ("disable", "enable")}  # these are bools: no, yes

HEADER = """#pragma once
// A class for each element of MJCF and a property for each attribute: made from the library and the
// manual of the MuJoCo that Gloam was built with. Properties that are not given are empty; setters
// return their element, so that they can be strung together; lengths of lists are checked when the
// document is. Units: m|rad is m or rad, after the joint or tendon; N|N m likewise.

#include <array>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/mjcf.h"

namespace gloam::mjcf {

"""


def camel(word):
    return "".join(part[:1].upper() + part[1:] for part in re.split(r"[_\W]+", word))


def class_names(paths):
    names = {}
    for path in paths:
        parts = path.split("/")[1:] or ["mujoco"]
        if len(parts) == 2 and parts[0] in ENDINGS:
            name = camel(parts[1]) + ENDINGS[parts[0]]
        elif len(parts) == 2 and parts[0] in SHORT:
            name = camel(parts[1])
        else:
            name = "".join(map(camel, parts))
        if name in names.values():
            name = "".join(map(camel, parts))
        if name in names.values():
            raise SystemExit(f"two elements would have the class {name}; one is {path}")
        names[path] = name
    return names


class Enums:
    """One enum for all attributes of one name and one list of keywords."""

    def __init__(self, elements, names):
        self.of, self.lists = {}, {}
        lists_of = {}
        for element in elements:
            for attribute in element["attributes"]:
                if self.is_enum(attribute):
                    lists_of.setdefault(attribute["name"], set()).add(tuple(attribute["keywords"]))
        for element in elements:
            for attribute in element["attributes"]:
                if not self.is_enum(attribute):
                    continue
                key = (attribute["name"], tuple(attribute["keywords"]))
                if key[1] in SHARED:
                    self.of[key] = SHARED[key[1]]
                    self.lists[self.of[key]] = key[1]
                if key not in self.of:
                    owner = "" if len(lists_of[key[0]]) == 1 else names[element["path"]].removeprefix("Default")
                    self.of[key] = owner + camel(key[0])
                    while self.of[key] in self.lists or self.of[key] in names.values():
                        self.of[key] += "Kind"
                    self.lists[self.of[key]] = key[1]

    @staticmethod
    def is_enum(attribute):
        return attribute["type"] == "kKeyword" and tuple(sorted(attribute["keywords"])) not in FLAGS

    def name(self, attribute):
        return self.of[(attribute["name"], tuple(attribute["keywords"]))]

    def text(self):
        for name, words in self.lists.items():
            values = ", ".join("k" + camel(word) for word in words)
            quoted = ", ".join(f'"{word}"' for word in words)
            yield f"enum class {name} {{ {values} }};\n"
            yield f"inline constexpr std::array<std::string_view, {len(words)}> words_of({name}) {{\n  return {{{quoted}}};\n}}\n"


def comment(attribute):
    notes = []
    if attribute["type"] in ("kInt", "kReal") and attribute["most"] != 1:
        least, most = attribute["least"], attribute["most"]
        notes.append("(n)" if most < 0 else f"({most})" if least == most else f"({least} … {most})")
    if attribute["unit"] and attribute["unit"] != "1":
        notes.append(f"[{attribute['unit']}]")
    if attribute["required"]:
        notes.append("required")
    if attribute["default"]:
        notes.append(f"default {attribute['default']}")
    if attribute["owner"]:
        notes.append(f"not of MJCF, of {attribute['owner']}: models in TOML only")
    text = ", ".join(notes)
    text = (text + ". " if text else "") + attribute["doc"]
    return "".join(f"  /// {line}\n" for line in textwrap.wrap(text, 96))


def properties(attribute, owner, enums):
    name = attribute["name"]
    function = RESERVED.get(name, name)
    quoted = f'"{name}"'
    many = attribute["most"] != 1
    setter = f"  {owner}& set_{name}"
    if attribute["type"] == "kString":
        yield f"  std::optional<std::string> {function}() const {{ return text_of({quoted}); }}\n"
        yield f"{setter}(std::string_view value) {{\n    put({quoted}, value);\n    return *this;\n  }}\n"
    elif attribute["type"] == "kKeyword" and enums.is_enum(attribute):
        enum = enums.name(attribute)
        if many:
            yield f"  std::vector<{enum}> {function}() const {{ return keywords_of<{enum}>({quoted}); }}\n"
            yield f"{setter}(std::initializer_list<{enum}> values) {{\n    put_keywords({quoted}, std::span(values));\n    return *this;\n  }}\n"
        else:
            yield f"  std::optional<{enum}> {function}() const {{ return keyword_of<{enum}>({quoted}); }}\n"
            yield f"{setter}({enum} value) {{\n    put_keywords({quoted}, std::span(&value, 1));\n    return *this;\n  }}\n"
    elif attribute["type"] == "kKeyword":
        yield f"  std::optional<bool> {function}() const {{ return flag_of({quoted}); }}\n"
        no, yes = sorted(attribute["keywords"])
        yield f'{setter}(bool value) {{\n    put({quoted}, value ? "{yes}" : "{no}");\n    return *this;\n  }}\n'
    else:
        kind, word = ("int", "int") if attribute["type"] == "kInt" else ("double", "real")
        if not many:
            yield f"  std::optional<{kind}> {function}() const {{ return {word}_of({quoted}); }}\n"
            yield f"{setter}({kind} value) {{\n    put({quoted}, std::span(&value, 1));\n    return *this;\n  }}\n"
            return
        yield f"  std::vector<{kind}> {function}() const {{ return {word}s_of({quoted}); }}\n"
        if attribute["least"] == attribute["most"]:
            yield f"{setter}(const std::array<{kind}, {attribute['most']}>& values) {{\n    put({quoted}, std::span(values));\n    return *this;\n  }}\n"
            return
        yield f"{setter}(std::span<const {kind}> values) {{\n    put({quoted}, values);\n    return *this;\n  }}\n"
        yield f"{setter}(std::initializer_list<{kind}> values) {{ return set_{name}(std::span(values)); }}\n"


def children_of(path, elements):
    """[(tag, path, may repeat)] of the elements allowed below."""
    holder = BODY if path in GROUPS else path
    below = []
    for element in elements:
        parent, _, name = element["path"].rpartition("/")
        if parent == holder:
            tag = "worldbody" if element["path"] == BODY else name
            once = element["times"] == "?" or parent == "mujoco" and element["path"] not in ("mujoco/default", "mujoco/include")
            below.append((tag, element["path"], not once))
        if element["path"] == holder and element["times"] == "R":
            below.append((name, element["path"], True))
    return below


def elements_header(elements):
    names = class_names([element["path"] for element in elements])
    enums = Enums(elements, names)
    out = [HEADER, *enums.text(), "\n"]
    out += [f"class {name};\n" for name in names.values()]
    bodies = []
    for element in elements:
        path, name = element["path"], names[element["path"]]
        own = path.rpartition("/")[2]
        out.append(f"\n/// <{own}>, in the grammar {path}.\nclass {name} : public Element {{\n public:\n"
                   f'  static constexpr std::string_view kPath = "{path}";\n'
                   f"  explicit {name}(Element element) : Element(std::move(element)) {{}}\n\n")
        for attribute in element["attributes"]:
            out.append(comment(attribute))
            out += properties(attribute, name, enums)
        for tag, below, repeats in children_of(path, elements):
            function = f"add_{tag}" if repeats else tag
            how = "add_known" if repeats else "find_or_add"
            out.append(f"  {names[below]} {function}();\n")
            bodies.append(f'inline {names[below]} {name}::{function}() {{ return {names[below]}({how}("{tag}")); }}\n')
        out.append("};\n")
    return "".join(out + ["\n"] + bodies + ["\n}  // namespace gloam::mjcf\n"])
