"""The notebooks run, and what they compare is equal."""

from pathlib import Path

import nbclient
import nbformat
import pytest

NOTEBOOKS = sorted((Path(__file__).parent.parent / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, here):
    notebook = nbformat.read(path, as_version=4)
    kernel = "python3"
    nbclient.NotebookClient(notebook, timeout=600, kernel_name=kernel).execute()
    assert sum("assert" in cell.source for cell in notebook.cells) >= 3


def test_there_are_three():
    assert len(NOTEBOOKS) == 3
