"""Reads the page of a navigation benchmark, and compares its figures with those of navigation_recompute.py."""

import re
from html.parser import HTMLParser

DIGITS = {"time": 1, "wall": 1, "cpu": 1}  # that the page prints; 2 of all other figures


class Page(HTMLParser):
    """Numbers of cells by (cell, metric), addresses, and tags of a report."""

    def __init__(self, text):
        super().__init__()
        self.figures, self.addresses, self.tags = {}, [], set()
        self._cell = None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.tags.add(tag)
        self.addresses += [value for name, value in attributes if name in ("href", "src", "poster") and value]
        if tag == "td":
            self._cell = (values["data-cell"], values["data-metric"]) if "data-cell" in values else None

    def handle_endtag(self, tag):
        if tag == "td":
            self._cell = None

    def handle_data(self, data):
        if self._cell:
            self.figures[self._cell] = self.figures.get(self._cell, "") + data + " "


def differences(text, figures):
    """Sentences about figures of the page that differ from the recomputed ones, or are missing."""
    printed, wrong = Page(text).figures, []
    for cell, values in figures.items():
        for metric in ("success", "sc", "spl", "collisions", "time", "distance", "wall", "cpu"):
            if (shown := printed.get(("/".join(cell), metric))) is None:
                if values["finished"] or metric not in ("wall", "cpu"):
                    wrong.append(f"the page lacks {metric} of {cell}")
                continue
            numbers = [float(number.replace("−", "-")) for number in re.findall(r"−?\d+\.\d+", shown)]
            triple = values[metric] if isinstance(values[metric], tuple) else (values[metric],)
            exact = triple if metric == "success" else triple[:1]  # bootstrap intervals are compared in cells.csv
            half = 0.5 * 10 ** -DIGITS.get(metric, 2) + 1e-9
            known = [number for number in exact if number is not None]
            if len(numbers) < len(known) or any(abs(a - b) > half for a, b in zip(numbers, known)):
                wrong.append(f"the page has {shown.strip()} as {metric} of {cell}, {exact} recomputed")
            if not known and numbers:
                wrong.append(f"the page has {shown.strip()} as {metric} of {cell}, which has none")
    return wrong
