//! What a file may contain, wherever it stands: the words banned below `service`, what a `mod.rs` may hold, sizes, names.

use proc_macro2::{Delimiter, TokenTree};

use crate::floors::KERNEL;
use crate::source::{NamedPath, Source, is_group, is_punct};

/// A file longer than this holds more than one idea.
const LONGEST_FILE: usize = 700;

/// Modules named after nothing.
const EMPTY_NAMES: &[&str] = &["utils", "util", "helpers", "helper", "common", "misc"];

/// Parts of the standard library that reach outside the process or read a clock.
const OUTSIDE: &[&str] = &[
    "std::env",
    "std::fs",
    "std::io::stderr",
    "std::io::stdin",
    "std::io::stdout",
    "std::net",
    "std::os",
    "std::process",
    "std::thread",
    "std::time",
];

/// Not a clock: a length of time, which limits are given in.
const NOT_A_CLOCK: &str = "std::time::Duration";

/// Words that make a value change under its readers, or make code wait.
const CHANGING: &[&str] =
    &["async", "await", "Cell", "RefCell", "UnsafeCell", "Mutex", "RwLock", "Condvar", "static_mut"];

/// Macros that write to the terminal.
const PRINTING: &[&str] = &["print", "println", "eprint", "eprintln"];

/// Macros that give up.
const PANICKING: &[&str] = &["panic", "todo", "unimplemented"];

/// What is wrong with `source`, one line each.
pub fn check(source: &Source) -> Vec<String> {
    let mut faults = Vec::new();
    let file = &source.file;
    if source.lines > LONGEST_FILE {
        faults.push(format!("{file}: {} lines; {LONGEST_FILE} is the most for one idea", source.lines));
    }
    if !source.has_header {
        faults.push(format!("{file}: begins with no `//!` comment that says what it answers"));
    }
    if let Some(name) = source.module.iter().find(|name| EMPTY_NAMES.contains(&name.as_str())) {
        faults.push(format!("{file}: `{name}` names nothing; name the thing it holds"));
    }
    if file.ends_with("/mod.rs") || file == "src/lib.rs" {
        faults.extend(items_beside_re_exports(&source.tokens).into_iter().map(|item| {
            format!("{file}: holds `{item}`; a module's root holds re-exports and a paragraph, nothing else")
        }));
    }
    for word in &source.words {
        let text = word.text.as_str();
        if (word.is_method && text == "unwrap") || (word.is_macro && PANICKING.contains(&text)) {
            faults
                .push(format!("{file}:{}: `{text}` outside of tests; return an error, or `expect` why not", word.line));
        }
    }
    if source.module.first().is_some_and(|floor| KERNEL.contains(&floor.as_str())) {
        faults.extend(below_service(source));
    }
    faults
}

/// Below `service`: nothing async, no I/O, no clock, no value that changes under its readers.
fn below_service(source: &Source) -> Vec<String> {
    let mut faults = Vec::new();
    for path in source.paths.iter().filter(|path| !path.own && reaches_outside(path)) {
        let names = path.names.join("::");
        faults
            .push(format!("{}:{}: `{names}` below service: no clock, files, network, threads", source.file, path.line));
    }
    for word in &source.words {
        let text = word.text.as_str();
        let changes = CHANGING.contains(&text) || text.starts_with("Atomic");
        if changes || (word.is_macro && PRINTING.contains(&text)) {
            faults.push(format!("{}:{}: `{text}` below service", source.file, word.line));
        }
    }
    faults
}

fn reaches_outside(path: &NamedPath) -> bool {
    let names = path.names.join("::");
    let within = |banned: &str| names == banned || names.starts_with(&format!("{banned}::"));
    !within(NOT_A_CLOCK) && OUTSIDE.iter().any(|banned| within(banned))
}

/// The first word of every top-level item that is not `mod x;`, `use ..;` or an alias `type X = ..;`.
fn items_beside_re_exports(tokens: &[TokenTree]) -> Vec<String> {
    let mut found = Vec::new();
    let mut item: Vec<&TokenTree> = Vec::new();
    for token in tokens {
        item.push(token);
        let ended = is_punct(token, ';') || is_group(token, Delimiter::Brace);
        let inside_use = matches!(item.as_slice(), [.., before, brace]
            if is_group(brace, Delimiter::Brace) && is_punct(before, ':'));
        if ended && !inside_use {
            let words = without_attributes(&item);
            let kind = words.iter().find(|word| *word != "pub");
            let by_semicolon = is_punct(token, ';');
            match kind.map(String::as_str) {
                Some("use" | "mod" | "type") if by_semicolon => {}
                Some(other) => found.push(other.to_owned()),
                None => {}
            }
            item.clear();
        }
    }
    found
}

/// The identifiers of an item at its own level; what stands in brackets (attributes, `pub(crate)`) does not count.
fn without_attributes(item: &[&TokenTree]) -> Vec<String> {
    item.iter()
        .filter_map(|token| match token {
            TokenTree::Ident(ident) => Some(ident.to_string()),
            TokenTree::Group(_) | TokenTree::Punct(_) | TokenTree::Literal(_) => None,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The faults of a file that begins with a header.
    fn faults(file: &str, text: &str) -> Vec<String> {
        check(&Source::parse(file, &format!("//! Header.\n{text}")).unwrap())
    }

    fn count(file: &str, text: &str) -> usize {
        faults(file, text).len()
    }

    #[test]
    fn clocks_files_and_network_are_found_below_service_only() {
        for text in ["use std::time::Instant;", "use std::{fs, net};", "fn f() { std::thread::sleep(d); }"] {
            assert!(count("src/query/a.rs", text) > 0, "{text}");
            assert_eq!(count("src/service/a.rs", text), 0, "{text}");
        }
        assert_eq!(count("src/limits.rs", "use std::time::Duration;"), 0);
        assert_eq!(count("src/robot/a.rs", "use std::io::{BufRead, Cursor};"), 0);
    }

    #[test]
    fn async_printing_and_changing_values_are_found_below_service_only() {
        for text in
            ["async fn f() {}", "fn f() { println!(); }", "struct A(std::sync::Mutex<u8>);", "use x::AtomicU64;"]
        {
            assert!(count("src/scene/a.rs", text) > 0, "{text}");
            assert_eq!(count("src/transports/a.rs", text), 0, "{text}");
        }
    }

    #[test]
    fn unwrap_and_panic_are_for_tests() {
        assert_eq!(count("src/app/a.rs", "fn f() { x.unwrap(); panic!(); }"), 2);
        assert_eq!(count("src/app/a.rs", "fn f() { x.unwrap_or(1); x.expect(\"why\"); }"), 0);
        assert_eq!(count("src/app/a.rs", "#[cfg(test)] mod tests { fn f() { x.unwrap(); } }"), 0);
    }

    #[test]
    fn a_module_root_holds_re_exports_only() {
        let good = "mod a; pub mod b; #[cfg(feature = \"grpc\")] pub(crate) use a::{X, y::Z}; pub type V = X;";
        assert_eq!(count("src/scene/mod.rs", good), 0);
        for bad in ["pub use a::{X}; fn f() {}", "struct A;", "mod a { }", "const X: u8 = 1;", "impl A {}", "m!{}"] {
            assert_eq!(count("src/scene/mod.rs", bad), 1, "{bad}");
            assert_eq!(count("src/scene/a.rs", bad), 0, "{bad}");
        }
    }

    #[test]
    fn long_nameless_and_headless_files_are_found() {
        assert_eq!(count("src/scene/a.rs", &"\n".repeat(LONGEST_FILE)), 1);
        assert_eq!(count("src/scene/a.rs", &"\n".repeat(LONGEST_FILE - 2)), 0);
        assert_eq!(count("src/scene/utils.rs", ""), 1);
        assert_eq!(count("src/scene/common/a.rs", ""), 1);
        assert_eq!(check(&Source::parse("src/scene/a.rs", "use x::y;").unwrap()).len(), 1);
    }
}
