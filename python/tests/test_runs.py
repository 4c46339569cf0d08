"""Runs from Python: the bits of the command line, its words, and what is set while they go on."""

import signal
import subprocess
import sys
import textwrap
import threading

import numpy as np
import pytest

import calcine

from bits import by_command, same_bits
from conftest import ROOT


def test_a_run_has_the_bits_of_the_command(column, command, tmp_path):
    seen = []
    results = column.run(tmp_path / "python", progress=lambda *now: seen.append(now))
    done = by_command(command, column, tmp_path / "command")
    assert done.returncode == 0, done.stderr
    same_bits(results.folder, tmp_path / "command")
    assert len(seen) == 40 and seen[-1] == pytest.approx((2.0, 2.0))


def test_a_resumed_run_has_the_bits_of_an_uninterrupted_one(column, tmp_path):
    whole = column.run(tmp_path / "whole")
    with column.start(tmp_path / "parts") as simulation:
        simulation.advance_to(0.9)
        assert simulation.ending is None
    assert simulation.ending == "checkpointed" and simulation.folder == tmp_path / "parts"
    again = column.start(tmp_path / "parts", resume=True)
    assert again.windows == 18
    assert again.run() == "finished"
    again.close()
    assert again.ending == "finished"
    same_bits(whole.folder, tmp_path / "parts")
    page = whole.report()
    assert page == whole.folder / "report.html" and "mean_temperature" in page.read_text("utf-8")


def test_what_is_wrong_with_a_case_is_said_in_the_words_of_the_command(column, command, tmp_path):
    wrong = column.set("particles.spheres.diameter", 2).set("time.acceleration", -1)
    done = by_command(command, wrong, tmp_path / "command")
    for act in (wrong.check, lambda: wrong.start(tmp_path / "python")):
        with pytest.raises(calcine.CaseError) as raised:
            act()
        assert raised.value.exit_code == done.returncode == 2
        assert str(raised.value).strip() in done.stderr


def test_a_refused_value_changes_nothing_and_the_run_goes_on(column, tmp_path):
    with column.start(tmp_path / "run") as simulation:
        with pytest.raises(calcine.CalcineError, match="no patch `botom`; it has"):
            simulation.set_boundary("botom", temperature=300.0)
        with pytest.raises(TypeError, match="has no `colour`"):
            simulation.set_boundary("bottom", colour=1.0)
        assert simulation.step() is None


def test_a_boundary_value_holds_from_the_next_window_on(column, tmp_path):
    with column.start(tmp_path / "warm") as warm, column.start(tmp_path / "cold") as cold:
        warm.set_boundary("bottom", temperature=500.0)
        for simulation in (warm, cold):
            simulation.advance_to(1.0)
        assert warm.particles.temperature[0] > cold.particles.temperature[0] + 1.0


def test_arrays_cannot_be_written_and_stay_as_they_are(column, tmp_path):
    with column.start(tmp_path / "run") as simulation:
        simulation.step()
        before = simulation.gas.temperature
        kept = before.copy()
        with pytest.raises(ValueError, match="read-only"):
            before[0] = 0.0
        simulation.advance_to(0.5)
        assert np.array_equal(before, kept)
        assert not np.array_equal(simulation.gas.temperature, kept)
        assert simulation.gas.velocity.shape == (len(simulation.mesh), 3)
        assert simulation.particles.position.shape == (len(simulation.particles), 3)
        assert not simulation.particles.position.flags.writeable
    # The arrays outlive the simulation.
    assert np.array_equal(before, kept)
    with pytest.raises(ValueError, match="closed"):
        simulation.step()


def test_other_threads_of_python_go_on_during_a_window(column, tmp_path):
    ended = threading.Event()
    with column.start(tmp_path / "run") as simulation:
        runner = threading.Thread(target=lambda: (simulation.run(), ended.set()))
        runner.start()
        counted = 0
        while not ended.is_set():
            counted += 1
        runner.join()
    assert counted > 0
    assert calcine.Results(tmp_path / "run").summary["windows"] == 40


def test_ctrl_c_leaves_a_checkpoint_from_which_the_same_bits_follow(column, tmp_path):
    program = textwrap.dedent(
        """
        import os, signal, sys
        import calcine
        case = calcine.Case(sys.argv[1], tuple(sys.argv[3:]))
        def progress(time, end):
            if time > 0.9:
                os.kill(os.getpid(), signal.SIGINT)
        case.run(sys.argv[2], progress=progress)
        """
    )
    line = [sys.executable, "-c", program, column.path, tmp_path / "parts", *column.changes]
    done = subprocess.run(line, capture_output=True, text=True, timeout=300, cwd=tmp_path)
    assert "KeyboardInterrupt" in done.stderr and done.returncode in (-signal.SIGINT, 130), done
    again = column.start(tmp_path / "parts", resume=True)
    assert 0.9 < again.time < 1.1
    again.run()
    again.close()
    same_bits(column.run(tmp_path / "whole").folder, tmp_path / "parts")


def test_results_have_units_and_the_last_committed_state(column, tmp_path):
    with column.start(tmp_path / "run") as simulation:
        simulation.run()
        gas, particles = simulation.gas.temperature, simulation.particles.temperature
    results = calcine.Results(tmp_path / "run")
    fields = results.fields()
    assert fields["temperature"].attrs["units"] == "K"
    assert fields["velocity"].dims == ("process_time", "cell", "component")
    assert np.array_equal(fields["temperature"].isel(process_time=-1), gas)
    assert np.array_equal(results.particles()["temperature"], particles)
    assert results.particles().attrs["units"]["position.x"] == "m"
    series = results.series()
    assert series.index[-1] == pytest.approx(2.0)
    assert results.series_xarray()["quantities.pressure_drop"].attrs["units"] == "Pa"
    with pytest.raises(calcine.CaseError, match="not the results folder"):
        calcine.Results(tmp_path)


def test_a_profile_has_the_means_of_layers(tmp_path):
    case = calcine.Case.from_file(ROOT / "cases/heated-bed.toml").set("time.end", "1 s")
    results = case.run(tmp_path / "run")
    line = results.plot_profile("temperature").lines[0]
    place, mean = line.get_data()
    fields = results.fields().isel(process_time=-1)
    assert np.all(np.diff(place) > 0) and 10 < len(place) < 100
    low = np.isclose(fields["z"], place[0])
    expected = np.average(fields["temperature"][low], weights=fields["cell_volume"][low])
    assert low.sum() > 20 and mean[0] == pytest.approx(float(expected), rel=1e-12)


def test_means_over_time_are_those_of_all_windows(column, tmp_path):
    case = column.set("output.means.from", "0.5 s").set("output.means.to", "1 s")
    case = case.set("output.means.gas", ["temperature", "velocity"])
    values = []
    with case.start(tmp_path / "run") as simulation:
        while simulation.step() is None:
            # Windows of 0.05 s, of which those that end up to 1 s lie in the interval.
            if 0.52 < simulation.time < 1.02:
                values.append(simulation.gas.temperature)
        with pytest.raises(calcine.CaseError, match="output.means"):
            column.run(tmp_path / "without").means()
    assert len(values) == 10
    means = calcine.Results(tmp_path / "run").means()
    assert means.attrs == {"from": 0.5, "to": 1.0, "averaged": pytest.approx(0.5)}
    assert means["temperature_mean"].attrs["units"] == "K"
    assert means["velocity_mean"].dims == ("cell", "component")
    np.testing.assert_allclose(means["temperature_mean"], np.mean(values, axis=0), rtol=1e-12)
    # Fluctuations of a millionth of the temperature are known to 1e-10 of themselves by the squares of the snapshots.
    np.testing.assert_allclose(means["temperature_rms"], np.std(values, axis=0), rtol=1e-6, atol=1e-9)
