//! Which calls took too long, and why? One line for a call beyond a threshold, at most one a second: what was asked, what it
//! cost, how long it waited and worked. Streams are as long as their callers like, and never slow.

use std::time::Duration;

use crate::query::Wants;
use crate::service::{CallNotes, Ending, Observer, Question, Seldom};

/// What the lines are filtered by.
const SLOW: &str = "clearance::slow";

/// Writes the lines.
#[derive(Debug)]
pub struct SlowQueries {
    threshold: Duration,
    line: Seldom,
}

impl SlowQueries {
    /// Calls that take at least `threshold` are slow.
    #[must_use]
    pub fn new(threshold: Duration) -> Self {
        Self { threshold, line: Seldom::new() }
    }
}

impl Observer for SlowQueries {
    fn ended(&self, notes: &CallNotes, ending: Ending) {
        if ending.took < self.threshold || notes.rpc().streams {
            return;
        }
        // What is not logged is counted, and told with the next line.
        let Some(times) = self.line.due() else { return };
        let seconds = |time: Option<Duration>| time.map(|time| time.as_secs_f64());
        let (asker, question, answered) = (notes.asker(), notes.question(), notes.answered());
        let cost = answered.map(|answered| answered.cost);
        tracing::warn!(
            target: SLOW,
            parent: None,
            call = notes.number(),
            rpc = notes.rpc().name,
            door = asker.door,
            client = &*asker.client,
            scene = notes.scene(),
            revision = notes.revision().map(|revision| revision.0),
            of = question.map(|question| question.of),
            items = question.map(|question| question.items),
            edits = notes.edits(),
            wants = question.map(wants),
            margin = question.map(|question| question.margin),
            absolute_tolerance = question.map(|question| question.absolute_tolerance),
            relative_tolerance = question.map(|question| question.relative_tolerance),
            outcome = ending.outcome.word,
            out_of_time = answered.map(|answered| answered.out_of_time),
            took_seconds = ending.took.as_secs_f64(),
            waited_seconds = seconds(notes.waited()),
            worked_seconds = seconds(notes.worked()),
            supports = cost.map(|cost| cost.supports),
            gjk_iterations = cost.map(|cost| cost.gjk_iterations),
            epa_iterations = cost.map(|cost| cost.epa_iterations),
            nodes = cost.map(|cost| cost.nodes),
            pairs = cost.map(|cost| cost.pairs),
            escalations = cost.map(|cost| cost.escalations),
            patch_corners = cost.map(|cost| cost.patch_corners),
            patch_cuts = cost.map(|cost| cost.patch_cuts),
            derivative_separations = cost.map(|cost| cost.derivative_separations),
            derivative_supports = cost.map(|cost| cost.derivative_supports),
            derivative_corners = cost.map(|cost| cost.derivative_corners),
            trace_id = notes.trace(),
            times,
            "slow query"
        );
    }
}

/// What was wanted, in the words of the protocol.
fn wants(question: &Question) -> String {
    let Wants { distance, witness, depth, pairs, patch, derivatives } = question.wants;
    let named = [
        ("distance", distance),
        ("witness", witness),
        ("depth", depth),
        ("pairs", pairs),
        ("patch", patch),
        ("derivatives", derivatives),
    ];
    let wanted = named.into_iter().filter_map(|(name, wanted)| wanted.then_some(name));
    ["verdict"].into_iter().chain(wanted).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use std::io;
    use std::sync::{Arc, Mutex};

    use tracing_subscriber::fmt::MakeWriter;

    use super::*;
    use crate::query::{CheckStates, Context, Mode};
    use crate::service::{Asker, Config, Patience, Rpc, Service, ServiceError, Target};

    /// Log lines of one test.
    #[derive(Clone, Default)]
    struct Lines(Arc<Mutex<Vec<u8>>>);

    impl io::Write for Lines {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().unwrap().extend_from_slice(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl MakeWriter<'_> for Lines {
        type Writer = Self;

        fn make_writer(&self) -> Self {
            self.clone()
        }
    }

    impl Lines {
        fn read(&self) -> Vec<serde_json::Value> {
            let text = String::from_utf8(self.0.lock().unwrap().clone()).unwrap();
            text.lines()
                .map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap()["fields"].clone())
                .collect()
        }
    }

    fn asker() -> Asker {
        Asker { door: "grpc", client: "planner".into(), traceparent: None }
    }

    /// Asks `count` times, each at least `length` long, and gives the lines that came of it.
    fn asked(threshold: Duration, length: Duration, count: usize) -> Vec<serde_json::Value> {
        let lines = Lines::default();
        let subscriber = tracing_subscriber::fmt().json().with_writer(lines.clone()).finish();
        tracing::subscriber::with_default(subscriber, || {
            let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
            let observers: Vec<Box<dyn Observer>> = vec![Box::new(SlowQueries::new(threshold))];
            let service = Service::observed(&Config { threads: 1, ..Config::default() }, observers).unwrap();
            service.create_scene("cell", &Default::default()).unwrap();
            let target = Target { scene: "cell".to_owned(), ..Target::default() };
            for _ in 0..count {
                let call = service.begin_call(Rpc { name: "CheckStates", streams: false }, asker);
                let question = move |view: &crate::service::View| {
                    std::thread::sleep(length);
                    let wants = Wants { patch: false, derivatives: false, ..Wants::ALL }; // Not every build has these.
                    let context = Context { wants, margin: 0.5, ..Context::default() };
                    view.check_states(&CheckStates {
                        robot: "nobody".to_owned(),
                        positions: vec![0.0; 6],
                        mode: Mode::All,
                        context,
                    })
                };
                let outcome = runtime.block_on(call.answer(service.ask(&target, Patience::default(), question)));
                assert!(matches!(outcome, Err(ServiceError::NotFound { .. })), "{outcome:?}");
            }
        });
        lines.read()
    }

    #[test]
    fn a_slow_call_is_told_with_what_it_waited_and_worked() {
        let lines = asked(Duration::from_millis(5), Duration::from_millis(6), 1);
        let [line] = lines.as_slice() else { panic!("{lines:?}") };
        assert_eq!(
            (&line["message"], &line["rpc"], &line["scene"]),
            (&"slow query".into(), &"CheckStates".into(), &"cell".into())
        );
        assert_eq!((&line["client"], &line["door"], &line["revision"]), (&"planner".into(), &"grpc".into(), &0.into()));
        assert_eq!((&line["outcome"], &line["times"]), (&"not_found".into(), &1.into()));
        let seconds = |name: &str| line[name].as_f64().unwrap_or_else(|| panic!("{name}: {line}"));
        assert!(seconds("worked_seconds") >= 0.006 && seconds("took_seconds") >= seconds("worked_seconds"), "{line}");
        assert!(seconds("waited_seconds") >= 0.0, "{line}");
    }

    #[test]
    fn a_quick_call_is_not_told() {
        assert_eq!(asked(Duration::from_secs(60), Duration::ZERO, 3), [] as [serde_json::Value; 0]);
    }

    #[test]
    fn a_flood_of_slow_calls_is_a_line_a_second() {
        let lines = asked(Duration::ZERO, Duration::ZERO, 200);
        assert!((1..=20).contains(&lines.len()), "{} lines", lines.len());
    }

    #[test]
    fn what_is_wanted_is_told_in_the_words_of_the_protocol() {
        let wants_all = Wants { distance: true, pairs: true, patch: true, ..Wants::VERDICT };
        let question = Question {
            of: "states",
            items: 1,
            wants: wants_all,
            margin: 0.0,
            absolute_tolerance: 0.0,
            relative_tolerance: 0.0,
        };
        assert_eq!(wants(&question), "verdict,distance,pairs,patch");
    }
}
