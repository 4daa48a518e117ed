"""Threads or memory that the system does not give: fewer threads, or an error; never the end of
the process.
"""

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="limits as Linux has them")

SURFACE = """
import os, resource
import surfmesh
surface = surfmesh.ParametricSurface("u", "v", "0.4*sin(3*u)*sin(3*v)", u=(-2, 2), v=(-2, 2))
box = surfmesh.from_cadquery(__import__("cadquery").Workplane().box(3, 2, 1).edges().fillet(0.2))
for subject in (surface, box):  # what is imported when it is needed is there
    surfmesh.mesh(subject, 0.4, jobs=4)
"""

NO_THREADS = """
if os.getuid() == 0:  # whom the limit does not bind
    try:
        os.setgid(65534)
        os.setuid(65534)
    except PermissionError:
        raise SystemExit(print("bound to be root"))
resource.setrlimit(resource.RLIMIT_NPROC, (2, 2))
for subject, size in ((surface, 0.02), (box, 0.1)):
    made = {surfmesh.mesh(subject, size, jobs=jobs).points.tobytes() for jobs in (1, 4)}
    print(len(made) == 1)
"""

NO_MEMORY = """
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + 100_000_000,) * 2)
try:
    surfmesh.mesh(surface, 0.005, jobs=3)
except MemoryError:
    print("no memory")
"""


def run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", SURFACE + code],
        capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_fewer_threads_where_the_system_gives_no_more():
    said = run(NO_THREADS)
    if said.startswith("bound"):
        pytest.skip("this root may not become another user, and limits do not bind it")
    assert said.split() == ["True", "True"]


def test_memory_that_runs_out_in_a_thread_is_an_error():
    assert run(NO_MEMORY).strip() == "no memory"
