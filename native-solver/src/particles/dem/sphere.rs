//! The particles as the solver holds them, in the order of space.

use calcine_coupler::periodicity::Periodicity;
use calcine_coupler::physics::Vec3;

/// Where a sphere is; one load for the search of contacts.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub struct SpherePosition {
    /// Centre in m.
    pub centre: Vec3,
    /// Radius in m.
    pub radius: f64,
}

/// How a sphere moves; one cache line.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub struct SphereMotion {
    /// Velocity in m/s.
    pub velocity: Vec3,
    /// 1/m in 1/kg; 0 for one that is held.
    pub inverse_mass: f64,
    /// Angular velocity in rad/s.
    pub spin: Vec3,
    /// 1/I in 1/(kg m²); 0 for one that is held.
    pub inverse_inertia: f64,
}

/// Drag of the gas on a sphere that follows its velocity.
#[derive(Clone, Copy, Debug, Default)]
pub struct SphereDrag {
    /// K in kg/s of the drag K (u − v).
    pub coefficient: f64,
    /// u in m/s.
    pub gas: Vec3,
    /// Its impulse over the window so far in N s.
    pub impulse: Vec3,
}

/// Force and torque of all contacts of a sphere.
#[derive(Clone, Copy, Debug, Default)]
pub struct SphereLoad {
    /// Force in N.
    pub force: Vec3,
    /// Torque in N m.
    pub torque: Vec3,
}

impl SphereLoad {
    /// Adds another load.
    #[inline(always)]
    pub fn add(&mut self, other: &SphereLoad) {
        self.force += other.force;
        self.torque += other.torque;
    }
}

/// Where a sphere is seen beyond a periodic plane.
#[derive(Clone, Copy, Debug)]
pub struct SphereImage {
    /// Index of the sphere.
    pub of: u32,
    /// Its translation in m.
    pub shift: Vec3,
}

/// All spheres; `row` is the place of a sphere among ascending ids. Behind the last sphere, `place`, `moves` and `material`
/// hold the images of those that may touch others across a periodic plane, so that a contact across it is evaluated as
/// any other.
#[derive(Clone, Debug, Default)]
pub struct Spheres {
    /// Places.
    pub place: Vec<SpherePosition>,
    /// Motions.
    pub moves: Vec<SphereMotion>,
    /// Materials.
    pub material: Vec<u32>,
    /// Force of the gas in N.
    pub push: Vec<Vec3>,
    /// Drag that follows velocities; empty where there is none.
    pub drag: Vec<SphereDrag>,
    /// Rows in ascending id.
    pub row: Vec<u32>,
    /// What is an image of what.
    pub images: Vec<SphereImage>,
}

impl Spheres {
    /// Their number, images not counted.
    pub fn len(&self) -> usize {
        self.row.len()
    }

    /// The sphere that an index means: the image's where it is one.
    #[inline]
    pub fn origin(&self, index: usize) -> usize {
        match index.checked_sub(self.row.len()) {
            Some(image) => self.images[image].of as usize,
            None => index,
        }
    }

    /// The row of a sphere or an image.
    #[inline]
    pub fn row_of(&self, index: usize) -> u32 {
        self.row[self.origin(index)]
    }

    /// Drops all images.
    pub fn drop_images(&mut self) {
        let count = self.len();
        self.images.clear();
        self.place.truncate(count);
        self.moves.truncate(count);
        self.material.truncate(count);
    }

    /// Makes the images of all spheres that may touch another across a periodic plane within a skin in m.
    pub fn add_images(&mut self, periodicity: &Periodicity, skin: f64) {
        if periodicity.is_none() {
            return;
        }
        let radii = self.place.iter().map(|place| place.radius);
        let largest = radii.fold(0.0, f64::max);
        for index in 0..self.len() {
            let (place, moves) = (self.place[index], self.moves[index]);
            let reach = place.radius + largest + skin;
            for shift in periodicity.images(place.centre, reach) {
                let of = index as u32;
                self.images.push(SphereImage { of, shift });
                self.place.push(SpherePosition {
                    centre: place.centre + shift,
                    ..place
                });
                self.moves.push(moves);
                self.material.push(self.material[index]);
            }
        }
    }

    /// Brings all images to where their spheres are now.
    pub fn move_images(&mut self) {
        let (place, seen) = self.place.split_at_mut(self.row.len());
        let (moves, moving) = self.moves.split_at_mut(self.row.len());
        for ((image, seen), moving) in self.images.iter().zip(seen).zip(moving) {
            seen.centre = place[image.of as usize].centre + image.shift;
            *moving = moves[image.of as usize];
        }
    }

    /// Brings all arrays into an order: element k is what was at `order[k]`.
    pub fn reorder(&mut self, order: &[u32], spare: &mut Spheres) {
        fn gather<T: Copy>(from: &mut Vec<T>, order: &[u32], spare: &mut Vec<T>) {
            spare.clear();
            spare.extend(order.iter().map(|&old| from[old as usize]));
            std::mem::swap(from, spare);
        }
        gather(&mut self.place, order, &mut spare.place);
        gather(&mut self.moves, order, &mut spare.moves);
        gather(&mut self.material, order, &mut spare.material);
        gather(&mut self.push, order, &mut spare.push);
        if !self.drag.is_empty() {
            gather(&mut self.drag, order, &mut spare.drag);
        }
        gather(&mut self.row, order, &mut spare.row);
    }
}
