"""How a client reaches a daemon: the connection, and what it shows."""

from __future__ import annotations

from collections import namedtuple
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Optional

import grpc

from .robots import PathLike

if TYPE_CHECKING:
    from .zenoh_channel import ZenohChannel

#: What addresses of zenoh begin with.
_ZENOH = "zenoh/"

_UNLIMITED = [("grpc.max_receive_message_length", -1), ("grpc.max_send_message_length", -1)]

#: gRPC would name the path of a socket as host, with characters that HTTP/2 servers in Rust refuse.
_UNIX = [*_UNLIMITED, ("grpc.default_authority", "localhost")]


def open_channel(
    address: str,
    *,
    token: Optional[str],
    ca: Optional[PathLike],
    certificate: Optional[PathLike],
    key: Optional[PathLike],
) -> grpc.Channel:
    """A channel to `address` on which every call brings the token."""
    if (certificate is None) != (key is None):
        raise ValueError("certificate and key go together")
    has_tls = ca is not None or certificate is not None
    target, encrypted = _target(address, has_tls)
    if has_tls and not encrypted:
        raise ValueError(f"{address} has no TLS: ca, certificate and key have no meaning there")
    if encrypted:
        credentials = grpc.ssl_channel_credentials(
            root_certificates=None if ca is None else Path(ca).read_bytes(),
            private_key=None if key is None else Path(key).read_bytes(),
            certificate_chain=None if certificate is None else Path(certificate).read_bytes(),
        )
        channel = grpc.secure_channel(target, credentials, options=_UNLIMITED)
    else:
        channel = grpc.insecure_channel(target, options=_UNIX if target.startswith("unix:") else _UNLIMITED)
    if token is None:
        return channel
    if not (token.isascii() and token.isprintable()):
        # The text of a token has no place in an error.
        raise ValueError("the token is not printable ASCII")
    return grpc.intercept_channel(channel, _Bearer(token))


def open_zenoh(
    address: str,
    *,
    prefix: str,
    config: Optional[PathLike],
    token: Optional[str],
    ca: Optional[PathLike],
    certificate: Optional[PathLike],
    key: Optional[PathLike],
) -> Optional[ZenohChannel]:
    """A session with zenoh if `address` is one of zenoh's."""
    if not address.startswith(_ZENOH):
        if config is not None:
            raise ValueError(f"{address} does not begin with {_ZENOH}: zenoh_config has no meaning there")
        return None
    given = {"token": token, "ca": ca, "certificate": certificate, "key": key}
    named = [name for name, value in given.items() if value is not None]
    if named:
        raise ValueError(f"through zenoh, {' and '.join(named)} cannot be given: zenoh_config says how to connect")
    try:
        from .zenoh_channel import ZenohChannel
    except ImportError as error:
        raise ImportError(f"{address} needs eclipse-zenoh: pip install './clients/python[zenoh]'") from error

    return ZenohChannel(address.removeprefix(_ZENOH), prefix, config)


def _target(address: str, has_tls: bool) -> tuple[str, bool]:
    """What gRPC calls the address, and whether it is one with TLS."""
    if address.startswith("unix:"):
        return address, False
    if address.startswith("https://"):
        return address.removeprefix("https://"), True
    if address.startswith("http://"):
        return address.removeprefix("http://"), False
    return address, has_tls


class _Details(
    namedtuple("_Details", ("method", "timeout", "metadata", "credentials", "wait_for_ready", "compression")),
    grpc.ClientCallDetails,
):
    """A call as an interceptor hands it on."""


class _Bearer(
    grpc.UnaryUnaryClientInterceptor,
    grpc.UnaryStreamClientInterceptor,
    grpc.StreamUnaryClientInterceptor,
    grpc.StreamStreamClientInterceptor,
):
    """Puts the token on every call. gRPC's own call credentials refuse to without TLS, which a daemon on loopback does not
    need."""

    def __init__(self, token: str):
        self._entry = ("authorization", f"Bearer {token}")

    def _call(self, proceed: Callable[[grpc.ClientCallDetails, Any], Any], details: grpc.ClientCallDetails, sent: Any) -> Any:
        metadata = [*(details.metadata or ()), self._entry]
        return proceed(
            _Details(
                details.method,
                details.timeout,
                metadata,
                details.credentials,
                details.wait_for_ready,
                details.compression,
            ),
            sent,
        )

    intercept_unary_unary = _call
    intercept_unary_stream = _call
    intercept_stream_unary = _call
    intercept_stream_stream = _call
