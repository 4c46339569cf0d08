"""The notebooks run from their first cell to their last, with the assertions in them."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

FOLDER = Path(__file__).resolve().parents[1] / "notebooks"
BOOKS = sorted(FOLDER.glob("*.ipynb"))


def test_there_are_three_notebooks():
    assert len(BOOKS) == 3


@pytest.mark.parametrize("path", BOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, monkeypatch, tmp_path):
    # Their pictures and results go where pytest removes them.
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setenv("MPLBACKEND", "agg")
    book = nbformat.read(path, as_version=4)
    assert not any(cell.get("outputs") for cell in book.cells), "committed without outputs"
    resources = {"metadata": {"path": str(FOLDER)}}
    NotebookClient(book, timeout=300, resources=resources).execute()
    pictures = list(tmp_path.rglob(f"{path.stem}.png"))
    assert len(pictures) == 1 and pictures[0].stat().st_size > 10_000
