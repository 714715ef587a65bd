//! At most k convex pieces for a body: those of its decomposition, joined two at a time.

use std::sync::Arc;

use crate::geometry::{Compound, ConvexHull, Core, InvalidShape, Part, Pose, Shape, TriangleMesh, Vec3, decomposed};

/// A piece on its way: its corners, and its volume.
#[derive(Clone)]
struct Piece {
    hull: Arc<ConvexHull>,
    volume: f64,
}

impl Piece {
    fn of(points: &[Vec3]) -> Result<Self, InvalidShape> {
        let hull = Arc::new(ConvexHull::new(points)?);
        let volume = volume(&hull);
        Ok(Self { hull, volume })
    }

    fn with(&self, other: &Self) -> Result<Self, InvalidShape> {
        Self::of(&[self.hull.points(), other.hull.points()].concat())
    }
}

/// Of a hull, from its bounds where it has no faces of its own: only told to compare pieces.
fn volume(hull: &ConvexHull) -> f64 {
    let Some(surface) = hull.surface() else { return 8.0 * hull.bounds().half_extents().product() };
    let points = hull.points();
    let of_face = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|i| points[i as usize] - points[0]);
        a.cross(&b).dot(&c) / 6.0
    };
    surface.triangles().iter().map(of_face).sum::<f64>().abs()
}

/// The decompositions with at most each of `counts` pieces, in falling order, beside the whole one, which comes first.
pub(super) fn with_at_most(mesh: &TriangleMesh, counts: &[usize]) -> Result<Vec<Arc<Compound>>, InvalidShape> {
    let whole = decomposed(mesh.vertices(), mesh.triangles())?;
    let mut pieces: Vec<Piece> = whole
        .parts()
        .iter()
        .filter_map(|part| if let Core::Convex(hull) = part.shape.core() { Some(hull) } else { None })
        .map(|hull| Piece { hull: Arc::clone(hull), volume: volume(hull) })
        .collect();
    let mut made = vec![Arc::new(whole)];
    for count in counts.iter().copied().filter(|count| *count > 0) {
        if pieces.len() <= count {
            continue;
        }
        while pieces.len() > count {
            join_two(&mut pieces)?;
        }
        let parts = pieces
            .iter()
            .map(|piece| Part { shape: Shape::hull(Arc::clone(&piece.hull)), pose: Pose::identity() })
            .collect();
        made.push(Arc::new(Compound::new(parts)?));
    }
    Ok(made)
}

/// Joins the two whose common hull adds the least volume.
fn join_two(pieces: &mut Vec<Piece>) -> Result<(), InvalidShape> {
    let mut best: Option<(f64, usize, usize, Piece)> = None;
    for i in 0..pieces.len() {
        for j in i + 1..pieces.len() {
            let joined = pieces[i].with(&pieces[j])?;
            let added = joined.volume - pieces[i].volume - pieces[j].volume;
            if best.as_ref().is_none_or(|(least, ..)| added < *least) {
                best = Some((added, i, j, joined));
            }
        }
    }
    if let Some((_, i, j, joined)) = best {
        pieces.swap_remove(j);
        pieces[i] = joined;
    }
    Ok(())
}
