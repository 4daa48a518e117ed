"""Executors that callers give: what is none, and what goes wrong with one that is."""

import re
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, Executor
from contextlib import contextmanager
from pickle import PicklingError
from typing import Any

from surfmesh.errors import MeshingError, SizingError, SurfmeshError, shown

_UNSENT = re.compile("pickle|serialize|local object")
"""In what Python and Dask say of objects that cannot be sent to another process."""


def require_executor(executor: Any) -> None:
    """Raises ``SizingError`` for what is no executor, as a client or a class of them is none."""
    if not isinstance(executor, Executor):
        raise SizingError(
            f"executor is {shown(executor)}: one of concurrent.futures is needed, as "
            "ProcessPoolExecutor(), or of Dask what client.get_executor() gives"
        )


@contextmanager
def executor_faults(work: str) -> Iterator[None]:
    """What an executor raises of itself becomes a ``MeshingError`` that says what to do.

    work: what its workers do: "mesh the faces".
    """
    try:
        yield
    except SurfmeshError:
        raise
    except BrokenExecutor as error:
        raise MeshingError(f"the workers that {work} are lost: {error}") from error
    except RuntimeError as error:
        if "after shutdown" not in str(error):
            raise
        raise MeshingError(
            f"the executor that is to {work} is shut down: call within its with statement"
        ) from error
    except (PicklingError, AttributeError, TypeError) as error:
        if not _UNSENT.search(str(error)):
            raise
        raise MeshingError(
            f"what the workers need to {work} cannot be sent to them ({error}): laws and sources "
            "of sizes are to be functions or classes of a module, no lambdas; or mesh by threads"
        ) from error
