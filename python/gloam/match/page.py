"""Pages from templates."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gloam


def render_template(file: Path, **values: Any) -> str:
    """The HTML of a template; all values are escaped unless the template marks them as safe. Errors: gloam.UnsupportedError."""
    try:
        import jinja2
    except ImportError as error:
        raise gloam.UnsupportedError("gloam match needs the package Jinja2", hint="pip install 'gloam[match]'") from error
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    return str(environment.from_string(file.read_text(encoding="utf-8")).render(**values))
