//! Bare zenoh, set up as the door is: a query to a queryable that replies at once, over TCP.

use std::time::Duration;

use zenoh::query::{ConsolidationMode, Queryable};
use zenoh::{Config as Configuration, Session, Wait};

use super::client::client_of;
use super::config::Config;
use crate::limits::Limits;
use crate::transports::echo::{Echo, EchoError, Parcel, wanted};

const KEY: &str = "clearance/echo";
const PATIENCE: Duration = Duration::from_secs(60);

/// A client of bare zenoh.
#[derive(Debug)]
pub struct ZenohEcho {
    client: Session,
    came: usize,
    _queryable: Queryable<()>,
    _server: Session,
}

impl ZenohEcho {
    /// Both sides in this process, with sizes as the door has them with these limits.
    ///
    /// # Errors
    /// What zenoh says.
    pub fn new(limits: &Limits) -> Result<Self, EchoError> {
        let config = Config::on_loopback("clearance").of_zenoh(limits).map_err(EchoError::of("zenoh"))?;
        let server = open(config)?;
        let queryable = server.declare_queryable(KEY).complete(true).callback(|query| {
            let wanted = query.payload().map_or(0, |payload| wanted(&payload.to_bytes()));
            // One that is gone waits for nothing.
            drop(query.reply(KEY, vec![0; wanted]).express(true).wait());
        });
        let queryable = queryable.wait().map_err(EchoError::of("zenoh"))?;
        let locators = server.info().locators().wait();
        let locator = locators.first().ok_or_else(|| EchoError::of("zenoh")("it does not listen"))?;
        let client = open(client_of(&locator.to_string()).map_err(EchoError::of("zenoh"))?)?;
        Ok(Self { client, came: 0, _queryable: queryable, _server: server })
    }
}

fn open(config: Configuration) -> Result<Session, EchoError> {
    zenoh::open(config).wait().map_err(EchoError::of("zenoh"))
}

impl Echo for ZenohEcho {
    fn exchange(&mut self, parcel: &Parcel) -> Result<(), EchoError> {
        let query = self.client.get(KEY).payload(parcel.bytes()).timeout(PATIENCE).express(true);
        let query =
            query.consolidation(ConsolidationMode::None).congestion_control(zenoh::qos::CongestionControl::Block);
        let replies = query.wait().map_err(EchoError::of("zenoh"))?;
        let reply = replies.recv().map_err(EchoError::of("zenoh"))?.into_result().map_err(EchoError::of("zenoh"))?;
        self.came = reply.payload().len();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_zenoh_brings_back_as_many_bytes_as_were_asked_for() {
        let mut echo = ZenohEcho::new(&Limits::default()).unwrap();
        for (size, wanted) in [(8, 0), (100, 3), (6 << 20, 5 << 20)] {
            echo.exchange(&Parcel::new(size, wanted)).unwrap();
            assert_eq!(echo.came, wanted);
        }
    }
}
