//! The C header, the Python client's table and `docs/wire.md` say the same as the layout: they are made from it and compared
//! with the committed files, and a C compiler confirms every offset.

use std::fmt::Write;
use std::process::Command;

use clearance::transports::shared_memory::layout::{
    ABI_HASH, ALIGNMENT, Field, MAGIC, MOST_SECTIONS, RequestHeader, ResponseHeader, SectionEntry, VERSION, kind,
};

const HEADER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/clients/c/clearance_shared_memory.h");
const PYTHON: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/clients/python/src/clearance/shared_memory_layout.py");
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/wire.md");

/// Every header: its name in C, its size, its fields.
const HEADERS: [(&str, usize, &[Field]); 3] = [
    ("clearance_request_header", RequestHeader::BYTES, RequestHeader::FIELDS),
    ("clearance_response_header", ResponseHeader::BYTES, ResponseHeader::FIELDS),
    ("clearance_section", SectionEntry::BYTES, SectionEntry::FIELDS),
];

fn size(field: &Field) -> usize {
    let one = match field.c_type {
        "uint8_t" => 1,
        "uint32_t" => 4,
        _ => 8,
    };
    one * field.count
}

fn array(count: usize) -> String {
    if count == 1 { String::new() } else { format!("[{count}]") }
}

fn c_header() -> String {
    let mut text = String::from(
        "/* Messages of the shared-memory door, layout for layout; docs/wire.md explains them.\n\
         \x20* Made from src/transports/shared_memory/layout.rs by `cargo test --test service header`; do not edit.\n\
         \x20* Little-endian machines only. */\n\
         #ifndef CLEARANCE_SHARED_MEMORY_H\n#define CLEARANCE_SHARED_MEMORY_H\n\n\
         #include <assert.h>\n#include <stddef.h>\n#include <stdint.h>\n\n",
    );
    let magic: String = MAGIC.iter().map(|byte| format!("0x{byte:02x}, ")).collect();
    writeln!(text, "#define CLEARANCE_MAGIC {{{}}}", magic.trim_end_matches(", ")).unwrap();
    writeln!(text, "#define CLEARANCE_ABI_HASH UINT64_C({ABI_HASH:#018x})").unwrap();
    writeln!(text, "#define CLEARANCE_VERSION {VERSION}").unwrap();
    writeln!(text, "#define CLEARANCE_ALIGNMENT {ALIGNMENT}").unwrap();
    writeln!(text, "#define CLEARANCE_MOST_SECTIONS {MOST_SECTIONS}\n").unwrap();
    for (name, bytes, fields) in HEADERS {
        writeln!(text, "typedef struct {name} {{").unwrap();
        let mut end = 0;
        for field in fields {
            writeln!(text, "    {} {}{}; /* {} */", field.c_type, field.name, array(field.count), field.meaning)
                .unwrap();
            end = field.offset + size(field);
        }
        if end < bytes {
            writeln!(text, "    uint8_t kept_free[{}]; /* zeros */", bytes - end).unwrap();
        }
        writeln!(text, "}} {name};\n").unwrap();
        for field in fields {
            writeln!(text, "static_assert(offsetof({name}, {}) == {}, \"{}\");", field.name, field.offset, field.name)
                .unwrap();
        }
        writeln!(text, "static_assert(sizeof({name}) == {bytes}, \"{name}\");\n").unwrap();
    }
    text.push_str("enum clearance_section_kind {\n");
    for column in kind::COLUMNS {
        writeln!(text, "    CLEARANCE_{} = {}, /* {} */", column.name, column.kind, column.meaning).unwrap();
    }
    text.push_str("};\n\n#endif\n");
    text
}

/// The module that the Python client reads offsets from.
fn python_layout() -> String {
    let mut text = String::from(
        "\"\"\"Where each field of a shared-memory message stands.\n\n\
         Made from src/transports/shared_memory/layout.rs by `cargo test --test service header`; do not edit.\n\"\"\"\n\n",
    );
    let magic: String = MAGIC.iter().map(|byte| format!("{byte:02x}")).collect();
    writeln!(text, "MAGIC = bytes.fromhex(\"{magic}\")\nABI_HASH = {ABI_HASH:#018x}\nVERSION = {VERSION}").unwrap();
    writeln!(text, "ALIGNMENT = {ALIGNMENT}\nMOST_SECTIONS = {MOST_SECTIONS}\n").unwrap();
    text.push_str("# Name: (size, {field: (numpy type, count, offset)}).\nHEADERS = {\n");
    for (name, bytes, fields) in HEADERS {
        writeln!(text, "    \"{name}\": (\n        {bytes},\n        {{").unwrap();
        for field in fields {
            let numpy = match field.c_type {
                "uint8_t" => "u1",
                "uint32_t" => "<u4",
                "uint64_t" => "<u8",
                _ => "<f8",
            };
            writeln!(text, "            \"{}\": (\"{numpy}\", {}, {}),", field.name, field.count, field.offset)
                .unwrap();
        }
        text.push_str("        },\n    ),\n");
    }
    text.push_str("}\n\n# Name: (kind, bytes of a number, numbers of a row).\nCOLUMNS = {\n");
    for column in kind::COLUMNS {
        let name = column.name.to_ascii_lowercase();
        writeln!(text, "    \"{name}\": ({}, {}, {}),", column.kind, column.element, column.per_row).unwrap();
    }
    text.push_str("}\n");
    text
}

/// The tables of the page: one a header, and one of the columns.
fn page_tables() -> String {
    let mut text = String::new();
    for (name, _, fields) in HEADERS {
        writeln!(text, "### `{name}`\n\n| offset | field | type | meaning |\n| --- | --- | --- | --- |").unwrap();
        for field in fields {
            let Field { name, c_type, count, offset, meaning } = *field;
            writeln!(text, "| {offset} | `{name}` | `{c_type}{}` | {meaning} |", array(count)).unwrap();
        }
        text.push('\n');
    }
    text.push_str(
        "### Columns\n\n| kind | column | bytes a number | numbers a row | holds |\n| --- | --- | --- | --- | --- |\n",
    );
    for column in kind::COLUMNS {
        let per_row = if column.per_row == 0 { "any".to_owned() } else { column.per_row.to_string() };
        writeln!(text, "| {} | `{}` | {} | {per_row} | {} |", column.kind, column.name, column.element, column.meaning)
            .unwrap();
    }
    text
}

/// Compares, or writes when it is told to.
fn compare(path: &str, wanted: &str) {
    if std::env::var_os("CLEARANCE_WRITE").is_some() {
        std::fs::write(path, wanted).unwrap();
    }
    let there = std::fs::read_to_string(path).unwrap();
    assert!(there == wanted, "{path} is not what the layout says; CLEARANCE_WRITE=1 cargo test --test service header");
}

#[test]
fn the_committed_header_is_the_layouts() {
    compare(HEADER, &c_header());
}

#[test]
fn the_committed_python_module_is_the_layouts() {
    compare(PYTHON, &python_layout());
}

#[test]
fn the_page_has_every_field_and_column() {
    let page = std::fs::read_to_string(PAGE).unwrap();
    let (before, rest) = page.split_once("<!-- tables -->\n").expect("a mark before the tables");
    let (_, after) = rest.split_once("<!-- end of tables -->\n").expect("a mark after the tables");
    let wanted = format!("{before}<!-- tables -->\n{}<!-- end of tables -->\n{after}", page_tables());
    compare(PAGE, &wanted);
}

/// The compiler's own numbers, not those that were written into the assertions.
#[test]
fn a_c_compiler_finds_every_field_where_the_layout_says() {
    let folder = tempfile::tempdir().unwrap();
    let (source, program) = (folder.path().join("offsets.c"), folder.path().join("offsets"));
    let mut text = format!("#include <stdio.h>\n#include \"{HEADER}\"\nint main(void) {{\n");
    let mut wanted = String::new();
    for (name, bytes, fields) in HEADERS {
        for field in fields {
            let value = format!("((struct {name} *)0)->{}", field.name);
            writeln!(
                text,
                "  printf(\"{name}.{} %zu %zu\\n\", offsetof(struct {name}, {}), sizeof({value}));",
                field.name, field.name
            )
            .unwrap();
            writeln!(wanted, "{name}.{} {} {}", field.name, field.offset, size(field)).unwrap();
        }
        writeln!(text, "  printf(\"{name} %zu\\n\", sizeof(struct {name}));").unwrap();
        writeln!(wanted, "{name} {bytes}").unwrap();
    }
    for column in kind::COLUMNS {
        writeln!(text, "  printf(\"{} %d\\n\", (int)CLEARANCE_{});", column.name, column.name).unwrap();
        writeln!(wanted, "{} {}", column.name, column.kind).unwrap();
    }
    writeln!(text, "  printf(\"%016llx\\n\", (unsigned long long)CLEARANCE_ABI_HASH);\n  return 0;\n}}").unwrap();
    writeln!(wanted, "{ABI_HASH:016x}").unwrap();
    std::fs::write(&source, text).unwrap();
    let flags = ["-std=c11", "-Wall", "-Wextra", "-Werror", "-o"];
    // Of its own umask: iceoryx2 changes that of this process for a moment whenever another test opens a listener.
    let mut compiler = Command::new("sh");
    compiler.args(["-c", "umask 022 && exec cc \"$@\"", "cc"]).args(flags).arg(&program).arg(&source);
    let compiled = compiler.output().unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let told = Command::new(&program).output().unwrap();
    assert_eq!(String::from_utf8(told.stdout).unwrap(), wanted);
}
