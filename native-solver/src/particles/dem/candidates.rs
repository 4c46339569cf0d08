//! Pairs of particles that may touch.

use calcine_coupler::physics::Vec3;

use super::sphere::SpherePosition;

/// Pairs that may touch, with their memory. Arrays that a run does not need are empty.
#[derive(Clone, Debug, Default)]
pub struct CandidatePairs {
    /// Indices of the two spheres; the first is of the block.
    pub pair: Vec<[u32; 2]>,
    /// Elongations of tangential springs in m; what does not touch has none, whatever stands here.
    pub shift: Vec<Vec3>,
    /// Those that touched in the last evaluation.
    pub touched: Vec<bool>,
    /// Torques of rolling springs in N m.
    pub rolling: Vec<Vec3>,
    /// What the law prepared.
    pub prepared: Vec<f64>,
    /// Distances of the surfaces in m up to which those that touched hold, of an adhesive law.
    pub tear_off: Vec<f64>,
}

impl CandidatePairs {
    /// Forgets all; keeps the memory.
    pub fn clear(&mut self) {
        self.pair.clear();
        self.shift.clear();
        self.touched.clear();
        self.rolling.clear();
        self.prepared.clear();
        self.tear_off.clear();
    }

    /// Lists the candidates that touch by an adhesive law, which keeps contacts until they tear off, and notes which they are; `torn`
    /// gets those that did tear off. Returns their number.
    pub fn adhering(
        &mut self,
        place: &[SpherePosition],
        touching: &mut [TouchingPair],
        mut torn: impl FnMut([usize; 2]),
    ) -> usize {
        let mut found = 0;
        let pairs = self.pair.iter().zip(&mut self.touched).zip(&self.tear_off);
        for (k, ((&pair, touched), &tear_off)) in pairs.enumerate() {
            let pair = pair.map(|index| index as usize);
            let [a, b] = pair.map(|index| &place[index]);
            let held = if *touched { tear_off } else { 0.0 };
            let reach = a.radius + b.radius + held;
            let touches = (a.centre - b.centre).norm_squared() < reach * reach;
            touching[found] = TouchingPair::new(k, *touched);
            found += usize::from(touches);
            if *touched && !touches {
                torn(pair);
            }
            *touched = touches;
        }
        found
    }
}

/// A candidate that touches: its index, and whether it did in the evaluation before.
#[derive(Clone, Copy, Debug, Default)]
pub struct TouchingPair(u32);

impl TouchingPair {
    /// The bit beside the index.
    const KEPT: u32 = 1 << 31;

    /// A candidate by its index.
    #[inline(always)]
    pub fn new(index: usize, kept: bool) -> Self {
        Self(index as u32 | u32::from(kept) << 31)
    }

    /// Index of the candidate.
    #[inline(always)]
    pub fn index(self) -> usize {
        (self.0 & !Self::KEPT) as usize
    }

    /// True where it touched before: its spring goes on.
    #[inline(always)]
    pub fn kept(self) -> bool {
        self.0 & Self::KEPT != 0
    }
}
