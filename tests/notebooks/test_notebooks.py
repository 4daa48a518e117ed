"""The notebooks run from top to bottom; what they claim they assert themselves."""

import os
from pathlib import Path

import nbformat
import pytest
from jupyter_client.manager import start_new_kernel
from nbclient import NotebookClient

import surfmesh as sm

FOLDER = Path(__file__).resolve().parents[2] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
TIME_LIMIT = 300  # seconds a cell, when kernels have to be compiled first


@pytest.fixture(scope="module")
def kernel():
    """One process for all of them: to import everything takes longer than most notebooks."""
    source = str(Path(sm.__file__).parents[1])
    inline = "module://matplotlib_inline.backend_inline"
    environment = {**os.environ, "PYTHONPATH": source, "MPLBACKEND": inline}
    manager, client = start_new_kernel(env=environment)
    client.stop_channels()
    yield manager
    manager.shutdown_kernel(now=True)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_runs(path, kernel, tmp_path):
    notebook = nbformat.read(path, as_version=4)
    fresh = f"%reset -f\nimport os\nos.chdir({str(tmp_path)!r})\ndel os"
    notebook.cells.insert(0, nbformat.v4.new_code_cell(fresh))
    NotebookClient(notebook, km=kernel, timeout=TIME_LIMIT).execute()
    outputs = [output for cell in notebook.cells if "outputs" in cell for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in outputs), "no picture"
    talk = [output.text for output in outputs if output.get("name") == "stderr"]
    assert not talk, talk


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_is_stored_without_outputs(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    for cell in notebook.cells:
        assert not cell.get("outputs") and cell.get("execution_count") is None
    assert notebook.cells[0].cell_type == "markdown" and notebook.cells[0].source.startswith("# ")


def test_there_are_eight():
    assert [path.stem[0] for path in NOTEBOOKS] == list("12345678")
