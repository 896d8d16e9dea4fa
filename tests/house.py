"""Figures of the house: `python3 tests/house.py` prints files by folder, long files and functions, and comments without a noun."""
import re
import subprocess
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CODE = {".h", ".cc", ".cu", ".cuh"}
BEGIN = re.compile(r"^(?:template <.*>\s*)?[A-Za-z_][^;{}]*\)[^;{}]*\{$|^[A-Za-z_].*\) (?:const |override |noexcept )*\{$")


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


def main():
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
