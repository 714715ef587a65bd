//! The boxes that every tree is made of, how they move, and what is asked of them: reader of `trees_N.bin`.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// Least corner, then greatest corner, metres.
pub type BoxRecord = [f64; 6];

/// Origin, unit direction, length, metres.
pub type RayRecord = [f64; 7];

/// A box that moves: its index, and by what, metres.
pub struct Move {
    pub index: u32,
    pub by: [f32; 3],
}

const BYTES_OF_A_MOVE: usize = 16;

/// Frames that move the same share of the boxes.
struct Stream {
    percent: u32,
    frames: u64,
    moves: u64,
    /// Where its first frame begins in the file, bytes.
    offset: u64,
}

/// The file, of which frames are read as they are asked for.
pub struct Boxes {
    pub boxes: Vec<BoxRecord>,
    pub queries: Vec<BoxRecord>,
    pub rays: Vec<RayRecord>,
    streams: Vec<Stream>,
    file: File,
}

impl Boxes {
    /// # Errors
    /// The file cannot be read, or is not one of boxes.
    pub fn open(path: &Path) -> io::Result<Self> {
        let mut file = File::open(path)?;
        let mut magic = [0; 8];
        file.read_exact(&mut magic)?;
        if magic != *b"CQTREES1" {
            return Err(io::Error::other("not a file of boxes"));
        }
        let [count, queries, rays, streams] = array(&mut file, u32::from_le_bytes)?;
        let mut heads = Vec::new();
        for _ in 0..streams {
            heads.push(array(&mut file, u32::from_le_bytes)?);
        }
        let boxes = arrays(&mut file, count)?;
        let queries = arrays(&mut file, queries)?;
        let rays = arrays(&mut file, rays)?;
        let mut offset = file.stream_position()?;
        let mut streams = Vec::new();
        for [percent, frames] in heads {
            let (frames, moves) = (u64::from(frames), u64::from(count) * u64::from(percent) / 100);
            streams.push(Stream { percent, frames, moves, offset });
            offset += frames * moves * BYTES_OF_A_MOVE as u64;
        }
        Ok(Self { boxes, queries, rays, streams, file })
    }

    /// Frame `index` of those that move `percent` of the boxes.
    ///
    /// # Errors
    /// There is no such frame, or the file cannot be read.
    pub fn frame(&mut self, percent: u32, index: u64) -> io::Result<Vec<Move>> {
        let stream = self.streams.iter().find(|s| s.percent == percent && index < s.frames);
        let Stream { moves, offset, .. } =
            stream.ok_or_else(|| io::Error::other(format!("no frame {index} of {percent} percent")))?;
        let mut bytes = vec![0; *moves as usize * BYTES_OF_A_MOVE];
        self.file.seek(SeekFrom::Start(offset + index * bytes.len() as u64))?;
        self.file.read_exact(&mut bytes)?;
        Ok(bytes.chunks_exact(BYTES_OF_A_MOVE).map(one_move).collect())
    }
}

fn one_move(bytes: &[u8]) -> Move {
    let word = |i: usize| <[u8; 4]>::try_from(&bytes[4 * i..4 * i + 4]).expect("a move has four words");
    Move { index: u32::from_le_bytes(word(0)), by: [1, 2, 3].map(|i| f32::from_le_bytes(word(i))) }
}

fn array<T: Copy + Default, const BYTES: usize, const COUNT: usize>(
    file: &mut File,
    from: fn([u8; BYTES]) -> T,
) -> io::Result<[T; COUNT]> {
    let mut values = [T::default(); COUNT];
    for value in &mut values {
        let mut bytes = [0; BYTES];
        file.read_exact(&mut bytes)?;
        *value = from(bytes);
    }
    Ok(values)
}

fn arrays<const COUNT: usize>(file: &mut File, count: u32) -> io::Result<Vec<[f64; COUNT]>> {
    let mut bytes = vec![0; count as usize * COUNT * 8];
    file.read_exact(&mut bytes)?;
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().expect("a double has eight bytes"));
    let numbers: Vec<f64> = bytes.chunks_exact(8).map(number).collect();
    Ok(numbers.chunks_exact(COUNT).map(|chunk| chunk.try_into().expect("chunks are of that length")).collect())
}
