"""The entries of a TOML file, with errors that name the file and the key."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from surfmesh.errors import SurfaceError, SurfmeshError


def sets_key(path: Path, key: str) -> bool:
    """Does the file set this key at its top level? A look at the lines, no parsing."""
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False
    return re.search(rf"^{key}\s*=", text, re.MULTILINE) is not None


class TomlEntries:
    """The entries of one file. error: what is raised for anything missing, unknown or wrong."""

    def __init__(self, path: Path, error: type[SurfmeshError] = SurfaceError) -> None:
        self.path, self.error = path, error
        try:
            self.content = tomllib.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise error(f"{path}: no such file") from None
        except OSError as reason:
            raise error(f"{path}: cannot be read: {reason.strerror}") from None
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as reason:
            raise error(f"{path}: not a TOML file: {reason}") from None

    def value(self, key: str, types: tuple[type, ...], default: Any = None) -> Any:
        if key not in self.content:
            if default is not None:
                return default
            raise self.error(f"{self.path}: the key '{key}' is missing")
        return self.expect(key, self.content[key], types)

    def table(self, key: str, required: bool = False) -> dict[str, Any]:
        return self.value(key, (dict,), default=None if required else {})

    def expect(self, key: str, value: Any, types: tuple[type, ...]) -> Any:
        """The value, when it has one of the types; true and false are not numbers here."""
        if not isinstance(value, types) or (isinstance(value, bool) and bool not in types):
            wanted = " or ".join(_TYPE_NAMES[t] for t in types)
            raise self.error(f"{self.path}: '{key}' must be {wanted}, not {value!r:.60}")
        return value

    def refuse_unknown(self, table: Mapping[str, Any], known, prefix: str) -> None:
        for key in table:
            if key not in known:
                choices = ", ".join(sorted(known))
                raise self.error(f"{self.path}: unknown key '{prefix}{key}'; known: {choices}")


_TYPE_NAMES = {
    str: "text",
    int: "a whole number",
    float: "a number",
    bool: "true or false",
    list: "a list",
    dict: "a table",
}
