"""Beds from Python: external solvers, feeds and outlets, mixtures, what is inside particles, quantities of the case."""

import math

import numpy as np
import pytest

import calcine

from bits import by_command, same_bits
from conftest import ROOT


@pytest.mark.parametrize(
    ("gas", "particles"), [("openfoam", "native"), ("native", "liggghts"), ("openfoam", "liggghts")]
)
def test_external_solvers_give_the_bits_of_the_command(column, command, tmp_path, gas, particles):
    results = column.run(tmp_path / "python", gas=gas, particles=particles)
    done = by_command(command, column, tmp_path / "command", "--gas", gas, "--particles", particles)
    assert done.returncode == 0, done.stderr
    same_bits(results.folder, tmp_path / "command")


@pytest.fixture
def moving() -> calcine.Case:
    """Ten seconds of a shaft with a feed and an outlet, in windows of half a second."""
    case = calcine.Case.from_file(ROOT / "cases/moving-bed.toml")
    return case.set("time.end", "10 s").set("output.series_every", "0.5 s")


def test_feeds_and_outlets_are_set_while_a_run_goes_on(moving, tmp_path):
    with moving.start(tmp_path / "run") as simulation:
        assert simulation.populations == ["beads"]
        simulation.set_outlet_rate("discharge", 0.0)
        with pytest.raises(calcine.CalcineError, match="no feed `chrge`"):
            simulation.set_feed("chrge", rate=0.01)
        simulation.advance_to(2.0)
        held = set(simulation.particles.id)
        simulation.set_feed("charge", rate=0.005, temperature=555.0)
        simulation.advance_to(6.0)
        now = simulation.particles
        new = ~np.isin(now.id, list(held))
        # 5 g/s over four seconds, but for what of the last beads is not there yet.
        assert now.mass[new].sum() == pytest.approx(0.02, abs=2 * now.mass.max())
        assert set(held) <= set(now.id)
        assert now.temperature[new].max() == pytest.approx(555.0, abs=5.0)
        simulation.set_outlet_rate("discharge", math.inf)
        before = len(now)
        simulation.step()
        assert len(simulation.particles) < before


def test_quantities_are_those_of_the_series(moving, tmp_path):
    rows = []
    with moving.start(tmp_path / "run") as simulation:
        rows.append(simulation.quantities)
        while simulation.step() is None:
            rows.append(simulation.quantities)
        rows.append(simulation.quantities)
    series = calcine.Results(tmp_path / "run").series()
    names = [name for name in series.columns if name.startswith("quantities.")]
    assert len(names) > 2 and len(series) == len(rows)
    for name in names:
        told = [row[name.removeprefix("quantities.")] for row in rows]
        np.testing.assert_array_equal(told, series[name])


def test_what_is_inside_particles_is_that_of_the_snapshot(tmp_path):
    case = calcine.Case.from_file(ROOT / "cases/lime-burning.toml")
    case = case.set("time.end", "5 min").set("output.particles", ["inside", "mass"])
    with case.start(tmp_path / "run") as simulation:
        with pytest.raises(calcine.CalcineError, match="1 mass fractions .* 3 are needed"):
            simulation.set_boundary("bottom", composition=[1.0])
        simulation.run()
        particles, gas = simulation.particles, simulation.gas
        inside = particles.inside
        assert "CaCO3" in inside and 0.0 < inside["CaCO3"].min() < inside["CaCO3"].max() <= 1.0
        assert not inside["CaCO3"].flags.writeable
        assert np.all(particles.weight == 1.0)
        assert gas.mass_fractions.shape == (len(simulation.mesh), len(gas.species))
        species, fractions = gas.species, gas.mass_fractions
        np.testing.assert_allclose(fractions.sum(axis=1), 1.0, rtol=1e-12)
    results = calcine.Results(tmp_path / "run")
    snapshot = results.particles()
    for name, values in inside.items():
        if values.ndim == 1:
            np.testing.assert_array_equal(values, snapshot[name])
    fields = results.fields().isel(process_time=-1)
    for column, name in enumerate(species):
        np.testing.assert_array_equal(fractions[:, column], fields[name])


def test_beads_that_roll_have_the_spin_that_the_case_measures(tmp_path):
    case = calcine.Case.from_file(ROOT / "cases/rotating-drum.toml").set("time.end", "20 ms")
    measure = '[{ name = "spin", measure = { particles = "angular_speed", statistic = "mean" } }]'
    with case.set("quantities", measure).start(tmp_path / "run") as simulation:
        simulation.advance_to(0.01)
        spin = np.linalg.norm(simulation.particles.angular_velocity, axis=1)
        assert len(spin) == len(simulation.particles) and spin.mean() > 1e-3
        assert simulation.quantities["spin"] == pytest.approx(spin.mean(), rel=1e-12)


def test_profiles_of_cells_without_layers_are_means_over_fifty():
    place = np.random.default_rng(1).uniform(2.0, 3.0, 4000)
    volume = np.random.default_rng(2).uniform(1.0, 2.0, 4000)
    middle, mean = calcine.results._layers(place, 3.0 * place - 1.0, volume)
    assert len(middle) == 50 and np.all(np.abs(np.diff(middle) - 0.02) < 0.005)
    np.testing.assert_allclose(mean, 3.0 * middle - 1.0, rtol=1e-12)


def test_parcels_have_their_weights_and_shells_a_column_each(tmp_path):
    case = calcine.Case.from_file(ROOT / "cases/parcel-bed.toml").set("time.end", "10 ms")
    with case.start(tmp_path / "parcels") as simulation:
        simulation.step()
        assert np.all(simulation.particles.weight == 43.0)
        # Parcels do not spin.
        spin = simulation.particles.angular_velocity
        assert spin.shape == (len(simulation.particles), 3) and not spin.any()
    case = calcine.Case.from_file(ROOT / "cases/calcining-stone.toml").set("time.end", "10 s")
    with case.start(tmp_path / "stone") as simulation:
        simulation.step()
        tables = [one for one in simulation.particles.inside.values() if one.ndim == 2]
        assert tables and all(len(one) == len(simulation.particles) for one in tables)
