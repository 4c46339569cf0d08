//! The energy budget of a bed.

use calcine_coupler::physics::Vec3;

/// What contacts store and dissipate, in J; sums over a block or a bed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactEnergy {
    /// In normal springs and cohesion now.
    pub elastic_normal: f64,
    /// In tangential springs now.
    pub elastic_tangential: f64,
    /// Lost in normal damping, and where adhesive contacts tear off.
    pub lost_normal: f64,
    /// Lost in sliding and tangential damping, with what a tangential spring loses or gains while its
    /// stiffness follows the overlap.
    pub lost_tangential: f64,
    /// Lost in rolling.
    pub lost_rolling: f64,
    /// Work of moving walls on particles.
    pub wall_work: f64,
    /// Work of gravity.
    pub gravity_work: f64,
    /// Work of the gas.
    pub push_work: f64,
}

impl ContactEnergy {
    /// Adds another budget.
    pub fn add(&mut self, other: &ContactEnergy) {
        self.elastic_normal += other.elastic_normal;
        self.elastic_tangential += other.elastic_tangential;
        self.lost_normal += other.lost_normal;
        self.lost_tangential += other.lost_tangential;
        self.lost_rolling += other.lost_rolling;
        self.wall_work += other.wall_work;
        self.gravity_work += other.gravity_work;
        self.push_work += other.push_work;
    }
}

/// The energy of a bed and what became of it since it was first counted, in J:
/// kinetic + rotational + elastic + lost − works is constant, up to the order of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BedEnergy {
    /// ½ m v², of particles that are not held.
    pub kinetic: f64,
    /// ½ I ω².
    pub rotational: f64,
    /// Momentum in kg m/s.
    pub momentum: Vec3,
    /// Contacts, walls, gravity and gas.
    pub contacts: ContactEnergy,
}

impl BedEnergy {
    /// Kinetic, rotational and elastic energy in J.
    pub fn stored(&self) -> f64 {
        let contacts = &self.contacts;
        self.kinetic + self.rotational + contacts.elastic_normal + contacts.elastic_tangential
    }

    /// Energy in J lost since counting began.
    pub fn lost(&self) -> f64 {
        let contacts = &self.contacts;
        contacts.lost_normal + contacts.lost_tangential + contacts.lost_rolling
    }

    /// Work in J done on the particles since counting began.
    pub fn work(&self) -> f64 {
        let contacts = &self.contacts;
        contacts.wall_work + contacts.gravity_work + contacts.push_work
    }

    /// What is stored and lost less the work; its change is the error of the budget.
    pub fn balance(&self) -> f64 {
        self.stored() + self.lost() - self.work()
    }
}
