"""What can go wrong, in the user's words.

Every error says what is wrong, where (a column of a formula, a (u, v) point, a side, a
loop), and what to do about it. Each is also the builtin that a caller would expect to catch.
"""


def shown(value: object, longest: int = 60) -> str:
    """A caller's value for a message: one short line, whatever it is and however it prints."""
    try:
        text = repr(value)
    except Exception:  # a number of too many digits, a broken object
        text = f"a {type(value).__name__}"
    text = "".join(c if c.isprintable() else " " for c in text)
    text = " ".join(text.split())
    return text if len(text) <= longest else text[: longest - 3] + "..."


class SurfmeshError(Exception):
    """The parent of everything that surfmesh raises on purpose."""


class SurfaceError(SurfmeshError, ValueError):
    """The surface cannot be used: empty domain, values that are not finite, no area."""


class FormulaError(SurfaceError):
    """A formula was refused.

    ``text`` is the formula, ``column`` the 1-based place in it, ``reason`` why. The message
    shows the formula with a caret under the column.
    """

    def __init__(self, reason: str, text: str = "", column: int = 1) -> None:
        self.reason, self.text, self.column = reason, text, column
        excerpt, caret = text, column
        if len(text) > 72:  # keep the neighbourhood of the column, not the whole text
            start = max(0, column - 36)
            excerpt, caret = text[start : start + 72], column - start
        excerpt = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in excerpt)
        pointer = f"\n  {excerpt}\n  {' ' * (caret - 1)}^" if text else ""
        super().__init__(f"{reason} (column {column}){pointer}")


class DomainError(SurfmeshError, ValueError):
    """A planar domain cannot be used: crossing segments, a loop without area, wrong arrays."""


class SizingError(SurfmeshError, ValueError):
    """A wish about sizes that cannot be met: unknown, contradictory, not positive."""


class MeshingError(SurfmeshError, RuntimeError):
    """No valid mesh could be made; the message names the place and the reason."""


class Cancelled(SurfmeshError, RuntimeError):
    """The progress callback returned False: the work was stopped, and nothing was written."""


class FileFormatError(SurfmeshError, ValueError):
    """A file cannot be read or written: unknown extension, wrong content."""


class CadError(SurfmeshError, ValueError):
    """A CAD model cannot be used: the file, a face or an edge, and why."""
