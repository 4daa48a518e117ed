"""One way to run property tests: the same examples every time, so that main stays green.

``SURFMESH_FUZZ=2000 pytest tests/kernels`` looks for new ones, that many a test.
"""

import os

from hypothesis import HealthCheck, settings

_CALM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
_fuzz = os.environ.get("SURFMESH_FUZZ")

settings.register_profile("repeatable", derandomize=True, **_CALM)
settings.register_profile("fuzz", max_examples=int(_fuzz or 1), **_CALM)
settings.load_profile("fuzz" if _fuzz else "repeatable")
