"""Runs by the command, and what makes two results folders the same."""

import subprocess

import h5py


def by_command(command, case, out, *more):
    changes = [word for change in case.changes for word in ("--set", change)]
    line = [command, "run", case.path, "--out", out, "--quiet", *changes, *more]
    return subprocess.run(line, capture_output=True, text=True, timeout=300)


def datasets(path):
    found = {}
    with h5py.File(path, locking=False) as store:
        store.visititems(
            lambda name, one: found.update({name: one[()].tobytes()})
            if isinstance(one, h5py.Dataset)
            else None
        )
    return found


def state(checkpoint):
    """The files of a checkpoint, save the sums, which are of them all and of wall times too."""
    files = (path for path in checkpoint.rglob("*") if path.is_file())
    names = {str(path.relative_to(checkpoint)): path.read_bytes() for path in files}
    return {name: held for name, held in names.items() if name != "SHA256SUMS"}


def same_bits(one, other):
    assert (one / "series.csv").read_bytes() == (other / "series.csv").read_bytes()
    assert datasets(one / "results.h5") == datasets(other / "results.h5")
    kept, others = state(one / "checkpoint"), state(other / "checkpoint")
    assert len(kept) > 2
    assert kept.keys() == others.keys()
    assert [name for name in kept if kept[name] != others[name]] == []
