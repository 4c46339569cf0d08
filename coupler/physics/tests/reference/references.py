#!/usr/bin/env python3
"""Reference values of gas reactions, by Cantera, an independent code with its own thermodynamics.

From this folder, with Cantera 3.2.0 (pip install cantera==3.2.0):

    python3 references.py

writes ignition.csv, equilibrium.csv and rates.csv. A test tool: nothing of it runs in Calcine's tests, which read the
tables only.
"""

import cantera as ct

HEAD = f"# Cantera {ct.__version__}, references.py; atomic weights and gas constant are Cantera's\n"
SPECIES = ["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"]
PHI = [0.6, 0.8, 1.0, 1.2, 1.4]
STARTS = [1200.0, 1350.0, 1500.0, 1650.0, 1800.0]


def fresh(gas, phi, temperature, pressure):
    """Methane and air of 21 and 79 parts, by moles."""
    gas.TPX = temperature, pressure, {"CH4": phi, "O2": 2.0, "N2": 2.0 * 79 / 21}


def network(gas, absolute):
    reactor = ct.IdealGasConstPressureReactor(gas, clone=False)
    net = ct.ReactorNet([reactor])
    net.rtol, net.atol = 1e-10, absolute
    net.max_steps = 1_000_000
    return reactor, net


def ignition(mechanism, phi, temperature, pressure):
    """Time at which the gas is 400 K hotter, and its temperature 20 ms after the fuel ended."""
    gas = ct.Solution(mechanism)
    fresh(gas, phi, temperature, pressure)
    reactor, net = network(gas, 1e-16)
    before = (0.0, temperature)
    while reactor.T < temperature + 400.0:
        before = (net.time, reactor.T)
        net.step()
    share = (temperature + 400.0 - before[1]) / (reactor.T - before[1])
    delay = before[0] + share * (net.time - before[0])
    # [CH4]^0.5 ends with an infinite slope: the last millionth of the fuel is taken away before.
    reactor, net = network(gas, 1e-14)
    while gas["CH4"].X[0] > 1e-7:
        net.step()
    rest = dict(zip(SPECIES, gas[SPECIES].Y))
    gas.TPY = gas.T, pressure, {**rest, "CH4": 0.0}
    reactor, net = network(gas, 1e-12)
    net.advance(0.02)
    return delay, reactor.T


def main():
    pressure = ct.one_atm
    with open("ignition.csv", "w") as out:
        out.write(HEAD + "phi,start_K,pressure_Pa,delay_s,end_K\n")
        for phi in PHI:
            for start in STARTS:
                for p in [pressure] if start != 1500.0 else [pressure, 10 * pressure]:
                    delay, end = ignition("jones-lindstedt.yaml", phi, start, p)
                    out.write(f"{phi},{start},{p:.1f},{delay:.8e},{end:.6f}\n")
    with open("equilibrium.csv", "w") as out:
        out.write(HEAD + "phi,start_K,pressure_Pa,end_K," + ",".join("X_" + s for s in SPECIES) + "\n")
        for phi in PHI:
            for start in [300.0, *STARTS]:
                gas = ct.Solution("jones-lindstedt.yaml")
                fresh(gas, phi, start, pressure)
                gas.equilibrate("HP", rtol=1e-12)
                row = ",".join(f"{x:.10e}" for x in gas[SPECIES].X)
                out.write(f"{phi},{start},{pressure:.1f},{gas.T:.6f},{row}\n")
    with open("rates.csv", "w") as out:
        out.write(HEAD + "mechanism,temperature_K,pressure_Pa,reaction,forth,back\n")
        mole = {"CH4": 0.05, "O2": 0.12, "CO": 0.03, "H2": 0.02, "H2O": 0.11, "CO2": 0.07, "N2": 0.6}
        for mechanism in ["jones-lindstedt", "kinds"]:
            for temperature, p in [(900.0, 1e5), (1500.0, 101325.0), (2200.0, 2e6)]:
                gas = ct.Solution(mechanism + ".yaml")
                gas.TPX = temperature, p, mole
                forth = 1e3 * gas.forward_rates_of_progress
                back = 1e3 * gas.reverse_rates_of_progress
                for k, (f, b) in enumerate(zip(forth, back)):
                    out.write(f"{mechanism},{temperature},{p:.1f},{k},{f:.12e},{b:.12e}\n")


main()
