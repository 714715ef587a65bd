//! What clients in every language are held to: recorded questions with the canonical bytes of their answers.

mod casts;
#[path = "../service/support/daemon.rs"]
#[expect(dead_code, reason = "tests of the service look into it as well")]
mod daemon;
mod estimates;
#[path = "../../examples/first_query.rs"]
#[expect(dead_code, reason = "the example's own way in")]
mod first_query;
mod library;
#[path = "../service/support/messages.rs"]
#[expect(dead_code, reason = "words for all tests of the service; these need some of them")]
mod messages;
mod questions;
mod record;
mod records;
mod rust;
#[path = "../service/support/watchdog.rs"]
#[expect(dead_code, reason = "as above")]
mod watchdog;
