//! What is answered with many messages, for doors that carry any message as bytes: one message after the other, as it is asked for.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use prost::Message;
use prost::bytes::Bytes;

use super::call::decoded;
use super::{SceneMessages, watch, watch_contacts};
use crate::service::{ContactWatch, Service, ServiceError};
use crate::transports::wire::{to_proto, v1};

/// A watch that is under way. Dropping it ends it.
#[derive(Debug)]
pub enum Steps {
    /// Of a scene.
    Scene(SceneMessages),
    /// Of contacts.
    Contacts {
        /// None after an error.
        watch: Option<ContactWatch>,
        /// What is left of the last step.
        rest: VecDeque<v1::WatchContactsResponse>,
    },
}

/// A message of a watch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StepMessage {
    /// Its bytes.
    pub message: Vec<u8>,
    /// Whether the step ends with it.
    pub complete: bool,
}

/// The watch that an rpc begins, named as for [`super::call`]; `None` if the rpc is not one of a watch.
///
/// # Errors
/// Bytes that are no such message, or what the service says.
pub async fn steps(
    service: &Arc<Service>,
    rpc: &str,
    message: Bytes,
    timeout: Option<Duration>,
) -> Result<Option<Steps>, ServiceError> {
    Ok(Some(match rpc {
        "Scenes/Watch" => Steps::Scene(watch(service, &decoded(message)?, timeout)?),
        "Queries/WatchContacts" => {
            let watch = watch_contacts(service, &decoded(message)?, timeout).await?;
            Steps::Contacts { watch: Some(watch), rest: VecDeque::new() }
        }
        _ => return Ok(None),
    }))
}

impl Steps {
    /// The next message, once there is one.
    ///
    /// # Errors
    /// As [`SceneMessages::next`] and [`ContactWatch::next`]. Then the watch has ended.
    pub async fn next(&mut self) -> Result<StepMessage, ServiceError> {
        match self {
            Self::Scene(messages) => {
                let message = messages.next().await?;
                Ok(StepMessage { complete: !message.more, message: message.encode_to_vec() })
            }
            Self::Contacts { watch, rest } => loop {
                if let Some(message) = rest.pop_front() {
                    return Ok(StepMessage { complete: rest.is_empty(), message: message.encode_to_vec() });
                }
                let under_way = watch.take().ok_or(ServiceError::ShuttingDown)?;
                let (under_way, messages) = under_way.next(to_proto::contact_messages).await?;
                *watch = Some(under_way);
                rest.extend(messages);
            },
        }
    }
}
