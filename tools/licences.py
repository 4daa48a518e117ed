"""`make licences`: every installed package that surfmesh needs, with its version and licence.

    python tools/licences.py            all of it, one line a package
    python tools/licences.py --direct   a Markdown table of what pyproject.toml names

What is wanted is found from surfmesh's own metadata, extra by extra, and followed through the
metadata of what is installed. Licences are what the packages state; where a wheel carries a
library under another licence, that stands in ``WITHIN`` (the run-time libraries of compilers,
free by their exceptions, are left out). Exit status 1: an ordinary install (no extra) needs a
package whose licence is not known, or is the GPL.
"""

import argparse
import re
import sys
from collections.abc import Iterator
from importlib import metadata
from typing import NamedTuple

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

EXTRAS = ("", "med", "docs", "test", "dev", "bench", "install")  # the first with a package owns it
WITHIN = {  # libraries inside wheels, where their licence is another than the package's
    "cadquery-ocp": "OCCT inside: LGPL-2.1 with exception",
    "mmgpy": "MMG inside: LGPL-3.0",
    "netgen-occt": "OCCT inside: LGPL-2.1 with exception",
    "nlopt": "Luksan's algorithms inside: LGPL-2.1",
    "shapely": "GEOS inside: LGPL-2.1",
    "triangle": "Triangle inside: not for sale without its author's leave",
}
SHORT = {  # first words of a licence that is given in full
    "BSD 3-Clause": "BSD-3-Clause", "The MIT License": "MIT", "MIT License": "MIT",
    "Apache License": "Apache-2.0", "Apache Software": "Apache-2.0",
}  # fmt: skip
PERMISSIVE = re.compile(
    r"\b(MIT|BSD|Apache|ISC|0BSD|Zlib|PSF|Python|HPND|Unlicense|CC0|BSL|Boost)", re.IGNORECASE
)
BINDING = (  # strongest first
    (re.compile(r"\bA?GPL|GNU (Affero )?General Public", re.IGNORECASE), "GPL"),
    (re.compile(r"LGPL|Lesser General Public", re.IGNORECASE), "LGPL"),
    (re.compile(r"\bMPL|Mozilla", re.IGNORECASE), "MPL"),
)
GOOD = ("permissive", "MPL", "LGPL")  # what an ordinary install may need


class Package(NamedTuple):
    """One line of the list."""

    name: str
    version: str
    licence: str
    kind: str  # permissive, MPL, LGPL, GPL, terms of its own or unknown
    wanted_by: str  # "surfmesh" or "surfmesh[extra]"
    direct: bool  # named in pyproject.toml


def packages() -> Iterator[Package]:
    """All that is installed of surfmesh's dependencies, those of an ordinary install first."""
    seen: set[str] = {"surfmesh"}
    named = _directly_named()
    for extra in EXTRAS:
        owner = f"surfmesh[{extra}]" if extra else "surfmesh"
        for name in sorted(_reached("surfmesh", {extra} - {""}, set()) - seen):
            seen.add(name)
            found = metadata.distribution(name)
            licence = stated_licence(found)
            kind = kind_of(licence, WITHIN.get(name, ""))
            yield Package(name, found.version, licence, kind, owner, name in named)


def stated_licence(found: metadata.Distribution) -> str:
    """What the metadata state: an SPDX expression, classifiers, or the licence field's begin."""
    expression = found.metadata.get("License-Expression")
    if expression:
        return expression
    classifiers = found.metadata.get_all("Classifier") or []
    ends = [c.split(" :: ")[-1] for c in classifiers if c.startswith("License :: ")]
    ends = [end for end in ends if end != "OSI Approved"]
    if ends:
        return ", ".join(ends)
    first = (found.metadata.get("License") or "").strip().split("\n")[0].strip()
    short = next((s for start, s in SHORT.items() if first.startswith(start)), first)
    return short[:40] or "unknown"


def kind_of(licence: str, within: str) -> str:
    """The strongest of the kinds of a licence and of a library inside."""
    if "not for sale" in within:
        return "terms of its own"
    either = PERMISSIVE.search(licence) and re.search(r"\bOR\b", licence)
    for text in ("" if either else licence, within):
        for pattern, kind in BINDING:
            if pattern.search(text):
                return kind
    return "permissive" if PERMISSIVE.search(licence) else "unknown"


def _directly_named() -> set[str]:
    return {canonicalize_name(Requirement(r).name) for r in metadata.requires("surfmesh") or []}


def _reached(name: str, extras: set[str], been: set[tuple[str, str]]) -> set[str]:
    """Names of all that ``name`` with these extras needs and is installed."""
    names: set[str] = set()
    for extra in ["", *extras]:
        if (name, extra) in been:
            continue
        been.add((name, extra))
        for text in metadata.requires(name) or []:
            wanted = Requirement(text)
            if wanted.marker and not wanted.marker.evaluate({"extra": extra}):
                continue
            other = canonicalize_name(wanted.name)
            if _is_installed(other):
                names |= {other} | _reached(other, set(wanted.extras), been)
    return names


def _is_installed(name: str) -> bool:
    try:
        metadata.distribution(name)
    except metadata.PackageNotFoundError:
        return False
    return True


def print_all(found: list[Package]) -> None:
    """One line a package, then those that are not permissive once more in a count."""
    width = max(len(p.name) + len(p.version) for p in found) + 2
    for p in found:
        mark = " " if p.kind == "permissive" else "*"
        remark = f"  ({WITHIN[p.name]})" if p.name in WITHIN else ""
        title = f"{p.name} {p.version}"
        print(f"{mark} {title:{width}}{p.wanted_by:18}{p.licence}{remark}")
    others = [p for p in found if p.kind != "permissive"]
    print(f"  {'three.js in view/assets':{width}}{'surfmesh':18}MIT")
    print(f"\n{len(found)} packages, {len(others)} of them not permissive (*):")
    for kind in dict.fromkeys(p.kind for p in others):
        names = ", ".join(f"{p.name} ({p.wanted_by})" for p in others if p.kind == kind)
        print(f"  {kind}: {names}")


def print_direct(found: list[Package]) -> None:
    """A Markdown table of what pyproject.toml names."""
    print("| package | needed by | licence |\n| --- | --- | --- |")
    for p in found:
        if p.direct:
            within = f"; {WITHIN[p.name]}" if p.name in WITHIN else ""
            print(f"| {p.name} | {p.wanted_by} | {p.licence}{within} |")


def main() -> int:
    """List them; 1 when an ordinary install needs what is not known or binds."""
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--direct", action="store_true", help="a table of direct dependencies")
    found = list(packages())
    (print_direct if options.parse_args().direct else print_all)(found)
    bad = [p for p in found if p.wanted_by == "surfmesh" and p.kind not in GOOD]
    for p in bad:
        print(f"{p.name}: {p.kind} licence in an ordinary install", file=sys.stderr)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
