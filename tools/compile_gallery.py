"""Compile the formulas of the gallery ahead: ``surfaces/compiled.json``. After a change there, or
of the compiler:

    python tools/compile_gallery.py
"""

import json
from pathlib import Path

from surfmesh.geometry.files.formula_file import gallery, gallery_folder, key_of_file
from surfmesh.geometry.files.formula_file import load_formula_file as loaded
from surfmesh.geometry.formulas.compiled_ahead import NAME


def compiled() -> dict[str, dict]:
    """All that the file holds, by key."""
    return {
        key_of_file(path): loaded(path, ahead=False).compiled().plain()
        for path in gallery().values()
    }


def written_to(path: Path) -> None:
    """One line a surface."""
    lines = [f"{json.dumps(key)}: {json.dumps(of)}" for key, of in sorted(compiled().items())]
    path.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    written_to(gallery_folder() / NAME)
