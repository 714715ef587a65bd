//! Which rpcs are there? Read from the descriptors, so that tests can hold tables against them.

use prost::Message;

/// One rpc.
pub struct Method {
    /// Package and service.
    pub service: String,
    /// The method's own name.
    pub method: String,
    /// It answers with more than one message.
    pub streams_answers: bool,
}

/// The part of a descriptor set that names rpcs (google/protobuf/descriptor.proto).
#[derive(Clone, PartialEq, Message)]
struct Files {
    #[prost(message, repeated, tag = "1")]
    file: Vec<FileOf>,
}

#[derive(Clone, PartialEq, Message)]
struct FileOf {
    #[prost(string, tag = "2")]
    package: String,
    #[prost(message, repeated, tag = "6")]
    service: Vec<ServiceOf>,
}

#[derive(Clone, PartialEq, Message)]
struct ServiceOf {
    #[prost(string, tag = "1")]
    name: String,
    #[prost(message, repeated, tag = "2")]
    method: Vec<MethodOf>,
}

#[derive(Clone, PartialEq, Message)]
struct MethodOf {
    #[prost(string, tag = "1")]
    name: String,
    #[prost(bool, tag = "6")]
    server_streaming: bool,
}

/// The rpcs of a descriptor set.
pub fn methods(descriptors: &[u8]) -> impl Iterator<Item = Method> {
    let files = Files::decode(descriptors).expect("tests hold descriptors of the build").file;
    files.into_iter().flat_map(|FileOf { package, service }| {
        service.into_iter().flat_map(move |ServiceOf { name, method }| {
            let service = format!("{package}.{name}");
            method.into_iter().map(move |method| Method {
                service: service.clone(),
                method: method.name,
                streams_answers: method.server_streaming,
            })
        })
    })
}
