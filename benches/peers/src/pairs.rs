//! The pairs of shapes that every contender is asked about: reader of `pairs.bin`, whose layout is in `README.md`.

use std::io;
use std::path::Path;

/// Half lengths in metres; axes along z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Hull,
    Sphere,
    Box,
    Capsule,
    Cylinder,
    Cone,
    Ellipsoid,
    Mesh,
}

const KINDS: [Kind; 8] =
    [Kind::Hull, Kind::Sphere, Kind::Box, Kind::Capsule, Kind::Cylinder, Kind::Cone, Kind::Ellipsoid, Kind::Mesh];

pub struct ShapeRecord {
    pub kind: Kind,
    /// What they mean is the kind's: radius first, then half length.
    pub params: [f64; 4],
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

pub struct PairSet {
    pub name: String,
    pub first: usize,
    pub count: usize,
    /// 0 when the pairs have nothing to do with one another.
    pub track_length: usize,
}

pub struct PoseRecord {
    /// Components x y z w.
    pub rotation: [f64; 4],
    pub translation: [f64; 3],
}

pub struct PairRecord {
    pub a: usize,
    pub b: usize,
    pub at_a: PoseRecord,
    pub at_b: PoseRecord,
}

pub struct Pairs {
    pub shapes: Vec<ShapeRecord>,
    pub sets: Vec<PairSet>,
    pub pairs: Vec<PairRecord>,
}

impl Pairs {
    /// # Errors
    /// The file cannot be read, or is not one of pairs.
    pub fn read(path: &Path) -> io::Result<Self> {
        let bytes = std::fs::read(path)?;
        let mut reader = Reader { rest: &bytes };
        if reader.take(8)? != b"CQPAIRS1" {
            return Err(io::Error::other("not a file of pairs"));
        }
        let (shapes, sets, pairs) = (reader.number()?, reader.number()?, reader.number()?);
        reader.number()?;
        Ok(Self {
            shapes: (0..shapes).map(|_| reader.shape()).collect::<io::Result<_>>()?,
            sets: (0..sets).map(|_| reader.set()).collect::<io::Result<_>>()?,
            pairs: (0..pairs).map(|_| reader.pair()).collect::<io::Result<_>>()?,
        })
    }

    pub fn of(&self, set: &PairSet) -> &[PairRecord] {
        &self.pairs[set.first..set.first + set.count]
    }
}

struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> io::Result<&'a [u8]> {
        let ended = || io::Error::other("the file of pairs ends too early");
        let (head, rest) = self.rest.split_at_checked(count).ok_or_else(ended)?;
        self.rest = rest;
        Ok(head)
    }

    fn bytes<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        self.take(N).map(|bytes| bytes.try_into().expect("that many were taken"))
    }

    fn number(&mut self) -> io::Result<u32> {
        self.bytes().map(u32::from_le_bytes)
    }

    fn real(&mut self) -> io::Result<f64> {
        self.bytes().map(f64::from_le_bytes)
    }

    fn reals<const N: usize>(&mut self) -> io::Result<[f64; N]> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.real()?;
        }
        Ok(values)
    }

    fn shape(&mut self) -> io::Result<ShapeRecord> {
        let (kind, vertices, triangles) = (self.number()?, self.number()?, self.number()?);
        self.number()?;
        let kind = *KINDS.get(kind as usize).ok_or_else(|| io::Error::other(format!("shape of kind {kind}")))?;
        let params = self.reals()?;
        let vertices = (0..vertices).map(|_| self.reals()).collect::<io::Result<_>>()?;
        let corners = |reader: &mut Self| Ok([reader.number()?, reader.number()?, reader.number()?]);
        let triangles: Vec<[u32; 3]> = (0..triangles).map(|_| corners(self)).collect::<io::Result<_>>()?;
        if triangles.len() % 2 == 1 {
            self.number()?;
        }
        Ok(ShapeRecord { kind, params, vertices, triangles })
    }

    fn set(&mut self) -> io::Result<PairSet> {
        let name = String::from_utf8_lossy(self.take(48)?).trim_end_matches('\0').to_owned();
        let (first, count, track_length) = (self.number()?, self.number()?, self.number()?);
        self.number()?;
        Ok(PairSet { name, first: first as usize, count: count as usize, track_length: track_length as usize })
    }

    fn pose(&mut self) -> io::Result<PoseRecord> {
        Ok(PoseRecord { rotation: self.reals()?, translation: self.reals()? })
    }

    fn pair(&mut self) -> io::Result<PairRecord> {
        let (a, b) = (self.number()? as usize, self.number()? as usize);
        Ok(PairRecord { a, b, at_a: self.pose()?, at_b: self.pose()? })
    }
}
