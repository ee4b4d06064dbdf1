"""The one exception of the package."""
from typing import Optional


class Error(Exception):
    """What is wrong, where, and how to correct it. Its text is one line of all three.

    what:    the problem, with figures
    where:   file and line, key, argument or method
    remedy:  what to change
    kind:    "input" (correct the request), "environment" (repair the machine) or "cancelled"
    """

    def __init__(self, what: str, where: str = "", remedy: str = "", kind: str = "input",
                 line: Optional[str] = None) -> None:
        super().__init__(what, where, remedy, kind, line)  # all of them: exceptions travel between processes
        self.what = what
        self.where = where
        self.remedy = remedy
        self.kind = kind
        self._line = line

    def __str__(self) -> str:
        if self._line is not None:
            return self._line
        return (self.where + ": " if self.where else "") + self.what + (" (%s)" % self.remedy if self.remedy else "")
