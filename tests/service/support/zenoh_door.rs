//! The door of zenoh: the messages that gRPC would carry, in queries and replies.

use std::time::Duration;

use clearance::app::DoorChoice;
use clearance::limits::Limits;
use clearance::transports::wire::v1;
use clearance::transports::zenoh::{Client, ClientError, Config, Watch};
use prost::Message;
use prost::bytes::Bytes;
use tonic::Code;

use super::by_name::ByName;
use super::daemon::{RunningDaemon, config};
use super::door::{Contacts, Messages, Refusal, Told, Watches};

/// What the keys of tests begin with. Sessions are of one daemon each: nobody hears of another's.
pub const PREFIX: &str = "test";
const PATIENCE: Duration = Duration::from_secs(100);

/// A daemon and a client of its zenoh door alone.
pub struct Zenoh {
    pub daemon: RunningDaemon,
    pub client: Client,
    pub endpoint: String,
}

impl Zenoh {
    pub async fn start(limits: Limits) -> Self {
        let mut config = config(limits);
        config.zenoh = DoorChoice::On(Config::on_loopback(PREFIX));
        let daemon = RunningDaemon::start(&config).await;
        let doors = daemon.service.doors();
        let endpoint = doors.iter().find(|door| door.kind == "zenoh").unwrap().address.clone();
        let client = Client::connect(&endpoint, PREFIX).await.unwrap();
        Self { daemon, client, endpoint }
    }
}

impl ByName for Zenoh {
    async fn open_with(limits: Limits) -> Self {
        Self::start(limits).await
    }

    async fn call_bytes(&self, rpc: &'static str, message: Vec<u8>) -> Told<Vec<u8>> {
        Ok(self.client.call(rpc, message, PATIENCE).await?.into())
    }
}

impl From<ClientError> for Refusal {
    fn from(error: ClientError) -> Self {
        let ClientError::Refused(refusal) = error else { panic!("{error}") };
        Self {
            code: Code::from(refusal.code),
            reason: refusal.reason.to_owned(),
            field: refusal.field().unwrap_or_default().to_owned(),
            message: refusal.message,
        }
    }
}

impl Watches for Zenoh {
    async fn watch_contacts(&self, request: v1::WatchContactsRequest) -> Told<impl Contacts> {
        begun(self.client.watch("Queries/WatchContacts", request.encode_to_vec(), PATIENCE, None).await?).await
    }

    async fn watch_scene(&self, request: v1::WatchRequest) -> Told<impl Messages<v1::WatchResponse>> {
        begun(self.client.watch("Scenes/Watch", request.encode_to_vec(), PATIENCE, None).await?).await
    }
}

/// Refusals come at once; a revision that is still to come may take longer.
const AT_ONCE: Duration = Duration::from_secs(2);

/// A watch whose beginning was not refused. gRPC tells that before the first message; here the first reply says it.
async fn begun(mut watch: Watch) -> Told<Begun> {
    let first = match tokio::time::timeout(AT_ONCE, watch.next()).await {
        Ok(reply) => reply?,
        Err(_) => None,
    };
    Ok(Begun { first, watch })
}

pub struct Begun {
    first: Option<Bytes>,
    watch: Watch,
}

impl Begun {
    async fn next(&mut self) -> Told<Option<Bytes>> {
        match self.first.take() {
            Some(first) => Ok(Some(first)),
            None => Ok(self.watch.next().await?),
        }
    }
}

impl Contacts for Begun {
    async fn message(&mut self) -> Told<v1::WatchContactsResponse> {
        let message = self.next().await?.expect("the watch ends with a reason");
        Ok(v1::WatchContactsResponse::decode(message).unwrap())
    }
}

impl Messages<v1::WatchResponse> for Begun {
    async fn message(&mut self) -> Told<Option<v1::WatchResponse>> {
        let message = self.next().await?;
        Ok(message.map(|message| v1::WatchResponse::decode(message).unwrap()))
    }
}
