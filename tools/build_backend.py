"""The build backend: scikit-build-core, with the C++ compiler that PyPI ships where there is none.

    python tools/build_backend.py      says so before a build that will need it

A machine's own compiler is much faster: zig first builds its C++ library, and is large. It is the
last resort that leaves Python and make as all that it takes.
"""

import os
import shutil
import stat
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

COMPILERS = ("c++", "g++", "clang++", "cl", "clang-cl")
VISUAL_STUDIO = Path(
    os.environ.get("ProgramFiles(x86)", ""), "Microsoft Visual Studio/Installer/vswhere.exe"
)
HERE = Path(__file__).resolve().parents[1]
ZIG = "ziglang>=0.13"
ANNOUNCEMENT = (
    "surfmesh: no C++ compiler was found (looked for $CXX, " + ", ".join(COMPILERS) + "). The core "
    "is built with zig from PyPI, a download of 100 MB and some minutes; a compiler of the system "
    "takes about a minute"
)


def has_compiler() -> bool:
    """Whether CMake will find a C++ compiler."""
    if os.environ.get("CXX") or any(map(shutil.which, COMPILERS)):
        return True
    return sys.platform == "win32" and VISUAL_STUDIO.exists()


def get_requires_for_build_wheel(config_settings: dict[str, Any] | None = None) -> list[str]:
    """What building takes on this machine (PEP 517)."""
    from scikit_build_core import build

    needed = build.get_requires_for_build_wheel(config_settings)
    return needed if has_compiler() else [*needed, ZIG]


def get_requires_for_build_editable(config_settings: dict[str, Any] | None = None) -> list[str]:
    """The same for a build where the sources lie (PEP 660)."""
    from scikit_build_core import build

    needed = build.get_requires_for_build_editable(config_settings)
    return needed if has_compiler() else [*needed, ZIG]


def build_wheel(folder: str, settings: dict | None = None, metadata: str | None = None) -> str:
    """A wheel with the compiled core (PEP 517)."""
    from scikit_build_core import build

    with _compiler():
        return build.build_wheel(folder, settings, metadata)


def build_editable(folder: str, settings: dict | None = None, metadata: str | None = None) -> str:
    """The compiled core in the package's folder, and a wheel that points there (PEP 660).

    scikit-build-core's own editable wheels find modules by a hook, which takes the folder of the
    core's types for the core.
    """
    from scikit_build_core import build
    from wheel.wheelfile import WheelFile

    with _compiler():
        _build_in_place()
    with tempfile.TemporaryDirectory() as staging:
        info = Path(staging, build.prepare_metadata_for_build_editable(staging, settings))
        Path(staging, "surfmesh.pth").write_text(f"{HERE}\n", encoding="utf-8")
        stated = (info / "WHEEL").read_text(encoding="utf-8")
        tag = stated.split("Tag: ")[1].split()[0]
        name = f"{info.name.removesuffix('.dist-info')}-{tag}.whl"
        with WheelFile(Path(folder, name), "w") as file:
            file.write_files(staging)
    return name


def _build_in_place() -> None:
    """The core into the package's folder, by CMake."""
    built = HERE / "build" / f"editable-{sys.implementation.cache_tag}"
    made_with = [f"-DPython_EXECUTABLE={sys.executable}", "-DSURFMESH_UNITY=ON"]
    made_with += filter(None, os.environ.get("SKBUILD_CMAKE_ARGS", "").split(";"))
    if shutil.which("ninja"):
        made_with += ["-G", "Ninja"]
    for command in (
        ["cmake", "-S", str(HERE), "-B", str(built), "-DCMAKE_BUILD_TYPE=Release", *made_with],
        ["cmake", "--build", str(built), "--config", "Release", "--parallel"],
    ):
        subprocess.run(command, check=True)  # noqa: S603 our own build


def get_requires_for_build_sdist(config_settings: dict[str, Any] | None = None) -> list[str]:
    """What packing the sources takes (PEP 517)."""
    from scikit_build_core import build

    return build.get_requires_for_build_sdist(config_settings)


def build_sdist(folder: str, config_settings: dict[str, Any] | None = None) -> str:
    """The packed sources (PEP 517)."""
    from scikit_build_core import build

    return build.build_sdist(folder, config_settings)


@contextmanager
def _compiler() -> Iterator[None]:
    """The machine's compiler, or zig under the names that CMake asks for."""
    if has_compiler():
        yield
        return
    print(ANNOUNCEMENT, file=sys.stderr, flush=True)
    before = os.environ.get("SKBUILD_CMAKE_ARGS")
    with tempfile.TemporaryDirectory(prefix="surfmesh-zig-") as folder:
        tools = {
            "CMAKE_CXX_COMPILER": _command(Path(folder), "c++"),
            "CMAKE_AR": _command(Path(folder), "ar"),
            "CMAKE_RANLIB": _command(Path(folder), "ranlib"),
        }
        given = [f"-D{name}={path.as_posix()}" for name, path in tools.items()]
        given.append("-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON")  # zig refuses
        os.environ["SKBUILD_CMAKE_ARGS"] = ";".join([*filter(None, [before]), *given])
        try:
            yield
        finally:
            del os.environ["SKBUILD_CMAKE_ARGS"]
            if before is not None:
                os.environ["SKBUILD_CMAKE_ARGS"] = before


def _command(folder: Path, tool: str) -> Path:
    """A command that runs a tool of zig."""
    if sys.platform == "win32":
        path = folder / f"zig-{tool}.cmd"
        path.write_text(f'@"{sys.executable}" -m ziglang {tool} %*\r\n', encoding="utf-8")
    else:
        path = folder / f"zig-{tool}"
        path.write_text(
            f'#!/bin/sh\nexec "{sys.executable}" -m ziglang {tool} "$@"\n', encoding="utf-8"
        )
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


if __name__ == "__main__" and not has_compiler():
    print(ANNOUNCEMENT, file=sys.stderr)
