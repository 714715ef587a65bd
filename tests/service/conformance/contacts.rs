//! Contacts that are watched.

use std::collections::BTreeMap;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::wire::v1::ContactEventKind::{Begin, End, Stay, Undecided};
use clearance::transports::wire::v1::ContactState;
use clearance::transports::wire::v1::revision_rule::Rule;
use tonic::Code;

use super::through_doors_with_watches;
use crate::support::door::{Contacts, Refusal, Watches};
use crate::support::messages::*;

through_doors_with_watches!(
    the_first_step_has_every_contact_and_the_next_ones_what_changed,
    a_step_says_why_a_contact_ended,
    what_stays_is_listed_where_asked,
    a_margin_counts_where_asked,
    undecided_pairs_are_told,
    a_reader_that_does_not_read_is_led_over_several_revisions,
    a_watch_can_begin_at_an_earlier_revision,
    long_lists_come_in_several_messages,
    points_of_contact_are_told_where_wanted,
    derivatives_of_contacts_are_told_where_wanted,
    a_deleted_scene_ends_a_watch,
    watchers_are_counted,
    watches_take_no_overlays,
    more_contacts_than_allowed_end_a_watch,
    what_cannot_be_watched_is_refused_by_field,
);

fn limits() -> Limits {
    Limits { max_watchers: 2, max_contacts: 6000, snapshots_kept: 4, ..Limits::default() }
}

fn ball(name: &str, x: f64) -> v1::Edit {
    add(name, sphere(0.5), at(x, 0.0, 0.0))
}

fn to(name: &str, x: f64) -> v1::Edit {
    move_to(named(name), at(x, 0.0, 0.0))
}

/// Balls named by their order, `x` metres along x.
async fn balls(door: &impl Watches, centres: &[f64]) {
    door.create_scene(SCENE).await.unwrap();
    let balls = centres.iter().enumerate().map(|(i, x)| ball(&format!("{i}"), *x));
    door.apply(apply(balls.collect())).await.unwrap();
}

/// From, to, and the events as kind and ids.
type Step = (Option<u64>, u64, Vec<(v1::ContactEventKind, u64, u64)>);

fn step(message: &v1::WatchContactsResponse) -> Step {
    assert!(!message.more);
    let events = message.events.iter().map(|event| (event.kind(), event.a, event.b)).collect();
    (message.from_revision, message.revision, events)
}

async fn the_first_step_has_every_contact_and_the_next_ones_what_changed(door: &impl Watches) {
    balls(door, &[0.0, 0.9, 1.8, 5.0]).await;
    let mut watch = door.watch_contacts(watch()).await.unwrap();
    let first = watch.message().await.unwrap();
    assert_eq!(step(&first), (None, 1, vec![(Begin, 1, 2), (Begin, 2, 3)]));
    assert_eq!((first.contacts, first.undecided), (2, 0));
    let pair = first.events[0].pair.as_ref().unwrap();
    assert!(pair.bracket.unwrap().upper <= 0.0 && pair.verdict() == v1::Verdict::Collision);

    let changed = door.apply(apply(vec![to("0", 4.1), to("3", 5.0)])).await.unwrap();
    let second = watch.message().await.unwrap();
    assert_eq!(step(&second), (Some(1), 2, vec![(End, 1, 2), (Begin, 1, 4)]));
    assert_eq!((second.contacts, second.epoch), (2, changed.epoch));
    assert_eq!(second.events[0].before(), ContactState::Contact);
    assert!(second.cost.unwrap().pairs <= 2, "{second:?}");
    // Nothing that touches anything: the revision is told all the same.
    door.apply(apply(vec![to("0", 4.2), to("0", 4.1)])).await.unwrap();
    assert_eq!(step(&watch.message().await.unwrap()), (Some(2), 3, Vec::new()));
}

async fn a_step_says_why_a_contact_ended(door: &impl Watches) {
    balls(door, &[0.0, 0.8, 1.6, 2.4, 3.2]).await;
    let mut watch = door.watch_contacts(watch()).await.unwrap();
    assert_eq!(watch.message().await.unwrap().contacts, 4);
    let party = |name| Some(v1::Party { kind: Some(v1::party::Kind::Body(named(name))) });
    let edits = vec![
        remove(named("0")),
        edit(v1::edit::Kind::SetEnabled(v1::SetEnabled { body: Some(named("4")), enabled: false })),
        edit(v1::edit::Kind::SetAllowedCollision(v1::SetAllowedCollision {
            a: party("2"),
            b: party("3"),
            allowed: Some(true),
        })),
    ];
    door.apply(apply(edits)).await.unwrap();
    let message = watch.message().await.unwrap();
    let reasons: Vec<_> = message.events.iter().map(|event| (event.a, event.b, event.kind(), event.reason())).collect();
    let (removed, disabled) = (v1::ContactEndReason::Removed, v1::ContactEndReason::Disabled);
    let not_a_pair = v1::ContactEndReason::NotAPair;
    assert_eq!(reasons, [(1, 2, End, removed), (3, 4, End, not_a_pair), (4, 5, End, disabled)]);
    door.apply(apply(vec![to("1", -5.0)])).await.unwrap();
    let message = watch.message().await.unwrap();
    assert_eq!(message.events[0].reason(), v1::ContactEndReason::Apart);
    assert_eq!((message.contacts, message.events.len()), (0, 1));
}

async fn what_stays_is_listed_where_asked(door: &impl Watches) {
    balls(door, &[0.0, 0.8, 5.0]).await;
    let mut watch = door.watch_contacts(v1::WatchContactsRequest { stays: true, ..watch() }).await.unwrap();
    let first = watch.message().await.unwrap();
    door.apply(apply(vec![to("2", 1.6)])).await.unwrap();
    let second = watch.message().await.unwrap();
    assert_eq!(step(&second).2, [(Stay, 1, 2), (Begin, 2, 3)]);
    assert_eq!(second.events[0].pair, first.events[0].pair, "what is known of a pair that rests stays true");
}

async fn a_margin_counts_where_asked(door: &impl Watches) {
    balls(door, &[0.0, 1.1]).await;
    let context = Some(v1::Context { margin: 0.2, ..context() });
    let threshold = v1::ContactThreshold::Margin.into();
    let mut near = door.watch_contacts(v1::WatchContactsRequest { context, threshold, stays: false }).await.unwrap();
    let mut touching = door.watch_contacts(watch()).await.unwrap();
    assert_eq!(near.message().await.unwrap().contacts, 1);
    assert_eq!(touching.message().await.unwrap().contacts, 0);
}

async fn undecided_pairs_are_told(door: &impl Watches) {
    door.create_scene(SCENE).await.unwrap();
    let cylinder = || shape(v1::shape::Core::Cylinder(v1::Cylinder { radius: 0.625, half_length: 1.0 }));
    // The rims touch off the axes, where no bracket proves it.
    let bodies = vec![add("a", cylinder(), at(0.0, 0.0, 0.0)), add("b", cylinder(), at(0.75, 1.0, 0.0))];
    door.apply(apply(bodies)).await.unwrap();
    let mut watch = door.watch_contacts(watch()).await.unwrap();
    let first = watch.message().await.unwrap();
    assert_eq!(step(&first).2, [(Undecided, 1, 2)]);
    assert_eq!((first.contacts, first.undecided), (0, 1));
    door.apply(apply(vec![move_to(named("b"), at(0.75, 0.9, 0.0))])).await.unwrap();
    let event = watch.message().await.unwrap().events.remove(0);
    assert_eq!((event.kind(), event.before(), event.after()), (Begin, ContactState::Undecided, ContactState::Contact));
}

/// However steps are joined, they lead from one to the next, and to what is there in the end.
async fn a_reader_that_does_not_read_is_led_over_several_revisions(door: &impl Watches) {
    balls(door, &[0.0, 0.9, 5.0]).await;
    let mut watch = door.watch_contacts(watch()).await.unwrap();
    let mut told = watch.message().await.unwrap();
    // Longer than revisions are kept.
    for i in 0..10 {
        door.apply(apply(vec![to("0", if i % 2 == 0 { 5.3 } else { 0.0 }), to("2", 5.0 + f64::from(i))]))
            .await
            .unwrap();
    }
    let mut contacts: BTreeMap<(u64, u64), ContactState> = BTreeMap::from([((1, 2), ContactState::Contact)]);
    let mut messages = 0;
    while told.revision < 11 {
        let next = watch.message().await.unwrap();
        assert_eq!(next.from_revision, Some(told.revision));
        for event in &next.events {
            let held = contacts.get(&(event.a, event.b)).copied().unwrap_or(ContactState::Apart);
            assert_eq!(held, event.before(), "{event:?}");
            contacts.insert((event.a, event.b), event.after());
        }
        (told, messages) = (next, messages + 1);
    }
    contacts.retain(|_, state| *state != ContactState::Apart);
    assert_eq!(contacts, BTreeMap::from([((1, 2), ContactState::Contact)]));
    assert!((1..=10).contains(&messages), "{messages}");
}

async fn a_watch_can_begin_at_an_earlier_revision(door: &impl Watches) {
    balls(door, &[0.0, 0.9]).await;
    door.apply(apply(vec![to("1", 3.0)])).await.unwrap();
    let request = v1::WatchContactsRequest { context: Some(asked_of(Rule::Exactly(1))), ..watch() };
    let mut watch = door.watch_contacts(request).await.unwrap();
    assert_eq!(step(&watch.message().await.unwrap()), (None, 1, vec![(Begin, 1, 2)]));
    assert_eq!(step(&watch.message().await.unwrap()), (Some(1), 2, vec![(End, 1, 2)]));
}

async fn long_lists_come_in_several_messages(door: &impl Watches) {
    door.create_scene(SCENE).await.unwrap();
    let row = (0..5001).map(|i| ball(&format!("{i}"), 0.9 * f64::from(i)));
    door.apply(apply(row.collect())).await.unwrap();
    let mut watch = door.watch_contacts(watch()).await.unwrap();
    let mut pairs = Vec::new();
    loop {
        let message = watch.message().await.unwrap();
        assert_eq!((message.from_revision, message.revision, message.contacts), (None, 1, 5000));
        pairs.extend(message.events.iter().map(|event| (event.kind(), event.a, event.b)));
        if !message.more {
            break;
        }
    }
    assert_eq!(pairs, (1..=5000).map(|i| (Begin, i, i + 1)).collect::<Vec<_>>());
}

async fn points_of_contact_are_told_where_wanted(door: &impl Watches) {
    balls(door, &[0.0, 0.75]).await;
    let wants = Some(v1::Wants { witness: true, depth: true, ..v1::Wants::default() });
    let request = v1::WatchContactsRequest { context: Some(v1::Context { wants, ..context() }), ..watch() };
    let first = door.watch_contacts(request).await.unwrap().message().await.unwrap();
    let pair = first.events[0].pair.as_ref().unwrap();
    assert!((pair.signed_distance + 0.25).abs() < 1e-9);
    assert!((pair.witness.unwrap().normal.unwrap().x - 1.0).abs() < 1e-9);
}

async fn derivatives_of_contacts_are_told_where_wanted(door: &impl Watches) {
    balls(door, &[0.0, 0.75]).await;
    let wants = Some(v1::Wants { depth: true, derivatives: true, ..v1::Wants::default() });
    let made = |options| {
        let context = v1::Context { wants, derivatives: Some(options), ..context() };
        v1::WatchContactsRequest { context: Some(context), ..watch() }
    };
    let mut watched = door.watch_contacts(made(v1::DerivativeOptions::default())).await.unwrap();
    let first = watched.message().await.unwrap();
    let told = first.events[0].pair.as_ref().unwrap().derivatives.as_ref().unwrap();
    assert_eq!(told.method(), v1::DerivativeMethod::Exact);
    for (column, number) in told.of_b.as_ref().unwrap().signed_distance.iter().enumerate() {
        let expected = if column == 0 { 1.0 } else { 0.0 };
        assert!((number - expected).abs() < 1e-9, "{told:?}");
    }
    let refusal = refused(door, made(v1::DerivativeOptions { samples: Some(10_001), ..Default::default() })).await;
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::ResourceExhausted, "LIMIT_EXCEEDED"), "{refusal:?}");
    assert!(refusal.message.starts_with("max_derivative_samples exceeded"), "{refusal:?}");
}

async fn a_deleted_scene_ends_a_watch(door: &impl Watches) {
    balls(door, &[0.0]).await;
    let mut watch = door.watch_contacts(watch()).await.unwrap();
    watch.message().await.unwrap();
    let delete = async {
        tokio::time::sleep(std::time::Duration::from_millis(50)).await;
        door.delete_scene(SCENE).await.unwrap()
    };
    let (told, _) = tokio::join!(watch.message(), delete);
    let refusal = told.unwrap_err();
    assert_eq!((refusal.code, refusal.message.as_str()), (Code::NotFound, "no scene \"cell\""));
}

/// What a watch is refused with, at once or in the place of its first message.
async fn refused(door: &impl Watches, request: v1::WatchContactsRequest) -> Refusal {
    match door.watch_contacts(request).await {
        Ok(mut watch) => watch.message().await.unwrap_err(),
        Err(refusal) => refusal,
    }
}

async fn watchers_are_counted(door: &impl Watches) {
    balls(door, &[0.0]).await;
    let mut kept = [door.watch_contacts(watch()).await.unwrap(), door.watch_contacts(watch()).await.unwrap()];
    for watch in &mut kept {
        watch.message().await.unwrap();
    }
    let refusal = refused(door, watch()).await;
    assert_eq!(refusal.code, Code::ResourceExhausted);
    assert_eq!(refusal.message, "max_watchers exceeded: asked for 3, allowed is 2");
    drop(kept);
    let mut tries = 0;
    // A connection takes a moment to tell that nobody reads.
    while let Err(refusal) = door.watch_contacts(watch()).await {
        assert!(refusal.code == Code::ResourceExhausted && tries < 200, "{refusal:?}");
        tries += 1;
        tokio::time::sleep(std::time::Duration::from_millis(20)).await;
    }
}

async fn more_contacts_than_allowed_end_a_watch(door: &impl Watches) {
    balls(door, &[0.0, 0.9]).await;
    let mut watch = door.watch_contacts(watch()).await.unwrap();
    watch.message().await.unwrap();
    // 110 balls in one place: 5995 pairs among themselves, and 110 with each of the first two.
    door.apply(apply((0..110).map(|i| ball(&format!("more {i}"), 0.45)).collect())).await.unwrap();
    let refusal = watch.message().await.unwrap_err();
    assert_eq!((refusal.code, refusal.reason.as_str()), (Code::ResourceExhausted, "LIMIT_EXCEEDED"));
    assert!(refusal.message.starts_with("max_contacts exceeded: asked for "), "{refusal:?}");
}

async fn what_cannot_be_watched_is_refused_by_field(door: &impl Watches) {
    balls(door, &[0.0]).await;
    let with = |context: v1::Context| v1::WatchContactsRequest { context: Some(context), ..watch() };
    let margin = v1::ContactThreshold::Margin.into();
    let filter = |filter| with(v1::Context { filter: Some(filter), ..context() });
    let cases = [
        (v1::WatchContactsRequest { context: None, ..watch() }, Code::InvalidArgument, "context"),
        (v1::WatchContactsRequest { threshold: 9, ..watch() }, Code::InvalidArgument, "threshold"),
        (with(v1::Context { margin: 0.1, ..context() }), Code::InvalidArgument, "context.margin"),
        (with(v1::Context { margin: f64::NAN, ..context() }), Code::InvalidArgument, "context.margin"),
        (
            v1::WatchContactsRequest { threshold: margin, ..with(v1::Context { margin: f64::INFINITY, ..context() }) },
            Code::InvalidArgument,
            "context.margin",
        ),
        (with(v1::Context { cut_off: Some(1.0), ..context() }), Code::InvalidArgument, "context.cut_off"),
        (with(v1::Context { max_pairs: Some(1), ..context() }), Code::InvalidArgument, "context.max_pairs"),
        (with(v1::Context { time_budget: Some(1.0), ..context() }), Code::InvalidArgument, "context.time_budget"),
        (with(v1::Context { answer_form: 2, ..context() }), Code::InvalidArgument, "context.answer_form"),
        (with(v1::Context { solver: 99, ..context() }), Code::InvalidArgument, "context.solver"),
        (
            with(v1::Context {
                derivatives: Some(v1::DerivativeOptions { method: 99, ..Default::default() }),
                ..context()
            }),
            Code::InvalidArgument,
            "context.derivatives.method",
        ),
        (filter(v1::Filter { groups: vec!["nobody".to_owned()], ..v1::Filter::default() }), Code::NotFound, ""),
        (filter(v1::Filter { ignore: vec![named("nobody")], ..v1::Filter::default() }), Code::NotFound, ""),
        (filter(v1::Filter { ignore: vec![numbered(77)], ..v1::Filter::default() }), Code::NotFound, ""),
        (with(v1::Context { scene: "elsewhere".to_owned(), ..context() }), Code::NotFound, ""),
    ];
    for (request, code, field) in cases {
        let refusal = refused(door, request).await;
        assert_eq!((refusal.code, refusal.field.as_str()), (code, field), "{refusal:?}");
    }
}

async fn watches_take_no_overlays(door: &impl Watches) {
    door.create_scene(SCENE).await.unwrap();
    for (field, context) in with_overlays() {
        let watch = v1::WatchContactsRequest { context: Some(context), ..watch() };
        let refusal = door.watch_contacts(watch).await.err().unwrap();
        assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, field), "{refusal:?}");
    }
}
