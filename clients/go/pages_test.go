package clearance_test

import (
	"context"
	"os"
	"os/exec"
	"path/filepath"
	"regexp"
	"strings"
	"testing"
)

// run runs a command to its end and returns what it printed.
func run(t *testing.T, folder, program string, arguments ...string) string {
	t.Helper()
	ctx, cancel := context.WithTimeout(context.Background(), 2*patience)
	defer cancel()
	command := exec.CommandContext(ctx, program, arguments...)
	command.Dir = folder
	var stderr strings.Builder
	command.Stderr = &stderr
	out, err := command.Output()
	if err != nil {
		t.Fatalf("%s %v: %v\n%s", program, arguments, err, stderr.String())
	}
	return string(out)
}

func build(t *testing.T, what string) string {
	t.Helper()
	program := filepath.Join(t.TempDir(), "program")
	run(t, "", "go", "build", "-o", program, what)
	return program
}

func TestTheFirstQueryPrintsWhatThatOfEveryClientPrints(t *testing.T) {
	expected := string(must(os.ReadFile(filepath.Join(repository(), "tests", "data", "first_query.txt")))(t))
	program := build(t, "./examples/first_query")
	address := startDaemon(t, "", "127.0.0.1:0")
	if got := run(t, repository(), program, address); got != expected {
		t.Errorf("got\n%s\nexpected\n%s", got, expected)
	}
}

func TestTheProgramInTheReadmeRuns(t *testing.T) {
	page := string(must(os.ReadFile("README.md"))(t))
	blocks := regexp.MustCompile("(?s)```go\n(.*?)```").FindAllStringSubmatch(page, -1)
	if len(blocks) != 1 {
		t.Fatalf("%d programs", len(blocks))
	}
	address := startDaemon(t, "", "127.0.0.1:0")
	file := filepath.Join(t.TempDir(), "main.go")
	program := strings.ReplaceAll(blocks[0][1], "127.0.0.1:50551", address)
	if err := os.WriteFile(file, []byte(program), 0o600); err != nil {
		t.Fatal(err)
	}
	// The page names files of the robot's folder.
	folder := filepath.Join(repository(), "tests", "data", "robot-ur5")
	got := run(t, folder, build(t, file))
	if !strings.Contains(got, "INVALID_FIELD") || !strings.Contains(got, "COLLISION") {
		t.Error(got)
	}
}

func TestGeneratingAgainChangesNothing(t *testing.T) {
	folder := t.TempDir()
	run(t, "", filepath.Join(repository(), "clients", "go", "regenerate"), folder)
	fresh := must(os.ReadDir(filepath.Join(folder, "clearancepb")))(t)
	kept := must(os.ReadDir("clearancepb"))(t)
	if len(fresh) == 0 || len(fresh) != len(kept) {
		t.Errorf("%d files are generated, %d are here", len(fresh), len(kept))
	}
	for _, file := range fresh {
		a := must(os.ReadFile(filepath.Join(folder, "clearancepb", file.Name())))(t)
		b := must(os.ReadFile(filepath.Join("clearancepb", file.Name())))(t)
		if string(a) != string(b) {
			t.Errorf("%s: run clients/go/regenerate", file.Name())
		}
	}
}
