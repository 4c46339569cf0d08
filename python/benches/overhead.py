"""Overhead of runs from Python over `calcine run`: whole processes in turn, with the same bits.

CALCINE=target/release/calcine PYTHONPATH=... python3 python/benches/overhead.py [ROUNDS] [CASE [KEY=VALUE ...]]

Each round runs the case by the command, by `Case.run`, and window by window with a look at the gas and the particles after each. Of all
rounds it prints the smallest processor time of each (which is disturbed least), that of its start apart, and the share beyond the command's.
"""

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
START = "import calcine\n"
RUN = START + "calcine.Case.from_file({case!r}){changes}.run({out!r})\n"
STEPS = (
    START
    + """with calcine.Case.from_file({case!r}){changes}.start({out!r}) as simulation:
    while simulation.step() is None:
        simulation.gas.temperature.max(), simulation.particles.temperature.mean()
"""
)


def processor_time(command: list[str]) -> float:
    """User and system time in s of a process that must succeed."""

    def used() -> float:
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    before = used()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, timeout=3600)
    return used() - before


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    case = sys.argv[2] if len(sys.argv) > 2 else str(ROOT / "cases/moving-bed.toml")
    changes = sys.argv[3:]
    keys = [change.split("=", 1) for change in changes]
    made = "".join(f".set({key!r}, {value!r})" for key, value in keys)
    words = [word for change in changes for word in ("--set", change)]
    best: dict[str, float] = {}
    series: dict[str, bytes] = {}
    with tempfile.TemporaryDirectory() as folder:
        for number in range(rounds):
            out = {name: f"{folder}/{name}-{number}" for name in ("command", "run", "steps")}
            fill = {name: {"case": case, "changes": made, "out": out[name]} for name in out}
            commands = {
                "command": [os.environ["CALCINE"], "run", "--quiet", case, "--out", out["command"], *words],
                "start": [sys.executable, "-c", START],
                "run": [sys.executable, "-c", RUN.format(**fill["run"])],
                "steps": [sys.executable, "-c", STEPS.format(**fill["steps"])],
            }
            for name, command in commands.items():
                best[name] = min(best.get(name, float("inf")), processor_time(command))
                if name in out:
                    series[name] = Path(out[name], "series.csv").read_bytes()
            if len(set(series.values())) != 1:
                sys.exit("the series differ")
    command, start = best["command"], best["start"]
    print(f"calcine run: {command:.3f} s; start of Python with the package: {start:.3f} s")
    for name in ("run", "steps"):
        beyond = best[name] - start - command
        print(f"{name}: {best[name]:.3f} s, beyond both {beyond:+.3f} s, {100 * beyond / command:+.2f} %")


if __name__ == "__main__":
    main()
