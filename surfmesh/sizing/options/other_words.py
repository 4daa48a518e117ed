"""What other programs call the options of ``Sizing``: for error messages."""

OTHER_WORDS = {
    "hausd": "chord",  # mmg
    "hausdorff": "chord",
    "sag": "chord",
    "sagitta": "chord",
    "deflection": "chord",  # OpenCASCADE
    "linear_deflection": "chord",
    "lin_deflection": "chord",
    "tolerance": "chord",  # CadQuery's exporters
    "faceting_tolerance": "chord",  # DAGMC
    "chordal_error": "chord",
    "chord_height": "chord",
    "angular_deflection": "angle",
    "ang_deflection": "angle",
    "angular_tolerance": "angle",
    "gradation": "growth",
    "hgrad": "growth",  # mmg
    "grading": "growth",  # netgen
    "growth_rate": "growth",
    "hsiz": "size",  # mmg
    "edge_length": "size",
    "hmax": "max_size",  # mmg
    "maxh": "max_size",  # netgen
    "mesh_size_max": "max_size",  # gmsh
    "clmax": "max_size",
    "hmin": "min_size",
    "minh": "min_size",
    "mesh_size_min": "min_size",
    "clmin": "min_size",
    "aspect_ratio": "anisotropy",
    "stretch": "anisotropy",
    "count": "triangles",
    "elements": "triangles",
    "faces": "triangles",
}
"""By word, in small letters with underscores."""


def own_word(word: str) -> str | None:
    """The option of ``Sizing`` that some other program calls ``word``; None: it is not known."""
    plain = "_".join(word.lower().replace("-", " ").replace("_", " ").replace(".", " ").split())
    return OTHER_WORDS.get(plain)
