//! Contacts and gaps as bonds.

use calcine_numerics::parallel::fill;
use calcine_physics::conduction::{SphereContact, SphereGap};

use super::{HeatLaws, HeatNetwork, NeighbourPair, NetworkSurroundings, ThermalProperties};

impl HeatNetwork {
    /// Contacts and gaps at the temperatures of the start, in K.
    pub(super) fn conduct(&mut self, old: &[f64], surroundings: &NetworkSurroundings<'_>) {
        let Self {
            laws,
            materials,
            material,
            walls,
            work,
            ..
        } = self;
        work.bonds.clear();
        work.reservoir_links.clear();
        work.conductance.resize(self.pairs.len(), 0.0);
        fill(&mut work.conductance, |pair| {
            let touch = &self.pairs[pair];
            let [i, j] = touch.particles;
            let of = [i, j].map(|p| &materials[material[p]]);
            let conductivity = [of[0].conductivity.at(old[i]), of[1].conductivity.at(old[j])];
            let gas = [i, j].map(|p| surroundings.gas_conductivity[p]);
            let gas = 2.0 * gas[0] * gas[1] / (gas[0] + gas[1]);
            conductance(laws, of, touch.radius, touch.overlap, conductivity, gas)
        });
        let bonds = self.pairs.iter().zip(&work.conductance);
        let conducting = bonds.filter(|(_, g)| **g > 0.0);
        let bond = |(touch, g): (&NeighbourPair, &f64)| (touch.particles, *g);
        work.bonds.extend(conducting.map(bond));
        for touch in &self.wall_touches {
            let (i, reservoir) = (touch.particle, touch.reservoir);
            let Some(&wall) = walls.get(reservoir) else {
                continue;
            };
            let of = [&materials[material[i]], &materials[wall]];
            let kelvin = [old[i], surroundings.reservoirs[reservoir]];
            let conductivity = [0, 1].map(|k| of[k].conductivity.at(kelvin[k]));
            let radius = [touch.radius, f64::INFINITY];
            let gas = surroundings.gas_conductivity[i];
            let g = conductance(laws, of, radius, touch.overlap, conductivity, gas);
            if g > 0.0 {
                work.reservoir_links.push(([i, reservoir], g));
            }
        }
    }
}

/// Conductance in W/K of contact and gap of two spheres.
fn conductance(
    laws: &HeatLaws,
    of: [&ThermalProperties; 2],
    radius: [f64; 2],
    overlap: f64,
    conductivity: [f64; 2],
    gas_conductivity: f64,
) -> f64 {
    let density = of.map(|one| one.density);
    let (soft, real) = (of.map(|one| one.soft), of.map(|one| one.real));
    let contact = SphereContact {
        radius,
        overlap: laws.area.overlap(radius, overlap, density, soft, real),
        conductivity,
    };
    let through = match contact.overlap > 0.0 {
        true => laws.conduction.conductance(&contact),
        false => 0.0,
    };
    let gap = SphereGap {
        radius,
        distance: match contact.overlap > 0.0 {
            true => -contact.overlap,
            false => -overlap,
        },
        contact_radius: (contact.reduced_radius() * contact.overlap).sqrt(),
        conductivity,
        gas_conductivity,
    };
    through + laws.gap.conductance(&gap)
}
