//! Which bytes of a glTF file are JSON, and which are its binary chunk?
//!
//! A binary file (chapter 4) is a header of 12 bytes and chunks: length, type, data. JSON comes first; the binary chunk,
//! if any, second. A file that does not begin with the magic word is JSON as a whole.

use super::MeshFileError;

const MAGIC: &[u8; 4] = b"glTF";

/// The JSON text, and the binary chunk if there is one.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), MeshFileError> {
    let Some(after_magic) = bytes.strip_prefix(MAGIC) else {
        return Ok((bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None));
    };
    let (version, rest) = word(after_magic, "GLB header")?;
    if version != 2 {
        return Err(MeshFileError::Unsupported { place: "GLB header".into(), what: format!("version {version}") });
    }
    let (length, rest) = word(rest, "GLB header")?;
    let Some(body) = (length as usize).checked_sub(12) else {
        return Err(MeshFileError::Syntax {
            place: "GLB header".into(),
            problem: format!("length {length} is below 12"),
        });
    };
    let body = rest.get(..body).ok_or_else(|| MeshFileError::Truncated {
        place: "GLB".into(),
        needed: u64::from(length),
        available: bytes.len(),
    })?;
    let (json, rest) = chunk(body, *b"JSON", "GLB chunk of JSON")?;
    let binary = if rest.is_empty() { None } else { Some(chunk(rest, *b"BIN\0", "binary GLB chunk")?.0) };
    Ok((json, binary))
}

fn chunk<'a>(bytes: &'a [u8], kind: [u8; 4], place: &str) -> Result<(&'a [u8], &'a [u8]), MeshFileError> {
    let (length, rest) = word(bytes, place)?;
    let (found, rest) = word(rest, place)?;
    if found.to_le_bytes() != kind {
        let problem = format!("its type is {:?}", String::from_utf8_lossy(&found.to_le_bytes()));
        return Err(MeshFileError::Syntax { place: place.to_owned(), problem });
    }
    rest.split_at_checked(length as usize).ok_or_else(|| MeshFileError::Truncated {
        place: place.to_owned(),
        needed: u64::from(length),
        available: rest.len(),
    })
}

fn word<'a>(bytes: &'a [u8], place: &str) -> Result<(u32, &'a [u8]), MeshFileError> {
    let (word, rest) = bytes.split_first_chunk::<4>().ok_or_else(|| MeshFileError::Truncated {
        place: place.to_owned(),
        needed: 4,
        available: bytes.len(),
    })?;
    Ok((u32::from_le_bytes(*word), rest))
}
