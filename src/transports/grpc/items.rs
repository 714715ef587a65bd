//! How many items did a call take? Those of questions are counted in the answer, where bulk and states are one list too;
//! edits in the request. Everything else has none.

use crate::transports::wire::v1;

/// A request or an answer that may have items.
pub(super) trait Items {
    /// How many.
    fn items(&self) -> usize;
}

impl Items for v1::Answer {
    fn items(&self) -> usize {
        self.items.len() + self.bulk.as_ref().map_or(0, |bulk| bulk.verdicts.len())
    }
}

impl Items for v1::QueryStreamResponse {
    fn items(&self) -> usize {
        use v1::query_stream_response::Outcome;
        match &self.outcome {
            None | Some(Outcome::Error(_)) => 0,
            Some(Outcome::CheckStates(answer)) => answer.items(),
            Some(Outcome::Collide(answer)) => answer.items(),
            Some(Outcome::Distance(answer)) => answer.items(),
            Some(Outcome::CastRays(answer)) => answer.items(),
            Some(Outcome::CastShapes(answer)) => answer.items(),
            Some(Outcome::CheckMovingPairs(answer)) => answer.items(),
            Some(Outcome::Overlap(answer)) => answer.items(),
            Some(Outcome::NearestBodies(answer)) => answer.items(),
            Some(Outcome::CheckMotions(answer)) => answer.items(),
            Some(Outcome::CheckPath(answer)) => answer.items(),
            Some(Outcome::Clearance(answer)) => answer.items(),
            Some(Outcome::Estimate(estimated)) => estimated.items(),
        }
    }
}

/// Messages, and what of each is counted.
macro_rules! counted {
    ($($message:ident: |$value:ident| $items:expr;)*) => {
        $(impl Items for v1::$message {
            fn items(&self) -> usize {
                let $value = self;
                $items
            }
        })*
    };
}

counted! {
    CheckStatesResponse: |m| m.answer.as_ref().map_or(0, Items::items);
    CollideResponse: |m| m.answer.as_ref().map_or(0, Items::items);
    DistanceResponse: |m| m.answer.as_ref().map_or(0, Items::items);
    CheckMotionsResponse: |m| m.answer.as_ref().map_or(0, Items::items);
    CheckPathResponse: |m| m.answer.as_ref().map_or(0, Items::items);
    ClearanceResponse: |m| m.answer.as_ref().map_or(0, Items::items);
    CastRaysResponse: |m| m.verdicts.len();
    CastShapesResponse: |m| m.items.len();
    CheckMovingPairsResponse: |m| m.items.len();
    OverlapResponse: |m| m.items.len();
    NearestBodiesResponse: |m| m.items.len();
    EstimateResponse: |m| usize::try_from(m.asked).unwrap_or(usize::MAX);
    ApplyRequest: |m| m.edits.len();
    PoseStreamResponse: |m| usize::try_from(m.poses).unwrap_or(usize::MAX);
}

/// Messages without items: what is counted stands on the other side of their call.
macro_rules! not_counted {
    ($($message:ident)*) => {
        $(impl Items for v1::$message {
            fn items(&self) -> usize {
                0
            }
        })*
    };
}

not_counted! {
    CheckStatesRequest CollideRequest DistanceRequest CheckMotionsRequest CheckPathRequest ClearanceRequest CastRaysRequest
    CastShapesRequest CheckMovingPairsRequest OverlapRequest NearestBodiesRequest EstimateRequest ApplyResponse GetSceneRequest
    GetSceneResponse DescribeMeshRequest DescribeMeshResponse WatchResponse
}
