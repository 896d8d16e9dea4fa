"""C++ reference: a page per public header, made of its declarations and their comments.

The headers follow one layout (clang-format; `///` above a declaration, `///<` behind it, `//` for the file and for remarks), which
is all that `parse` relies on.
"""
import re
from dataclasses import dataclass, field

TYPE = re.compile(r"^(?:template <.*?>\s*)?(?:struct|class|union|enum class|enum)\s+(?:\[\[\w+\]\]\s+)?(\w+)[^;()]*\{")
NAMES = [r"^#define (\w+)", r"^using (?:enum )?(\w+)", r"^[^(]*\bconstexpr [^(]*?(\w+) = ", r"(operator[^\w\s(]+|~?\w+)\(",
         r"(\w+)(?: = |\[|;|$)"]
ACCESS = re.compile(r"^(public|protected|private):$")
SKIPPED = re.compile(r"^(#(include|pragma|if|endif)|namespace|\}  // namespace|(struct|class) \w+;)")


@dataclass
class Declaration:
    """A declaration with its comment; a remark between declarations has no code."""
    code: str = ""
    text: str = ""
    members: list = field(default_factory=list)

    @property
    def type_name(self):
        found = TYPE.match(self.code + " {") if self.code.split(" ")[0] in ("template", "struct", "class", "union", "enum") else None
        return found.group(1) if found else None

    @property
    def name(self):
        """Of the type, function, alias, constant or macro that it declares."""
        if self.type_name:
            return self.type_name
        code = re.sub(r"^template <.*?>\n?\s*", "", self.code, flags=re.S)
        for pattern in NAMES:
            if found := re.search(pattern, code):
                return found.group(1)
        return code.split("\n")[0]


def without_comment(line):
    return re.sub(r"\s*//.*$", "", line)


def trailing_comment(line):
    found = re.search(r"///< ?(.*)$", line)
    return found.group(1) if found else ""


def depth(text):
    """Open braces, brackets and parentheses, but none in string literals."""
    text = re.sub(r'"(\\.|[^"\\])*"|\'(\\.|[^\'\\])\'', "", text)
    return sum(text.count(c) for c in "({[") - sum(text.count(c) for c in ")}]")


def is_complete(code):
    return depth(code) == 0 and bool(re.search(r"[;}]$", code)) and not re.match(r"^template <[^>]*>$", code)


def signature(code):
    """The declaration without a function's body, and without the value of a long constant."""
    if code.startswith("#define"):
        return code.split(")")[0] + ")" if "(" in code.split("\n")[0] else code.split("\n")[0]
    at, level = 0, 0
    for at, c in enumerate(code):
        if c == "{" and level == 0 and "(" in code[:at] and not code[:at].rstrip().endswith(("=", "return")):
            head = re.sub(r"\)\s*:\s[^:].*$", ")", code[:at].rstrip(), flags=re.S)
            return head + ";"
        level += (c in "(") - (c in ")")
    if code.count("\n") > 6 and " = " in code:
        return code.split(" = ")[0] + ";"
    return code


class Parser:
    def __init__(self, lines):
        self.lines, self.at, self.found, self.text, self.hidden = lines, 0, [], [], False

    def run(self):
        while self.at < len(self.lines):
            self.step(self.lines[self.at].strip())
        return self.found

    def step(self, line):
        if access := ACCESS.match(line):
            self.hidden = access.group(1) == "private"
        elif line.startswith("///"):
            self.text.append(line[3:].strip())
        elif line.startswith("//"):
            return self.remark()
        elif line and not SKIPPED.match(line):
            return self.declaration()
        elif not line:
            self.text = []
        self.at += 1

    def remark(self):
        text = []
        while self.at < len(self.lines) and re.match(r"^\s*//($|[^/])", self.lines[self.at]):
            text.append(self.lines[self.at].strip()[2:].strip())
            self.at += 1
        if not self.hidden and not text[0].startswith("NOLINT"):
            self.found.append(Declaration(text="\n".join(text)))

    def declaration(self):
        first, code, text = self.at, "", self.text
        is_macro = self.lines[first].startswith("#define")
        while self.at < len(self.lines):
            line = self.lines[self.at]
            code = (code + "\n" + without_comment(line).rstrip("\\").rstrip()).strip("\n")
            text = [*text, trailing_comment(line)] if trailing_comment(line) and not TYPE.match(code.strip()) else text
            self.at += 1
            if (is_macro and not line.endswith("\\")) or (not is_macro and is_complete(code.strip())):
                break
        while self.at < len(self.lines) and self.lines[self.at].strip().startswith("///<"):
            text = [*text, trailing_comment(self.lines[self.at])]
            self.at += 1
        self.text = []
        is_detail = code.lstrip().startswith("static_assert") or (is_macro and not text)
        if not self.hidden and not is_detail:
            self.found.append(self.made_of(code, [line for line in text if line], first))

    def made_of(self, code, text, first):
        margin = len(code) - len(code.lstrip())
        code = "\n".join(line[margin:] for line in code.splitlines())
        if TYPE.match(code.replace("\n", " ")) and "\n" in code:
            head, body = code.split("{", 1)[0].strip(), self.lines[first + code.split("{", 1)[0].count("\n") + 1:self.at - 1]
            is_enum = re.match(r"enum", head)
            members = enumerators(body) if is_enum else Parser(["private:" if head.startswith("class") else "", *body]).run()
            return Declaration(head, "\n".join(self_text(text, body)), members)
        return Declaration(signature(code), "\n".join(text))


def self_text(text, body):
    """The comment above a type, without trailing comments of its members."""
    inner = {trailing_comment(line) for line in body}
    return [line for line in text if line not in inner]


def enumerators(body):
    found, text = [], []
    for line in (line.strip() for line in body):
        if line.startswith("///<") and found:
            found[-1].text += "\n" + trailing_comment(line)
        elif line.startswith("///"):
            text.append(line[3:].strip())
        elif line.startswith("//"):
            found.append(Declaration(text=line[2:].strip()))
        elif line:
            found.append(Declaration(without_comment(line).rstrip(","), "\n".join([*text, *filter(None, [trailing_comment(line)])])))
            text = []
    return found


def parse(source):
    """Introduction and declarations of a header."""
    lines = source.splitlines()
    declarations = Parser(lines).run()
    introduction = declarations.pop(0).text if declarations and not declarations[0].code else ""
    return introduction, declarations
