//! Log lines as programs read them: one for each call, one for a slow one, and no secret in any.

use std::collections::BTreeMap;

use clearance::transports::wire::v1;
use serde_json::Value;
use tonic::Request;

use crate::daemon::{Daemon, ball, collide};

const TRACE: &str = "4bf92f3577b34da6a3ce929d0e0e4736";

/// The fields of every line whose message is `message`.
fn told(log: &str, message: &str) -> Vec<Value> {
    let lines = log.lines().map(|line| serde_json::from_str::<Value>(line).unwrap_or_else(|e| panic!("{e}: {line}")));
    let fields = lines.map(|line| line["fields"].clone());
    fields.filter(|fields| fields["message"] == message).collect()
}

#[tokio::test(flavor = "multi_thread")]
async fn every_call_is_a_line_of_json_and_no_token_is_in_any() {
    let folder = tempfile::tempdir().unwrap();
    let (file, token) = (folder.path().join("clearance.toml"), "a-token-that-nobody-guesses");
    std::fs::write(folder.path().join("token"), token).unwrap();
    let token_file = folder.path().join("token");
    let text = format!("[[grpc.tokens]]\nname = \"planner\"\nfile = {token_file:?}\nscopes = [\"read\", \"write\"]\n");
    std::fs::write(&file, text).unwrap();
    let config = file.to_str().unwrap();
    let daemon =
        Daemon::start(&["--config", config, "--log", "trace", "--log-format", "json", "--limit", "max_items=2"]);
    let bearer = |token: &str| format!("Bearer {token}").parse().unwrap();
    let (mut scenes, mut queries) = (daemon.scenes().await, daemon.queries().await);
    let mut create = Request::new(v1::CreateSceneRequest { name: "cell".to_owned(), ..Default::default() });
    create.metadata_mut().insert("authorization", bearer(token));
    scenes.create_scene(create).await.unwrap();
    let edits = vec![ball("a", 0.0)];
    let mut apply = Request::new(v1::ApplyRequest { scene: "cell".to_owned(), edits, ..v1::ApplyRequest::default() });
    apply.metadata_mut().insert("authorization", bearer(token));
    scenes.apply(apply).await.unwrap();
    let ask = |bodies: &[&str], token: &str| {
        let mut request = Request::new(collide("cell", bodies));
        request.metadata_mut().insert("authorization", bearer(token));
        request.metadata_mut().insert("traceparent", format!("00-{TRACE}-00f067aa0ba902b7-00").parse().unwrap());
        request
    };
    let refused = queries.collide(ask(&["a"; 3], token)).await.unwrap_err();
    let number = refused.metadata().get("clearance-call").unwrap().to_str().unwrap().to_owned();
    queries.collide(ask(&["a"], "another-token-altogether")).await.unwrap_err();
    let (code, log, _) = daemon.stop();
    assert_eq!(code, Some(0), "{log}");

    let calls = told(&log, "call");
    let by_outcome: BTreeMap<_, _> = calls.iter().map(|call| (call["outcome"].as_str().unwrap(), call)).collect();
    let over = by_outcome["limit_exceeded"];
    assert_eq!(
        (&over["rpc"], &over["door"], &over["client"]),
        (&"Collide".into(), &"grpc".into(), &"token:planner".into())
    );
    assert_eq!((&over["scene"], &over["items"], &over["limit"]), (&"cell".into(), &3.into(), &"max_items".into()));
    assert_eq!((&over["trace_id"], over["call"].to_string()), (&TRACE.into(), number));
    assert!(over["took_seconds"].as_f64().unwrap() >= over["worked_seconds"].as_f64().unwrap());
    assert_eq!((&by_outcome["ok"]["rpc"], &by_outcome["ok"]["edits"]), (&"Apply".into(), &1.into()));
    assert!(by_outcome["unknown_token"]["client"].as_str().unwrap().starts_with("peer:"), "{log}");
    for secret in [token, "another-token-altogether"] {
        assert!(!log.contains(secret), "{log}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_slow_question_is_told_with_what_was_asked_and_what_it_cost() {
    let daemon = Daemon::start(&["--slow-query-seconds", "0.000001", "--log-format", "json"]);
    let mut queries = daemon.queries().await;
    daemon.with_balls("cell").await;
    // The two calls before have taken this second's line.
    tokio::time::sleep(std::time::Duration::from_millis(1_100)).await;
    queries.collide(collide("cell", &["a", "b", "c"])).await.unwrap();
    let (code, log, _) = daemon.stop();
    assert_eq!(code, Some(0), "{log}");
    let slow = told(&log, "slow query");
    let line = slow.iter().find(|line| line["rpc"] == "Collide").unwrap_or_else(|| panic!("{log}"));
    assert_eq!((&line["scene"], &line["revision"], &line["outcome"]), (&"cell".into(), &1.into(), &"ok".into()));
    assert_eq!((&line["of"], &line["items"], &line["wants"]), (&"subjects".into(), &3.into(), &"verdict".into()));
    assert!(line["nodes"].as_u64().unwrap() + line["pairs"].as_u64().unwrap() > 0, "{line}");
    for number in ["margin", "absolute_tolerance", "relative_tolerance", "waited_seconds", "worked_seconds"] {
        assert!(line[number].as_f64().is_some_and(|value| value >= 0.0), "{number}: {line}");
    }
    assert!(slow.len() <= 3, "at most one line a second: {log}");
}

#[test]
fn a_log_format_that_is_none_is_refused() {
    let output = crate::daemon::serve().args(["--log-format", "xml"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("neither text nor json"));
}
