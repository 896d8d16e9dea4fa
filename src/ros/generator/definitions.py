"""Reads interface definitions of ROS 2: .msg, .srv and .action files.

A line is `TYPE NAME`, `TYPE NAME DEFAULT` or `TYPE NAME=VALUE`, and '#' begins a comment. Comments at the top of a message
describe the message; all others describe the field or constant beside or below them.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

INTEGERS = {f"{sign}int{bits}": (0, 2**bits - 1) if sign else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
            for sign in ("", "u") for bits in (8, 16, 32, 64)} | {"char": (0, 255), "byte": (0, 255)}
FLOATS = {"float32": 3.4028234663852886e38, "float64": 1.7976931348623157e308}  # with the largest value
PRIMITIVES = {*INTEGERS, *FLOATS, "bool", "string"}
UNSUPPORTED = {"wstring", "wchar", "float128", "time", "duration"}
MOST_ELEMENTS = 2**32 - 1
# Parts of a file: suffixes of the names of its messages.
PARTS = {"msg": [""], "srv": ["_Request", "_Response"], "action": ["_Goal", "_Result", "_Feedback"]}
MESSAGE_NAME, FIELD_NAME = re.compile(r"[A-Z][A-Za-z0-9]*"), re.compile(r"[a-z](_?[a-z0-9]+)*")
CONSTANT_NAME, PACKAGE_NAME = re.compile(r"[A-Z](_?[A-Z0-9]+)*"), re.compile(r"[a-z](_?[a-z0-9]+)*")
# Names that a C++ struct cannot have as members; GLOAM_MESSAGE (message.h) defines members().
RESERVED = set("""alignas alignof and and_eq asm auto bitand bitor bool break case catch char class compl concept const consteval
    constexpr constinit continue co_await co_return co_yield decltype default delete do double else enum explicit export extern
    false float for friend goto if inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private
    protected public register requires return short signed sizeof static struct switch template this throw true try typedef
    typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq members""".split())


class DefinitionError(Exception):
    """A fault in a file, at a line; line 0 = in the file as a whole."""

    def __init__(self, path, line, message):
        super().__init__(f"{path}:{line}: error: {message}" if line else f"{path}: error: {message}")


@dataclass
class Type:
    element: str  # a primitive, "Name" or "package/Name"
    bound: int = 0  # most characters of a string; 0 = any number
    array: str = ""  # "", "[]", "[N]" or "[<=N]"
    size: int = 0  # N


@dataclass
class Field:
    type: Type
    name: str
    line: int
    default: str = ""  # as in the file
    value: object = None  # the default's: a bool, int, float, str or a list of these
    docs: list = field(default_factory=list)
    target: object = None  # the message that it refers to, from packages.py


@dataclass
class Constant:
    type: str
    name: str
    text: str  # as in the file
    value: object
    docs: list = field(default_factory=list)


@dataclass
class Message:
    name: str  # "SetBool_Request"
    path: Path
    fields: list = field(default_factory=list)
    constants: list = field(default_factory=list)
    docs: list = field(default_factory=list)


def read_definition(path):
    """The messages of a file: one of a .msg file, two of a .srv file, three of an .action file."""
    path = Path(path)
    suffixes = PARTS[path.suffix[1:]]
    if not MESSAGE_NAME.fullmatch(path.stem):
        raise DefinitionError(path, 0, f"'{path.stem}' is not the name of an interface: expected CamelCase")
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError as error:
        raise DefinitionError(path, 0, "the file is not UTF-8") from error
    parts = [[]]
    for number, line in enumerate(lines, 1):
        if line.strip() != "---":
            parts[-1].append((number, line.strip()))
        elif len(parts) < len(suffixes):
            parts.append([])
        else:
            raise DefinitionError(path, number, f"too many lines '---': a {path.suffix} file has {len(suffixes)} parts")
    if len(parts) < len(suffixes):
        raise DefinitionError(path, len(lines), f"a line '---' is missing: a {path.suffix} file has {len(suffixes)} parts")
    return [PartReader(Message(path.stem + suffix, path)).read(part) for suffix, part in zip(suffixes, parts)]


class PartReader:
    """Reads the lines of one message."""

    def __init__(self, message):
        self.message, self.line, self.docs = message, 0, []

    def error(self, text):
        return DefinitionError(self.message.path, self.line, text)

    def read(self, lines):
        has_started = False
        for self.line, text in lines:
            if text.startswith("#"):
                (self.docs if has_started else self.message.docs).append(text[1:].strip())
            elif text:
                self.read_member(text)
                has_started, self.docs = True, []
            else:
                has_started, self.docs = has_started or bool(self.message.docs), []
        return self.message

    def read_member(self, text):
        found = re.fullmatch(r"(\S+)\s+([^\s=#]+)\s*(.*)", text)
        if not found:
            raise self.error(f"'{text}' is neither a field nor a constant: expected a type and a name")
        type_text, name, rest = found.groups()
        kind = self.read_type(type_text)
        is_constant = rest.startswith("=")
        value, comment = self.split_comment(rest[1:].strip() if is_constant else rest, kind.element == "string")
        docs = self.docs + ([comment] if comment else [])
        if name in [member.name for member in self.message.fields + self.message.constants]:
            raise self.error(f"'{name}' is defined twice")
        if is_constant:
            self.message.constants.append(self.constant(kind, type_text, name, value, docs))
        else:
            self.message.fields.append(self.field(kind, name, value, docs))

    def split_comment(self, text, is_string):
        """The value and the comment behind it. A '#' in quotes belongs to a string."""
        if not is_string:
            value, _, comment = text.partition("#")
        elif found := re.fullmatch(r"""((?:[^#"']|"[^"]*"|'[^']*')*)(?:#(.*))?""", text):
            value, comment = found.group(1), found.group(2) or ""
        else:
            raise self.error(f"a quote is not closed: {text}")
        return value.strip(), comment.strip()

    def constant(self, kind, type_text, name, text, docs):
        if kind.element not in PRIMITIVES or kind.array or kind.bound:
            raise self.error(f"constant '{name}' has type {type_text}: expected a primitive type without bounds")
        if not CONSTANT_NAME.fullmatch(name):
            raise self.error(f"'{name}' is not the name of a constant: expected capital letters, digits and underscores")
        return Constant(kind.element, name, text, self.read_value(kind, text), docs)

    def field(self, kind, name, text, docs):
        if not FIELD_NAME.fullmatch(name):
            raise self.error(f"'{name}' is not the name of a field: expected lower-case letters, digits and underscores")
        if name in RESERVED:
            raise self.error(f"a field cannot be called '{name}': C++ reserves the name")
        return Field(kind, name, self.line, text, self.read_default(kind, text) if text else None, docs)

    def read_type(self, text):
        found = re.fullmatch(r"([^\[\]<>=]+)(?:<=([^\[\]]*))?(\[(<=)?([^\[\]]*)\])?", text)
        if not found:
            raise self.error(f"'{text}' is not a type")
        element, bound, array, is_bounded, size = found.groups()
        if bound is not None and element != "string":
            raise self.error(f"'{text}' is not a type: only strings have a bound")
        if element in UNSUPPORTED:
            raise self.error(f"type {element} is not supported")
        kind = Type(element, self.read_size(bound) if bound is not None else 0, array or "")
        if array and array != "[]":
            kind.size = self.read_size(size)
        if is_bounded and element == "bool":
            raise self.error("bounded sequences of bool are not supported: use bool[] or bool[N]")
        names = element.split("/")
        if element not in PRIMITIVES and not (MESSAGE_NAME.fullmatch(names[-1]) and all(map(PACKAGE_NAME.fullmatch, names[:-1]))
                                              and len(names) <= 3 and names[1:-1] in ([], ["msg"])):
            raise self.error(f"'{element}' is not a type: expected a primitive type, Name or package/Name")
        return kind

    def read_size(self, text):
        if not re.fullmatch(r"[0-9]+", text) or not 1 <= int(text) <= MOST_ELEMENTS:
            raise self.error(f"'{text}' is not a size: expected 1 to {MOST_ELEMENTS}")
        return int(text)

    def read_default(self, kind, text):
        if kind.element not in PRIMITIVES:
            raise self.error(f"a field of type {kind.element} cannot have a default value")
        if not kind.array:
            return self.read_value(kind, text)
        if not re.fullmatch(r"\[.*\]", text):
            raise self.error(f"{text} is not a list such as [1, 2]")
        items = [item.strip() for item in re.findall(r"""(?:[^,"']|"[^"]*"|'[^']*')+""", text[1:-1]) if item.strip()]
        if kind.size and (len(items) > kind.size if kind.array.startswith("[<=") else len(items) != kind.size):
            raise self.error(f"{text} has {len(items)} elements, its type {kind.array}")
        return [self.read_value(kind, item) for item in items]

    def read_value(self, kind, text):
        """The value of a primitive type; its bound applies."""
        if kind.element == "string":
            if text[:1] in ("'", '"') and text.find(text[0], 1) != len(text) - 1:
                raise self.error(f"{text} is not a string: the quotes must enclose all of it")
            value = text[1:-1] if text[:1] in ("'", '"') else text
            if "\\" in value or len(value.encode()) > (kind.bound or MOST_ELEMENTS):
                raise self.error(f"{text} has escapes, which are not supported" if "\\" in value
                                 else f"{text} has more than {kind.bound} characters")
            return value
        if kind.element == "bool" and text in ("true", "True", "1", "false", "False", "0"):
            return text in ("true", "True", "1")
        if kind.element in INTEGERS and re.fullmatch(r"[+-]?[0-9]+", text):
            low, high = INTEGERS[kind.element]
            if low <= int(text) <= high:
                return int(text)
            raise self.error(f"{text} is out of range: {kind.element} has {low} to {high}")
        if kind.element in FLOATS and re.fullmatch(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?", text):
            if abs(float(text)) <= FLOATS[kind.element]:
                return float(text)
            raise self.error(f"{text} is out of range of {kind.element}")
        raise self.error(f"'{text}' is not a value of type {kind.element}")
