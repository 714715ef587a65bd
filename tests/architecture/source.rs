//! What does a source file name? Reads Rust by its tokens, so that comments, doc links and strings do not count, and
//! code that is compiled for tests alone is left out.

use std::str::FromStr;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// One file of `src/`, ready to be asked about.
pub struct Source {
    /// The path from the repository's root, for messages.
    pub file: String,
    /// The module the file is, from the crate's root; `main.rs` counts as the module `main`.
    pub module: Vec<String>,
    /// Lines, comments included.
    pub lines: usize,
    /// Whether it begins with a `//!` comment.
    pub has_header: bool,
    /// Paths of two or more names, and whatever `use` brings in.
    pub paths: Vec<NamedPath>,
    /// Every identifier.
    pub words: Vec<Word>,
    /// The file's own items, as tokens.
    pub tokens: Vec<TokenTree>,
}

/// A path as it is meant: `crate`, `self` and `super` are resolved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedPath {
    /// Whether it begins in our own crate.
    pub own: bool,
    /// Its names, without `crate`.
    pub names: Vec<String>,
    /// Where it begins.
    pub line: usize,
}

/// An identifier and what stands around it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    /// The identifier.
    pub text: String,
    /// Whether `!` follows: `panic!` is another word than `panic`.
    pub is_macro: bool,
    /// Whether `.` stands before it.
    pub is_method: bool,
    /// Where it stands.
    pub line: usize,
}

impl Source {
    /// Reads `text`, the contents of `file` (a path such as `src/geometry/pose.rs`).
    ///
    /// # Errors
    /// Text that is not made of Rust's tokens.
    pub fn parse(file: &str, text: &str) -> Result<Self, String> {
        let tokens = TokenStream::from_str(text).map_err(|e| format!("{file}: {e}"))?;
        let tokens = without_tests(tokens);
        let module = module_of(file);
        let mut paths = Vec::new();
        collect_paths(&tokens, &mut module.clone(), &mut paths);
        let mut words = Vec::new();
        collect_words(&tokens, &mut words);
        let has_header = text.trim_start().starts_with("//!");
        Ok(Self { file: file.to_owned(), module, lines: text.lines().count(), has_header, paths, words, tokens })
    }
}

/// `src/geometry/pose.rs` is the module `geometry::pose`, `src/geometry/mod.rs` is `geometry`, `src/lib.rs` the root.
fn module_of(file: &str) -> Vec<String> {
    let inside = file.trim_start_matches("src/").trim_end_matches(".rs");
    let mut names: Vec<String> = inside.split('/').map(str::to_owned).collect();
    if names.last().is_some_and(|last| last == "mod" || last == "lib") {
        names.pop();
    }
    names
}

/// Drops every item under `#[cfg(test)]` or `#[test]`, at every depth.
fn without_tests(tokens: TokenStream) -> Vec<TokenTree> {
    let mut kept = Vec::new();
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        let is_test = is_punct(&token, '#') && tokens.peek().is_some_and(is_test_attribute);
        if is_test {
            // The item ends with its body or with its semicolon, whichever comes first.
            let ends = |t: &TokenTree| is_group(t, Delimiter::Brace) || is_punct(t, ';');
            tokens.by_ref().find(ends);
            continue;
        }
        kept.push(match token {
            TokenTree::Group(group) => {
                let inner: TokenStream = without_tests(group.stream()).into_iter().collect();
                let mut pruned = proc_macro2::Group::new(group.delimiter(), inner);
                pruned.set_span(group.span());
                TokenTree::Group(pruned)
            }
            TokenTree::Ident(_) | TokenTree::Punct(_) | TokenTree::Literal(_) => token,
        });
    }
    kept
}

/// `[test]` or `[cfg(...)]` with `test` and no `not` in it.
fn is_test_attribute(token: &TokenTree) -> bool {
    let TokenTree::Group(group) = token else { return false };
    let text = group.stream().to_string();
    let names: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|n| !n.is_empty()).collect();
    group.delimiter() == Delimiter::Bracket
        && match names.first() {
            Some(&"test") => names.len() == 1,
            Some(&"cfg") => names.contains(&"test") && !names.contains(&"not"),
            Some(_) | None => false,
        }
}

fn collect_words(tokens: &[TokenTree], words: &mut Vec<Word>) {
    for (i, token) in tokens.iter().enumerate() {
        match token {
            TokenTree::Group(group) => collect_words(&group.stream().into_iter().collect::<Vec<_>>(), words),
            TokenTree::Ident(ident) => words.push(Word {
                text: ident.to_string(),
                is_macro: tokens.get(i + 1).is_some_and(|next| is_punct(next, '!')),
                is_method: i > 0 && is_punct(&tokens[i - 1], '.'),
                line: ident.span().start().line,
            }),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}

fn collect_paths(tokens: &[TokenTree], module: &mut Vec<String>, paths: &mut Vec<NamedPath>) {
    let mut i = 0;
    while i < tokens.len() {
        if let [TokenTree::Ident(word), TokenTree::Ident(name), TokenTree::Group(body), ..] = &tokens[i..]
            && word == "mod"
        {
            module.push(name.to_string());
            collect_paths(&body.stream().into_iter().collect::<Vec<_>>(), module, paths);
            module.pop();
            i += 3;
            continue;
        }
        match &tokens[i] {
            TokenTree::Ident(start) => {
                let imported = i > 0 && matches!(&tokens[i - 1], TokenTree::Ident(word) if word == "use");
                let mut found = Vec::new();
                i = read_path(tokens, i, &[], &mut found);
                let line = start.span().start().line;
                let named = found.into_iter().filter(|names| names.len() > 1 || imported);
                paths.extend(named.map(|names| resolve(names, module, line)));
            }
            TokenTree::Group(group) => {
                collect_paths(&group.stream().into_iter().collect::<Vec<_>>(), module, paths);
                i += 1;
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => i += 1,
        }
    }
}

/// Reads the path or use-tree at `start` into `found`, each path behind `prefix`; returns where it ends.
fn read_path(tokens: &[TokenTree], start: usize, prefix: &[String], found: &mut Vec<Vec<String>>) -> usize {
    let mut names = prefix.to_vec();
    let mut i = start;
    loop {
        match tokens.get(i) {
            Some(TokenTree::Ident(name)) => names.push(name.to_string()),
            Some(TokenTree::Punct(star)) if star.as_char() == '*' => names.push("*".to_owned()),
            Some(TokenTree::Group(list)) if list.delimiter() == Delimiter::Brace && i > start => {
                let list: Vec<TokenTree> = list.stream().into_iter().collect();
                for branch in list.split(|t| is_punct(t, ',')).filter(|branch| !branch.is_empty()) {
                    read_path(branch, 0, &names, found);
                }
                return i + 1;
            }
            Some(_) | None => break, // A turbofish: the names before it are the path.
        }
        i += 1;
        let colons = tokens.get(i..i + 2).is_some_and(|next| next.iter().all(|t| is_punct(t, ':')));
        if !colons {
            break;
        }
        i += 2;
    }
    found.push(names);
    i.max(start + 1)
}

fn resolve(names: Vec<String>, module: &[String], line: usize) -> NamedPath {
    let mut base = module.to_vec();
    let mut rest = names.as_slice();
    match rest.first().map(String::as_str) {
        Some("crate") => base.clear(),
        Some("clearance") if module == ["main"] => base.clear(),
        Some("self" | "super") => {
            while rest.first().is_some_and(|name| name == "super") {
                base.pop();
                rest = &rest[1..];
            }
            let skip = usize::from(rest.first().is_some_and(|name| name == "self"));
            base.extend_from_slice(&rest[skip..]);
            return NamedPath { own: true, names: base, line };
        }
        Some(_) | None => return NamedPath { own: false, names, line },
    }
    base.extend_from_slice(&rest[1..]);
    NamedPath { own: true, names: base, line }
}

/// Whether the token is that mark.
pub fn is_punct(token: &TokenTree, mark: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == mark)
}

/// Whether the token is a group in those brackets.
pub fn is_group(token: &TokenTree, delimiter: Delimiter) -> bool {
    matches!(token, TokenTree::Group(group) if group.delimiter() == delimiter)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn own_paths(file: &str, text: &str) -> Vec<String> {
        let source = Source::parse(file, text).unwrap();
        source.paths.iter().filter(|p| p.own).map(|p| p.names.join("::")).collect()
    }

    #[test]
    fn use_trees_are_written_out() {
        let text = "use crate::{geometry::{Pose, Vec3}, scene::Scene}; use crate::query::*;";
        let expected = ["geometry::Pose", "geometry::Vec3", "scene::Scene", "query::*"];
        assert_eq!(own_paths("src/service/mod.rs", text), expected);
    }

    #[test]
    fn super_and_self_are_resolved_against_the_file_and_inline_modules() {
        let text = "use super::super::scene::Scene; mod inner { fn f() { super::super::Aabb::empty(); self::g(); } }";
        let expected = ["scene::Scene", "geometry::Aabb::empty", "geometry::pose::inner::g"];
        assert_eq!(own_paths("src/geometry/pose.rs", text), expected);
        assert_eq!(own_paths("src/geometry/mod.rs", "use self::pose::Pose;"), ["geometry::pose::Pose"]);
    }

    #[test]
    fn paths_in_macros_and_expressions_count() {
        let text = "fn f() { println!(\"{}\", crate::service::x()); let v = crate::app::g::<u8>(); }";
        assert_eq!(own_paths("src/query/collide.rs", text), ["service::x", "app::g"]);
    }

    #[test]
    fn comments_strings_and_tests_do_not_count() {
        let text = r##"
            //! See [`crate::service::Service`].
            /// And [`crate::app`].
            const A: &str = "crate::app::x"; const B: &str = r#"use crate::app::x;"#;
            #[cfg(test)] mod tests { use crate::app::x; }
            #[cfg(test)] use crate::app::y;
            impl A { #[cfg(test)] fn f() { crate::app::z(); } }
            #[cfg(not(test))] use crate::scene::Scene;
        "##;
        assert_eq!(own_paths("src/query/collide.rs", text), ["scene::Scene"]);
    }

    #[test]
    fn words_tell_macros_and_methods_apart() {
        let source = Source::parse("src/a.rs", "fn f() { panic!(); x.await; let unwrap = 1; }").unwrap();
        let word = |text: &str| source.words.iter().find(|w| w.text == text).unwrap();
        assert!(word("panic").is_macro && word("await").is_method && !word("unwrap").is_method);
    }

    #[test]
    fn lines_are_those_of_the_file() {
        let source = Source::parse("src/a.rs", "//! A.\n\nuse std::fs;\n").unwrap();
        assert!(source.has_header);
        assert_eq!(source.paths, [NamedPath { own: false, names: vec!["std".into(), "fs".into()], line: 3 }]);
    }
}
