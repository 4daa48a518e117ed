"""XML that was written by somebody else: one parser for .vtu, .vtp, .xdmf and .3mf.

A document type can declare entities, which name other files or grow without end; none of these
formats has one, so that a file with one is refused. Elements may be nested as deep as the formats
need, and no deeper.
"""

from collections.abc import Callable, Iterable
from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

from surfmesh.errors import FileFormatError

DEEPEST = 100  # elements within each other; the formats have up to eight
MOST_ELEMENTS = 200_000  # of a tree; arrays are text of an element, not elements
PIECE = 1 << 16  # bytes parsed at once: an error ends the work within as many


def root_of(path: Path, data: bytes) -> ElementTree.Element:
    """The root element of a whole document in memory.

    Raises ``FileFormatError``, which names ``path``, for a document type, for more than
    ``DEEPEST`` elements in each other or ``MOST_ELEMENTS`` in all, and for what is not XML.
    """
    parser = ElementTree.XMLParser(target=_Tree(path))  # noqa: S314 no document types
    try:
        for at in range(0, len(data), PIECE):
            parser.feed(data[at : at + PIECE])
        return parser.close()
    except ElementTree.ParseError as error:
        raise FileFormatError(f"{path}: not whole XML: {error}") from None


class _Tree(ElementTree.TreeBuilder):
    """A tree that does not grow without limit."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path, self.depth, self.count = path, 0, 0

    def doctype(self, name: str, public: str | None, system: str | None) -> None:
        raise _document_type(self.path)

    def start(self, tag: str, attributes: dict[str, str]) -> ElementTree.Element:
        self.depth, self.count = self.depth + 1, self.count + 1
        if self.depth > DEEPEST:
            raise _too_deep(self.path)
        if self.count > MOST_ELEMENTS:
            raise FileFormatError(f"{self.path}: holds more than {MOST_ELEMENTS} XML elements")
        return super().start(tag, attributes)

    def end(self, tag: str) -> ElementTree.Element:
        self.depth -= 1
        return super().end(tag)


def parse(
    path: Path,
    pieces: Iterable[bytes],
    start: Callable[[str, dict[str, str]], None],
    end: Callable[[str], None],
    text: Callable[[str], None],
) -> None:
    """Call ``start``, ``end`` and ``text`` for what ``pieces`` of a document hold; no tree is made.

    Tags with a namespace come as ``namespace}tag``. Raises as ``root_of`` does, but for the number
    of elements.
    """
    depth = 0

    def opened(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > DEEPEST:
            raise _too_deep(path)
        start(tag, attributes)

    def closed(tag: str) -> None:
        nonlocal depth
        depth -= 1
        end(tag)

    def doctype(*_: object) -> None:
        raise _document_type(path)

    parser = expat.ParserCreate(namespace_separator="}")
    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = opened, closed
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = text, doctype
    try:
        for piece in pieces:
            parser.Parse(piece, False)
        parser.Parse(b"", True)
    except expat.ExpatError as error:
        raise FileFormatError(f"{path}: not whole XML: {error}") from None


def _document_type(path: Path) -> FileFormatError:
    return FileFormatError(
        f"{path}: XML with a document type (<!DOCTYPE ...>) is not read; save it without"
    )


def _too_deep(path: Path) -> FileFormatError:
    return FileFormatError(f"{path}: XML elements are nested more than {DEEPEST} deep")
