//! Where does each field of a shared-memory message stand? The tables that the reader, the writer, `docs/wire.md` and
//! the C header are held to, and the hash over them that both sides compare.
//!
//! A message is one run of bytes, aligned to 64: a header, a table of sections, the sections. Every number is
//! little-endian. Sections are columns: one row an item, rows one after the other without gaps.

/// The first eight bytes of every message.
pub const MAGIC: [u8; 8] = *b"CLRSHM\r\n";
/// Changes whenever a message of before can no longer be read.
pub const VERSION: u32 = 1;
/// Messages and their sections begin at multiples of this, bytes.
pub const ALIGNMENT: usize = 64;
/// Sections of one message, at most.
pub const MOST_SECTIONS: usize = 64;
/// Bytes of one entry of the table of sections.
pub const ENTRY_BYTES: usize = 32;

/// One field of a header or of an entry of the table of sections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name, in Rust and in C.
    pub name: &'static str,
    /// Its type in C.
    pub c_type: &'static str,
    /// How many of that type.
    pub count: usize,
    /// Where it begins, bytes from the start of the header or entry.
    pub offset: usize,
    /// What it means, with unit and frame.
    pub meaning: &'static str,
}

/// One kind of section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its number in the table of sections.
    pub kind: u32,
    /// Its name.
    pub name: &'static str,
    /// Bytes of one number: 1, 4 or 8 (8 bytes are an IEEE 754 double unless the meaning says otherwise).
    pub element: usize,
    /// Numbers of one row; 0: as many as the stride says.
    pub per_row: usize,
    /// What it holds, with unit and frame.
    pub meaning: &'static str,
}

/// A value with a fixed place in a header.
trait Plain: Copy {
    const C_TYPE: &'static str;
    const COUNT: usize;
    fn get(bytes: &[u8], offset: usize) -> Self;
    fn put(self, bytes: &mut [u8], offset: usize);
}

/// `N` bytes from `offset` on; zeros where there are none.
fn bytes_at<const N: usize>(bytes: &[u8], offset: usize) -> [u8; N] {
    bytes.get(offset..).and_then(|rest| rest.first_chunk()).copied().unwrap_or([0; N])
}

fn put_at(bytes: &mut [u8], offset: usize, value: &[u8]) {
    if let Some(place) = bytes.get_mut(offset..offset + value.len()) {
        place.copy_from_slice(value);
    }
}

macro_rules! plain_number {
    ($($type:ty, $c:literal);*) => {$(
        impl Plain for $type {
            const C_TYPE: &'static str = $c;
            const COUNT: usize = 1;
            fn get(bytes: &[u8], offset: usize) -> Self {
                Self::from_le_bytes(bytes_at(bytes, offset))
            }
            fn put(self, bytes: &mut [u8], offset: usize) {
                put_at(bytes, offset, &self.to_le_bytes());
            }
        }
    )*};
}
plain_number!(u32, "uint32_t"; u64, "uint64_t"; f64, "double");

impl<const N: usize> Plain for [u8; N] {
    const C_TYPE: &'static str = "uint8_t";
    const COUNT: usize = N;
    fn get(bytes: &[u8], offset: usize) -> Self {
        bytes_at(bytes, offset)
    }
    fn put(self, bytes: &mut [u8], offset: usize) {
        put_at(bytes, offset, &self);
    }
}

/// A header: its struct, its reader and writer, and its table, from one list.
macro_rules! header {
    ($(#[$about:meta])* $name:ident of $bytes:literal bytes {
        $($offset:literal $field:ident: $type:ty = $meaning:literal;)*
    }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct $name {
            $(#[doc = $meaning] pub $field: $type,)*
        }

        impl $name {
            /// Its size.
            pub const BYTES: usize = $bytes;
            /// Its fields, in the order of their places.
            pub const FIELDS: &'static [Field] = &[$(Field {
                name: stringify!($field),
                c_type: <$type as Plain>::C_TYPE,
                count: <$type as Plain>::COUNT,
                offset: $offset,
                meaning: $meaning,
            }),*];

            /// What stands in `bytes`; what is missing reads as zeros.
            #[must_use]
            pub fn read(bytes: &[u8]) -> Self {
                Self { $($field: Plain::get(bytes, $offset)),* }
            }

            /// Writes it to the start of `bytes`.
            pub fn write(&self, bytes: &mut [u8]) {
                $(self.$field.put(bytes, $offset);)*
            }
        }
    };
}

header! {
    /// The start of a request.
    RequestHeader of 256 bytes {
        0 magic: [u8; 8] = "the bytes 43 4c 52 53 48 4d 0d 0a";
        8 abi_hash: u64 = "hash of this layout; another one is refused";
        16 version: u32 = "of the layout: 1";
        20 sections: u32 = "entries of the table of sections, which follows the header";
        24 total_bytes: u64 = "length of the message, header and table included";
        32 nonce: [u8; 16] = "random for each request; the answer has the same, and one with another is not the caller's";
        48 client: [u8; 16] = "the client's own: its listener for answers has these bytes as its name, in lower-case hexadecimal";
        64 question: u32 = "1 states, 2 motions, 3 path, 4 collide, 5 distance, 6 rays, 7 any rpc by its name";
        68 mode: u32 = "0 all items, 1 stop at the first hit; of rays: 0 the first body met, 1 every one, 2 whether there is any";
        72 flags: u32 = "bits that say which optional fields are given: 1 epoch, 2 cut_off, 4 accuracy, 8 max_pairs, 16 layers, 32 mask, 64 resolution, 128 max_states, 256 time_budget_ns; and 512: disregard allowed collisions";
        76 items: u32 = "rows of the columns of items: states, motions, waypoints of a path, subjects or rays";
        80 revision_rule: u32 = "0 the latest, 1 exactly `revision`, 2 at least `revision`";
        84 wants: u32 = "bits: 1 distance, 2 witness, 4 depth, 8 pairs, 16 the sides of the nearest pair";
        88 epoch: u64 = "the epoch that is meant, where given";
        96 revision: u64 = "the revision that is meant";
        104 timeout_ns: u64 = "nanoseconds from the arrival of the request until nobody listens any more; 0: the daemon's longest";
        112 time_budget_ns: u64 = "nanoseconds after which the caller wants what is there, where given";
        120 margin: f64 = "metres: a pair apart but nearer than this is MARGIN";
        128 cut_off: f64 = "metres: pairs farther than this need no distance, where given";
        136 accuracy_absolute: f64 = "metres, where given";
        144 accuracy_relative: f64 = "a factor, where given";
        152 resolution: f64 = "metres: of motions, where given";
        160 solver: u32 = "who measures a pair: the numbers of `Solver` in query.proto";
        164 max_pairs: u32 = "pairs or hits listed for an item, where given";
        168 layers: u32 = "of bare shapes and rays: bits of the layers they are in, where given";
        172 mask: u32 = "of bare shapes and rays: bits of the layers they meet, where given";
        176 find: u32 = "of motions: 0 the first contact, 1 any contact";
        180 max_states: u32 = "of motions: states looked at for one of them, where given";
    }
}

header! {
    /// The start of an answer, or of an error.
    ResponseHeader of 256 bytes {
        0 magic: [u8; 8] = "the bytes 43 4c 52 53 48 4d 0d 0a";
        8 abi_hash: u64 = "hash of this layout";
        16 version: u32 = "of the layout: 1";
        20 sections: u32 = "entries of the table of sections, which follows the header";
        24 total_bytes: u64 = "length of the message, header and table included";
        32 nonce: [u8; 16] = "of the request";
        48 code: u32 = "0 an answer; else an error, the number of its gRPC status, and the sections of errors say more";
        52 question: u32 = "of the request";
        56 items: u32 = "rows of the columns of items";
        60 flags: u32 = "bits: 1 `stopped_at` is given, 2 the time ran out and the items not looked at are NOT_RUN";
        64 epoch: u64 = "which life of the scene was asked";
        72 revision: u64 = "which state of it";
        80 stopped_at: u32 = "the item that stopped the batch, where given";
        84 reserved: u32 = "zero";
        88 supports: u64 = "support points of a Minkowski difference, count, over all items";
        96 gjk_iterations: u64 = "rounds of GJK, count";
        104 epa_iterations: u64 = "rounds of EPA, count";
        112 nodes: u64 = "nodes of trees that were opened, count";
        120 pairs: u64 = "pairs of convex shapes that were looked at, count";
        128 escalations: u64 = "pairs that doubles left open and a higher precision took over, count";
    }
}

header! {
    /// One entry of the table of sections.
    SectionEntry of 32 bytes {
        0 kind: u32 = "which column";
        4 stride: u32 = "bytes of one row";
        8 offset: u64 = "where the section begins, bytes from the start of the message; a multiple of 64";
        16 bytes: u64 = "its length; a multiple of the stride";
        24 reserved: u64 = "zero";
    }
}

/// The kinds of sections.
pub mod kind {
    use super::Column;

    macro_rules! columns {
        ($($kind:literal $name:ident $element:literal x $per_row:literal $meaning:literal;)*) => {
            $(#[doc = $meaning] pub const $name: u32 = $kind;)*

            /// Every kind, in the order of the numbers.
            pub const COLUMNS: &[Column] = &[$(Column {
                kind: $kind,
                name: stringify!($name),
                element: $element,
                per_row: $per_row,
                meaning: $meaning,
            }),*];
        };
    }

    columns! {
        1 SCENE 1 x 1 "request, but for any rpc: the scene's name, UTF-8; must be there";
        2 ROBOT 1 x 1 "request for states, motions, path: the robot's name in the scene, UTF-8; must be there";
        3 POSITIONS 8 x 0 "request for states, motions, path: joint positions in the robot's order, radians or metres; a row a state or waypoint, or start and goal of a motion one after the other";
        4 GROUPS 1 x 1 "request: names of the groups that are looked at, UTF-8, a zero byte after each";
        5 IGNORE 8 x 1 "request: ids of bodies that are left out, unsigned";
        6 SUBJECT_KINDS 1 x 1 "request to collide, distance: 1 all pairs, 2 a body, 3 a shape at a pose, 4 what changed since a revision, 5 the shape of a body at another pose";
        7 SUBJECT_IDS 8 x 1 "request to collide, distance, unsigned: the body's id (2, 5) or the revision (4); else zero";
        8 POSES 8 x 7 "request to collide, distance: of subjects 3 and 5: translation x y z, metres, and quaternion w x y z, of the shape in the world; else not read";
        9 SHAPE_KINDS 1 x 1 "request to collide, distance: of subject 3: 1 sphere, 2 box, 3 capsule, 4 cylinder, 5 cone, 6 ellipsoid, 7 point; else not read";
        10 SHAPE_PARAMETERS 8 x 4 "request to collide, distance: of subject 3, metres: three numbers (radius; half extents x y z; radius, half length; radii x y z), then the swept radius; else not read";
        11 ORIGINS 8 x 3 "request for rays: where each begins, metres, world";
        12 DIRECTIONS 8 x 3 "request for rays: of any length but zero, world";
        13 LENGTHS 8 x 1 "request for rays: how far each goes, metres; one row for all, or one each";

        14 RPC 1 x 1 "request for any rpc: its service and method, for example `Queries/CastShapes`, UTF-8; must be there";
        15 MESSAGE 1 x 1 "request for any rpc: its request message, protobuf; absent: an empty one. Of `Assets/PutAsset` the messages of the stream, each behind its length as a varint";

        32 VERDICTS 1 x 1 "an item's verdict: the numbers of `Verdict`, of rays of `CastVerdict`";
        33 INDETERMINACIES 1 x 1 "why an item is INDETERMINATE: the numbers of `Indeterminacy`";
        34 NEAREST_LOWER 8 x 1 "distance wanted, metres: of the pair of least signed distance; NaN: no such pair";
        35 NEAREST_UPPER 8 x 1 "the same: upper end of the bracket";
        36 NEAREST_SIGNED_DISTANCE 8 x 1 "the same: best estimate inside the bracket";
        37 SELF_LOWER 8 x 1 "of states, distance wanted, metres: of two links; NaN: no such pair";
        38 SELF_UPPER 8 x 1 "the same: upper end of the bracket";
        39 SELF_SIGNED_DISTANCE 8 x 1 "the same: best estimate inside the bracket";
        40 SCENE_LOWER 8 x 1 "of states, distance wanted, metres: of a link and a body; NaN: no such pair";
        41 SCENE_UPPER 8 x 1 "the same: upper end of the bracket";
        42 SCENE_SIGNED_DISTANCE 8 x 1 "the same: best estimate inside the bracket";
        43 PROBLEM_ITEMS 4 x 1 "indices of the items that are INVALID_INPUT, unsigned";
        44 PROBLEM_TEXTS 1 x 1 "what is wrong with each of them, UTF-8, a zero byte after each";
        45 TRUNCATED 1 x 1 "pairs wanted, and of rays: 1 where an item had more pairs or hits than are listed";
        46 FREE_UNTIL 8 x 1 "of motions, a part of it; of rays, metres: up to here is proved free";
        47 REACHED_FROM 8 x 1 "of motions, a part of it: proved apart before; NaN: no contact";
        48 REACHED_TO 8 x 1 "of motions, a part of it: proved in contact here; NaN: no contact";
        49 UNDECIDED_FROM 8 x 1 "of motions, a part of it: the first stretch that is not proved; NaN: none";
        50 UNDECIDED_TO 8 x 1 "of motions, a part of it: its end; NaN: none";
        51 STATES 8 x 1 "of motions: states that pairs were measured in, count, a double; NaN: not run";

        52 RESPONSE 1 x 1 "of any rpc: its response message, protobuf";
        53 DECLARED_EMPTY 1 x 1 "pairs that the scene declares empty and that no item says anything about: the names of both sides, one after the other, UTF-8, a zero byte after each; absent: none";
        54 DECLARED_EMPTY_NOT_LISTED 8 x 1 "how many more such pairs there are than `max_pairs` lets that column have, one unsigned number; absent: none";

        64 NEAREST_A_KIND 1 x 1 "sides wanted, side A of the nearest pair: 0 no pair, 1 a link, 2 the question's shape, 3 a body";
        65 NEAREST_A_ID 8 x 1 "the same: index of the link, id of the body, unsigned";
        66 NEAREST_A_SHAPE 4 x 1 "the same: which shape of the link, unsigned";
        67 NEAREST_A_SUBSHAPE 4 x 1 "the same: triangle, part, column or point, unsigned";
        68 NEAREST_B_KIND 1 x 1 "side B of the nearest pair";
        69 NEAREST_B_ID 8 x 1 "the same: index of the link, id of the body, unsigned";
        70 NEAREST_B_SHAPE 4 x 1 "the same: which shape of the link, unsigned";
        71 NEAREST_B_SUBSHAPE 4 x 1 "the same: triangle, part, column or point, unsigned";
        72 NEAREST_VERDICT 1 x 1 "sides wanted: of the nearest pair alone; 0: no pair";
        73 NEAREST_INDETERMINACY 1 x 1 "sides wanted: why the nearest pair is INDETERMINATE";
        74 NEAREST_TERMINATION 1 x 1 "sides wanted: how the work on the nearest pair stopped, the numbers of `Termination`; 0: no pair";
        75 NEAREST_POINT_ON_A 8 x 3 "witness wanted, metres, world: of the nearest pair; NaN: none";
        76 NEAREST_POINT_ON_B 8 x 3 "the same, on side B";
        77 NEAREST_NORMAL 8 x 3 "witness wanted, world: unit vector from A to B; NaN: none";
        78 NEAREST_POINT_ERROR 8 x 1 "witness wanted, metres: how far at most the points are off; NaN: none";
        79 NEAREST_NORMAL_ERROR 8 x 1 "witness wanted, radians: how far at most the normal is turned; NaN: none";

        96 PAIR_COUNTS 4 x 1 "pairs wanted: how many of the listed pairs belong to each item, unsigned; the columns after this have a row a listed pair";
        97 PAIR_A_KIND 1 x 1 "listed pairs, side A, as for the nearest pair";
        98 PAIR_A_ID 8 x 1 "the same: index of the link, id of the body, unsigned";
        99 PAIR_A_SHAPE 4 x 1 "the same: which shape of the link, unsigned";
        100 PAIR_A_SUBSHAPE 4 x 1 "the same: triangle, part, column or point, unsigned";
        101 PAIR_B_KIND 1 x 1 "listed pairs, side B";
        102 PAIR_B_ID 8 x 1 "the same: index of the link, id of the body, unsigned";
        103 PAIR_B_SHAPE 4 x 1 "the same: which shape of the link, unsigned";
        104 PAIR_B_SUBSHAPE 4 x 1 "the same: triangle, part, column or point, unsigned";
        105 PAIR_VERDICT 1 x 1 "listed pairs: the verdict of each";
        106 PAIR_INDETERMINACY 1 x 1 "listed pairs: why one is INDETERMINATE";
        107 PAIR_TERMINATION 1 x 1 "listed pairs: how the work stopped";
        108 PAIR_LOWER 8 x 1 "listed pairs, metres: lower end of the bracket";
        109 PAIR_UPPER 8 x 1 "listed pairs, metres: upper end of the bracket";
        110 PAIR_SIGNED_DISTANCE 8 x 1 "listed pairs, metres: best estimate inside the bracket";

        128 HIT_COUNTS 4 x 1 "of rays: how many of the hits belong to each ray, unsigned; the next columns have a row a hit";
        129 HIT_BODIES 8 x 1 "of rays: ids of the bodies met, unsigned";
        130 HIT_SUBSHAPES 4 x 1 "of rays: triangle, part, column or point, unsigned";
        131 HIT_LOWER 8 x 1 "of rays, metres along the ray: not met before";
        132 HIT_UPPER 8 x 1 "of rays, metres along the ray: met at the latest here";
        133 HIT_AT_START 1 x 1 "of rays: 1 where the ray begins in the body";
        134 HIT_POINTS 8 x 3 "of rays: metres, world";
        135 HIT_NORMALS 8 x 3 "of rays: unit vectors out of the body, world";
        136 GRAZED_COUNTS 4 x 1 "of rays: how many of the grazed bodies belong to each ray, unsigned; the next columns have a row each";
        137 GRAZED_BODIES 8 x 1 "of rays: ids of bodies that are perhaps met, unsigned";
        138 GRAZED_LOWER 8 x 1 "of rays, metres along the ray: not met before";
        139 GRAZED_UPPER 8 x 1 "of rays, metres along the ray: not met after";
        140 GRAZED_INDETERMINACIES 1 x 1 "of rays: why it is left open";

        160 ERROR_REASON 1 x 1 "of errors: a name of `ErrorReason` in service.proto without its prefix, ASCII";
        161 ERROR_MESSAGE 1 x 1 "of errors: for people, UTF-8";
        162 ERROR_FIELD 1 x 1 "of errors with a field at fault: its path, UTF-8";
        163 ERROR_DETAILS 1 x 1 "of errors: key=value lines as in gRPC's metadata, without `clearance-`, UTF-8";
    }

    /// The column of a number.
    #[must_use]
    pub fn column(kind: u32) -> Option<&'static Column> {
        COLUMNS.binary_search_by_key(&kind, |column| column.kind).ok().map(|index| &COLUMNS[index])
    }
}

/// FNV-1a, 64 bits, over bytes.
const fn hashed(mut hash: u64, bytes: &[u8]) -> u64 {
    let mut index = 0;
    while index < bytes.len() {
        hash = (hash ^ bytes[index] as u64).wrapping_mul(0x0000_0100_0000_01b3);
        index += 1;
    }
    hash
}

const fn hashed_number(hash: u64, number: usize) -> u64 {
    hashed(hash, &(number as u64).to_le_bytes())
}

const fn hashed_fields(mut hash: u64, bytes: usize, fields: &[Field]) -> u64 {
    hash = hashed_number(hash, bytes);
    let mut index = 0;
    while index < fields.len() {
        let field = &fields[index];
        hash = hashed(hashed(hash, field.name.as_bytes()), field.c_type.as_bytes());
        hash = hashed_number(hashed_number(hash, field.count), field.offset);
        index += 1;
    }
    hash
}

const fn hashed_layout() -> u64 {
    let mut hash = hashed_number(0xcbf2_9ce4_8422_2325, VERSION as usize);
    hash = hashed_fields(hash, RequestHeader::BYTES, RequestHeader::FIELDS);
    hash = hashed_fields(hash, ResponseHeader::BYTES, ResponseHeader::FIELDS);
    hash = hashed_fields(hash, SectionEntry::BYTES, SectionEntry::FIELDS);
    let mut index = 0;
    while index < kind::COLUMNS.len() {
        let column = &kind::COLUMNS[index];
        hash = hashed(hashed_number(hash, column.kind as usize), column.name.as_bytes());
        hash = hashed_number(hashed_number(hash, column.element), column.per_row);
        index += 1;
    }
    hash
}

/// Over names, types and places of all fields and columns: two sides that differ in any of them do not talk.
pub const ABI_HASH: u64 = hashed_layout();

#[cfg(test)]
mod tests {
    use super::*;

    fn size_of_c(field: &Field) -> usize {
        let one = match field.c_type {
            "uint8_t" => 1,
            "uint32_t" => 4,
            "uint64_t" | "double" => 8,
            other => panic!("{other}"),
        };
        one * field.count
    }

    #[test]
    fn fields_follow_one_another_where_c_puts_them() {
        let tables = [(RequestHeader::FIELDS, 256), (ResponseHeader::FIELDS, 256), (SectionEntry::FIELDS, ENTRY_BYTES)];
        for (fields, bytes) in tables {
            let mut end = 0;
            for field in fields {
                assert_eq!(field.offset, end, "{field:?} leaves a gap");
                assert_eq!(field.offset % (size_of_c(field) / field.count), 0, "{field:?} is not aligned");
                end = field.offset + size_of_c(field);
            }
            assert!(end <= bytes && bytes % ENTRY_BYTES == 0);
        }
        assert_eq!((RequestHeader::BYTES % ALIGNMENT, ResponseHeader::BYTES % ALIGNMENT), (0, 0));
    }

    #[test]
    fn columns_are_sorted_and_of_sizes_that_are_read() {
        assert!(kind::COLUMNS.windows(2).all(|pair| pair[0].kind < pair[1].kind));
        assert!(kind::COLUMNS.iter().all(|column| matches!(column.element, 1 | 4 | 8)));
        assert_eq!(kind::column(kind::ORIGINS).map(|column| (column.element, column.per_row)), Some((8, 3)));
        assert_eq!(kind::column(0), None);
    }

    #[test]
    fn a_header_is_read_as_it_was_written() {
        let header = RequestHeader { magic: MAGIC, nonce: [7; 16], margin: 0.25, max_states: 9, ..Default::default() };
        let mut bytes = [0; RequestHeader::BYTES];
        header.write(&mut bytes);
        assert_eq!(RequestHeader::read(&bytes), header);
        assert_eq!(RequestHeader::read(&bytes[..10]).nonce, [0; 16], "short bytes are no reason to stop");
    }
}
