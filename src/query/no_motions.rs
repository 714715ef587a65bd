//! Questions about motions in a build without their code: all are refused, so none is ever there to be answered.

use std::convert::Infallible;
use std::marker::PhantomData;

use super::answer::{ItemAnswer, Refused};
use super::cast_answer::CastItem;
use super::cast_request::{CastShapes, CheckMovingPairs};
use super::item_batch::ItemBatch;
use super::overlay::Place;
use super::request::{CheckMotions, Motions as Layout};
use crate::scene::Snapshot;

/// Never one that was checked: [`CastShapes`] is refused.
pub struct Casts<'a>(Never<'a>);

/// Never one that was checked: [`CheckMovingPairs`] is refused.
pub struct MovingPairs<'a>(Never<'a>);

/// Never one that was checked: [`CheckMotions`] is refused.
pub(super) struct Motions<'a>(Never<'a>);

struct Never<'a>(Infallible, PhantomData<&'a ()>);

fn refused(field: &'static str) -> Refused {
    Refused::NotBuilt { field, effect: "motion" }
}

impl<'a> Casts<'a> {
    /// # Errors
    /// Always: this build is without motions.
    pub fn new(_: &'a Snapshot, _: &'a CastShapes) -> Result<Self, Refused> {
        Err(refused("items"))
    }
}

impl<'a> MovingPairs<'a> {
    /// # Errors
    /// Always: this build is without motions.
    pub fn new(_: &'a Snapshot, _: &'a CheckMovingPairs) -> Result<Self, Refused> {
        Err(refused("items"))
    }
}

impl<'a> Motions<'a> {
    pub fn new(_: Place<'a>, request: &'a CheckMotions) -> Result<Self, Refused> {
        Err(refused(match request.motions {
            Layout::Edges => "motions",
            Layout::Path => "waypoints",
        }))
    }

    pub fn width(&self) -> usize {
        match self.0.0 {}
    }

    pub fn len(&self) -> usize {
        match self.0.0 {}
    }

    pub fn answer(&self, _: usize, _: &dyn Fn() -> bool) -> ItemAnswer {
        match self.0.0 {}
    }
}

impl ItemBatch for Casts<'_> {
    type Item = CastItem;

    fn snapshot(&self) -> &Snapshot {
        match self.0.0 {}
    }

    fn len(&self) -> usize {
        match self.0.0 {}
    }

    fn not_run(&self) -> CastItem {
        match self.0.0 {}
    }

    fn answer(&self, _: usize, _: &dyn Fn() -> bool) -> CastItem {
        match self.0.0 {}
    }
}

impl ItemBatch for MovingPairs<'_> {
    type Item = CastItem;

    fn snapshot(&self) -> &Snapshot {
        match self.0.0 {}
    }

    fn len(&self) -> usize {
        match self.0.0 {}
    }

    fn not_run(&self) -> CastItem {
        match self.0.0 {}
    }

    fn answer(&self, _: usize, _: &dyn Fn() -> bool) -> CastItem {
        match self.0.0 {}
    }
}
