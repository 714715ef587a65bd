//! `clearance pairs`: how far apart are two shapes, line by line? The library itself, no daemon.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use serde::Serialize;
use serde_json::Value;

use super::case::{self, Case};
use super::exit_code::Failed;
use super::touching::{self, Listed};
use super::words;
use crate::geometry::Vec3;
use crate::narrow_phase::{self, Accuracy, Depth, Goal, NoSeparation, Separation, Solver};
use crate::query::Verdict;

/// Flags of `clearance pairs`.
#[derive(clap::Args, Clone, Debug)]
pub struct Pairs {
    /// JSON lines, one case each; standard input when absent.
    pub file: Option<PathBuf>,
    /// Skip this many cases at the head of the input.
    #[arg(default_value_t = 0)]
    pub start: usize,
    /// Width of the bracket at which the work on a pair ends, relative to the distance; 1e-9 when absent, and with 0 it ends
    /// where rounding ends it.
    #[arg(long, value_name = "REL", value_parser = not_negative)]
    pub tolerance: Option<f64>,
    /// Width of the bracket at which the work on a pair ends, in metres; the wider of the two counts.
    #[arg(long, value_name = "METRES", default_value_t = 0.0, value_parser = not_negative)]
    pub absolute_tolerance: f64,
    /// How far the work on a pair goes.
    #[arg(long, value_enum, default_value_t = Until::Penetration)]
    pub depth: Until,
    /// Who does it; a pair that the solver does not take is answered with the status `unsupported`.
    #[arg(long, value_name = "NAME", default_value_t, value_parser = solver_named)]
    pub solver: Solver,
    /// Also list the pairs of triangles that touch, where one shape is a mesh and the other a mesh or convex; at most so many.
    #[arg(long, value_name = "N", num_args = 0..=1, require_equals = true, default_missing_value = "100000")]
    pub touching: Option<usize>,
    /// Microseconds after which the work on a pair ends with the bracket reached so far.
    #[arg(long, value_name = "N")]
    pub max_time_us: Option<u64>,
    /// Accepted like everywhere; the output is JSON lines with or without it.
    #[arg(long)]
    pub json: bool,
}

/// Names of [`Depth`] on the command line.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// Whether they touch.
    Verdict,
    /// The distance when apart; an overlap is only proved.
    Distance,
    /// The depth of an overlap too.
    Penetration,
}

impl From<Until> for Depth {
    fn from(until: Until) -> Self {
        match until {
            Until::Verdict => Self::Verdict,
            Until::Distance => Self::Distance,
            Until::Penetration => Self::Penetration,
        }
    }
}

fn solver_named(name: &str) -> Result<Solver, String> {
    let names = || Solver::ALL.map(Solver::name).join(", ");
    Solver::named(name).ok_or_else(|| format!("known are {}", names()))
}

fn not_negative(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if number >= 0.0 { Ok(number) } else { Err("must not be negative".to_owned()) }
}

/// Answers every case of the input in order, each with one flushed line.
///
/// Line by line, and not sorted by kinds of shapes: a caller may wait for an answer before it writes the next case, and
/// `docs/queries.md` says how little sorting would save.
///
/// # Errors
/// The input cannot be read or the output not be written. A case that makes no sense is no error, but a line that says so.
pub fn run(pairs: &Pairs, output: &mut dyn Write) -> Result<(), Failed> {
    let (name, mut input): (_, Box<dyn BufRead>) = match &pairs.file {
        Some(path) => {
            let name = path.display().to_string();
            let file = File::open(path).map_err(|error| Failed::input(format!("{name}: {error}")))?;
            (name, Box::new(BufReader::new(file)))
        }
        None => ("standard input".to_owned(), Box::new(io::stdin().lock())),
    };
    answer_all(pairs, &name, &mut *input, output)
}

fn answer_all(pairs: &Pairs, name: &str, input: &mut dyn BufRead, output: &mut dyn Write) -> Result<(), Failed> {
    let mut line = Vec::new();
    let mut case_number = 0;
    let unreadable = |error| Failed::input(format!("{name}: {error}"));
    while input.read_until(b'\n', &mut line).map_err(unreadable)? > 0 {
        let text = line.trim_ascii();
        if !text.is_empty() {
            if case_number >= pairs.start {
                write_line(output, &answer(text, pairs)).map_err(|error| Failed::output(&error))?;
            }
            case_number += 1;
        }
        line.clear();
    }
    Ok(())
}

fn write_line(output: &mut dyn Write, line: &Line) -> io::Result<()> {
    serde_json::to_writer(&mut *output, line)?;
    output.write_all(b"\n")?;
    output.flush()
}

/// One line of output.
#[derive(Serialize)]
struct Line {
    id: Value,
    #[serde(flatten)]
    outcome: Outcome,
}

#[derive(Serialize)]
#[serde(tag = "status", rename_all = "lowercase")]
enum Outcome {
    Ok(Measured),
    Invalid { message: String },
    Unsupported { message: String },
}

#[derive(Serialize)]
struct Measured {
    verdict: &'static str,
    signed_distance: f64,
    lower: f64,
    upper: f64,
    normal: Option<[f64; 3]>,
    witness: Option<[[f64; 3]; 2]>,
    point_error: f64,
    normal_error: f64,
    termination: &'static str,
    iterations: u64,
    micros: f64,
    #[serde(flatten)]
    listed: Option<Listed>,
}

fn answer(line: &[u8], pairs: &Pairs) -> Line {
    let (id, case) = case::read_line(line);
    let outcome = match case.map(|case| measure(&case, pairs)) {
        Ok(Ok(measured)) => Outcome::Ok(measured),
        Ok(Err(NoSeparation::Unclaimed(unclaimed))) => Outcome::Unsupported { message: unclaimed.to_string() },
        Ok(Err(none @ (NoSeparation::Unbounded { .. } | NoSeparation::Empty { .. }))) => {
            Outcome::Invalid { message: none.to_string() }
        }
        Err(message) => Outcome::Invalid { message },
    };
    Line { id, outcome }
}

fn measure(case: &Case, pairs: &Pairs) -> Result<Measured, NoSeparation> {
    let started = Instant::now();
    let budget = pairs.max_time_us.map(Duration::from_micros);
    let out_of_time = || budget.is_some_and(|budget| started.elapsed() >= budget);
    let whole = Goal::penetration();
    let relative = pairs.tolerance.unwrap_or(whole.accuracy.relative);
    let accuracy = Accuracy { relative, absolute: pairs.absolute_tolerance };
    let goal = Goal { depth: pairs.depth.into(), accuracy, solver: pairs.solver, stop: &out_of_time, ..whole };
    let (at_a, at_b) = (case.pose_a.placement(), case.pose_b.placement());
    let separation = narrow_phase::separation(&case.a, &case.b, &at_a, &at_b, &goal)?;
    let micros = started.elapsed().as_secs_f64() * 1e6;
    let listed = pairs.touching.and_then(|limit| touching::listed(case, limit, &out_of_time));
    Ok(Measured { listed, ..written(&separation, micros) })
}

fn written(separation: &Separation, micros: f64) -> Measured {
    let Separation { bracket, signed_distance, normal, point_on_a, point_on_b, .. } = *separation;
    let Separation { point_error, normal_error, termination, cost, .. } = *separation;
    Measured {
        verdict: words::verdict(Verdict::of(&bracket, 0.0, termination)),
        signed_distance,
        lower: bracket.lower,
        upper: bracket.upper,
        normal: finite(normal),
        witness: finite(point_on_a).zip(finite(point_on_b)).map(|(a, b)| [a, b]),
        point_error,
        normal_error,
        termination: words::termination(termination),
        iterations: cost.gjk_iterations + cost.epa_iterations,
        micros,
        listed: None,
    }
}

fn finite(v: Vec3) -> Option<[f64; 3]> {
    v.iter().all(|c| c.is_finite()).then(|| v.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALLS: &str = r#"{"id": "balls", "a": {"type": "sphere", "params": {"radius": 1}}, "pose_a": {"t": [0, 0, 0], "q": [1, 0, 0, 0]}, "b": {"type": "point"}, "pose_b": {"t": [0, 0, 3], "q": [1, 0, 0, 0]}}"#;

    fn lines(input: &str, start: usize) -> Vec<Value> {
        answers(input, &["--", "-", &start.to_string()])
    }

    /// The input answered with these arguments; the file among them is not opened.
    fn answers(input: &str, arguments: &[&str]) -> Vec<Value> {
        #[derive(clap::Parser)]
        struct Command {
            #[command(flatten)]
            pairs: Pairs,
        }
        let Command { pairs } = clap::Parser::parse_from([&["pairs"], arguments].concat());
        let mut output = Vec::new();
        answer_all(&pairs, "test", &mut input.as_bytes(), &mut output).unwrap();
        String::from_utf8(output).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    #[test]
    fn a_case_is_answered_with_every_field() {
        let answers = lines(BALLS, 0);
        let answer = answers[0].as_object().unwrap();
        let keys: Vec<&str> = answer.keys().map(String::as_str).collect();
        let expected = "id iterations lower micros normal normal_error point_error signed_distance status termination upper verdict witness";
        assert_eq!(keys, expected.split(' ').collect::<Vec<_>>());
        assert_eq!(answer["id"], "balls");
        assert_eq!(answer["status"], "ok");
        assert_eq!(answer["verdict"], "FREE");
        assert!((answer["signed_distance"].as_f64().unwrap() - 2.0).abs() < 1e-14);
        assert!((answer["witness"][0][2].as_f64().unwrap() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn touching_triangles_are_listed_where_there_are_any() {
        let crossed = r#"{"a": {"type": "mesh", "params": {"vertices": [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 4, 1]], "triangles": [[0, 1, 3], [0, 1, 2]]}}, "pose_a": {"t": [0, 0, 0], "q": [1, 0, 0, 0]}, "b": {"type": "segment", "params": {"a": [1, 1, -1], "b": [1, 1.5, 1]}}, "pose_b": {"t": [0, 0, 0], "q": [1, 0, 0, 0]}}"#;
        let answers = answers(&format!("{crossed}\n{BALLS}"), &["--touching", "-"]);
        assert_eq!(answers[0]["touching"], serde_json::json!([[0, 0], [1, 0]]));
        assert_eq!(answers[0]["truncated"], false);
        assert!(answers[1].get("touching").is_none() && answers[1].get("truncated").is_none());
        let cut = self::answers(crossed, &["--touching=1", "-"]);
        assert_eq!((cut[0]["touching"].as_array().unwrap().len(), &cut[0]["truncated"]), (1, &Value::Bool(true)));
    }

    #[test]
    fn a_bad_line_is_an_answer_and_not_the_end() {
        let unbounded = r#"{"type": "plane", "params": {"normal": [0, 0, 1], "offset": 0}}"#;
        let planes = BALLS
            .replace(r#"{"type": "sphere", "params": {"radius": 1}}"#, unbounded)
            .replace(r#"{"type": "point"}"#, unbounded);
        let answers = lines(&format!("{{\"id\": 1}}\n\nnonsense\n{planes}\n{BALLS}"), 0);
        assert_eq!(answers.len(), 4);
        assert_eq!(answers[0], serde_json::json!({"id": 1, "status": "invalid", "message": "a: is missing"}));
        assert_eq!(answers[1]["id"], Value::Null);
        assert!(answers[2]["message"].as_str().unwrap().contains("unbounded"), "{}", answers[2]);
        assert_eq!(answers[3]["status"], "ok");
    }

    #[test]
    fn start_skips_cases_not_lines() {
        assert_eq!(lines(&format!("\n{{\"id\": 1}}\n\n{BALLS}\n"), 1)[0]["id"], "balls");
    }

    #[test]
    fn a_pair_that_the_solver_does_not_take_is_unsupported_and_says_why() {
        let cone =
            BALLS.replace(r#"{"type": "point"}"#, r#"{"type": "cone", "params": {"radius": 1, "half_length": 1}}"#);
        let both = answers(&format!("{cone}\n{BALLS}"), &["--solver", "qp"]);
        assert_eq!(both[0]["status"], "unsupported");
        assert_eq!(both[0]["message"], "the solver qp does not take a sphere and a cone: a cone is no polytope");
        assert_eq!(both[1]["status"], "ok");
    }

    #[test]
    fn work_goes_as_far_as_was_asked() {
        let overlapping = BALLS
            .replace("[0, 0, 3]", "[0, 0, 0.25]")
            .replace(r#"{"type": "point"}"#, r#"{"type": "box", "params": {"half_extents": [1, 2, 3]}}"#);
        let depth = |arguments: &[&str]| {
            let answer = &answers(&overlapping, arguments)[0];
            assert_eq!(answer["verdict"], "COLLISION");
            (answer["termination"].clone(), answer["upper"].as_f64().unwrap() - answer["lower"].as_f64().unwrap())
        };
        assert!(depth(&[]).1 < 1e-8);
        for until in ["verdict", "distance"] {
            let (termination, width) = depth(&["--depth", until]);
            assert_eq!(termination, "DECIDED");
            assert!(width > 1e-3, "{width}");
        }
    }
}
