#!/usr/bin/env python3
"""Writes option_texts.inc: the description of each option in the public headers, for the JSON Schema of scene files.

  option_texts.py --out option_texts.inc HEADER...

For every struct of the headers: struct_text(), the comment above it, and visit_texts(), which goes through the
members with the comment above or behind each.
"""

import argparse
import json
import re
from pathlib import Path


def members_of(body):
    """[(name, text)] of a struct's data members."""
    members, above, statement, last = [], [], "", []
    for line in body.splitlines():
        code, slashes, comment = line.partition("//")
        is_doc = slashes and comment.startswith("/")
        text = comment.removeprefix("/").removeprefix("<").strip() if is_doc else ""
        if not code.strip():
            if is_doc and comment.startswith("/<"):
                for member in last:
                    member[1] += " " + text
            elif is_doc:
                above.append(text)
            elif not slashes:
                above = []
            continue
        statement += code
        if not statement.rstrip().endswith((";", "}")) or statement.count("{") != statement.count("}"):
            continue
        plain = re.sub(r'"[^"]*"', "", statement)
        while (shorter := re.sub(r"<[^<>]*>|\{[^{}]*\}", "", plain)) != plain:
            plain = shorter
        last = []
        if "(" not in plain:
            for part in plain.strip().rstrip(";").split(","):
                last.append([part.partition("=")[0].split()[-1], " ".join([*above, text]).strip()])
        members += last
        above, statement = [], ""
    return members


def structs_of(text):
    """[(name, base, text, members)]"""
    pattern = re.compile(r"((?:^///[^\n]*\n)*)^struct (\w+)(?: : (\w+))? \{\n(.*?)^\};", re.M | re.S)
    for docs, name, base, body in pattern.findall(text):
        yield name, base, " ".join(line.removeprefix("///").strip() for line in docs.splitlines()), members_of(body)


def quoted(text):
    return json.dumps(text, ensure_ascii=False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("headers", type=Path, nargs="+")
    args = parser.parse_args()
    lines = ["// Made by option_texts.py."]
    for header in args.headers:
        for name, base, text, members in structs_of(header.read_text(encoding="utf-8")):
            lines.append(f"inline std::string_view struct_text(const {name}&) {{ return {quoted(text)}; }}")
            lines.append(f"template <class F>\nvoid visit_texts(F& f, const {name}& o) {{")
            if base:
                lines.append(f"  visit_texts(f, static_cast<const {base}&>(o));")
            lines += [f"  f(o.{member}, {quoted(said)});" for member, said in members]
            lines.append("}")
    args.out.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
