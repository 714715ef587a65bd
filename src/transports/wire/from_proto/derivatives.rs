//! Derivatives: how they are to be made, and what a client reads of them.

use super::Path;
use super::answer::NotAnAnswer;
use super::query::unknown_value;
use crate::narrow_phase::{DerivativeCost, DerivativeGoal, DerivativeMethod, Derivatives, TwistMatrix};
use crate::query::PairDerivatives;
use crate::service::ServiceError;
use crate::transports::wire::v1;

/// How derivatives are to be made; the numbers are checked by the query itself.
pub(super) fn derivative_goal(
    path: &Path<'_>,
    options: Option<&v1::DerivativeOptions>,
) -> Result<DerivativeGoal, ServiceError> {
    let defaults = DerivativeGoal::default();
    let Some(v1::DerivativeOptions { method, epsilon, samples, seed }) = options.copied() else { return Ok(defaults) };
    let known = v1::DerivativeMethod::try_from(method).map_err(|_| unknown_value(&path.field("method"), method))?;
    Ok(DerivativeGoal {
        method: known_method(known).unwrap_or(defaults.method),
        epsilon: epsilon.unwrap_or(defaults.epsilon),
        samples: samples.unwrap_or(defaults.samples),
        seed: seed.unwrap_or(defaults.seed),
        stream: defaults.stream,
    })
}

fn known_method(method: v1::DerivativeMethod) -> Option<DerivativeMethod> {
    match method {
        v1::DerivativeMethod::Unspecified => None,
        v1::DerivativeMethod::Exact => Some(DerivativeMethod::Exact),
        v1::DerivativeMethod::ExactCell => Some(DerivativeMethod::ExactCell),
        v1::DerivativeMethod::FiniteDifference => Some(DerivativeMethod::FiniteDifference),
        v1::DerivativeMethod::Smoothed0 => Some(DerivativeMethod::Smoothed0),
        v1::DerivativeMethod::Smoothed1Gaussian => Some(DerivativeMethod::Smoothed1Gaussian),
        v1::DerivativeMethod::Smoothed1Gumbel => Some(DerivativeMethod::Smoothed1Gumbel),
    }
}

/// How a pair changes when its bodies move. What it cost is told of the item alone.
pub(super) fn derivatives(told: &v1::PairDerivatives) -> Result<PairDerivatives, NotAnAnswer> {
    let missing = || NotAnAnswer::missing("derivatives");
    let sides = [told.of_a.as_ref().ok_or_else(missing)?, told.of_b.as_ref().ok_or_else(missing)?];
    let method = v1::DerivativeMethod::try_from(told.method).ok().and_then(known_method);
    let twists = Derivatives {
        signed_distance: both(sides, |side| side.signed_distance.as_slice().try_into().ok())?,
        normal: both(sides, |side| rows(&side.normal))?,
        point_on_a: both(sides, |side| rows(&side.point_on_a))?,
        point_on_b: both(sides, |side| rows(&side.point_on_b))?,
        method: method.ok_or_else(missing)?,
        conditioning: told.conditioning,
        residual: told.residual,
        epsilon: told.epsilon,
        samples: told.samples,
        seed: told.seed,
        is_valid: told.is_valid,
        on_border: told.on_border,
        is_contested: told.is_contested,
        cost: DerivativeCost::default(),
    };
    Ok(PairDerivatives { twists, joints: told.joints.clone() })
}

/// The same of either side.
fn both<T>(
    [a, b]: [&v1::TwistDerivatives; 2],
    read: impl Fn(&v1::TwistDerivatives) -> Option<T>,
) -> Result<[T; 2], NotAnAnswer> {
    read(a).zip(read(b)).map(|(a, b)| [a, b]).ok_or(NotAnAnswer::missing("derivatives"))
}

/// Three rows of six, row by row.
fn rows(numbers: &[f64]) -> Option<TwistMatrix> {
    (numbers.len() == 18).then(|| TwistMatrix::from_row_slice(numbers))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transports::wire::to_proto::pair_derivatives;

    /// Every number is another one, so that none can stand in another's place.
    fn sample() -> PairDerivatives {
        let matrix = |from: f64| TwistMatrix::from_fn(|row, column| from + row as f64 + 0.1 * column as f64);
        let twists = Derivatives {
            signed_distance: [[1.0, 2.0, 3.0, 4.0, 5.0, -0.0], [6.0, 7.0, 8.0, 9.0, 10.0, 11.0]],
            normal: [matrix(20.0), matrix(30.0)],
            point_on_a: [matrix(40.0), matrix(50.0)],
            point_on_b: [matrix(60.0), matrix(70.0)],
            method: DerivativeMethod::Smoothed1Gumbel,
            conditioning: f64::INFINITY,
            residual: 1e-9,
            epsilon: 0.25,
            samples: 7,
            seed: u64::MAX,
            is_valid: true,
            on_border: false,
            is_contested: true,
            cost: DerivativeCost::default(),
        };
        PairDerivatives { twists, joints: vec![0.5, -0.25, 0.0] }
    }

    fn through_bytes(derivatives: &PairDerivatives) -> v1::PairDerivatives {
        use prost::Message;
        v1::PairDerivatives::decode(pair_derivatives(derivatives).encode_to_vec().as_slice()).unwrap()
    }

    #[test]
    fn what_is_written_is_read_back() {
        let sample = sample();
        let told = through_bytes(&sample);
        assert_eq!(told.of_b.as_ref().unwrap().normal[..8], [30.0, 30.1, 30.2, 30.3, 30.4, 30.5, 31.0, 31.1]);
        assert_eq!(derivatives(&told).unwrap(), sample);
        for conditioning in [f64::NEG_INFINITY, -3.0, 0.0] {
            let twists = Derivatives { conditioning, ..sample.twists.clone() };
            let written = PairDerivatives { twists, joints: Vec::new() };
            assert_eq!(derivatives(&through_bytes(&written)).unwrap(), written);
        }
        let unknown = Derivatives { conditioning: f64::NAN, ..sample.twists };
        let read = derivatives(&through_bytes(&PairDerivatives { twists: unknown, joints: Vec::new() })).unwrap();
        assert_eq!(read.twists.conditioning.to_bits(), f64::NAN.to_bits());
    }

    #[test]
    fn each_method_has_a_number_of_its_own() {
        let methods = [
            DerivativeMethod::Exact,
            DerivativeMethod::ExactCell,
            DerivativeMethod::FiniteDifference,
            DerivativeMethod::Smoothed0,
            DerivativeMethod::Smoothed1Gaussian,
            DerivativeMethod::Smoothed1Gumbel,
        ];
        for (method, number) in methods.into_iter().zip(1..) {
            let twists = Derivatives { method, ..sample().twists };
            let told = pair_derivatives(&PairDerivatives { twists, joints: Vec::new() });
            assert_eq!((told.method, derivatives(&told).unwrap().twists.method), (number, method));
        }
    }

    #[test]
    fn an_answer_that_lacks_numbers_is_none() {
        let good = pair_derivatives(&sample());
        type Spoil = fn(&mut v1::PairDerivatives);
        let spoilt: [Spoil; 8] = [
            |told| told.of_a = None,
            |told| told.of_b = None,
            |told| told.method = 0,
            |told| told.method = 7,
            |told| told.of_a.as_mut().unwrap().signed_distance.truncate(5),
            |told| told.of_b.as_mut().unwrap().normal.push(0.0),
            |told| told.of_a.as_mut().unwrap().point_on_a.clear(),
            |told| told.of_b.as_mut().unwrap().point_on_b.truncate(6),
        ];
        for spoil in spoilt {
            let mut told = good.clone();
            spoil(&mut told);
            assert_eq!(derivatives(&told), Err(NotAnAnswer::missing("derivatives")), "{told:?}");
        }
    }

    #[test]
    fn options_that_are_left_out_are_the_defaults() {
        let read = |options: Option<v1::DerivativeOptions>| derivative_goal(&Path::root("context"), options.as_ref());
        let defaults = DerivativeGoal::default();
        assert_eq!(read(None).unwrap(), defaults);
        assert_eq!(read(Some(v1::DerivativeOptions::default())).unwrap(), defaults);
        let all = v1::DerivativeOptions { method: 4, epsilon: Some(0.5), samples: Some(3), seed: Some(9) };
        let goal =
            DerivativeGoal { method: DerivativeMethod::Smoothed0, epsilon: 0.5, samples: 3, seed: 9, ..defaults };
        assert_eq!(read(Some(all)).unwrap(), goal);
        for method in [-1, 7, i32::MAX] {
            let refused = read(Some(v1::DerivativeOptions { method, ..all })).unwrap_err();
            assert_eq!(refused.to_string(), format!("context.method: has the unknown value {method}"));
        }
    }
}
