//! Where on an axis is a number, and which numbers are written beside it?

/// What the numbers of an axis are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// Written as ns, us, ms, s.
    Seconds,
    /// Written as B, kB, MB.
    Bytes,
    /// Parts of one, written in per cent.
    Part,
    /// As they are.
    Plain,
}

/// An axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis<'a> {
    pub label: &'a str,
    pub unit: Unit,
    pub log: bool,
    /// Ends that are shown whatever the data.
    pub around: Option<(f64, f64)>,
}

impl<'a> Axis<'a> {
    pub fn log(label: &'a str, unit: Unit) -> Self {
        Self { label, unit, log: true, around: None }
    }

    pub fn linear(label: &'a str, unit: Unit) -> Self {
        Self { label, unit, log: false, around: None }
    }
}

/// An axis with ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    log: bool,
    unit: Unit,
}

impl Scale {
    /// Around all values, up to whole steps. Of a logarithmic axis values that are not positive do not count.
    pub fn around(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let usable = |value: &f64| value.is_finite() && (!axis.log || *value > 0.0);
        let ends = axis.around.map_or([f64::NAN; 2], |(low, high)| [low, high]);
        let all = values.chain(ends).filter(usable);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (if axis.log { 0.1 } else { 0.0 }, 1.0) };
        let (log, unit) = (axis.log, axis.unit);
        if log {
            let (mut low, mut high) = (libm::log10(low), libm::log10(high));
            if high - low < 0.9 {
                let middle = 0.5 * (low + high);
                (low, high) = (middle - 0.5, middle + 0.5);
            }
            let room = 0.04 * (high - low);
            return Self { low: low - room, high: high + room, log, unit };
        }
        let step = nice((high - low).max(1e-12) / 4.0);
        Self { low: (low / step).floor() * step, high: ((high / step).ceil() * step).max(low + step), log, unit }
    }

    /// From 0 to 1 within the ends; outside where a number is.
    pub fn place(&self, value: f64) -> f64 {
        let value = if self.log { libm::log10(value.max(1e-300)) } else { value };
        (value - self.low) / (self.high - self.low)
    }

    /// At most so many numbers, with their text.
    pub fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        if !self.log {
            let step = nice((self.high - self.low) / most.max(1) as f64);
            let (first, last) = ((self.low / step).ceil() as i64, (self.high / step + 1e-9).floor() as i64);
            return (first..=last).map(|i| i as f64 * step).map(|value| (value, self.text(value))).collect();
        }
        let decades = (self.low.ceil() as i32..=self.high.floor() as i32).count().max(1);
        if decades <= 2 {
            // Within two decades also 2 and 5 of each.
            let all = (self.low.floor() as i32..=self.high.ceil() as i32)
                .flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| digit * power(decade)));
            let shown: Vec<f64> = all.filter(|v| (0.0..=1.0).contains(&self.place(*v))).collect();
            if (2..=most).contains(&shown.len()) {
                return shown.into_iter().map(|value| (value, self.text(value))).collect();
            }
        }
        let step = decades.div_ceil(most.max(1)).max(1) as i32;
        let of_decade = |decade: i32| (power(decade), self.text(power(decade)));
        let aligned = (self.low.ceil() as i32..=self.high.floor() as i32).filter(|decade| decade.rem_euclid(step) == 0);
        aligned.map(of_decade).collect()
    }

    fn text(&self, value: f64) -> String {
        match self.unit {
            Unit::Seconds => with_prefix(value, &[(1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns")]),
            Unit::Bytes => with_prefix(value, &[(1e6, "MB"), (1e3, "kB"), (1.0, "B")]),
            Unit::Part => format!("{} %", short(100.0 * value)),
            Unit::Plain => short(value),
        }
    }
}

fn power(decade: i32) -> f64 {
    // By text: powers of ten that are read are rounded once.
    format!("1e{decade}").parse().unwrap_or(f64::NAN)
}

/// 1, 2 or 5 times a power of ten, at least the value.
fn nice(value: f64) -> f64 {
    let decade = power(libm::log10(value).floor() as i32);
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|digit| digit * decade).find(|step| *step >= value * 0.999).unwrap_or(value)
}

fn with_prefix(value: f64, prefixes: &[(f64, &str)]) -> String {
    let fits = |(factor, _): &&(f64, &str)| value.abs() >= 0.999 * factor;
    let (factor, name) = prefixes.iter().find(fits).or(prefixes.last()).copied().unwrap_or((1.0, ""));
    format!("{} {name}", short(value / factor))
}

/// A number in words: two digits.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(0.01..100_000.0).contains(&value.abs()) {
        return format!("{value:.0e}").replace('-', "−");
    }
    let digits = (1.0 - libm::log10(value.abs()).floor()).clamp(0.0, 3.0) as usize;
    let text = format!("{value:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    text.replace('-', "−")
}

/// A time in words: three digits and a unit.
pub(super) fn time(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "no time".to_owned();
    }
    let (factor, name) = [(1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns")]
        .into_iter()
        .find(|(factor, _)| seconds >= 0.9995 * factor)
        .unwrap_or((1e-9, "ns"));
    let value = seconds / factor;
    let digits = (2.0 - libm::log10(value.max(0.1)).floor()).clamp(0.0, 2.0) as usize;
    format!("{value:.digits$} {name}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_within_the_ends_and_not_too_many() {
        let axis = Axis::log("", Unit::Seconds);
        let scale = Scale::around(&axis, [3e-8, 2e-3].into_iter());
        let ticks = scale.ticks(6);
        assert_eq!(ticks.first().unwrap().1, "100 ns");
        assert!(ticks.len() <= 6 && ticks.iter().all(|(v, _)| (0.0..=1.0).contains(&scale.place(*v))), "{ticks:?}");
        let scale = Scale::around(&Axis::log("", Unit::Plain), [1e-16, 1.0].into_iter());
        let texts: Vec<String> = scale.ticks(5).into_iter().map(|(_, text)| text).collect();
        assert_eq!(texts, ["1e−16", "1e−12", "1e−8", "1e−4", "1"]);
        let scale = Scale::around(&Axis::linear("", Unit::Part), [0.0, 0.27].into_iter());
        assert_eq!(scale.ticks(4).last().unwrap().1, "30 %");
    }

    #[test]
    fn no_values_are_a_scale_all_the_same() {
        for axis in [Axis::log("", Unit::Plain), Axis::linear("", Unit::Bytes)] {
            let scale = Scale::around(&axis, std::iter::empty());
            assert!(scale.place(0.5).is_finite() && !scale.ticks(4).is_empty());
        }
    }

    #[test]
    fn times_have_three_digits() {
        assert_eq!([1.5e-7, 2.346e-5, 0.1, 59.0].map(time), ["150 ns", "23.5 µs", "100 ms", "59.0 s"]);
    }
}
