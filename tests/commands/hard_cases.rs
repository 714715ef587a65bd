//! `clearance pairs` on the corpus of hard pairs (`tests/data/hard.md`).
//!
//! The oracle is the truth that stands in each case, to 41 digits: exact rational or 400-bit arithmetic. `noise` there is a few
//! units in the last place of the relative placement; no estimate in doubles is asked for better than a multiple of it.
//! Brackets are held to all the digits.

use std::cmp::Ordering;
use std::fs;

use dashu_int::IBig;
use serde_json::Value;

use crate::{clearance, data, json_lines, number};

/// A case, its truth in short, and what was answered.
struct Scored {
    case: Value,
    answer: Value,
    truth: f64,
    size: f64,
    noise: f64,
}

impl Scored {
    fn error(&self) -> f64 {
        (number(&self.answer["signed_distance"]) - self.truth).abs()
    }

    /// Names the case in a failure.
    fn name(&self) -> String {
        let answer = &self.answer;
        format!("{} ({}): truth {}, answer {answer}", self.case["id"], self.case["note"], self.truth)
    }
}

fn answered() -> Vec<Scored> {
    let file = data("hard.jsonl");
    let cases = json_lines(&fs::read(&file).unwrap());
    let output = clearance(&["pairs", file.to_str().unwrap()]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let answers = json_lines(&output.stdout);
    assert_eq!(answers.len(), cases.len());
    let score = |(case, answer): (Value, Value)| {
        assert_eq!(answer["id"], case["id"]);
        assert_eq!(answer["status"], "ok", "{answer}");
        let of = |name: &str| number(&case["truth"][name]);
        Scored { truth: of("signed_distance"), size: of("size"), noise: of("noise"), case, answer }
    };
    cases.into_iter().zip(answers).map(score).collect()
}

/// The names of the cases that `is_good` refuses.
fn bad(scored: &[Scored], is_good: impl Fn(&Scored) -> bool) -> Vec<String> {
    scored.iter().filter(|s| !is_good(s)).map(Scored::name).collect()
}

fn point(value: &Value) -> Option<[f64; 3]> {
    let list = value.as_array()?;
    Some([list[0].as_f64()?, list[1].as_f64()?, list[2].as_f64()?])
}

/// A double against a decimal number, without rounding: equal when they differ by less than the last digit says.
fn compare(x: f64, digits: &str) -> Ordering {
    let (mantissa, power) = digits.split_once('e').unwrap();
    let fraction = mantissa.split_once('.').unwrap().1.len();
    let power = power.parse::<i64>().unwrap() - i64::try_from(fraction).unwrap();
    let mut decimal: IBig = mantissa.replace('.', "").parse().unwrap();
    // x = n 2^-1074; both sides are multiplied until they are integers.
    let magnitude = x.abs().to_bits();
    let (exponent, bits) = (magnitude >> 52, magnitude & ((1 << 52) - 1));
    let mut n = IBig::from(if exponent == 0 { bits } else { bits | 1 << 52 });
    n <<= usize::try_from(exponent.max(1) - 1).unwrap();
    if x < 0.0 {
        n = -n;
    }
    decimal <<= 1074;
    let mut last_digit = IBig::ONE << 1074;
    let ten = IBig::from(10).pow(usize::try_from(power.abs()).unwrap());
    if power < 0 {
        n *= ten;
    } else {
        decimal *= &ten;
        last_digit *= ten;
    }
    let off = n - decimal;
    if off < last_digit && -&off < last_digit { Ordering::Equal } else { off.cmp(&IBig::ZERO) }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[test]
fn every_bracket_holds_the_truth_and_every_distance_is_close() {
    let scored = answered();
    assert!(scored.len() > 1000, "{} cases", scored.len());

    let outside = bad(&scored, |s| {
        let digits = s.case["truth"]["digits"].as_str().unwrap();
        compare(number(&s.answer["lower"]), digits).is_le() && compare(number(&s.answer["upper"]), digits).is_ge()
    });
    assert!(outside.is_empty(), "{} brackets miss the truth:\n{}", outside.len(), outside.join("\n"));

    let wrong_sign = bad(&scored, |s| {
        s.truth.abs() <= 64.0 * s.noise || (number(&s.answer["signed_distance"]) > 0.0) == (s.truth > 0.0)
    });
    assert!(wrong_sign.is_empty(), "{} wrong signs:\n{}", wrong_sign.len(), wrong_sign.join("\n"));

    let far = bad(&scored, |s| s.error() <= 1e-6 + 1e-6 * s.truth.abs());
    assert!(far.is_empty(), "{} are off by a micrometre and a millionth:\n{}", far.len(), far.join("\n"));

    let loose = bad(&scored, |s| s.error() <= 1e-9 * s.truth.abs().max(s.size) + 64.0 * s.noise);
    assert!(loose.is_empty(), "{} are off by 1e-9 of their size:\n{}", loose.len(), loose.join("\n"));
}

#[test]
fn verdicts_follow_from_brackets_and_are_withheld_only_where_the_bracket_straddles_zero() {
    let scored = answered();
    let contradicting = bad(&scored, |s| {
        let expected = match (number(&s.answer["lower"]), number(&s.answer["upper"])) {
            (_, upper) if upper <= 0.0 => "COLLISION",
            (lower, _) if lower > 0.0 => "FREE",
            _ => "INDETERMINATE",
        };
        s.answer["verdict"] == expected
    });
    assert!(contradicting.is_empty(), "{}", contradicting.join("\n"));
    // Polytopes and balls swept over them are decided in exact arithmetic, curved bodies as far as doubles go.
    let withheld = bad(&scored, |s| {
        let curved = s.case["truth"]["certified"] != "exact" && s.truth.abs() <= 256.0 * s.noise;
        s.answer["verdict"] != "INDETERMINATE" || curved
    });
    assert!(withheld.is_empty(), "{} were not decided:\n{}", withheld.len(), withheld.join("\n"));
    // The corpus must reach what is checked here.
    for (verdict, least) in [("FREE", 500), ("COLLISION", 500), ("INDETERMINATE", 1)] {
        assert!(scored.iter().filter(|s| s.answer["verdict"] == verdict).count() >= least, "{verdict}");
    }
    assert!(scored.iter().filter(|s| s.answer["termination"] == "EXACT").count() > 50);
}

#[test]
fn normals_and_witnesses_agree_with_the_truth_and_the_distance() {
    let scored = answered();
    let mut normals_checked = 0;
    for s in &scored {
        if s.case["truth"]["normal_checked"] == true {
            let truth = point(&s.case["truth"]["normal"]).unwrap();
            let normal = point(&s.answer["normal"]).unwrap_or_else(|| panic!("no normal: {}", s.name()));
            // Half the squared chord is one minus the cosine of the angle, without cancellation.
            let chord = [0, 1, 2].map(|i| normal[i] - truth[i]);
            assert!(dot(chord, chord).sqrt() <= 1e-4, "normal: {}", s.name());
            // The truth is itself rounded, relative to how large the shapes are against their distance.
            let rounding = 1e-15 + 4.0 * s.noise / s.truth.abs();
            assert!(dot(chord, chord).sqrt() <= number(&s.answer["normal_error"]) + rounding, "normal: {}", s.name());
            normals_checked += 1;
        }
        let extreme = s.truth.abs() >= 1e150 || s.size >= 1e150;
        if let (Some(a), Some(b), false) = (point(&s.answer["witness"][0]), point(&s.answer["witness"][1]), extreme) {
            let apart = [0, 1, 2].map(|i| b[i] - a[i]);
            let far_out = a.iter().chain(&b).fold(0.0, |far: f64, c| far.max(c.abs()));
            let off = (dot(apart, apart).sqrt() - number(&s.answer["signed_distance"]).abs()).abs();
            assert!(off <= 1e-6 * s.size + 64.0 * s.noise + 1e-13 * far_out, "witness: {}", s.name());
        }
    }
    assert!(normals_checked > 1000, "{normals_checked} normals");
}

#[test]
fn every_solver_brackets_the_truth_of_the_cases_it_takes() {
    let file = data("hard.jsonl");
    let cases = json_lines(&fs::read(&file).unwrap());
    // How many of the 1348 cases each takes at least: all, or those of polytopes.
    for (solver, least) in [
        ("frank_wolfe", cases.len()),
        ("gjk", cases.len()),
        ("gjk_polyak", cases.len()),
        ("gjk_nesterov", cases.len()),
        ("gjk_nesterov_normalised", cases.len()),
        ("sat", 600),
        ("qp", 800),
        ("exact", 800),
    ] {
        let output = clearance(&["pairs", file.to_str().unwrap(), "--solver", solver]);
        let answers = json_lines(&output.stdout);
        assert_eq!(answers.len(), cases.len(), "{solver}");
        let mut taken = 0;
        for (case, answer) in cases.iter().zip(&answers).filter(|(_, answer)| answer["status"] == "ok") {
            let (truth, noise) = (number(&case["truth"]["signed_distance"]), number(&case["truth"]["noise"]));
            let holds = |lower: f64, upper: f64| lower - 4.0 * noise <= truth && truth <= upper + 4.0 * noise;
            assert!(holds(number(&answer["lower"]), number(&answer["upper"])), "{solver}: {truth}, {answer}");
            taken += 1;
        }
        assert!(taken >= least, "{solver} took {taken} cases");
        let unsupported = answers.iter().filter(|answer| answer["status"] == "unsupported");
        assert_eq!(unsupported.filter(|answer| answer["message"].is_string()).count(), cases.len() - taken, "{solver}");
    }
    let unknown = clearance(&["pairs", file.to_str().unwrap(), "--solver", "guess"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&unknown.stderr).contains("gjk_polyak"), "the names are listed");
}

#[test]
fn start_skips_cases_and_changes_nothing_else() {
    let file = data("hard.jsonl");
    let without_times = |arguments: &[&str]| {
        let mut answers = json_lines(&clearance(arguments).stdout);
        answers.iter_mut().for_each(|answer| drop(answer.as_object_mut().unwrap().remove("micros")));
        answers
    };
    let all = without_times(&["pairs", file.to_str().unwrap()]);
    let tail = without_times(&["pairs", file.to_str().unwrap(), "1300"]);
    assert_eq!(tail, all[1300..]);
}

#[test]
fn no_time_at_all_still_gives_a_valid_bracket() {
    let file = data("hard.jsonl");
    let cases = json_lines(&fs::read(&file).unwrap());
    let answers = json_lines(&clearance(&["pairs", file.to_str().unwrap(), "--max-time-us", "0"]).stdout);
    let cut = answers.iter().filter(|answer| answer["termination"] == "TIME_LIMIT").count();
    assert!(cut > 500, "only {cut} answers say that the time cut them");
    assert!(answers.iter().all(|answer| answer["termination"] != "ITERATION_LIMIT"));
    for (case, answer) in cases.iter().zip(&answers) {
        let (truth, noise) = (number(&case["truth"]["signed_distance"]), number(&case["truth"]["noise"]));
        // An upper or lower end that is not there yet is infinite, which JSON writes as null.
        let lower = answer["lower"].as_f64().unwrap_or(f64::NEG_INFINITY);
        let upper = answer["upper"].as_f64().unwrap_or(f64::INFINITY);
        assert!(lower - 4.0 * noise <= truth && truth <= upper + 4.0 * noise, "{answer}");
    }
}

#[test]
fn an_unreadable_file_is_named_and_has_its_exit_code() {
    let output = clearance(&["pairs", "/no/such/file.jsonl"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&output.stderr).contains("/no/such/file.jsonl"));
    assert_eq!(clearance(&["pairs", "--tolerance", "-1"]).status.code(), Some(2));
}
