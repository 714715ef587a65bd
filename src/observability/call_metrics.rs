//! How many calls, how long did they take, what came out? Counted as each call ends; a call adds a microsecond at most.

use std::sync::Arc;

use prometheus_client::encoding::EncodeLabelSet;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::histogram::Histogram;
use prometheus_client::registry::Registry;
use tracing::Span;

use crate::service::{CallNotes, Ending, Observer};

/// Upper ends of the buckets of all times, seconds: what a small question takes through shared memory, up to the longest
/// deadline that is of use to a planner.
const BUCKETS: [f64; 22] = [
    1e-5, 2.5e-5, 5e-5, 1e-4, 2.5e-4, 5e-4, 1e-3, 2.5e-3, 5e-3, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0,
    30.0, 60.0, 300.0,
];

#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct CallLabels {
    door: &'static str,
    rpc: &'static str,
    outcome: &'static str,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct WorkLabels {
    door: &'static str,
    rpc: &'static str,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct ItemLabels {
    door: &'static str,
    rpc: &'static str,
    verdict: &'static str,
    /// Of undecided items; else empty, which is none.
    reason: &'static str,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct LimitLabels {
    door: &'static str,
    limit: &'static str,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct DoorLabels {
    door: &'static str,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct CostLabels {
    kind: &'static str,
}

type Times<L> = Family<L, Histogram, fn() -> Histogram>;

fn times<L: Clone + std::hash::Hash + Eq>() -> Times<L> {
    Family::new_with_constructor(|| Histogram::new(BUCKETS))
}

/// The metrics of calls. Clones count together.
#[derive(Clone, Debug)]
pub struct CallMetrics(Arc<Families>);

#[derive(Debug)]
struct Families {
    duration: Times<CallLabels>,
    wait: Times<WorkLabels>,
    work: Times<WorkLabels>,
    under_way: Family<DoorLabels, Gauge>,
    streams: Family<CallLabels, Counter>,
    items: Family<ItemLabels, Counter>,
    out_of_time: Family<WorkLabels, Counter>,
    edits: Family<DoorLabels, Counter>,
    limits: Family<LimitLabels, Counter>,
    /// In the order of [`COSTS`].
    cost: [Counter; COSTS.len()],
}

/// The counters of the kernel that add up what answers cost.
const COSTS: [&str; 11] = [
    "supports",
    "gjk_iterations",
    "epa_iterations",
    "nodes",
    "pairs",
    "escalations",
    "patch_corners",
    "patch_cuts",
    "derivative_separations",
    "derivative_supports",
    "derivative_corners",
];

impl CallMetrics {
    /// Metrics that are part of what `registry` tells.
    pub fn register(registry: &mut Registry) -> Self {
        let cost = Family::<CostLabels, Counter>::default();
        registry.register("clearance_query_cost", "What answers cost: counters of the kernel", cost.clone());
        let families = Families {
            duration: times(),
            wait: times(),
            work: times(),
            under_way: Family::default(),
            streams: Family::default(),
            items: Family::default(),
            out_of_time: Family::default(),
            edits: Family::default(),
            limits: Family::default(),
            // Looked up once: every answer adds to all of them.
            cost: COSTS.map(|kind| cost.get_or_create_owned(&CostLabels { kind })),
        };
        let Families { duration, wait, work, under_way, streams, items, out_of_time, edits, limits, cost: _ } =
            &families;
        registry.register(
            "clearance_call_duration_seconds",
            "Time from the arrival of a call to its answer, without the time that a caller takes to read it",
            duration.clone(),
        );
        registry.register(
            "clearance_call_wait_seconds",
            "Time that a call waited for its turn: for a thread, or for changes before it",
            wait.clone(),
        );
        registry.register("clearance_call_work_seconds", "Time that was worked on a call", work.clone());
        registry.register("clearance_calls_in_flight", "Calls under way, streams included", under_way.clone());
        registry.register("clearance_streams_ended", "Streams that have ended", streams.clone());
        registry.register("clearance_items", "Items of questions that were answered", items.clone());
        registry.register(
            "clearance_answers_out_of_time",
            "Answers whose time ran out before every item was looked at",
            out_of_time.clone(),
        );
        registry.register("clearance_edits", "Edits of scenes that were sent and decoded", edits.clone());
        registry.register("clearance_limit_refusals", "Calls that were refused by a limit", limits.clone());
        Self(Arc::new(families))
    }
}

impl Observer for CallMetrics {
    fn begun(&self, notes: &CallNotes, _span: &Span) {
        self.0.under_way.get_or_create(&DoorLabels { door: notes.asker().door }).inc();
    }

    fn ended(&self, notes: &CallNotes, ending: Ending) {
        let families = &*self.0;
        let (door, rpc) = (notes.asker().door, notes.rpc().name);
        families.under_way.get_or_create(&DoorLabels { door }).dec();
        let labels = CallLabels { door, rpc, outcome: ending.outcome.word };
        if notes.rpc().streams {
            families.streams.get_or_create(&labels).inc();
        } else {
            families.duration.get_or_create(&labels).observe(ending.took.as_secs_f64());
        }
        for (time, histograms) in [(notes.waited(), &families.wait), (notes.worked(), &families.work)] {
            if let Some(time) = time {
                histograms.get_or_create(&WorkLabels { door, rpc }).observe(time.as_secs_f64());
            }
        }
        if let Some(limit) = ending.outcome.limit {
            families.limits.get_or_create(&LimitLabels { door, limit }).inc();
        }
        if let Some(edits) = notes.edits() {
            families.edits.get_or_create(&DoorLabels { door }).inc_by(edits as u64);
        }
        let Some(answered) = notes.answered() else { return };
        for (verdict, reason, count) in answered.verdicts.named() {
            if count == 0 {
                continue;
            }
            families.items.get_or_create(&ItemLabels { door, rpc, verdict, reason }).inc_by(count);
        }
        if answered.out_of_time {
            families.out_of_time.get_or_create(&WorkLabels { door, rpc }).inc();
        }
        let cost = answered.cost;
        let counts = [
            cost.supports,
            cost.gjk_iterations,
            cost.epa_iterations,
            cost.nodes,
            cost.pairs,
            cost.escalations,
            cost.patch_corners,
            cost.patch_cuts,
            cost.derivative_separations,
            cost.derivative_supports,
            cost.derivative_corners,
        ];
        for (total, count) in families.cost.iter().zip(counts) {
            total.inc_by(count);
        }
    }
}
