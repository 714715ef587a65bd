//! How much work is a question? What is surely little is answered by the task that has read it.

use crate::service::FEW_ITEMS;
use crate::transports::wire::v1;
use crate::transports::wire::v1::doubles::Form;
use crate::transports::wire::v1::shape::Core;
use crate::transports::wire::v1::subject::Kind;

/// Joint positions of so many states, of an arm with sixteen joints.
const FEW_POSITIONS: usize = FEW_ITEMS * 16;

/// An estimate from the message alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effort {
    /// Less than handing it over.
    Little,
    /// Perhaps much.
    Any,
}

impl Effort {
    fn little_if(little: bool) -> Self {
        if little { Self::Little } else { Self::Any }
    }

    /// Of states, unless they are asked what-if: making a world takes its time.
    pub fn of_states(message: &v1::CheckStatesRequest) -> Self {
        Self::little_if(numbers(message.positions.as_ref()) <= FEW_POSITIONS && is_as_is(message.context.as_ref()))
    }

    /// Of subjects. All pairs, and shapes that have to be built first, may take long.
    pub fn of_subjects(items: &[v1::Subject], context: Option<&v1::Context>) -> Self {
        Self::little_if(items.len() <= FEW_ITEMS && items.iter().all(is_quick) && is_as_is(context))
    }

    /// Of rays.
    pub fn of_rays(message: &v1::CastRaysRequest) -> Self {
        Self::little_if(numbers(message.origins.as_ref()) <= 3 * FEW_ITEMS)
    }
}

fn numbers(doubles: Option<&v1::Doubles>) -> usize {
    match doubles.and_then(|doubles| doubles.form.as_ref()) {
        None => 0,
        Some(Form::Packed(packed)) => packed.values.len(),
        Some(Form::LittleEndian(bytes)) => bytes.len() / size_of::<f64>(),
    }
}

fn is_as_is(context: Option<&v1::Context>) -> bool {
    context.is_none_or(|context| context.overlay.is_none() && context.alternatives.is_empty())
}

fn is_quick(subject: &v1::Subject) -> bool {
    match &subject.kind {
        None | Some(Kind::Body(_)) => true,
        Some(Kind::AllPairs(_) | Kind::ChangedSince(_)) => false,
        Some(Kind::Shape(placed)) => match placed.shape.as_ref().and_then(|shape| shape.core.as_ref()) {
            None
            | Some(
                Core::Sphere(_)
                | Core::Box(_)
                | Core::Capsule(_)
                | Core::Cylinder(_)
                | Core::Cone(_)
                | Core::Ellipsoid(_)
                | Core::Point(_)
                | Core::Segment(_)
                | Core::Triangle(_)
                | Core::HalfSpace(_)
                | Core::Plane(_),
            ) => true,
            Some(
                Core::Convex(_)
                | Core::Mesh(_)
                | Core::MeshAsset(_)
                | Core::Compound(_)
                | Core::HeightField(_)
                | Core::PointCloud(_)
                | Core::Voxels(_),
            ) => false,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_items_of_plain_kinds_are_little_work_and_nothing_else_is() {
        let body = || v1::Subject { kind: Some(Kind::Body(v1::BodyRef::default())) };
        let all = || v1::Subject { kind: Some(Kind::AllPairs(v1::AllPairs {})) };
        let shape = |core| {
            let shape = Some(v1::Shape { core: Some(core), ..v1::Shape::default() });
            v1::Subject { kind: Some(Kind::Shape(v1::PlacedShape { shape, pose: None })) }
        };
        let of = |items: Vec<v1::Subject>| Effort::of_subjects(&items, None);
        assert_eq!(of((0..FEW_ITEMS).map(|_| body()).collect()), Effort::Little);
        assert_eq!(of((0..=FEW_ITEMS).map(|_| body()).collect()), Effort::Any);
        assert_eq!(of(vec![body(), all()]), Effort::Any);
        assert_eq!(of(vec![shape(Core::Sphere(v1::Sphere { radius: 1.0 }))]), Effort::Little);
        assert_eq!(of(vec![shape(Core::Convex(v1::Convex::default()))]), Effort::Any);
        let supposed = v1::Context { overlay: Some(v1::Overlay::default()), ..v1::Context::default() };
        assert_eq!(Effort::of_subjects(&[body()], Some(&supposed)), Effort::Any);
        let states = |numbers| v1::CheckStatesRequest {
            positions: Some(v1::Doubles { form: Some(Form::LittleEndian(vec![0; 8 * numbers].into())) }),
            ..v1::CheckStatesRequest::default()
        };
        assert_eq!(Effort::of_states(&states(FEW_POSITIONS)), Effort::Little);
        assert_eq!(Effort::of_states(&states(FEW_POSITIONS + 1)), Effort::Any);
    }
}
