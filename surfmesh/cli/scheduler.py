"""The machines that a Dask scheduler knows, as an executor."""

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from surfmesh.errors import MeshingError, printable

PATIENCE = "20s"
"""How long a scheduler may take to answer."""


@contextmanager
def executor_of(address: str | None) -> Iterator[Executor | None]:
    """What meshes the faces at this address; None where there is none.

    Raises ``MeshingError`` where nothing answers, or Dask is not installed.
    """
    if address is None:
        yield None
        return
    try:
        from distributed import Client
    except ImportError:
        raise MeshingError("--scheduler needs Dask: pip install 'surfmesh[cluster]'") from None
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise MeshingError(
            f"no scheduler at {printable(address)}: {printable(str(error))}"
        ) from None
    with client:
        yield client.get_executor()
