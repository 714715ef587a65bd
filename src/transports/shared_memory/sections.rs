//! Is a message's table of sections sound, and what is in its sections? Total: whatever the bytes, the outcome is
//! checked columns or an error that names the entry and field. Reads only memory that nobody else can write to.

use std::ops::Range;

use super::layout::{ALIGNMENT, ENTRY_BYTES, MOST_SECTIONS, SectionEntry, kind};

/// A message that is not laid out as it must be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{field}: {problem}")]
pub struct Malformed {
    /// Path of the field, for example `sections[3].offset`.
    pub field: String,
    /// What is wrong with it.
    pub problem: String,
}

impl Malformed {
    pub(super) fn new(field: impl Into<String>, problem: impl Into<String>) -> Self {
        Self { field: field.into(), problem: problem.into() }
    }
}

/// One section that lies where it may.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Section {
    kind: u32,
    stride: usize,
    place: Range<usize>,
}

/// A message whose table of sections was checked.
#[derive(Clone, Debug)]
pub struct Sections<'a> {
    message: &'a [u8],
    found: Vec<Section>,
}

impl<'a> Sections<'a> {
    /// Checks the table of `count` entries behind a header of `header_bytes`. `message` is as long as it says it is.
    ///
    /// # Errors
    /// An entry that does not fit.
    pub fn check(message: &'a [u8], header_bytes: usize, count: u32) -> Result<Self, Malformed> {
        let entries = count as usize;
        if entries > MOST_SECTIONS {
            return Err(Malformed::new("sections", format!("{count} are more than {MOST_SECTIONS}")));
        }
        let table_end = header_bytes + entries * ENTRY_BYTES;
        let Some(table) = message.get(header_bytes..table_end) else {
            let problem = format!("{count} entries do not fit into {} bytes", message.len());
            return Err(Malformed::new("sections", problem));
        };
        let mut found: Vec<Section> = Vec::with_capacity(entries);
        for (index, entry) in table.chunks_exact(ENTRY_BYTES).map(SectionEntry::read).enumerate() {
            let wrong = |field: &str, problem: String| Malformed::new(format!("sections[{index}].{field}"), problem);
            let section = one(&entry, message.len(), table_end).map_err(|(field, problem)| wrong(field, problem))?;
            if found.iter().any(|other| other.kind == section.kind) {
                return Err(wrong("kind", format!("{} is there twice", entry.kind)));
            }
            found.push(section);
        }
        Ok(Self { message, found })
    }

    fn section(&self, kind: u32) -> Option<&Section> {
        self.found.iter().find(|section| section.kind == kind)
    }

    /// Whether a section is there.
    #[must_use]
    pub fn has(&self, kind: u32) -> bool {
        self.section(kind).is_some()
    }

    /// The bytes of a section.
    #[must_use]
    pub fn bytes(&self, kind: u32) -> Option<&'a [u8]> {
        self.message.get(self.section(kind)?.place.clone())
    }

    /// Bytes of one row of a section.
    #[must_use]
    pub fn stride(&self, kind: u32) -> Option<usize> {
        self.section(kind).map(|section| section.stride)
    }

    /// The numbers of a section of doubles, row after row.
    #[must_use]
    pub fn doubles(&self, kind: u32) -> Option<Vec<f64>> {
        self.numbers(kind, f64::from_le_bytes)
    }

    /// The numbers of a section of 64-bit integers.
    #[must_use]
    pub fn integers(&self, kind: u32) -> Option<Vec<u64>> {
        self.numbers(kind, u64::from_le_bytes)
    }

    /// The numbers of a section of 32-bit integers.
    #[must_use]
    pub fn counts(&self, kind: u32) -> Option<Vec<u32>> {
        self.numbers(kind, u32::from_le_bytes)
    }

    /// A section of text.
    ///
    /// # Errors
    /// It is not UTF-8.
    pub fn text(&self, kind: u32) -> Result<Option<&'a str>, Malformed> {
        let text = |bytes| std::str::from_utf8(bytes).map_err(|_| Malformed::new(name_of(kind), "is not UTF-8"));
        self.bytes(kind).map(text).transpose()
    }

    /// The texts of a section, a zero byte after each.
    ///
    /// # Errors
    /// They are not UTF-8, or the last has no zero byte after it.
    pub fn texts(&self, kind: u32) -> Result<Vec<&'a str>, Malformed> {
        let Some(all) = self.text(kind)?.filter(|all| !all.is_empty()) else { return Ok(Vec::new()) };
        let all =
            all.strip_suffix('\0').ok_or_else(|| Malformed::new(name_of(kind), "does not end with a zero byte"))?;
        Ok(all.split('\0').collect())
    }

    fn numbers<const N: usize, T>(&self, kind: u32, number: fn([u8; N]) -> T) -> Option<Vec<T>> {
        let (numbers, _) = self.bytes(kind)?.as_chunks::<N>();
        Some(numbers.iter().map(|bytes| number(*bytes)).collect())
    }
}

/// A column's name as paths of fields have it.
pub(super) fn name_of(kind: u32) -> String {
    kind::column(kind).map_or_else(|| format!("column {kind}"), |column| column.name.to_ascii_lowercase())
}

fn one(entry: &SectionEntry, message_bytes: usize, first: usize) -> Result<Section, (&'static str, String)> {
    let SectionEntry { kind, stride, offset, bytes, reserved } = *entry;
    let column = kind::column(kind).ok_or_else(|| ("kind", format!("{kind} is not known")))?;
    if reserved != 0 {
        return Err(("reserved", format!("is {reserved} instead of zero")));
    }
    let width = stride as usize;
    let fits = if column.per_row == 0 {
        width > 0 && width.is_multiple_of(column.element)
    } else {
        width == column.per_row * column.element
    };
    if !fits {
        let wanted = match column.per_row {
            0 => format!("a multiple of {}", column.element),
            numbers => (numbers * column.element).to_string(),
        };
        return Err(("stride", format!("is {stride}; rows of {} have {wanted} bytes", name_of(kind))));
    }
    let outside = |field, number: u64| (field, format!("{number} is outside the message of {message_bytes} bytes"));
    let begin = usize::try_from(offset).map_err(|_| outside("offset", offset))?;
    if !begin.is_multiple_of(ALIGNMENT) {
        return Err(("offset", format!("{offset} is not a multiple of {ALIGNMENT}")));
    }
    if begin < first {
        return Err(("offset", format!("{offset} lies in the header or the table, which end at {first}")));
    }
    if begin > message_bytes {
        return Err(outside("offset", offset));
    }
    let length = usize::try_from(bytes).map_err(|_| outside("bytes", bytes))?;
    let end = begin.checked_add(length).filter(|end| *end <= message_bytes).ok_or_else(|| outside("bytes", bytes))?;
    if !length.is_multiple_of(width) {
        return Err(("bytes", format!("{bytes} is not a multiple of the stride {stride}")));
    }
    Ok(Section { kind, stride: width, place: begin..end })
}

/// A message being written.
#[derive(Debug)]
pub struct Writer {
    bytes: Vec<u8>,
    header_bytes: usize,
    room: usize,
    written: usize,
}

impl Writer {
    /// A message with a header of `header_bytes` and room for `room` sections.
    #[must_use]
    pub fn new(header_bytes: usize, room: usize) -> Self {
        Self::within(Vec::new(), header_bytes, room)
    }

    /// The same in memory that was used before.
    #[must_use]
    pub fn within(mut memory: Vec<u8>, header_bytes: usize, room: usize) -> Self {
        memory.clear();
        memory.resize((header_bytes + room * ENTRY_BYTES).next_multiple_of(ALIGNMENT), 0);
        Self { bytes: memory, header_bytes, room, written: 0 }
    }

    /// How many sections there are so far.
    #[must_use]
    pub fn sections(&self) -> u32 {
        self.written as u32
    }

    /// Writes one section; `rows` appends its bytes.
    fn section(&mut self, kind: u32, stride: usize, rows: impl FnOnce(&mut Vec<u8>)) {
        debug_assert!(self.written < self.room, "there is room for {} sections", self.room);
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGNMENT), 0);
        let offset = self.bytes.len();
        rows(&mut self.bytes);
        let bytes = (self.bytes.len() - offset) as u64;
        let entry = SectionEntry { kind, stride: stride as u32, offset: offset as u64, bytes, reserved: 0 };
        let place = self.header_bytes + self.written * ENTRY_BYTES;
        entry.write(&mut self.bytes[place..place + ENTRY_BYTES]);
        self.written += 1;
    }

    /// A column of bytes.
    pub fn bytes(&mut self, kind: u32, rows: impl IntoIterator<Item = u8>) {
        self.section(kind, 1, |bytes| bytes.extend(rows));
    }

    /// A column of 32-bit integers.
    pub fn counts(&mut self, kind: u32, rows: impl IntoIterator<Item = u32>) {
        self.section(kind, 4, |bytes| rows.into_iter().for_each(|row| bytes.extend_from_slice(&row.to_le_bytes())));
    }

    /// A column of 64-bit integers.
    pub fn integers(&mut self, kind: u32, rows: impl IntoIterator<Item = u64>) {
        self.section(kind, 8, |bytes| rows.into_iter().for_each(|row| bytes.extend_from_slice(&row.to_le_bytes())));
    }

    /// A column of doubles, `per_row` in each row.
    pub fn doubles(&mut self, kind: u32, per_row: usize, numbers: &[f64]) {
        self.section(kind, 8 * per_row, |bytes| {
            let begin = bytes.len();
            bytes.resize(begin + size_of_val(numbers), 0);
            let (places, _) = bytes[begin..].as_chunks_mut::<8>();
            places.iter_mut().zip(numbers).for_each(|(place, number)| *place = number.to_le_bytes());
        });
    }

    /// The same, one number after the other.
    pub fn doubles_of(&mut self, kind: u32, per_row: usize, numbers: impl IntoIterator<Item = f64>) {
        let all = |bytes: &mut Vec<u8>| numbers.into_iter().for_each(|row| bytes.extend_from_slice(&row.to_le_bytes()));
        self.section(kind, 8 * per_row, all);
    }

    /// A text.
    pub fn text(&mut self, kind: u32, text: &str) {
        self.section(kind, 1, |bytes| bytes.extend_from_slice(text.as_bytes()));
    }

    /// Texts, a zero byte after each.
    pub fn texts<'t>(&mut self, kind: u32, texts: impl IntoIterator<Item = &'t str>) {
        self.section(kind, 1, |bytes| {
            for text in texts {
                bytes.extend(text.bytes().filter(|byte| *byte != 0).chain([0]));
            }
        });
    }

    /// The message, once `header` has written its header, told the number of sections and the length.
    #[must_use]
    pub fn finish(mut self, header: impl FnOnce(u32, u64, &mut [u8])) -> Vec<u8> {
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGNMENT), 0);
        let (sections, total) = (self.sections(), self.bytes.len() as u64);
        header(sections, total, &mut self.bytes);
        self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: usize = 64;

    fn message() -> Vec<u8> {
        let mut writer = Writer::new(HEADER, 3);
        writer.text(kind::SCENE, "cell");
        writer.doubles(kind::ORIGINS, 3, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        writer.counts(kind::PAIR_COUNTS, [7, 8]);
        writer.finish(|_, _, _| ())
    }

    fn with_entry(index: usize, change: impl FnOnce(&mut SectionEntry)) -> Vec<u8> {
        let mut bytes = message();
        let place = &mut bytes[HEADER + index * ENTRY_BYTES..];
        let mut entry = SectionEntry::read(place);
        change(&mut entry);
        entry.write(place);
        bytes
    }

    #[test]
    fn what_was_written_is_read() {
        let bytes = message();
        let sections = Sections::check(&bytes, HEADER, 3).unwrap();
        assert_eq!(sections.text(kind::SCENE), Ok(Some("cell")));
        assert_eq!(sections.doubles(kind::ORIGINS), Some(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(sections.counts(kind::PAIR_COUNTS), Some(vec![7, 8]));
        assert_eq!(sections.doubles(kind::LENGTHS), None);
    }

    #[test]
    fn every_fault_of_an_entry_is_told_with_its_field() {
        type Change = fn(&mut SectionEntry);
        let cases: [(&str, Change); 12] = [
            ("kind", |e| e.kind = 9999),
            ("kind", |e| (e.kind, e.stride, e.bytes) = (kind::SCENE, 1, 4)),
            ("reserved", |e| e.reserved = 1),
            ("stride", |e| e.stride = 0),
            ("stride", |e| e.stride = 8),
            ("stride", |e| e.stride = u32::MAX),
            ("offset", |e| e.offset += 1),
            ("offset", |e| e.offset = 64),
            ("offset", |e| e.offset = 1 << 40),
            ("bytes", |e| e.bytes = u64::MAX - 63),
            ("bytes", |e| e.bytes += 24 * 1000),
            ("bytes", |e| e.bytes -= 8),
        ];
        for (field, change) in cases {
            let bytes = with_entry(1, change);
            let error = Sections::check(&bytes, HEADER, 3).unwrap_err();
            assert_eq!(error.field, format!("sections[1].{field}"), "{error}");
        }
    }

    #[test]
    fn a_table_that_does_not_fit_is_refused() {
        let bytes = message();
        for count in [65, u32::MAX, 63] {
            let error = Sections::check(&bytes[..128], HEADER, count).unwrap_err();
            assert_eq!(error.field, "sections", "{error}");
        }
    }

    #[test]
    fn texts_end_with_zero_bytes() {
        let mut writer = Writer::new(HEADER, 2);
        writer.texts(kind::GROUPS, ["a", "", "c\0d"]);
        writer.text(kind::PROBLEM_TEXTS, "open");
        let bytes = writer.finish(|_, _, _| ());
        let sections = Sections::check(&bytes, HEADER, 2).unwrap();
        assert_eq!(sections.texts(kind::GROUPS), Ok(vec!["a", "", "cd"]));
        assert_eq!(sections.texts(kind::PROBLEM_TEXTS).unwrap_err().field, "problem_texts");
        assert_eq!(sections.texts(kind::SCENE), Ok(Vec::new()));
    }
}
