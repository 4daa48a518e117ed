"""Records of long runs: one JSON object a line, written as soon as it is known."""

import json
from collections.abc import Iterable
from contextlib import nullcontext
from pathlib import Path


def kept(records: Iterable[dict], path: Path | None) -> list[dict]:
    """All records; each goes to ``path``, if there is one, before the next is asked for."""
    found = []
    with open(path, "w", encoding="utf-8") if path else nullcontext() as out:
        for record in records:
            found.append(record)
            if out is not None:
                out.write(json.dumps(record) + "\n")
                out.flush()
    return found


def read(path: Path) -> list[dict]:
    """What ``kept`` has written."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line]
