//! The mesh's hash, as the C++ side derives it from what OpenFOAM has read
//! (`adapters/openfoam/library/meshIdentity.H`).

use calcine_coupler::mesh::Mesh;

/// 64-bit FNV-1a over words of 64 bits (Fowler, Noll, Vo; its published offset and prime).
struct Fnv(u64);

impl Fnv {
    fn add(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

/// Hash of point coordinates, points of each face, owners and neighbours, in 16 digits.
pub fn mesh_hash(mesh: &Mesh) -> String {
    let mut hash = Fnv(0xcbf2_9ce4_8422_2325);
    for point in &mesh.topology().points {
        // A sum with zero makes -0 the same as 0.
        point.iter().for_each(|x| hash.add((x + 0.0).to_bits()));
    }
    for face in 0..mesh.faces() {
        let points = mesh.face_points(face);
        hash.add(points.len() as u64);
        points.iter().for_each(|&point| hash.add(point.into()));
    }
    for &cell in mesh.owner().iter().chain(mesh.neighbour()) {
        hash.add(cell.into());
    }
    format!("{:016x}", hash.0)
}
