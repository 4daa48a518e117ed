"""What can go wrong, in the user's words.

Every error says what is wrong, where (a column of a formula, a (u, v) point, a side, a
loop), and what to do about it. Each is also the builtin that a caller would expect to catch.
"""

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # errors import nothing
    import numpy as np
    from numpy.typing import NDArray

UNSAFE = re.compile(
    "[\x00-\x1f\x7f-\x9f\xad\u061c\u180e\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff"
    "\ufff9-\ufffb\ud800-\udfff\U000e0000-\U000e007f]"
)
"""What moves the cursor, recolours, reorders or hides text, and halves of characters: control
characters, invisible ones and directions of writing. The joiners U+200C and U+200D are letters'
own business and stay."""


def printable(text: object) -> str:
    """``str(text)`` on one line of a terminal, each of its unsafe characters as an escape.

    A file name, a key or a label may hold anything: "\x1b" becomes the four signs that write it.
    """
    return UNSAFE.sub(_escaped, str(text))


def _escaped(found: re.Match[str]) -> str:
    return found[0].encode("unicode_escape", "surrogatepass").decode("ascii")


def shown(value: object, longest: int = 60) -> str:
    """A caller's value for a message: one short line, whatever it is and however it prints."""
    try:
        text = repr(value)
    except Exception:  # a number of too many digits, a broken object
        text = f"a {type(value).__name__}"
    text = printable(" ".join(text.split()))
    return text if len(text) <= longest else text[: longest - 3] + "..."


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The known name that is nearest to ``name``, as the end of a message; empty when none is."""
    from difflib import get_close_matches

    near = get_close_matches(name.lower(), known, n=1)
    return f"; did you mean {near[0]!r}?" if near else ""


class SurfmeshError(Exception):
    """The parent of everything that surfmesh raises on purpose."""

    where: "NDArray[np.float64] | None" = None
    """(u, v) or (k, 2): the places in the parameter plane, where these are known."""


class MissingExtraError(SurfmeshError, ImportError):
    """A library is not there that comes with an extra, as in ``pip install 'surfmesh[view]'``."""


@contextmanager
def needs(extra: str, what: str) -> Iterator[None]:
    """Imports of libraries that come with an extra: MissingExtraError where one is not there.

    what: for whom they are, the beginning of the message.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        message = f"{what} needs {error.name}: pip install 'surfmesh[{extra}]'"
        raise MissingExtraError(message, name=error.name) from None


class SurfaceError(SurfmeshError, ValueError):
    """The surface cannot be used: empty domain, values that are not finite, no area."""


class FormulaError(SurfaceError):
    """A formula was refused.

    ``text`` is the formula, ``column`` the 1-based place in it, ``reason`` why. The message
    shows the formula with a caret under the column.
    """

    def __init__(self, reason: str, text: str = "", column: int = 1) -> None:
        self.reason, self.text, self.column = reason, text, column
        # of a long text the neighbourhood of the column
        start = max(0, column - 36) if len(text) > 72 else 0
        shown, before = printable(text[start : start + 72]), printable(text[start : column - 1])
        pointer = f"\n  {shown}\n  {' ' * len(before)}^" if text else ""
        super().__init__(f"{reason} (column {column}){pointer}")


class DomainError(SurfmeshError, ValueError):
    """A planar domain cannot be used: crossing segments, a loop without area, wrong arrays."""


class SizingError(SurfmeshError, ValueError):
    """A size request that cannot be met: unknown, contradictory, not positive."""


class MeshingError(SurfmeshError, RuntimeError):
    """No valid mesh could be made; the message names the place and the reason."""


class Cancelled(SurfmeshError, RuntimeError):
    """The progress callback returned False: the work was stopped, and nothing was written."""


class FileFormatError(SurfmeshError, ValueError):
    """A file cannot be read or written: unknown extension, wrong content."""


class CadError(SurfmeshError, ValueError):
    """A CAD model cannot be used: the file, a face or an edge, and why."""
