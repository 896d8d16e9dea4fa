"""Figures of the code base: `python3 tests/house.py` prints files by folder, long files and functions, and phrases to avoid.

`python3 tests/house.py --phrases [TEXT]` lists each of these phrases with its line, in files with TEXT in their names.
tests/language_rule.py limits their number.
"""
import ast
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CODE = {".h", ".cc", ".cu", ".cuh"}
BEGIN = re.compile(r"^(?:template <.*>\s*)?[A-Za-z_][^;{}]*\)[^;{}]*\{$|^[A-Za-z_].*\) (?:const |override |noexcept )*\{$")

# Readers stumble over noun clauses that replace a noun, machines that speak, and words out of use.
PHRASES = {
    "noun clause": re.compile(r"\bwhat\b(?![^.|]*\?)|\bthat which\b|\b(?:of|than|as|by|with|for|from|to|in|on) those\b(?= of\b| that\b| who| which\b|[.,;:)])"
                              r"|\bthose (?:of|that|who|whose|which)\b|\bwho(?:m?ever|so)\b|\bwhatever\b", re.I),
    "machine that speaks": re.compile(r"\b(?:say|says|said|saying|tell|tells|told|telling|hear|hears|heard|hearing|obey|obeys|obeyed|obeying"
                                      r"|refuse|refuses|refused|refusing|complains?|complained)\b", re.I),
    "out of use": re.compile(r"\banew\b|\blest\b|\bwhose like\b|\b(?:go|goes|gone|going|went) on (?:from|with|in|at)\b|\bto the bit\b|\btheir kin\b"
                             r"|\bthereof\b|\bwhereto\b|\bbut for\b", re.I),
}


def sources():
    listed = subprocess.run(["git", "ls-files", "src", "include", "apps"], cwd=ROOT, capture_output=True, text=True).stdout.split()
    return [ROOT / name for name in listed if Path(name).suffix in CODE]


def functions(lines):
    """First line, number of lines and name of each function at the top level of a file."""
    start = None
    for i, line in enumerate(lines):
        if start is None and line.endswith("{") and not line.startswith((" ", "namespace", "struct", "class", "enum", "}", "#", "union")):
            start = i
        elif start is not None and line.startswith("}"):
            head = start
            while head > 0 and lines[head - 1] and not lines[head - 1].startswith(("}", "/", "#", " ")) and not lines[head].lstrip().startswith("template"):
                head -= 1
            yield head + 1, i - start + 1, lines[start].split("(")[0].split()[-1] if "(" in lines[start] else lines[start]
            start = None


def documented():
    """Files whose words users read: README.md, docs/, public headers, the Python package, sources for their messages."""
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "README.md", "docs/*.md", "include/*.h", "python/gloam/*.py"],
                            cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
    speaking = [str(path.relative_to(ROOT)) for path in sources() if path.suffix == ".cc" and not re.search(r"/(?:test|fuzz)/", str(path))]
    return [ROOT / name for name in sorted(listed + speaking) if (ROOT / name).exists()]


def prose(path):
    """Numbered lines of a file's prose: documents without code but with its comments, comments of headers, docstrings of Python, and the
    texts of two words and more in sources, which are messages."""
    lines, kept = path.read_text().splitlines(), []
    if path.suffix == ".py":
        nodes = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)]
        strings = [node.body[0].value for node in nodes if ast.get_docstring(node)]
        kept = [(number, lines[number - 1]) for string in strings for number in range(string.lineno, string.end_lineno + 1)]
    elif path.suffix == ".h":
        kept = [(number, found.group(1)) for number, line in enumerate(lines, 1) if (found := re.search(r"(?<!:)//+<?(.*)$", line))]
    elif path.suffix == ".cc":
        for number, line in enumerate(lines, 1):
            if not line.lstrip().startswith(("//", "#include")):
                kept += [(number, text) for text in re.findall(r'"((?:[^"\\]|\\.)*)"', line) if " " in text.strip()]
        return kept
    else:
        in_code = False
        for number, line in enumerate(lines, 1):
            if line.lstrip().startswith("```"):
                in_code = not in_code
            elif not in_code:
                kept.append((number, line))
            elif found := re.search(r"(?:^|\s)(?:#|//) (.*)$", line):
                kept.append((number, found.group(1)))
    return [(number, re.sub(r"`[^`]*`|\"[^\"]*\"|\]\([^)]*\)", "`", line)) for number, line in sorted(kept)]


def phrases(path):
    """Kind, line and text of each phrase to avoid; one may run over the end of a line."""
    lines = prose(path)
    text = "\n".join(re.sub(r"^\s*", "", line) for _, line in lines)
    for kind, pattern in PHRASES.items():
        flowing = re.sub(r"\n", " ", text)
        for found in pattern.finditer(flowing):
            yield kind, lines[text.count("\n", 0, found.start())][0], found.group(0)


def phrase_counts():
    """Number of phrases to avoid by file, of files that have any."""
    return Counter({str(path.relative_to(ROOT)): n for path in documented() if (n := sum(1 for _ in phrases(path)))})


def list_phrases(text):
    for path in documented():
        name = str(path.relative_to(ROOT))
        if text in name:
            for kind, line, words in sorted(phrases(path), key=lambda found: found[1]):
                print(f"{name}:{line}: {kind}: {words}")


def main():
    if sys.argv[1:2] == ["--phrases"]:
        list_phrases("".join(sys.argv[2:3]))
        return
    counts = phrase_counts()
    print(f"phrases to avoid in README.md, docs/, public headers, Python docstrings and messages: {sum(counts.values())}")
    for name, n in counts.most_common():
        print(f"  {n} {name}")
    folders, long_files, long_functions, comments = Counter(), [], [], Counter()
    for path in sources():
        name = str(path.relative_to(ROOT))
        is_test = "/test/" in name or "/fuzz/" in name
        if not is_test:
            folders[str(path.parent.relative_to(ROOT))] += 1
        lines = path.read_text().splitlines()
        for word in re.findall(r"(?://|///|///<) (Of|What) ", "\n".join(lines)):
            comments[word] += not is_test
        if is_test:
            continue
        if len(lines) > (150 if path.suffix == ".h" else 250):
            long_files.append((len(lines), name))
        long_functions += [(n, f"{name}:{at} {what}") for at, n, what in functions(lines) if n > 60]
    print("folders of most files:", ", ".join(f"{n} {f}" for f, n in folders.most_common(6)))
    print(f"comments that begin with Of: {comments['Of']}, with What: {comments['What']}")
    print(f"files over 250 lines (headers 150): {len(long_files)}; longest:")
    for n, name in sorted(long_files, reverse=True)[:12]:
        print(f"  {n} {name}")
    over = [f for f in long_functions if f[0] > 100]
    print(f"functions over 60 lines: {len(long_functions)}, over 100: {len(over)}")
    for n, name in sorted(over, reverse=True):
        print(f"  {n} {name}")


if __name__ == "__main__":
    main()
