package clearance

import (
	"context"
	"crypto/tls"
	"crypto/x509"
	"errors"
	"fmt"
	"math"
	"net"
	"strings"

	"google.golang.org/grpc"
	"google.golang.org/grpc/credentials"
)

// DialOption says what a client shows the daemon, and whom it trusts.
type DialOption func(*dialing)

type dialing struct {
	token   string
	tls     *tls.Config
	problem error
	more    []grpc.DialOption
}

// WithToken puts a bearer token on every call. Without TLS it can be read on its way.
func WithToken(token string) DialOption {
	return func(d *dialing) {
		for _, c := range token {
			if c <= ' ' || c > '~' {
				// The text of a token has no place in an error.
				d.problem = errors.New("the token is not printable ASCII")
			}
		}
		d.token = token
	}
}

// WithTLS asks for TLS: a daemon whose certificate the system, or RootCAs of the configuration, trusts.
func WithTLS(config *tls.Config) DialOption {
	return func(d *dialing) { d.tls = config.Clone() }
}

// WithCA asks for TLS with a daemon whose certificate one of these (PEM) has signed.
func WithCA(pem []byte) DialOption {
	return func(d *dialing) {
		pool := x509.NewCertPool()
		if !pool.AppendCertsFromPEM(pem) {
			d.problem = errors.New("the CA has no certificate in it")
		}
		d.encrypted().RootCAs = pool
	}
}

// WithCertificate asks for TLS and shows a certificate of the client's own. Both are PEM.
func WithCertificate(certificate, key []byte) DialOption {
	return func(d *dialing) {
		pair, err := tls.X509KeyPair(certificate, key)
		if err != nil {
			d.problem = fmt.Errorf("the client's certificate: %w", err)
		}
		d.encrypted().Certificates = []tls.Certificate{pair}
	}
}

// WithGRPC hands options to gRPC, for example for keepalive.
func WithGRPC(options ...grpc.DialOption) DialOption {
	return func(d *dialing) { d.more = append(d.more, options...) }
}

func (d *dialing) encrypted() *tls.Config {
	if d.tls == nil {
		d.tls = &tls.Config{MinVersion: tls.VersionTLS12}
	}
	return d.tls
}

func connect(address string, options []DialOption) (*grpc.ClientConn, error) {
	var d dialing
	for _, option := range options {
		option(&d)
	}
	if d.problem != nil {
		return nil, d.problem
	}
	with := []grpc.DialOption{
		grpc.WithDefaultCallOptions(grpc.MaxCallRecvMsgSize(math.MaxInt32), grpc.MaxCallSendMsgSize(math.MaxInt32)),
		grpc.WithUnaryInterceptor(unaryErrors),
		grpc.WithStreamInterceptor(streamErrors),
	}
	if d.token != "" {
		with = append(with, grpc.WithPerRPCCredentials(bearer(d.token)))
	}
	switch {
	case strings.HasPrefix(address, "unix:"):
		path := strings.TrimPrefix(address, "unix:")
		// gRPC would name the path as host, with characters that HTTP/2 servers in Rust refuse.
		address = "passthrough:///localhost"
		with = append(with, grpc.WithContextDialer(func(ctx context.Context, _ string) (net.Conn, error) {
			return new(net.Dialer).DialContext(ctx, "unix", path)
		}))
		if d.tls != nil {
			return nil, errors.New("a Unix socket has no TLS: CA and certificate have no meaning there")
		}
	case strings.HasPrefix(address, "https://"):
		address = strings.TrimPrefix(address, "https://")
		d.encrypted()
	case strings.HasPrefix(address, "http://"):
		address = strings.TrimPrefix(address, "http://")
		if d.tls != nil {
			return nil, fmt.Errorf("http://%s has no TLS: CA and certificate have no meaning there", address)
		}
	}
	if d.tls != nil {
		with = append(with, grpc.WithTransportCredentials(credentials.NewTLS(d.tls)))
	} else {
		// Newer versions have credentials/insecure for this; the one of Debian 12 does not.
		with = append(with, grpc.WithInsecure())
	}
	return grpc.Dial(address, append(with, d.more...)...)
}

// bearer puts a token on calls.
type bearer string

func (b bearer) GetRequestMetadata(context.Context, ...string) (map[string]string, error) {
	return map[string]string{"authorization": "Bearer " + string(b)}, nil
}

// RequireTransportSecurity is false for daemons on loopback and behind Unix sockets.
func (b bearer) RequireTransportSecurity() bool { return false }
