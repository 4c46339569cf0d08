//! The small cases of the agreement tests, as text.

/// Laws, coupling and results of all cases; one population of small beads.
fn rest(particles: &str) -> String {
    format!(
        r#"
[materials.glass]
density = "2500 kg/m^3"
heat_capacity = "840 J/kg/K"
[[particles]]
name = "beads"
material = "glass"
diameter = "4 mm"
motion = "frozen"
place = {{ grid = {{ {particles} }} }}
temperature = "300 K"
[laws]
drag = {{ law = "ergun-wen-yu" }}
heat_transfer = {{ law = "gunn" }}
conduction = {{ law = "none" }}
radiation = {{ law = "none" }}
[coupling]
mapping = "overlap"
smoother = {{ max_solid_fraction = 0.64 }}
[output]
every = "0.5 s"
series_every = "0.1 s"
gas = ["temperature", "velocity", "pressure"]
particles = ["temperature"]
"#
    )
}

const DROP: &str = r#"
[[quantities]]
name = "pressure_drop"
measure = { difference = "pressure", patches = ["bottom", "top"] }
"#;

/// Air whose mass flow and temperature rise, through a bed in a duct with walls of a given temperature,
/// into a pressure that rises too.
pub fn duct(convection: &str) -> String {
    let beads = r#"first = "5 5 15 mm", spacing = "5 5 5 mm", counts = [3, 3, 5]"#;
    format!(
        r#"format = 1
title = "Hot gas of a given mass flow in a cold duct"
[time]
end = "2 s"
motion_window = "5 ms"
acceleration = 20
gas_storage = "process"
[mesh]
box = {{ size = "20 20 60 mm", cells = [4, 4, 12], patches = ["side", "side", "side", "side", "bottom", "top"] }}
[gas]
mixture = "air"
initial = {{ temperature = "300 K", pressure = "1 atm", velocity = "0 0 0.3 m/s" }}
controls = {{ outer_iterations = 60, outer_tolerance = 1e-7, linear_tolerance = 1e-13, convection = "{convection}" }}
[gas.patch.bottom]
inlet = {{ mass_flow = [["0 s", "0.4 kg/h"], ["1 s", "0.8 kg/h"]], temperature = [["0 s", "300 K"], ["1 s", "400 K"]] }}
[gas.patch.top]
outlet = {{ pressure = [["0 s", "1 atm"], ["1 s", "1.001 atm"]] }}
[gas.patch.side]
wall = {{ velocity = "no-slip", heat = {{ temperature = "310 K" }} }}
{}{DROP}"#,
        rest(beads)
    )
}

/// Air over a heated floor between openings on both sides and above: a plume that draws air in.
pub fn open_box(convection: &str) -> String {
    let beads = r#"first = "50 10 30 mm", spacing = "5 5 5 mm", counts = [1, 1, 1]"#;
    let opening = r#"opening = { pressure = "1 atm", temperature = "300 K" }"#;
    format!(
        r#"format = 1
title = "A plume of air in an open box"
[time]
end = "1 s"
motion_window = "5 ms"
acceleration = 1
[mesh]
box = {{ size = "100 20 100 mm", cells = [10, 2, 10], patches = ["west", "east", "side", "side", "floor", "top"] }}
[gas]
mixture = "air"
gravity = "0 0 -9.81 m/s^2"
initial = {{ temperature = "300 K", pressure = "1 atm" }}
controls = {{ outer_iterations = 100, outer_tolerance = 1e-9, linear_tolerance = 1e-13, convection = "{convection}" }}
[gas.patch.west]
{opening}
[gas.patch.east]
{opening}
[gas.patch.top]
{opening}
[gas.patch.floor]
wall = {{ velocity = "no-slip", heat = {{ flux = "500 W/m^2" }} }}
[gas.patch.side]
wall = {{ velocity = "slip", heat = "adiabatic" }}
{}
[[quantities]]
name = "hottest"
measure = {{ gas = "temperature", statistic = "max" }}
[[quantities]]
name = "fastest"
measure = {{ gas = "speed", statistic = "max" }}
"#,
        rest(beads)
    )
}

/// Hydrogen between two outlets of unlike pressures, of which the upper one lets another gas back in.
pub fn backflow() -> String {
    let beads = r#"first = "5 5 15 mm", spacing = "5 5 5 mm", counts = [3, 3, 5]"#;
    format!(
        r#"format = 1
title = "Gas that comes back in through an outlet"
[time]
end = "1 s"
motion_window = "5 ms"
acceleration = 2
[mesh]
box = {{ size = "20 20 60 mm", cells = [4, 4, 12], patches = ["side", "side", "side", "side", "bottom", "top"] }}
[gas]
mixture = "purge"
species = ["H2", "N2", "CO2"]
schmidt = 0.7
initial = {{ temperature = "300 K", pressure = "1 atm", composition = {{ mole = {{ H2 = 1 }} }} }}
controls = {{ outer_iterations = 60, outer_tolerance = 1e-7, linear_tolerance = 1e-13 }}
[gas.patch.bottom]
outlet = {{ pressure = "1 atm" }}
[gas.patch.top]
outlet = {{ pressure = "1.00001 atm", backflow = {{ temperature = "350 K", composition = {{ mole = {{ CO2 = 0.5, N2 = 0.5 }} }} }} }}
[gas.patch.side]
wall = {{ velocity = "slip", heat = "adiabatic" }}
{}{DROP}"#,
        rest(beads)
    )
}

/// Hot hydrogen and nitrogen drive carbon dioxide out of a bed: unlike molar masses, heat capacities and
/// viscosities, slow enough for diffusion to matter at the inlet.
pub fn purge(convection: &str) -> String {
    let beads = r#"first = "5 5 15 mm", spacing = "5 5 5 mm", counts = [3, 3, 5]"#;
    format!(
        r#"format = 1
title = "Hydrogen and nitrogen purge carbon dioxide from a bed"
[time]
end = "1 s"
motion_window = "5 ms"
acceleration = 10
gas_storage = "process"
[mesh]
box = {{ size = "20 20 60 mm", cells = [2, 2, 12], patches = ["side", "side", "side", "side", "bottom", "top"] }}
[gas]
mixture = "purge"
species = ["N2", "H2", "CO2"]
schmidt = 0.4
initial = {{ temperature = "300 K", pressure = "1 atm", velocity = "0 0 0.1 m/s", composition = {{ mole = {{ CO2 = 1 }} }} }}
controls = {{ outer_iterations = 80, outer_tolerance = 1e-8, linear_tolerance = 1e-13, convection = "{convection}" }}
[gas.patch.bottom]
inlet = {{ superficial_velocity = "0.1 m/s", temperature = [["0 s", "300 K"], ["0.5 s", "400 K"]], composition = [["0 s", {{ mole = {{ CO2 = 1 }} }}], ["0.4 s", {{ mole = {{ H2 = 0.5, N2 = 0.5 }} }}]] }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.side]
wall = {{ velocity = "no-slip", heat = {{ temperature = "310 K" }} }}
{}{DROP}"#,
        rest(beads).replace(r#""pressure"]"#, r#""pressure", "mass_fractions"]"#)
    )
}

/// The same bed in a tube, whose cells are skewed, with a finer zone across the bed's end.
pub fn tube() -> String {
    let beads = r#"first = "-4.5 -4.5 15 mm", spacing = "4.5 4.5 5 mm", counts = [3, 3, 4]"#;
    format!(
        r#"format = 1
title = "Hot gas in a tube with finer cells"
[time]
end = "2 s"
motion_window = "5 ms"
acceleration = 20
gas_storage = "process"
[mesh]
cylinder = {{ diameter = "20 mm", length = "50 mm", cells = [6, 10], refine = [{{ cylinder = {{ from = "0 0 20 mm", to = "0 0 40 mm", radius = "5 mm" }} }}] }}
[gas]
mixture = "air"
initial = {{ temperature = "300 K", pressure = "1 atm", velocity = "0 0 0.5 m/s" }}
controls = {{ outer_iterations = 60, outer_tolerance = 1e-7, linear_tolerance = 1e-13 }}
[gas.patch.bottom]
inlet = {{ superficial_velocity = "0.5 m/s", temperature = [["0 s", "300 K"], ["1 s", "400 K"]] }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.side]
wall = {{ velocity = "no-slip", heat = {{ coefficient = "20 W/m^2/K", ambient = "300 K" }} }}
{}{DROP}"#,
        rest(beads)
    )
}

/// Air in a closed box heated by its floor: it circulates, and its pressure rises.
pub fn heated_box(side: &str, convection: &str) -> String {
    let beads = r#"first = "7 10 10 mm", spacing = "6 6 6 mm", counts = [1, 1, 1]"#;
    format!(
        r#"format = 1
title = "A closed box of air, heated by its floor"
[time]
end = "2 s"
motion_window = "10 ms"
gas_storage = "process"
[mesh]
box = {{ size = "20 20 20 mm", cells = [5, 5, 5], patches = ["side", "side", "side", "side", "floor", "lid"] }}
[gas]
mixture = "air"
initial = {{ temperature = "300 K", pressure = "1 atm" }}
gravity = "0 0 -9.81 m/s^2"
controls = {{ outer_iterations = 60, outer_tolerance = 1e-8, linear_tolerance = 1e-13, convection = "{convection}" }}
[gas.patch.side]
wall = {{ velocity = "{side}", heat = "adiabatic" }}
[gas.patch.floor]
wall = {{ velocity = "no-slip", heat = {{ temperature = [["0 s", "300 K"], ["0.5 s", "400 K"]] }} }}
[gas.patch.lid]
wall = {{ velocity = "no-slip", heat = {{ coefficient = "20 W/m^2/K", ambient = "300 K" }} }}
{}"#,
        rest(beads)
    )
}

/// Turbulent air through a duct with walls, over beads that leave it free (`held`) or make a bed of its
/// middle, into which eddies do not go.
pub fn turbulent_duct(particles: &str, heat: &str, every: &str) -> String {
    format!(
        r#"format = 1
title = "Turbulent air in a duct"
[time]
end = "0.3 s"
motion_window = "1 ms"
[mesh]
box = {{ size = "20 10 200 mm", cells = [6, 1, 24], patches = ["wall", "axis", "side", "side", "bottom", "top"] }}
[gas]
mixture = "air"
initial = {{ temperature = "300 K", pressure = "1 atm", velocity = "0 0 8 m/s" }}
turbulence = {{ model = "k-epsilon", initial = {{ energy = "0.5 m^2/s^2", length_scale = "2 mm" }} }}
controls = {{ outer_iterations = 60, outer_tolerance = 1e-8, linear_tolerance = 1e-13, convection = "upwind" }}
[gas.patch.bottom]
inlet = {{ superficial_velocity = "8 m/s", temperature = [["0 s", "300 K"], ["0.1 s", "400 K"]], turbulence = {{ intensity = 0.1, length_scale = "2 mm" }} }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.wall]
wall = {{ velocity = "no-slip", heat = {heat} }}
[gas.patch.axis]
symmetry = {{}}
[gas.patch.side]
symmetry = {{}}
{}{DROP}"#,
        rest(particles)
            .replace(r#""pressure"]"#, r#""pressure", "turbulence"]"#)
            .replace(r#"every = "0.5 s""#, &format!("every = \"{every}\""))
    )
}

/// Hot methane and air through a duct with eddies, past one bead: it lights and burns by the four steps, all of it (`laminar`)
/// or what eddies mix of it (`pasr`).
pub fn stirred_duct(model: &str) -> String {
    let bead = r#"first = "10 5 45 mm", spacing = "5 5 5 mm", counts = [1, 1, 1]"#;
    let model = match model {
        "pasr" => r#"model = "pasr", mixing_constant = 2"#,
        _ => r#"model = "laminar""#,
    };
    format!(
        r#"format = 1
title = "Methane burns in a turbulent duct"
[time]
end = "10 ms"
motion_window = "0.2 ms"
[mesh]
box = {{ size = "20 10 50 mm", cells = [2, 1, 10], patches = ["wall", "axis", "side", "side", "bottom", "top"] }}
[gas]
mixture = "methane and air"
species = ["CH4", "O2", "CO", "H2", "CO2", "H2O", "N2"]
schmidt = 0.7
initial = {{ temperature = "1300 K", pressure = "1 atm", velocity = "0 0 8 m/s", composition = {{ mole = {{ CH4 = 0.05, O2 = 0.19, N2 = 0.76 }} }} }}
turbulence = {{ model = "k-epsilon", initial = {{ energy = "1 m^2/s^2", length_scale = "2 mm" }} }}
controls = {{ outer_iterations = 60, outer_tolerance = 1e-7, linear_tolerance = 1e-13, convection = "upwind" }}
chemistry = {{ mechanism = "jones-lindstedt", {model} }}
[gas.patch.bottom]
inlet = {{ superficial_velocity = "8 m/s", temperature = "1300 K", composition = {{ mole = {{ CH4 = 0.05, O2 = 0.19, N2 = 0.76 }} }}, turbulence = {{ intensity = 0.1, length_scale = "2 mm" }} }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.wall]
wall = {{ velocity = "no-slip", heat = "adiabatic" }}
[gas.patch.axis]
symmetry = {{}}
[gas.patch.side]
symmetry = {{}}
{}{DROP}
[[quantities]]
name = "methane"
measure = {{ gas = "mass_fraction", of = "CH4", statistic = "mean" }}
"#,
        rest(bead)
            .replace("ergun-wen-yu", "none")
            .replace("gunn", "none")
            .replace(
                r#""pressure"]"#,
                r#""pressure", "mass_fractions", "turbulence"]"#
            )
            .replace(r#"every = "0.5 s""#, r#"every = "10 ms""#)
            .replace(r#"series_every = "0.1 s""#, r#"series_every = "2 ms""#)
    )
}

/// Fresh methane and air of 300 K into a bed of 1900 K, where it lights and burns as far as the eddies of the bed, by a law, mix it.
pub fn burner_in_a_bed(law: &str) -> String {
    let beads = r#"first = "2.5 2.5 2.5 mm", spacing = "5 5 5 mm", counts = [4, 4, 10]"#;
    format!(
        r#"format = 1
title = "A burner in a bed"
[time]
end = "20 ms"
motion_window = "0.5 ms"
[mesh]
box = {{ size = "20 20 60 mm", cells = [2, 2, 12], patches = ["wall", "wall", "wall", "wall", "bottom", "top"] }}
[gas]
mixture = "methane and air"
species = ["CH4", "O2", "CO", "H2", "CO2", "H2O", "N2"]
schmidt = 0.7
initial = {{ temperature = "1800 K", pressure = "1 atm", velocity = "0 0 2 m/s", composition = {{ mole = {{ O2 = 0.0998, CO2 = 0.0499, H2O = 0.0998, N2 = 0.7505 }} }} }}
turbulence = {{ model = "k-epsilon", initial = {{ energy = "0.1 m^2/s^2", length_scale = "2 mm" }}, bed = {{ law = "{law}" }} }}
controls = {{ outer_iterations = 60, outer_tolerance = 1e-7, linear_tolerance = 1e-13, convection = "upwind" }}
chemistry = {{ mechanism = "jones-lindstedt", model = "pasr" }}
[gas.patch.bottom]
inlet = {{ superficial_velocity = "2 m/s", temperature = "300 K", composition = {{ mole = {{ CH4 = 0.08717, O2 = 0.19177, N2 = 0.72106 }} }}, turbulence = {{ intensity = 0.05, length_scale = "0.7 mm" }} }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.wall]
wall = {{ velocity = "no-slip", heat = "adiabatic" }}
{}{DROP}
[[quantities]]
name = "methane"
measure = {{ gas = "mass_fraction", of = "CH4", statistic = "mean" }}
"#,
        rest(beads)
            .replace(r#"temperature = "300 K""#, r#"temperature = "1900 K""#)
            .replace(
                r#""pressure"]"#,
                r#""pressure", "mass_fractions", "turbulence"]"#
            )
            .replace(r#"every = "0.5 s""#, r#"every = "20 ms""#)
            .replace(r#"series_every = "0.1 s""#, r#"series_every = "2 ms""#)
    )
}

/// Fresh methane and air into a duct of what a leaner gas has burnt to, past one bead, in windows far longer than the gas takes through it.
pub fn burner_duct() -> String {
    let bead = r#"first = "5 5 195 mm", spacing = "5 5 5 mm", counts = [1, 1, 1]"#;
    format!(
        r#"format = 1
title = "A burner in a duct"
[time]
end = "13.56 s"
motion_window = "10 ms"
acceleration = 678
gas_storage = "process"
[mesh]
box = {{ size = "10 10 200 mm", cells = [1, 1, 20], patches = ["side", "side", "side", "side", "bottom", "top"] }}
[gas]
mixture = "methane and air"
species = ["CH4", "O2", "CO", "H2", "CO2", "H2O", "N2"]
schmidt = 0.7
initial = {{ temperature = "1800 K", pressure = "1 atm", velocity = "0 0 2 m/s", composition = {{ mole = {{ O2 = 0.0998, CO2 = 0.0499, H2O = 0.0998, N2 = 0.7505 }} }} }}
controls = {{ outer_iterations = 10, outer_tolerance = 1e-7, linear_tolerance = 1e-13, convection = "upwind" }}
chemistry = {{ mechanism = "jones-lindstedt" }}
[gas.patch.bottom]
inlet = {{ superficial_velocity = "2 m/s", temperature = "300 K", composition = {{ mole = {{ CH4 = 0.08717, O2 = 0.19177, N2 = 0.72106 }} }} }}
[gas.patch.top]
outlet = {{ pressure = "1 atm" }}
[gas.patch.side]
symmetry = {{}}
{}"#,
        rest(bead)
            .replace("ergun-wen-yu", "none")
            .replace("gunn", "none")
            .replace(r#""4 mm""#, r#""0.5 mm""#)
            .replace(r#""pressure"]"#, r#""pressure", "mass_fractions"]"#)
            .replace(r#"every = "0.5 s""#, r#"every = "13.56 s""#)
            .replace(r#"series_every = "0.1 s""#, r#"series_every = "6.78 s""#)
    )
}
