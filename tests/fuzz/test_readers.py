"""Damaged files and odd command lines: one clear line or a result that holds together.

``SURFMESH_FUZZ=N`` tries N of each kind here, ``make fuzz`` prints a table of as many.
"""

import os

import pytest
from fuzz import trials
from fuzz.mutations import mutant
from fuzz.seed_files import originals

SEED = 1
COUNT = {"step": 4, "iges": 3, "brep": 3, "surface": 12, "command": 40}  # the slower ones
MANY = 30

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="inputs are tried in forks")


@pytest.mark.parametrize("kind", trials.KINDS)
def test_hostile_input_is_refused_in_one_line_or_read_as_something_sound(kind):
    count = int(os.environ.get("SURFMESH_FUZZ") or COUNT.get(kind, MANY))
    faults = [t for t in trials.tried(trials.mutants(kind, SEED, range(count))) if t.is_fault]
    said = "\n\n".join(f"{t.name}: {t.ended}: {t.said}" for t in faults)
    again = f"benchmarks/trust.py --only {kind} --seed {SEED} --numbers N --keep FOLDER"
    assert not faults, f"{len(faults)} of {count}; as files: {again}\n{said}"


@pytest.mark.parametrize("kind", [".obj", ".glb", ".3mf", "surface"])
def test_mutants_are_functions_of_seed_and_number(kind):
    files = originals(kind)
    first = [mutant(files, kind, 5, number) for number in range(20)]
    assert first == [mutant(files, kind, 5, number) for number in range(20)]
    assert len({found.data for found in first}) > 15
    assert first != [mutant(files, kind, 6, number) for number in range(20)]


def test_what_ends_a_process_is_told_and_the_rest_is_tried(monkeypatch):
    """The judge itself: a crash, a loop, an endless demand for memory, a warning, a print."""
    import warnings

    def work(path, found):
        number = int(found.data)
        if number == 1:
            os.abort()
        if number == 2:
            return "x" * (4 << 30)
        if number == 3:
            warnings.warn("odd", stacklevel=1)
        if number == 4:
            os.write(1, b"from a library")
        if number == 5:
            raise KeyError("odd")
        if number == 6:
            raise ValueError("two\nlines") from None
        while number == 7:
            pass
        return "fine"

    monkeypatch.setitem(trials.TRIED, "surface", work)
    monkeypatch.setitem(trials.SECONDS, "surface", 1)
    tasks = [
        trials.Task("surface", str(n), lambda n=n: trials.Mutant(str(n).encode(), 0, ()))
        for n in range(9)
    ]
    ends = [trial.ended for trial in trials.tried(tasks, prepare=False)]
    assert ends == [
        "read", "crashed", "memory", "noise", "noise", "traceback", "traceback", "hung", "read"
    ]  # fmt: skip
