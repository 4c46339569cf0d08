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

/// First words of what is hashed of a face.
const OF_POINTS: u64 = 1;
const OF_OWNER: u64 = 2;
const OF_NEIGHBOUR: u64 = 3;

/// Hash of some words.
fn hash(words: impl IntoIterator<Item = u64>) -> u64 {
    let mut hash = Fnv(0xcbf2_9ce4_8422_2325);
    words.into_iter().for_each(|word| hash.add(word));
    hash.0
}

/// Hash, in 16 digits: the sum over faces of the hashes of the face's number and points, of its number
/// and owner, and of its number and neighbour. A sum, so that the parts of a divided mesh add up.
pub fn mesh_hash(mesh: &Mesh) -> String {
    let points = &mesh.topology().points;
    let mut sum = 0u64;
    for face in 0..mesh.faces() {
        let number = face as u64;
        let corners = mesh.face_points(face);
        // A sum with zero makes -0 the same as 0.
        let coordinates = corners.iter().flat_map(|&point| {
            let point = points[point as usize];
            [point.x, point.y, point.z].map(|x| (x + 0.0).to_bits())
        });
        let count = corners.len() as u64;
        sum = sum
            .wrapping_add(hash(
                [OF_POINTS, number, count].into_iter().chain(coordinates),
            ))
            .wrapping_add(hash([OF_OWNER, number, mesh.owner()[face].into()]));
        if let Some(&other) = mesh.neighbour().get(face) {
            sum = sum.wrapping_add(hash([OF_NEIGHBOUR, number, other.into()]));
        }
    }
    format!("{sum:016x}")
}
