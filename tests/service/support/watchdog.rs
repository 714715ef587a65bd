//! No test hangs: whatever is awaited is given up after a time that no healthy run comes near.

use std::time::Duration;

const PATIENCE: Duration = Duration::from_secs(60);

pub async fn watched<T>(what: &str, future: impl Future<Output = T>) -> T {
    match tokio::time::timeout(PATIENCE, future).await {
        Ok(value) => value,
        Err(_) => panic!("{what}: nothing came in {PATIENCE:?}"),
    }
}

/// Waits until `condition` holds.
pub async fn eventually(what: &str, mut condition: impl FnMut() -> bool) {
    let poll = async {
        while !condition() {
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
    };
    watched(what, poll).await;
}
