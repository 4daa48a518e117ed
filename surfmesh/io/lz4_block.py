"""One block of LZ4, as VTK writes it: a run of literals and a copy of earlier bytes, repeated.

Source: "LZ4 Block Format Description", https://github.com/lz4/lz4/blob/dev/doc/lz4_Block_format.md
"""

LEAST_COPY = 4  # bytes


def decompressed(data: bytes, size: int) -> bytes:
    """The ``size`` bytes that ``data`` stands for; ValueError when it stands for others."""
    found, at = bytearray(), 0
    while at < len(data):
        token = data[at]
        count, at = _length(data, at + 1, token >> 4)
        if at + count > len(data) or len(found) + count > size:
            raise ValueError("a block of LZ4 is damaged")
        found += data[at : at + count]
        at += count
        if at == len(data):  # the last sequence has literals alone
            break
        back = int.from_bytes(data[at : at + 2], "little")
        count, at = _length(data, at + 2, token & 15)
        count += LEAST_COPY
        if not 0 < back <= len(found) or len(found) + count > size:
            raise ValueError("a block of LZ4 is damaged")
        start = len(found) - back
        while count > 0:  # what it copies may be bytes that it has just made
            piece = found[start : start + count]
            found += piece
            count -= len(piece)
    if len(found) != size:
        raise ValueError("a block of LZ4 is damaged")
    return bytes(found)


def _length(data: bytes, at: int, nibble: int) -> tuple[int, int]:
    """The length that starts with four bits of the token, and where the next byte stands."""
    if nibble < 15:
        return nibble, at
    while True:
        if at >= len(data):
            raise ValueError("a block of LZ4 is damaged")
        nibble += data[at]
        at += 1
        if data[at - 1] < 255:
            return nibble, at
