"""Errors of a server."""


class GloamError(Exception):
    """An operation was refused. kind: "input", "io", "usage", "partial", "diverged", "unsupported", "interrupted"."""

    def __init__(self, error):
        self.kind = error.get("kind", "")
        self.message = error.get("message", "")
        self.remedy = error.get("remedy", "")
        self.where = error.get("where", "")  # file:line:column of the user's own file, or ""
        place = f"{self.where}: " if self.where else ""
        remedy = f" ({self.remedy})" if self.remedy else ""
        super().__init__(f"{place}{self.message}{remedy}")
