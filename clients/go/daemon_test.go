package clearance_test

import (
	"bufio"
	"context"
	"os"
	"os/exec"
	"path/filepath"
	"strings"
	"syscall"
	"testing"
	"time"

	"example.com/clearance"
)

// repository is where the checkout is; the test script says so, because GOPATH is somewhere else.
func repository() string {
	if root := os.Getenv("CLEARANCE_ROOT"); root != "" {
		return root
	}
	return filepath.Join("..", "..")
}

// patience is far more than any step of a healthy run takes.
const patience = time.Minute

// startDaemon runs a daemon until the test is over and returns its address.
func startDaemon(t *testing.T, configuration, address string) string {
	t.Helper()
	program := os.Getenv("CLEARANCE_BIN")
	if program == "" {
		program = filepath.Join(repository(), "target", "debug", "clearance")
	}
	file := filepath.Join(t.TempDir(), "clearance.toml")
	if err := os.WriteFile(file, []byte(configuration), 0o600); err != nil {
		t.Fatal(err)
	}
	daemon := exec.Command(program, "serve", "--config", file, "--grpc-address", address, "--no-shared-memory", "--no-zenoh")
	out, err := daemon.StdoutPipe()
	if err != nil {
		t.Fatal(err)
	}
	if err := daemon.Start(); err != nil {
		t.Fatal(err)
	}
	watchdog := time.AfterFunc(patience, func() { daemon.Process.Kill() })
	t.Cleanup(func() {
		daemon.Process.Signal(syscall.SIGTERM)
		err := daemon.Wait()
		watchdog.Stop()
		if err != nil {
			t.Errorf("the daemon ended with %v", err)
		}
	})
	line, err := bufio.NewReader(out).ReadString('\n')
	words := strings.Fields(line)
	if err != nil || len(words) < 3 || words[0] != "listening" || words[1] != "grpc" {
		t.Fatalf("%s said %q, %v", program, line, err)
	}
	return words[2]
}

// connected is a context that ends before the watchdog, and a client of a daemon of its own.
func connected(t *testing.T) (context.Context, *clearance.Client) {
	t.Helper()
	return dialed(t, startDaemon(t, "", "127.0.0.1:0"))
}

func dialed(t *testing.T, address string, options ...clearance.DialOption) (context.Context, *clearance.Client) {
	t.Helper()
	ctx, cancel := context.WithTimeout(context.Background(), patience/2)
	client, err := clearance.Dial(address, options...)
	if err != nil {
		t.Fatal(err)
	}
	t.Cleanup(func() {
		client.Close()
		cancel()
	})
	return ctx, client
}

func must[T any](value T, err error) func(*testing.T) T {
	return func(t *testing.T) T {
		t.Helper()
		if err != nil {
			t.Fatal(err)
		}
		return value
	}
}
