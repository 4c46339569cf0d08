//! Walls that hold a force: kicked and moved with the particles, against what pressed them in the last evaluation.

use calcine_coupler::physics::Vec3;

use super::super::walls::Servo;
use super::Engine;

/// A wall that holds a force between two windows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ServoState {
    /// Distance in m from where it started.
    pub distance: f64,
    /// Speed in m/s.
    pub rate: f64,
    /// Force in N of the particles on the wall in the last evaluation.
    pub pressed: Vec3,
    /// Distance in m at the last search for candidates.
    pub searched: f64,
}

impl Engine {
    /// The walls that hold a force.
    pub(super) fn servos(&self) -> impl Iterator<Item = &Servo> {
        self.walls.iter().filter_map(|wall| wall.servo.as_ref())
    }

    /// Where walls that hold a force are, and what presses them.
    pub fn servo_states(&self) -> Vec<ServoState> {
        let walls = self.walls.iter().enumerate();
        let moved = walls.filter_map(|(index, wall)| Some((index, wall.servo.as_ref()?)));
        let states = moved.enumerate().map(|(k, (index, servo))| ServoState {
            distance: servo.distance,
            rate: servo.rate,
            pressed: self.pressed(index),
            searched: self.searched_servos.get(k).copied().unwrap_or_default(),
        });
        states.collect()
    }

    /// Puts walls that hold a force where they were at a search, or where they are.
    pub(super) fn place_servos(&mut self, states: &[ServoState], at_search: bool) {
        let servos = self.walls.iter_mut().filter_map(|wall| wall.servo.as_mut());
        for (servo, state) in servos.zip(states) {
            servo.rate = state.rate;
            servo.distance = match at_search {
                true => state.searched,
                false => state.distance,
            };
        }
    }

    /// Takes up what pressed the walls; the sum over all blocks is that of the first.
    pub(super) fn press(&mut self, states: &[ServoState]) {
        let mut pressed = vec![Vec3::zeros(); self.walls.len()];
        let walls = self.walls.iter().zip(&mut pressed);
        let held = walls.filter(|(wall, _)| wall.servo.is_some());
        for ((_, pressed), state) in held.zip(states) {
            *pressed = state.pressed;
        }
        if let (Some(block), false) = (self.blocks.first_mut(), states.is_empty()) {
            block.walls.pressed = pressed;
        }
    }

    /// Force in N of all particles on a wall in the last evaluation.
    fn pressed(&self, wall: usize) -> Vec3 {
        let blocks = self.blocks.iter();
        blocks
            .filter_map(|block| block.walls.pressed.get(wall))
            .sum()
    }

    /// So many half kicks of the walls that hold a force, and their move over a step.
    pub(super) fn steer(&mut self, kicks: u32) {
        self.kick_servos(kicks);
        let step = self.contacts.step;
        for servo in self.walls.iter_mut().filter_map(|wall| wall.servo.as_mut()) {
            servo.drift(step);
        }
    }

    /// The last half kick of a window.
    pub(super) fn release(&mut self) {
        self.kick_servos(1);
    }

    /// Steps without particles.
    pub(super) fn steer_alone(&mut self, steps: i64) {
        if self.servos().next().is_none() {
            return;
        }
        for _ in 0..steps {
            self.steer(1);
            self.release();
        }
    }

    fn kick_servos(&mut self, kicks: u32) {
        let span = 0.5 * self.contacts.step * f64::from(kicks);
        for index in 0..self.walls.len() {
            let Some(direction) = self.walls[index]
                .servo
                .as_ref()
                .map(|servo| servo.direction)
            else {
                continue;
            };
            // What presses the wall pushes it back along the line.
            let against = -self.pressed(index).dot(&direction);
            if let Some(servo) = &mut self.walls[index].servo {
                servo.kick(span, against);
            }
        }
    }
}
