"""Rooms of the core can be compiled as one file each: names of a file are unique in its room."""

import re
from collections import defaultdict
from pathlib import Path

import pytest

SOURCES = Path(__file__).parents[2] / "src"
ROOMS = sorted({path.parent for path in SOURCES.glob("*/*.cpp")})
CONSTANT = re.compile(r"^(?:static )?constexpr (?:[\w:<>, ]+?) (\w+)(?:\[\w*\])? ?[={]")
OTHERS = re.compile(r"(?:, |^\s+)([A-Z][A-Z0-9_]+) ?[={]")  # of the same statement
TYPE = re.compile(r"^(?:struct|class|enum class) (\w+).*\{")
FUNCTION = re.compile(r"^(?=\w)(?!namespace|template)[\w:<>&*, ]+ (\w+\([^;)]*)[^;]*\{")
ALIAS = re.compile(r"^using (\w+) = (.*);")  # twice the same is allowed
TWINS = re.compile(r"tape_\w+")  # for numbers and for intervals: each by itself, see CMakeLists.txt


def local_names(path: Path) -> dict[str, str]:
    """Constants, types, aliases and functions at the left margin that other files do not see.

    Each with what may not differ or, where nothing may stand twice, with the file.
    """
    names, hidden, in_constants = {}, False, False
    for line in path.read_text(encoding="utf-8").splitlines():
        if re.match(r"namespace \{", line):
            hidden = True
        elif re.match(r"\}  // namespace$", line):
            hidden = False
        elif hidden:
            in_constants = in_constants or CONSTANT.match(line) is not None
            if in_constants:
                names.update(dict.fromkeys(OTHERS.findall(line), path.name))
                in_constants = ";" not in line
            if found := CONSTANT.match(line) or TYPE.match(line):
                names[found.group(1)] = path.name
            elif found := ALIAS.match(line):
                names[found.group(1)] = found.group(2)
            elif found := FUNCTION.match(line):  # with its arguments: overloads are allowed
                names[found.group(1)] = path.name
    return names


@pytest.mark.parametrize("room", ROOMS, ids=lambda room: room.name)
def test_names_of_a_file_are_unique_in_its_room(room):
    meanings = defaultdict(set)
    for path in sorted(room.glob("*.cpp")):
        if not TWINS.match(path.stem):
            for name, meaning in local_names(path).items():
                meanings[path.stem.endswith("bindings"), name].add(meaning)
    assert not {name: found for (_, name), found in meanings.items() if len(found) > 1}


@pytest.mark.parametrize("room", ROOMS, ids=lambda room: room.name)
def test_a_template_is_specialised_in_one_file(room):
    places = defaultdict(set)
    for path in sorted(room.glob("*.?pp")):
        for found in re.finditer(r"^template <>\nstruct (\w+<[\w:]+>)", path.read_text(), re.M):
            places[found.group(1)].add(path.name)
    assert not {name: found for name, found in places.items() if len(found) > 1}


@pytest.mark.parametrize("room", ROOMS, ids=lambda room: room.name)
def test_types_of_a_file_have_no_name_that_its_room_has_for_others(room):
    """What follows in the same file of several would not know which is meant."""
    named = re.compile(r"^(?:using|struct|class|enum class) (\w+)\b(?: = |.*\{)")
    seen = {
        found.group(1)
        for path in sorted(room.glob("*.hpp"))
        for line in path.read_text(encoding="utf-8").splitlines()
        if (found := named.match(line))
    }
    files = [path for path in sorted(room.glob("*.cpp")) if not TWINS.match(path.stem)]
    both = seen & {name for path in files for name in local_names(path)}
    assert not both


def test_types_that_others_see_have_one_meaning():
    """Two types of one name in two rooms are one to the linker: what is made of one, such as an
    array of it, would have the size of the other."""
    places = defaultdict(set)
    for path in sorted(SOURCES.rglob("*.?pp")):
        hidden = False
        for line in path.read_text(encoding="utf-8").splitlines():
            hidden = not line.startswith("}  // namespace") and (hidden or line == "namespace {")
            if not hidden and (found := re.match(r"(?:struct|class|enum class) (\w+)\b.*\{", line)):
                if not re.match(r"(?:struct|class) \w+(?:::|<)", line):
                    places[found.group(1)].add(path.relative_to(SOURCES).as_posix())
    assert not {name: found for name, found in places.items() if len(found) > 1}
