"""The text of a file, of a known size and of no device."""

from __future__ import annotations

from pathlib import Path

from surfmesh.errors import SurfmeshError

MOST_BYTES = 32_000_000
"""What is longer is refused: parsers of text take a second for some megabytes."""


def text_of(path: Path, error: type[SurfmeshError], kind: str) -> str:
    """The whole text, in UTF-8 with or without its mark, every end of a line as one "\\n".

    kind: what the file should be, such as "a TOML file". Raises ``error`` that names the path for
    what is missing, no file, too long, not readable or not UTF-8.
    """
    try:
        if not path.is_file():
            reason = "cannot be read: not a file" if path.exists() else "no such file"
            raise error(f"{path}: {reason}")
        if (size := path.stat().st_size) > MOST_BYTES:
            raise error(
                f"{path}: holds {size / 1e6:.3g} MB; {kind} of up to {MOST_BYTES / 1e6:g} MB is "
                "read: give so many numbers as arrays, from Python"
            )
        return path.read_text(encoding="utf-8-sig")
    except OSError as reason:
        raise error(f"{path}: cannot be read: {reason.strerror}") from None
    except UnicodeDecodeError as reason:
        raise error(f"{path}: not {kind}: {reason}") from None
    except ValueError as reason:  # a name with a NUL in it; errors of ours are ValueErrors too
        raise reason if isinstance(reason, SurfmeshError) else error(f"{path}: {reason}") from None
