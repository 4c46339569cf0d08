//! The passes of a step over all contacts: forces alone, or forces and motion block by block.

use std::iter::repeat;

use calcine_coupler::excursion::Excursion;
use calcine_coupler::motion::ContactForce;
use calcine_coupler::physics::contact::{
    ContactModel, HertzMindlin, Linear, LinearSprings, OpenfoamSpringSliderDashpot,
    SpringSliderDashpot,
};
use rayon::prelude::*;

use super::super::block::{Block, size};
use super::super::force_context::ForceContext;
use super::super::motion::{self, ForceKick};
use super::super::sphere::{SphereLoad, Spheres};
use super::Engine;

impl Engine {
    /// Forces of all contacts; memories are brought up to date over a time in s.
    pub(super) fn evaluate(&mut self, step: f64) {
        self.pass(step, false);
    }

    /// True where a step may go block by block: by one thread, and where a block's particles get loads of blocks before it
    /// only.
    pub(super) fn sweeps(&self) -> bool {
        !self.parallel() && self.search.forward
    }

    /// Forces of a step, and the kick and the move to the next one as soon as a block has all its loads, while its
    /// particles are at hand; returns their largest speed in m/s. Blocks that follow look at them no more: what
    /// comes out are the bits of forces first and motion after.
    pub(super) fn sweep(&mut self, step: f64) -> f64 {
        self.pass(step, true)
    }

    /// Contacts that were pressed in farther than their law holds since this was asked last, by rows, over the smaller radius:
    /// the most in one step, and the deepest of all.
    pub fn take_deep_contacts(&mut self) -> Excursion {
        std::mem::take(&mut self.deep)
    }

    pub(super) fn note_deep_contacts(&mut self) {
        let mut now = Excursion::default();
        for block in &self.blocks {
            now.add(&block.deep);
        }
        self.deep.keep_worst(&now);
    }

    fn pass(&mut self, step: f64, moves: bool) -> f64 {
        self.stamp += 1;
        match self.contacts.law.force {
            ContactForce::HertzMindlin => self.pass_with(&HertzMindlin, step, moves),
            ContactForce::SpringSliderDashpot => self.pass_with(&SpringSliderDashpot, step, moves),
            ContactForce::OpenfoamSpringSliderDashpot => {
                self.pass_with(&OpenfoamSpringSliderDashpot, step, moves)
            }
            ContactForce::Linear {
                characteristic_speed: speed,
            } => self.pass_with(&Linear { speed }, step, moves),
            ContactForce::LinearSprings {
                stiffness,
                tangential_ratio,
            } => self.pass_with(
                &LinearSprings {
                    stiffness,
                    tangential_ratio,
                },
                step,
                moves,
            ),
        }
    }

    fn pass_with<L: ContactModel>(&mut self, law: &L, step: f64, moves: bool) -> f64 {
        match (moves, self.counting) {
            (true, true) => self.sweep_with::<L, true>(law, step),
            (true, false) => self.sweep_with::<L, false>(law, step),
            (false, true) => self.evaluate_with::<L, true>(law, step),
            (false, false) => self.evaluate_with::<L, false>(law, step),
        }
    }

    fn evaluate_with<L: ContactModel, const BUDGET: bool>(&mut self, law: &L, step: f64) -> f64 {
        let parallel = self.parallel();
        let scene = ForceContext {
            law,
            rules: &self.rules,
            spheres: &self.spheres,
            walls: &self.walls,
            step,
            stamp: self.stamp,
        };
        let work = |(block, outgoing): (&mut Block, &mut Vec<SphereLoad>)| {
            block.evaluate::<L, BUDGET>(&scene, outgoing);
        };
        if parallel {
            self.blocks
                .par_iter_mut()
                .zip(&mut self.outgoing)
                .for_each(work);
        } else {
            self.blocks
                .iter_mut()
                .zip(&mut self.outgoing)
                .for_each(work);
        }
        0.0
    }

    fn sweep_with<L: ContactModel, const BUDGET: bool>(&mut self, law: &L, step: f64) -> f64 {
        let kick = self.kick(2);
        let (count, size) = (self.spheres.len(), size(self.spheres.len()));
        let mut fastest = 0.0f64;
        for (index, block) in self.blocks.iter_mut().enumerate() {
            let scene = ForceContext {
                law,
                rules: &self.rules,
                spheres: &self.spheres,
                walls: &self.walls,
                step,
                stamp: self.stamp,
            };
            let own = block.begin..count.min(block.begin + size);
            // Loads that are used up at once need no memory of each block's own.
            self.spare.resize(own.len(), SphereLoad::default());
            std::mem::swap(&mut self.spare, &mut block.load);
            let (before, rest) = self.outgoing.split_at_mut(index);
            block.evaluate::<L, BUDGET>(&scene, &mut rest[0]);
            block.take_up(before);
            let Spheres {
                place,
                moves,
                push,
                drag,
                ..
            } = &mut self.spheres;
            let bodies = (&mut place[own.clone()], &mut moves[own.clone()]);
            let push = &push[own.clone()];
            let largest = if drag.is_empty() {
                motion::drift::<BUDGET, _>(block, &kick, bodies, push, repeat(ForceKick))
            } else {
                motion::drift::<BUDGET, _>(block, &kick, bodies, push, &mut drag[own])
            };
            fastest = fastest.max(largest);
            std::mem::swap(&mut self.spare, &mut block.load);
        }
        fastest.sqrt()
    }
}
