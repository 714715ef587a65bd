//! Bare gRPC, set up as the door is: HTTP/2 frames, a length, bytes, and no message in them.

use std::convert::Infallible;
use std::future::{Ready, ready};
use std::pin::Pin;
use std::task::{Context, Poll};

use http::uri::PathAndQuery;
use prost::bytes::{Buf, BufMut, Bytes};
use tokio::net::{TcpListener, UnixListener};
use tokio::runtime::{Handle, Runtime};
use tokio_stream::StreamExt;
use tokio_stream::wrappers::{TcpListenerStream, UnixListenerStream};
use tonic::body::Body;
use tonic::codec::{Codec, DecodeBuf, Decoder, EncodeBuf, Encoder};
use tonic::server::{NamedService, UnaryService};
use tonic::transport::{Channel, Endpoint, Server};
use tonic::{Request, Response, Status};

use super::door::WINDOW;
use crate::transports::echo::{Echo, EchoError, Parcel, wanted};

const METHOD: PathAndQuery = PathAndQuery::from_static("/clearance.Echo/Exchange");

/// A client of bare gRPC.
#[derive(Debug)]
pub struct GrpcEcho {
    channel: Channel,
    runtime: Runtime,
    came: Bytes,
}

impl GrpcEcho {
    /// Over TCP, or, with a path, over a Unix socket; `server` runs the other end.
    ///
    /// # Errors
    /// No port is free, or the path is taken.
    pub fn new(server: &Handle, unix: Option<&str>) -> Result<Self, EchoError> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(EchoError::of("tonic"))?;
        let builder = || {
            Server::builder()
                .initial_stream_window_size(WINDOW)
                .initial_connection_window_size(WINDOW)
                .add_service(EchoService)
        };
        let _entered = server.enter();
        let address = match unix {
            Some(path) => {
                let listener = UnixListener::bind(path).map_err(EchoError::of("tonic"))?;
                server.spawn(builder().serve_with_incoming(UnixListenerStream::new(listener)));
                format!("unix:{path}")
            }
            None => {
                let listener = std::net::TcpListener::bind("127.0.0.1:0").map_err(EchoError::of("tonic"))?;
                listener.set_nonblocking(true).map_err(EchoError::of("tonic"))?;
                let address = listener.local_addr().map_err(EchoError::of("tonic"))?;
                let listener = TcpListener::from_std(listener).map_err(EchoError::of("tonic"))?;
                // A server that waits for more to send meets a client that waits to acknowledge: 40 ms.
                let connections = TcpListenerStream::new(listener)
                    .map(|stream| stream.and_then(|stream| stream.set_nodelay(true).map(|()| stream)));
                server.spawn(builder().serve_with_incoming(connections));
                format!("http://{address}")
            }
        };
        let endpoint = Endpoint::from_shared(address).map_err(EchoError::of("tonic"))?;
        let endpoint =
            endpoint.tcp_nodelay(true).initial_stream_window_size(WINDOW).initial_connection_window_size(WINDOW);
        let channel = runtime.block_on(endpoint.connect()).map_err(EchoError::of("tonic"))?;
        Ok(Self { channel, runtime, came: Bytes::new() })
    }
}

impl Echo for GrpcEcho {
    fn exchange(&mut self, parcel: &Parcel) -> Result<(), EchoError> {
        let call = async {
            let mut client = tonic::client::Grpc::new(self.channel.clone()).max_decoding_message_size(usize::MAX);
            client.ready().await.map_err(EchoError::of("tonic"))?;
            let request = Request::new(Bytes::copy_from_slice(parcel.bytes()));
            client.unary(request, METHOD, Raw).await.map_err(EchoError::of("tonic"))
        };
        self.came = self.runtime.block_on(call)?.into_inner();
        Ok(())
    }
}

/// The other end.
#[derive(Clone, Debug)]
struct EchoService;

impl NamedService for EchoService {
    const NAME: &'static str = "clearance.Echo";
}

impl tower::Service<http::Request<Body>> for EchoService {
    type Response = http::Response<Body>;
    type Error = Infallible;
    type Future = Pin<Box<dyn Future<Output = Result<Self::Response, Infallible>> + Send>>;

    fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<Result<(), Infallible>> {
        Poll::Ready(Ok(()))
    }

    fn call(&mut self, request: http::Request<Body>) -> Self::Future {
        Box::pin(async {
            let grpc = tonic::server::Grpc::new(Raw);
            let mut grpc = grpc.apply_max_message_size_config(Some(usize::MAX), Some(usize::MAX));
            Ok(grpc.unary(Exchange, request).await)
        })
    }
}

struct Exchange;

impl UnaryService<Bytes> for Exchange {
    type Response = Bytes;
    type Future = Ready<Result<Response<Bytes>, Status>>;

    fn call(&mut self, request: Request<Bytes>) -> Self::Future {
        ready(Ok(Response::new(vec![0; wanted(request.get_ref())].into())))
    }
}

/// Bytes as they are.
#[derive(Clone, Copy, Debug)]
struct Raw;

impl Codec for Raw {
    type Encode = Bytes;
    type Decode = Bytes;
    type Encoder = Self;
    type Decoder = Self;

    fn encoder(&mut self) -> Self {
        *self
    }

    fn decoder(&mut self) -> Self {
        *self
    }
}

impl Encoder for Raw {
    type Item = Bytes;
    type Error = Status;

    fn encode(&mut self, item: Bytes, room: &mut EncodeBuf<'_>) -> Result<(), Status> {
        room.put(item);
        Ok(())
    }
}

impl Decoder for Raw {
    type Item = Bytes;
    type Error = Status;

    fn decode(&mut self, bytes: &mut DecodeBuf<'_>) -> Result<Option<Bytes>, Status> {
        Ok(Some(bytes.copy_to_bytes(bytes.remaining())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_grpc_brings_back_as_many_bytes_as_were_asked_for() {
        let server = Runtime::new().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("echo.sock");
        for unix in [None, path.to_str()] {
            let mut echo = GrpcEcho::new(server.handle(), unix).unwrap();
            for (size, wanted) in [(8, 0), (100, 3), (6 << 20, 5 << 20)] {
                echo.exchange(&Parcel::new(size, wanted)).unwrap();
                assert_eq!(echo.came.len(), wanted);
            }
        }
    }
}
