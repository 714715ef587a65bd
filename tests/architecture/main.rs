//! Holds the rules of `docs/architecture.md`: the floors, the three invariants, and how a file may look.
//!
//! The rules are checked against the tree as it stands here, and each checker is tried on small made-up sources beside
//! it, so that a checker which finds nothing is found itself.

mod floors;
mod habits;
mod operators_page;
mod source;

use std::fs;
use std::path::Path;

use source::Source;

/// Every file of `src/`, in the order of their paths.
fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    let mut folders = vec![root.join("src")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    // A module `tests` is compiled for tests alone, and so is what lies in its folder.
    files.retain(|file| !file.ends_with("tests.rs") && !file.parent().is_some_and(|folder| folder.ends_with("tests")));
    let read = |file: &std::path::PathBuf| {
        let name = file.strip_prefix(root).unwrap().to_str().unwrap().to_owned();
        Source::parse(&name, &fs::read_to_string(file).unwrap()).unwrap()
    };
    files.iter().map(read).collect()
}

fn nothing_wrong(faults: Vec<String>) {
    assert!(faults.is_empty(), "{} fault(s):\n{}", faults.len(), faults.join("\n"));
}

/// What a question goes through from the door's call to its answer, on the floor `service`; below it no lock is allowed
/// anyway.
const READ_PATH: &[&str] = &["published.rs", "revision_rule.rs", "view.rs", "admission.rs", "scene_health.rs"];

/// Words that stand for waiting on somebody else.
const LOCKS: &[&str] =
    &["Mutex", "RwLock", "Condvar", "OnceLock", "LazyLock", "Semaphore", "Notify", "Barrier", "watch", "mpsc", "lock"];

fn locks(source: &Source) -> Vec<String> {
    let named = source.words.iter().filter(|word| LOCKS.contains(&word.text.as_str()));
    named.map(|word| format!("{}:{}: a reader must not wait: `{}`", source.file, word.line, word.text)).collect()
}

#[test]
fn readers_take_no_lock() {
    let sources = sources();
    let on_the_path = |source: &&Source| READ_PATH.iter().any(|file| source.file == format!("src/service/{file}"));
    let path: Vec<&Source> = sources.iter().filter(on_the_path).collect();
    assert_eq!(path.len(), READ_PATH.len());
    nothing_wrong(path.into_iter().flat_map(locks).collect());
    let wrong = Source::parse("src/service/view.rs", "fn f(m: &std::sync::Mutex<u8>) { m.lock(); }").unwrap();
    assert_eq!(locks(&wrong).len(), 2);
}

#[test]
fn imports_go_downward_only() {
    nothing_wrong(sources().iter().flat_map(floors::check).collect());
}

#[test]
fn every_dependency_has_its_floors() {
    let manifest = include_str!("../../Cargo.toml").parse().unwrap();
    nothing_wrong(floors::check_manifest(&manifest));
}

#[test]
fn files_keep_the_habits_of_the_house() {
    let sources = sources();
    assert!(sources.len() > 10, "only {} files were read", sources.len());
    nothing_wrong(sources.iter().flat_map(habits::check).collect());
}

/// The last half of the third invariant: what is answered says which scene it was asked of.
#[test]
fn answers_name_epoch_and_revision() {
    let answers = sources().into_iter().find(|source| source.file == "src/query/answer.rs").unwrap();
    let text: String = answers.tokens.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    let answer = text.split("pub struct Answer ").nth(1).expect("src/query/answer.rs holds `struct Answer`");
    let fields = answer.split('}').next().unwrap();
    for field in ["pub epoch", "pub revision"] {
        assert!(fields.contains(field), "`struct Answer` has no field `{field}`");
    }
}
