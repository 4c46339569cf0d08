#!/usr/bin/env python3
"""Reference values of gas reactions, by Cantera, an independent code with its own thermodynamics.

From this folder, with Cantera 3.2.0 (pip install cantera==3.2.0):

    python3 references.py

writes ignition.csv, equilibrium.csv, rates.csv and stirred.csv. A test tool: nothing of it runs in Calcine's tests, which read the
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


def stirred(gas, inflow, start, residence, density=None):
    """Steady stirred reactor of one volume, found from a start; the residence time is that of gas of a density, else the inflow's."""
    parts = dict(thermo="ideal-gas", kinetics="gas", species=gas.species(), reactions=gas.reactions())
    entering, inside, leaving = ct.Solution(**parts), ct.Solution(**parts), ct.Solution(**parts)
    entering.TPY, inside.TPY, leaving.TPY = inflow, start, start
    flow = (density or entering.density) / residence
    # [CH4]^0.5 has an infinite slope at its end, which no integration passes: without methane its reactions are left out.
    for k, reaction in enumerate(inside.reactions()):
        ends = "CH4" in reaction.reactants and inflow[2][inside.species_index("CH4")] == 0.0
        inside.set_multiplier(0.0 if ends else 1.0, k)
    up, down = ct.Reservoir(entering, clone=False), ct.Reservoir(leaving, clone=False)
    reactor = ct.IdealGasReactor(inside, clone=False)
    inlet = ct.MassFlowController(up, reactor, mdot=flow)
    ct.PressureController(reactor, down, primary=inlet, K=1e-3 * flow)
    net = ct.ReactorNet([reactor])
    net.rtol, net.atol = 1e-10, 1e-15
    net.max_steps = 1_000_000
    net.advance(100 * residence)
    return inside.T, dict(zip(SPECIES, inside[SPECIES].Y))


def one_step(base):
    """CH4 + 2 O2 and H2 + 1/2 O2, each with k = 1e9 m3/mol/s exp(-100 kJ/mol/RT) [fuel] [O2]."""
    steps = []
    for equation, fuel in [("CH4 + 2 O2 => CO2 + 2 H2O", "CH4"), ("H2 + 0.5 O2 => H2O", "H2")]:
        step = ct.Reaction(equation=equation, rate=ct.ArrheniusRate(1e12, 0.0, 1e8))
        step.orders = {fuel: 1.0, "O2": 1.0}
        steps.append(step)
    return ct.Solution(thermo="ideal-gas", kinetics="gas", species=base.species(), reactions=steps)


def write_stirred():
    """Chains of three stirred reactors from hot burnt gas, the residence time at which one goes out, and CHM-3."""
    columns = ",".join("Y_" + name for name in SPECIES)
    with open("stirred.csv", "w") as out:
        out.write(HEAD + "case,residence_s,cell,T_K," + columns + "\n")

        def line(case, residence, cell, found):
            values = ",".join(f"{max(found[1][name], 0.0):.10e}" for name in SPECIES)
            out.write(f"{case},{residence:.8e},{cell},{found[0]:.6f},{values}\n")

        gas = ct.Solution("jones-lindstedt.yaml")
        gas.TPX = 1800.0, ct.one_atm, {"O2": 0.4, "CO2": 0.8, "H2O": 1.6, "N2": 7.52}
        hot = gas.TPY
        gas.TPX = 300.0, ct.one_atm, {"CH4": 0.8, "O2": 2.0, "N2": 7.52}
        fresh, density = gas.TPY, gas.density
        for exponent in range(-6, 2):
            inflow = fresh
            for cell in range(3):
                found = stirred(gas, inflow, hot, 10.0**exponent, density)
                line("chain", 10.0**exponent, cell, found)
                gas.TPY = found[0], ct.one_atm, {k: y if y > 1e-6 else 0.0 for k, y in found[1].items()}
                inflow = gas.TPY
        short, long = 1e-4, 1e-3
        while long / short > 1.0001:
            middle = (short * long) ** 0.5
            lit = stirred(gas, fresh, hot, middle)[0] > 1000.0
            short, long = (short, middle) if lit else (middle, long)
        for share in [0.98, 1.02]:
            line("blow-out", share * long, 0, stirred(gas, fresh, hot, share * long))
        gas = one_step(gas)
        # phi 0.8 of CH4 and H2, 70 to 30.
        oxygen = (0.7 * 2.0 + 0.3 * 0.5) / 0.8
        gas.TPX = 2000.0, ct.one_atm, {"CO2": 0.7, "H2O": 1.7, "O2": oxygen - 1.55, "N2": 3.76 * oxygen}
        hot = gas.TPY
        gas.TPX = 500.0, ct.one_atm, {"CH4": 0.7, "H2": 0.3, "O2": oxygen, "N2": 3.76 * oxygen}
        for residence in [1e-3, 1e-2, 1e-1]:
            line("flame", residence, 0, stirred(gas, gas.TPY, hot, residence))


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
    write_stirred()


main()
