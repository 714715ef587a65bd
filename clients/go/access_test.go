package clearance_test

import (
	"crypto/ecdsa"
	"crypto/elliptic"
	"crypto/rand"
	"crypto/x509"
	"crypto/x509/pkix"
	"encoding/pem"
	"fmt"
	"math/big"
	"net"
	"os"
	"path/filepath"
	"testing"
	"time"

	"example.com/clearance"
)

const reader = "a-token-that-only-reads"

func TestATokenAllowsWhatItsScopesSay(t *testing.T) {
	file := filepath.Join(t.TempDir(), "reader")
	if err := os.WriteFile(file, []byte(reader), 0o600); err != nil {
		t.Fatal(err)
	}
	configuration := fmt.Sprintf("[[grpc.tokens]]\nname = \"reader\"\nfile = %q\nscopes = [\"read\"]\n", file)
	address := startDaemon(t, configuration, "127.0.0.1:0")

	ctx, nobody := dialed(t, address)
	_, err := nobody.ListScenes(ctx)
	if refused := refusal(t, err, clearance.ErrNotAllowed); refused.Reason != "NO_TOKEN" {
		t.Errorf("%+v", refused)
	}
	ctx, stranger := dialed(t, address, clearance.WithToken("some-other-token"))
	_, err = stranger.ListScenes(ctx)
	if refused := refusal(t, err, clearance.ErrNotAllowed); refused.Reason != "UNKNOWN_TOKEN" {
		t.Errorf("%+v", refused)
	}
	ctx, client := dialed(t, address, clearance.WithToken(reader))
	must(client.ListScenes(ctx))(t)
	_, err = client.CreateScene(ctx, "cell")
	if refused := refusal(t, err, clearance.ErrNotAllowed); refused.Reason != "MISSING_SCOPE" || refused.Scope != "write" {
		t.Errorf("%+v", refused)
	}
	if _, err := clearance.Dial(address, clearance.WithToken("not\nprintable")); err == nil {
		t.Error("it cannot be sent")
	}
}

func TestAUnixSocket(t *testing.T) {
	address := startDaemon(t, "", "unix:"+filepath.Join(t.TempDir(), "clearance.sock"))
	ctx, client := dialed(t, address)
	must(client.CreateScene(ctx, "cell"))(t)
	if _, err := clearance.Dial(address, clearance.WithCA(newAuthority(t).pem)); err == nil {
		t.Error("a socket has no TLS")
	}
}

func TestCertificatesOfBothSides(t *testing.T) {
	folder, authority := t.TempDir(), newAuthority(t)
	certificate, key := authority.issue(t, "localhost")
	write := func(name string, data []byte) string {
		path := filepath.Join(folder, name)
		if err := os.WriteFile(path, data, 0o600); err != nil {
			t.Fatal(err)
		}
		return path
	}
	configuration := fmt.Sprintf("[grpc.tls]\ncertificate = %q\nkey = %q\nclient_ca = %q\n",
		write("certificate.pem", certificate), write("key.pem", key), write("ca.pem", authority.pem))
	address := startDaemon(t, configuration, "127.0.0.1:0")
	_, port, err := net.SplitHostPort(address)
	if err != nil {
		t.Fatal(err)
	}

	mine, myKey := authority.issue(t, "me")
	ctx, client := dialed(t, "https://localhost:"+port, clearance.WithCA(authority.pem), clearance.WithCertificate(mine, myKey))
	must(client.ServerInfo(ctx))(t)

	ctx, nameless := dialed(t, "localhost:"+port, clearance.WithCA(authority.pem))
	_, err = nameless.ServerInfo(ctx)
	refusal(t, err, clearance.ErrUnavailable)
	ctx, distrustful := dialed(t, "localhost:"+port, clearance.WithCA(newAuthority(t).pem), clearance.WithCertificate(mine, myKey))
	_, err = distrustful.ServerInfo(ctx)
	refusal(t, err, clearance.ErrUnavailable)

	if _, err := clearance.Dial(address, clearance.WithCA([]byte("no PEM"))); err == nil {
		t.Error("it is no certificate")
	}
	if _, err := clearance.Dial("http://"+address, clearance.WithCA(authority.pem)); err == nil {
		t.Error("http has no TLS")
	}
}

// authority signs certificates.
type authority struct {
	pem         []byte
	certificate *x509.Certificate
	key         *ecdsa.PrivateKey
}

func newAuthority(t *testing.T) authority {
	t.Helper()
	key := must(ecdsa.GenerateKey(elliptic.P256(), rand.Reader))(t)
	template := &x509.Certificate{
		SerialNumber: big.NewInt(1), Subject: pkix.Name{CommonName: "an authority"},
		NotBefore: time.Now().Add(-time.Hour), NotAfter: time.Now().Add(time.Hour),
		IsCA: true, BasicConstraintsValid: true, KeyUsage: x509.KeyUsageCertSign,
	}
	der := must(x509.CreateCertificate(rand.Reader, template, template, &key.PublicKey, key))(t)
	certificate := must(x509.ParseCertificate(der))(t)
	return authority{pem.EncodeToMemory(&pem.Block{Type: "CERTIFICATE", Bytes: der}), certificate, key}
}

func (a authority) issue(t *testing.T, name string) (certificate, key []byte) {
	t.Helper()
	pair := must(ecdsa.GenerateKey(elliptic.P256(), rand.Reader))(t)
	template := &x509.Certificate{
		SerialNumber: big.NewInt(2), Subject: pkix.Name{CommonName: name}, DNSNames: []string{name},
		NotBefore: time.Now().Add(-time.Hour), NotAfter: time.Now().Add(time.Hour),
		ExtKeyUsage: []x509.ExtKeyUsage{x509.ExtKeyUsageServerAuth, x509.ExtKeyUsageClientAuth},
	}
	der := must(x509.CreateCertificate(rand.Reader, template, a.certificate, &pair.PublicKey, a.key))(t)
	private := must(x509.MarshalPKCS8PrivateKey(pair))(t)
	return pem.EncodeToMemory(&pem.Block{Type: "CERTIFICATE", Bytes: der}),
		pem.EncodeToMemory(&pem.Block{Type: "PRIVATE KEY", Bytes: private})
}
