//! Reads `tests/data/hard.jsonl` into specimens, with the digits of its truth.

use serde_json::Value;

use crate::oracle::double_double::Dd;
use crate::specimen::{Form, Specimen};

pub struct HardCase {
    pub id: String,
    /// The situation, and who reported it.
    pub note: String,
    pub a: Specimen,
    pub b: Specimen,
    /// The signed distance, from 41 decimal digits.
    pub truth: Dd,
    /// How far the digits themselves may be off, metres: the gap of the arithmetic that found them.
    pub gap: f64,
    /// Sum of the two extents, metres.
    pub size: f64,
    /// Found in rational arithmetic.
    pub exact: bool,
}

pub fn hard_cases() -> Vec<HardCase> {
    let text = include_str!("../data/hard.jsonl");
    text.lines().map(|line| case(&serde_json::from_str(line).expect("a line is JSON"))).collect()
}

fn case(line: &Value) -> HardCase {
    let truth = &line["truth"];
    HardCase {
        id: line["id"].as_str().expect("an id").to_owned(),
        note: line["note"].as_str().expect("a note").to_owned(),
        a: specimen(&line["a"], &line["pose_a"]),
        b: specimen(&line["b"], &line["pose_b"]),
        truth: decimal(truth["digits"].as_str().expect("digits")),
        gap: truth["gap"].as_f64().unwrap_or(0.0),
        size: truth["size"].as_f64().expect("a size"),
        exact: truth["certified"] == "exact",
    }
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let list = value.as_array().expect("a list of numbers");
    std::array::from_fn(|i| list[i].as_f64().expect("a number"))
}

fn specimen(shape: &Value, pose: &Value) -> Specimen {
    let params = &shape["params"];
    let number = |name: &str| params[name].as_f64().expect("a number");
    let form = match shape["type"].as_str().expect("a type") {
        "sphere" => Form::sphere(number("radius")),
        "point" => Form::point(),
        "box" => Form::cuboid(numbers(&params["half_extents"])),
        "capsule" => Form::capsule(number("radius"), number("half_length")),
        "cylinder" => Form::cylinder(number("radius"), number("half_length")),
        "cone" => Form::cone(number("radius"), number("half_length")),
        "ellipsoid" => Form::ellipsoid(numbers(&params["radii"])),
        "convex" => {
            let points: Vec<[f64; 3]> = params["points"].as_array().expect("points").iter().map(numbers).collect();
            Form::convex(&points)
        }
        "triangle" => Form::triangle([numbers(&params["a"]), numbers(&params["b"]), numbers(&params["c"])]),
        "segment" => Form::segment([numbers(&params["a"]), numbers(&params["b"])]),
        "halfspace" => Form::half_space(numbers(&params["normal"]), number("offset")),
        other => panic!("no oracle for {other}"),
    };
    let form = form.expect("the corpus holds valid shapes");
    let form = match params["margin"].as_f64() {
        Some(margin) => form.swept(margin).expect("a valid margin"),
        None => form,
    };
    form.placed(numbers(&pose["t"]), numbers(&pose["q"])).expect("a valid pose")
}

/// A decimal number of any number of digits, to about 1e-29 of itself.
fn decimal(text: &str) -> Dd {
    let (mantissa, exponent) = text.split_once('e').expect("an exponent");
    let digits = mantissa.trim_start_matches('-').replace('.', "");
    let ten = Dd::from(10.0);
    let whole = digits.bytes().fold(Dd::ZERO, |sum, digit| sum * ten + Dd::from(f64::from(digit - b'0')));
    let power = exponent.parse::<i32>().expect("a whole number") - (digits.len() as i32 - 1);
    let scaled = (0..power.abs()).fold(whole, |x, _| if power < 0 { x / ten } else { x * ten });
    if mantissa.starts_with('-') { -scaled } else { scaled }
}
