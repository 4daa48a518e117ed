"""How much larger a file may become by unpacking it.

A few bytes can stand for gigabytes, by compression or by many references to the same bytes.
"""

from pathlib import Path

from surfmesh.errors import FileFormatError

FREE = 32 << 20  # bytes that any file may unpack to: small files of equal numbers do
LARGEST_RATIO = 40  # bytes for each byte of the file beyond these


class Expansion:
    """What one file has been unpacked to so far."""

    def __init__(self, path: Path, size: int) -> None:
        """size: bytes of the file."""
        self.path, self.size = path, size
        self.limit = FREE + LARGEST_RATIO * size
        self.taken = 0

    def take(self, count: int) -> None:
        """Raise ``FileFormatError`` before ``count`` more bytes are unpacked beyond the limit."""
        self.taken += count
        if self.taken > self.limit:
            raise FileFormatError(
                f"{self.path}: would unpack to more than {LARGEST_RATIO} times its "
                f"{self.size} bytes and {FREE >> 20} MB; save it without compression"
            )
