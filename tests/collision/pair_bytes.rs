//! A placed pair of shapes as bytes, so that every string of bytes of some length is a pair that can be asked about: for
//! the fuzz target `bracket`.
//!
//! A shape is a byte for its kind, one that says whether a ball is swept over it, and its numbers; then come its position and
//! quaternion. A number is the 8 bytes of a double, little-endian. Doubles whose exponents would leave the range that the
//! oracle is made for are brought into it, all others mean themselves: so the corpus of hard pairs makes seeds.

use crate::oracle::{Body, Core};
use crate::specimen::{Form, Specimen};

/// Exponents of the doubles that mean themselves.
const EXPONENTS: std::ops::Range<i32> = -60..60;

/// Most points of a hull.
const MOST_POINTS: usize = 24;

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    fn number(&mut self) -> Option<f64> {
        let (first, rest) = self.0.split_first_chunk::<8>()?;
        self.0 = rest;
        let bits = u64::from_le_bytes(*first);
        let exponent = ((bits >> 52) & 0x7ff) as i32 - 1023;
        if bits << 1 == 0 {
            return Some(0.0);
        }
        let folded = EXPONENTS.start + (exponent - EXPONENTS.start).rem_euclid(EXPONENTS.end - EXPONENTS.start);
        Some(f64::from_bits(bits & !(0x7ff << 52) | ((folded + 1023) as u64) << 52))
    }

    fn length(&mut self) -> Option<f64> {
        self.number().map(f64::abs)
    }

    fn lengths(&mut self) -> Option<[f64; 3]> {
        Some([self.length()?, self.length()?, self.length()?])
    }

    fn vector(&mut self) -> Option<[f64; 3]> {
        Some([self.number()?, self.number()?, self.number()?])
    }

    fn form(&mut self) -> Option<Form> {
        let (kind, swept) = (self.byte()?, self.byte()?);
        let form = match kind % 12 {
            0 => Form::point(),
            1 => Form::sphere(self.length()?),
            2 => Form::cuboid(self.lengths()?),
            3 => Form::capsule(self.length()?, self.length()?),
            4 => Form::cylinder(self.length()?, self.length()?),
            5 => Form::cone(self.length()?, self.length()?),
            6 => Form::ellipsoid(self.lengths()?),
            7 => {
                let count = 1 + usize::from(self.byte()?) % MOST_POINTS;
                let points: Option<Vec<_>> = (0..count).map(|_| self.vector()).collect();
                Form::convex(&points?)
            }
            8 => Form::triangle([self.vector()?, self.vector()?, self.vector()?]),
            9 => Form::segment([self.vector()?, self.vector()?]),
            10 => Form::half_space(self.vector()?, self.number()?),
            _ => Form::plane(self.vector()?, self.number()?),
        }?;
        if swept % 2 == 1 { form.swept(self.length()?) } else { Some(form) }
    }

    fn specimen(&mut self) -> Option<Specimen> {
        let form = self.form()?;
        let place = self.vector()?;
        form.placed(place, [self.number()?, self.number()?, self.number()?, self.number()?])
    }
}

/// Which goal is asked for, and the pair; none when the bytes end too soon or the library refuses the numbers.
pub fn read(bytes: &[u8]) -> Option<(u8, Specimen, Specimen)> {
    let mut reader = Reader(bytes);
    let goal = reader.byte()?;
    let (a, b) = (reader.specimen()?, reader.specimen()?);
    (a.body.core.is_bounded() || b.body.core.is_bounded()).then_some((goal, a, b))
}

/// The bytes of a pair; none for one with numbers out of range, or too many of them.
pub fn write(a: &Specimen, b: &Specimen) -> Option<Vec<u8>> {
    let mut bytes = vec![0];
    for body in [&a.body, &b.body] {
        write_body(&mut bytes, body)?;
    }
    // What is read back must be what was written, or the seed is not the hard pair it came from.
    let (_, read_a, read_b) = read(&bytes)?;
    let same = |one: &Specimen, other: &Specimen| format!("{:?}", one.body) == format!("{:?}", other.body);
    (same(a, &read_a) && same(b, &read_b)).then_some(bytes)
}

fn write_body(bytes: &mut Vec<u8>, body: &Body) -> Option<()> {
    let radius = body.swept_radius.hi;
    let (kind, numbers): (u8, Vec<f64>) = match &body.core {
        Core::Cuboid(half) => (2, half.to_vec()),
        Core::Cylinder { radius, half_length } => (4, vec![*radius, *half_length]),
        Core::Cone { radius, half_length } => (5, vec![*radius, *half_length]),
        Core::Ellipsoid(radii) => (6, radii.to_vec()),
        Core::Hull(points) => (7, points.concat()),
        Core::HalfSpace { normal, offset, thin } => {
            (if *thin { 11 } else { 10 }, [normal.as_slice(), &[*offset]].concat())
        }
    };
    bytes.extend([kind, u8::from(radius > 0.0)]);
    if let Core::Hull(points) = &body.core {
        bytes.push(u8::try_from(points.len()).ok().filter(|count| usize::from(*count) <= MOST_POINTS)? - 1);
    }
    let radius = (radius > 0.0).then_some(radius);
    let all = numbers.iter().chain(&radius).chain(&body.translation).chain(&body.rotation);
    all.for_each(|x| bytes.extend(x.to_le_bytes()));
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hard_cases::hard_cases;

    /// Every hard pair that the format has room for is read back as it was written, and most are. With `FUZZ_CORPUS` set to a
    /// folder they are written there, and lines of the corpus beside them: the seeds of `fuzz/run`.
    #[test]
    fn hard_pairs_survive_as_bytes() {
        let cases = hard_cases();
        let seeds: Vec<_> = cases.iter().filter_map(|case| Some((&case.id, write(&case.a, &case.b)?))).collect();
        assert!(seeds.len() > 900, "only {} of {} fit", seeds.len(), cases.len());
        let Ok(folder) = std::env::var("FUZZ_CORPUS") else { return };
        let folder = std::path::PathBuf::from(folder);
        let (pairs, lines) = (folder.join("bracket"), folder.join("case_line"));
        std::fs::create_dir_all(&pairs).unwrap();
        std::fs::create_dir_all(&lines).unwrap();
        for (id, bytes) in seeds {
            std::fs::write(pairs.join(id), bytes).unwrap();
        }
        // Every tenth line: a few of each kind show the format.
        for (number, line) in include_str!("../data/hard.jsonl").lines().enumerate().step_by(10) {
            if line.len() < 4000 {
                std::fs::write(lines.join(number.to_string()), line).unwrap();
            }
        }
    }
}
