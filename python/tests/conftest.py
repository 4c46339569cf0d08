import os
from pathlib import Path

import pytest

import calcine

ROOT = Path(__file__).resolve().parents[2]
SHORT = {
    "time.end": "2 s",
    "output.every": "0.7 s",
    "output.series_every": "0.1 s",
}


@pytest.fixture
def column() -> calcine.Case:
    """Forty windows of the heated column, 0.05 s each, with snapshots and rows among them."""
    case = calcine.Case.from_file(ROOT / "cases/heated-column.toml")
    for key, value in SHORT.items():
        case = case.set(key, value)
    return case


@pytest.fixture
def command() -> Path:
    """The program `calcine` that was built with the package."""
    return Path(os.environ["CALCINE"])
