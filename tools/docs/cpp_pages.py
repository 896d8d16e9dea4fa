"""Writes the parsed headers (headers.py) as pages of Markdown and HTML."""
import html
import re

from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import CppLexer

import headers

TO_DOCS = {1: "../../docs/", 2: "../../../docs/"}  # from api/cpp/ and from its folders


def prose(text, to_docs):
    """A comment as HTML: paragraphs, `code`, and links to pages of docs/."""
    text = html.escape(text, quote=False)
    text = re.sub(r"`([^`]+)`", r"<code>\1</code>", text)
    text = re.sub(r"\bdocs/(\w+)\.md\b", rf'<a href="{to_docs}\1.html">docs/\1.md</a>', text)
    return "".join(f"<p>{part.strip()}</p>" for part in re.split(r"\n\s*\n", text) if part.strip())


class Pages:
    def __init__(self, include):
        self.include = include
        self.parsed = {path.relative_to(include).as_posix(): headers.parse(path.read_text())
                       for path in sorted(include.rglob("*.h"), key=lambda path: (path.parent, path.name))}
        self.types = {}
        for name, (_, declarations) in self.parsed.items():
            for declaration in declarations:
                if declaration.type_name:
                    self.types.setdefault(declaration.type_name, (name, declaration.type_name.lower()))

    @staticmethod
    def page_of(header):
        return header.removeprefix("gloam/").removesuffix(".h")

    def code(self, text, header):
        """Highlighted code on one page, in which names of public types lead to their pages."""
        up = "../" * self.page_of(header).count("/")

        def link(match):
            name = match.group(2)
            if name not in self.types:
                return match.group(0)
            page, anchor = self.types[name]
            return f'{match.group(1)}<a href="{up}{self.page_of(page)}.html#{anchor}">{name}</a></span>'
        spans = highlight(text, CppLexer(stripall=True), HtmlFormatter(nowrap=True)).strip()
        return re.sub(r'(<span class="n[a-z]*">)(\w+)</span>', link, spans)

    def members(self, declarations, header):
        """A list of definitions: code, then its comment."""
        to_docs, parts = TO_DOCS[header.count("/")], []
        for declaration in declarations:
            if not declaration.code:
                parts.append(f'<dd class="remark">{prose(declaration.text, to_docs)}</dd>')
                continue
            one_line = re.sub(r"\n\s*", " ", declaration.code)
            parts.append(f'<dt><code class="highlight">{self.code(one_line, header)}</code></dt>')
            inner = self.members(declaration.members, header) if declaration.members else ""
            if declaration.text or inner:
                parts.append(f"<dd>{prose(declaration.text, to_docs)}{inner}</dd>")
        return f'<dl class="members">{"".join(parts)}</dl>'

    def text(self, header):
        introduction, declarations = self.parsed[header]
        to_docs, parts, last = TO_DOCS[header.count("/")], [], None
        for declaration in declarations:
            if not declaration.code:
                parts.append(prose(declaration.text, to_docs))
                continue
            name = declaration.name
            if name != last:  # overloads share a heading
                anchor = name.lower() if name.isidentifier() else "operators"
                parts.append(f"## `{name}` {{ #{anchor} }}")
            last = name
            code = f'<pre class="highlight"><code>{self.code(declaration.code, header)}</code></pre>'
            parts.append(code + "\n" + prose(declaration.text, to_docs)
                         + (self.members(declaration.members, header) if declaration.members else ""))
        return f'# {header}\n\n{prose(introduction, to_docs)}\n\n' + "\n\n".join(parts) + "\n"

    def write(self, folder):
        """Writes all pages and an index; returns them for the navigation."""
        rows, nav, folders = [], [], {}
        for header, (introduction, _) in self.parsed.items():
            page = folder / f"{self.page_of(header)}.md"
            page.parent.mkdir(parents=True, exist_ok=True)
            page.write_text(self.text(header))
            first = re.split(r"(?<=\.)\s", introduction.replace("\n", " "), maxsplit=1)[0]
            rows.append(f"* [{header}]({self.page_of(header)}.md): {html.escape(first, quote=False)}")
            entry = {header.split("/")[-1]: f"api/cpp/{self.page_of(header)}.md"}
            *_, parent, _ = header.split("/")
            (nav if parent == "gloam" else folders.setdefault(f"{parent}/", [])).append(entry)
        (folder / "README.md").write_text("# C++ reference\n\nThe public headers. [docs/library.md](../../docs/library.md) is the guide.\n\n"
                                          + "\n".join(rows) + "\n")
        return [*nav, *({name: entries} for name, entries in folders.items())]
