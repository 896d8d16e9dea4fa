#!/usr/bin/env python3
"""Writes the C++ structs of ROS messages: a header for each package of interface definitions, and all_messages.h.

  generate_messages.py --definitions FOLDER --out FOLDER

Headers that would not change are not written, so that a new message compiles only the files that include its package. Other
headers in the output folder are removed.
"""

import argparse
import json
import sys
from itertools import groupby
from pathlib import Path

from definitions import FLOATS, INTEGERS, DefinitionError
from packages import declaration_order, needed_packages, package_order, read_packages

CPP_TYPES = {name: f"{name}_t" for name in INTEGERS} | {"char": "char", "byte": "std::byte", "float32": "float", "float64": "double",
                                                      "bool": "bool", "string": "std::string"}
MADE = "// Made by generate_messages.py, do not edit."


def cpp_name(namespace, kind, *name):
    """The namespace of a package's messages of a kind, or a message in it."""
    return "::".join([namespace, *([] if kind == "msg" else [kind]), *name])


def cpp_type(part):
    """The type of a field; message.h describes these types."""
    kind = part.type
    if part.target:
        element = cpp_name(part.target.namespace, part.target.kind, part.target.name)
    elif kind.bound:
        element = f"BoundedString<{kind.bound}>"
    else:
        element = CPP_TYPES[kind.element]
    if not kind.array:
        return element
    if kind.array == "[]":
        return {"uint8": "Bytes", "bool": "Bools"}.get(kind.element, f"std::vector<{element}>")
    return f"{'BoundedVector' if kind.array.startswith('[<=') else 'std::array'}<{element}, {kind.size}>"


def cpp_string(text):
    return json.dumps(text, ensure_ascii=False)


def cpp_value(element, value):
    if isinstance(value, list):
        return "{" + ", ".join(cpp_value(element, one) for one in value) + "}"
    if element == "string":
        return cpp_string(value)
    if element == "bool":
        return str(value).lower()
    if element in FLOATS:
        return repr(value) + ("f" if element == "float32" else "")
    if element == "byte":
        return f"std::byte{{{value}}}"
    if element == "char":
        return f"static_cast<char>({value})"
    if value == -(2**63):
        return "INT64_MIN"
    return f"{value}{'u' if element[0] == 'u' else ''}{'ll' if element.endswith('64') else ''}"


def initializer(part):
    kind = part.type
    if part.value is not None:
        value = cpp_value(kind.element, part.value)
        return f" = std::vector<uint8_t>{value}" if kind.element == "uint8" and kind.array == "[]" else f" = {value}"
    if kind.size and not kind.array.startswith("[<="):
        return " = {}"
    if kind.array or part.target or kind.element == "string":
        return ""
    return {"bool": " = false", "byte": " = {}"}.get(kind.element, " = 0")


def member_lines(code, docs):
    """A member with its comments: one stands beside it, several above."""
    if len(docs) == 1:
        return [f"  {code}  ///< {docs[0]}"]
    return [*(f"  /// {text}" for text in docs), f"  {code}"]


def constant_lines(constant):
    cpp = "std::string_view" if constant.type == "string" else CPP_TYPES[constant.type]
    return member_lines(f"static constexpr {cpp} {constant.name} = {cpp_value(constant.type, constant.value)};", constant.docs)


def text_table(name, cpp, rows):
    """A member with texts of the definition, from which type_description.h describes the struct."""
    if not rows:
        return []
    return [f"  static constexpr {cpp} {name}[] = {{", *("      {" + ", ".join(map(cpp_string, row)) + "}," for row in rows), "  };"]


def struct_lines(message):
    lines = [*(f"/// {text}" for text in message.docs), f"struct {message.name} {{"]
    for constant in message.constants:
        lines += constant_lines(constant)
    for part in message.fields:
        lines += member_lines(f"{cpp_type(part)} {part.name}{initializer(part)};", part.docs)
    lines += text_table("kConstants", "ConstantText", [(constant.type, constant.name, constant.text) for constant in message.constants])
    lines += text_table("kDefaults", "DefaultText", [(part.name, part.default) for part in message.fields if part.default])
    return [*lines, f"  GLOAM_MESSAGE({', '.join([message.name, *(part.name for part in message.fields)])})", "};", ""]


def package_header(package):
    lines = [MADE, "#pragma once", "", '#include "ros/message.h"',
             *(f'#include "ros/messages/{name}.h"' for name in sorted(needed_packages(package))), ""]
    for kind, keys in groupby(declaration_order(package), lambda key: key[0]):
        scope = f"gloam::{cpp_name(package.namespace, kind)}"
        lines += [f"namespace {scope} {{", "", f'inline constexpr std::string_view kPackage = "{package.ros_name}/{kind}";', ""]
        for key in keys:
            lines += struct_lines(package.messages[key])
        lines += [f"}}  // namespace {scope}", ""]
    return "\n".join(lines)


def list_header(packages):
    """all_messages.h: older versions are left out, because their messages have the names of the current ones."""
    names = [cpp_name(package.namespace, kind, name) for package in packages for kind, name in declaration_order(package)]
    return "\n".join([MADE, "#pragma once", "", '#include "ros/message.h"',
                      *(f'#include "ros/messages/{package.namespace}.h"' for package in packages), "", "namespace gloam {", "",
                      "using AllMessages = MessageList<", ",\n".join(f"    {name}" for name in names) + ">;", "",
                      "}  // namespace gloam", ""])


def headers_of(folder):
    """{file name: text} of all headers."""
    packages = read_packages(folder)
    ordered = [packages[name] for name in package_order(packages)]
    headers = {f"{package.namespace}.h": package_header(package) for package in ordered}
    return headers | {"all_messages.h": list_header([package for package in ordered if package.is_current])}


def write_headers(headers, out):
    out.mkdir(parents=True, exist_ok=True)
    for file in out.glob("*.h"):
        if file.name not in headers:
            file.unlink()
    for name, text in headers.items():
        file = out / name
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--definitions", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    args = parser.parse_args()
    try:
        write_headers(headers_of(args.definitions), args.out)
    except DefinitionError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
