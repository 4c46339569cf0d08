//! Triangles in a tree of boxes.

use calcine_physics::Vec3;

use super::ray::RayHit;

/// Triangles to a leaf at most.
const LEAF: usize = 4;

/// A box around triangles, and what is in it.
#[derive(Clone, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
    /// First triangle and their number in a leaf; the left child's index and 0 in a branch.
    first: usize,
    count: usize,
    /// The right child's index in a branch.
    right: usize,
}

/// Triangles, both sides of them.
#[derive(Clone, Debug, Default)]
pub struct TriangleTree {
    triangles: Vec<[Vec3; 3]>,
    nodes: Vec<Node>,
}

impl TriangleTree {
    /// Halves the triangles at the median of their centres along the longest side, again and again.
    pub fn new(triangles: &[[Vec3; 3]]) -> Self {
        let mut tree = Self {
            triangles: triangles.to_vec(),
            nodes: Vec::new(),
        };
        if !triangles.is_empty() {
            tree.build(0, triangles.len());
        }
        tree
    }

    fn build(&mut self, first: usize, count: usize) -> usize {
        let own = &mut self.triangles[first..first + count];
        let (mut low, mut high) = (own[0][0], own[0][0]);
        for corner in own.iter().flatten() {
            (low, high) = (low.inf(corner), high.sup(corner));
        }
        let index = self.nodes.len();
        let (axis, _) = (high - low).argmax();
        let leaf = count <= LEAF;
        if !leaf {
            let centre = |one: &[Vec3; 3]| one[0][axis] + one[1][axis] + one[2][axis];
            own.sort_by(|a, b| centre(a).total_cmp(&centre(b)));
        }
        self.nodes.push(Node {
            low,
            high,
            first,
            count: if leaf { count } else { 0 },
            right: 0,
        });
        if !leaf {
            let half = count / 2;
            self.nodes[index].first = self.build(first, half);
            self.nodes[index].right = self.build(first + half, count - half);
        }
        index
    }

    /// Distance in m of a point from the nearest triangle; infinite beyond `within` in m.
    pub fn distance(&self, point: Vec3, within: f64) -> f64 {
        let mut best = within * within;
        let mut found = false;
        self.visit(
            |node| {
                let outside = (node.low - point)
                    .sup(&(point - node.high))
                    .sup(&Vec3::zeros());
                outside.norm_squared()
            },
            |limit, triangle| {
                let square = (nearest(triangle, point) - point).norm_squared();
                if square <= *limit {
                    found = true;
                    *limit = square;
                }
            },
            &mut best,
        );
        if found { best.sqrt() } else { f64::INFINITY }
    }

    /// Where a ray meets a triangle first.
    pub fn hit(&self, origin: Vec3, way: Vec3) -> Option<RayHit> {
        let mut best = f64::INFINITY;
        let mut normal = Vec3::zeros();
        self.visit(
            |node| {
                let (mut from, mut to) = (0.0_f64, f64::INFINITY);
                for axis in 0..3 {
                    let ends = [node.low[axis], node.high[axis]]
                        .map(|side| (side - origin[axis]) / way[axis]);
                    // A ray along the sides of a flat box gives 0/0, which must not cut it off.
                    let [a, b] = if ends[0].is_nan() || ends[1].is_nan() {
                        [f64::NEG_INFINITY, f64::INFINITY]
                    } else {
                        ends
                    };
                    (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
                }
                if from <= to { from } else { f64::INFINITY }
            },
            |limit, triangle| {
                if let Some((distance, across)) = meets(triangle, origin, way)
                    && distance < *limit
                {
                    *limit = distance;
                    normal = across;
                }
            },
            &mut best,
        );
        best.is_finite().then_some(RayHit {
            distance: best,
            normal,
        })
    }

    /// Goes through all boxes whose measure is below the limit, which finds may lower.
    fn visit(
        &self,
        measure: impl Fn(&Node) -> f64,
        mut look: impl FnMut(&mut f64, &[Vec3; 3]),
        limit: &mut f64,
    ) {
        let mut stack = vec![0];
        while let Some(index) = stack.pop() {
            let Some(node) = self.nodes.get(index) else {
                return;
            };
            let far = measure(node);
            if far > *limit || far.is_infinite() {
                continue;
            }
            if node.count > 0 {
                for triangle in &self.triangles[node.first..node.first + node.count] {
                    look(limit, triangle);
                }
            } else {
                stack.push(node.right);
                stack.push(node.first);
            }
        }
    }
}

/// Distance along a ray and the normal against it (Möller and Trumbore 1997).
fn meets(triangle: &[Vec3; 3], origin: Vec3, way: Vec3) -> Option<(f64, Vec3)> {
    let (first, second) = (triangle[1] - triangle[0], triangle[2] - triangle[0]);
    let square = way.cross(&second);
    let size = first.dot(&square);
    if size == 0.0 {
        return None;
    }
    let from = origin - triangle[0];
    let u = from.dot(&square) / size;
    let turned = from.cross(&first);
    let v = way.dot(&turned) / size;
    let distance = second.dot(&turned) / size;
    if u < 0.0 || v < 0.0 || u + v > 1.0 || distance < 0.0 {
        return None;
    }
    let normal = first.cross(&second).try_normalize(0.0)?;
    Some((distance, -normal * normal.dot(&way).signum()))
}

/// The point of a triangle nearest to a point.
fn nearest([a, b, c]: &[Vec3; 3], point: Vec3) -> Vec3 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(&ac);
    let square = normal.norm_squared();
    if square > 0.0 {
        let from = point - a;
        let v = from.cross(&ac).dot(&normal) / square;
        let w = ab.cross(&from).dot(&normal) / square;
        if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
            return a + v * ab + w * ac;
        }
    }
    let on = |p: &Vec3, q: &Vec3| {
        let edge = q - p;
        let size = edge.norm_squared();
        let share = if size > 0.0 {
            ((point - p).dot(&edge) / size).clamp(0.0, 1.0)
        } else {
            0.0
        };
        p + share * edge
    };
    let apart = |place: &Vec3| (place - point).norm_squared();
    let mut best = on(a, b);
    for place in [on(b, c), on(c, a)] {
        if apart(&place) < apart(&best) {
            best = place;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::random::SplitMix64;

    fn scatter(count: usize) -> (Vec<[Vec3; 3]>, SplitMix64) {
        let mut random = SplitMix64(7);
        let mut place = || Vec3::new(random.unit(), random.unit(), random.unit());
        let triangles = (0..count)
            .map(|_| {
                let corner = place();
                [corner, corner + 0.1 * place(), corner + 0.1 * place()]
            })
            .collect();
        (triangles, random)
    }

    #[test]
    fn the_tree_finds_what_the_search_over_all_triangles_finds() {
        let (triangles, mut random) = scatter(300);
        let tree = TriangleTree::new(&triangles);
        for _ in 0..200 {
            let origin = Vec3::new(random.unit(), random.unit(), random.unit());
            let way = Vec3::new(
                random.unit() - 0.5,
                random.unit() - 0.5,
                random.unit() - 0.5,
            );
            let way = way.normalize();
            let all = triangles.iter().filter_map(|t| meets(t, origin, way));
            let first = all.map(|hit| hit.0).fold(f64::INFINITY, f64::min);
            let found = tree
                .hit(origin, way)
                .map_or(f64::INFINITY, |hit| hit.distance);
            assert_eq!(found, first);
            let apart = |t: &[Vec3; 3]| (nearest(t, origin) - origin).norm_squared();
            let near = triangles
                .iter()
                .map(apart)
                .fold(f64::INFINITY, f64::min)
                .sqrt();
            assert_eq!(tree.distance(origin, 10.0), near);
            assert_eq!(tree.distance(origin, 0.5 * near), f64::INFINITY);
        }
    }

    #[test]
    fn nearest_points_lie_on_faces_edges_and_corners() {
        let triangle = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let tree = TriangleTree::new(&[triangle]);
        for (point, apart) in [
            (Vec3::new(0.2, 0.2, 0.5), 0.5),
            (Vec3::new(0.5, -3.0, 4.0), 5.0),
            (Vec3::new(-3.0, -4.0, 0.0), 5.0),
            (Vec3::new(1.0, 1.0, 0.0), 0.5_f64.sqrt()),
        ] {
            assert!((tree.distance(point, 10.0) - apart).abs() < 1e-14);
        }
        let hit = tree.hit(Vec3::new(0.2, 0.2, 1.0), -Vec3::z()).unwrap();
        assert_eq!((hit.distance, hit.normal), (1.0, Vec3::z()));
        assert!(
            TriangleTree::new(&[])
                .hit(Vec3::zeros(), Vec3::x())
                .is_none()
        );
    }
}
