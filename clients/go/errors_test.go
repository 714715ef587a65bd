package clearance_test

import (
	"context"
	"errors"
	"math"
	"testing"
	"time"

	"example.com/clearance"
	pb "example.com/clearance/clearancepb"
	"google.golang.org/grpc/codes"
	"google.golang.org/grpc/status"
)

func refusal(t *testing.T, err error, kind error) *clearance.Error {
	t.Helper()
	var refused *clearance.Error
	if !errors.As(err, &refused) || !errors.Is(err, kind) {
		t.Fatalf("%v (%T) is not %v", err, err, kind)
	}
	return refused
}

func TestErrorsSayWhat(t *testing.T) {
	ctx, client := dialed(t, startDaemon(t, "limits.max_items = 3\n", "127.0.0.1:0"))
	scene := must(client.CreateScene(ctx, "cell"))(t)
	must(scene.Apply(ctx, clearance.AddBody("a", clearance.Sphere(1), clearance.At(0, 0, 0))))(t)

	_, err := scene.Apply(ctx, clearance.MoveBody("a", clearance.At(0, 0, 1)), clearance.AddBody("b", clearance.Sphere(math.NaN()), nil))
	invalid := refusal(t, err, clearance.ErrInvalidRequest)
	if invalid.Item != 1 || invalid.Field != "edits[1].add_body.shape.sphere.radius" || invalid.Reason != "INVALID_FIELD" {
		t.Errorf("%+v", invalid)
	}
	if status.Code(err) != codes.InvalidArgument {
		t.Error(status.Code(err))
	}

	_, err = client.CreateScene(ctx, "cell")
	if taken := refusal(t, err, clearance.ErrConflict); taken.Reason != "ALREADY_EXISTS" || taken.Item != -1 {
		t.Errorf("%+v", taken)
	}
	_, err = scene.ApplyAt(ctx, 7, clearance.RemoveBody("a"))
	if moved := refusal(t, err, clearance.ErrConflict); moved.Reason != "REVISION_MOVED_ON" || moved.Revision != 1 {
		t.Errorf("%+v", moved)
	}
	_, err = client.Scene("nowhere").Distance(ctx, nil)
	refusal(t, err, clearance.ErrNotFound)

	probe := clearance.Body("a")
	_, err = scene.Collide(ctx, []*pb.Subject{probe, probe, probe, probe})
	if limit := refusal(t, err, clearance.ErrLimitExceeded); limit.Limit != "max_items" || limit.Asked != 4 || limit.Allowed != 3 {
		t.Errorf("%+v", limit)
	}

	for i := 0; i < 65; i++ {
		must(scene.Apply(ctx, clearance.MoveBody("a", clearance.At(float64(i), 0, 0))))(t)
	}
	_, err = scene.Distance(ctx, nil, clearance.Exactly(1))
	if gone := refusal(t, err, clearance.ErrRevisionGone); gone.OldestRevision <= 1 {
		t.Errorf("%+v", gone)
	}

	soon, cancel := context.WithTimeout(ctx, 50*time.Millisecond)
	defer cancel()
	_, err = scene.Distance(soon, nil, clearance.AtLeast(1000))
	var late *clearance.Error
	// The daemon and the client count the same deadline; either may be the first to tell.
	if !errors.As(err, &late) || !(errors.Is(err, clearance.ErrUnavailable) || errors.Is(err, context.DeadlineExceeded)) {
		t.Error(err)
	}
}

func TestADaemonThatIsNotThereIsUnavailable(t *testing.T) {
	ctx, client := dialed(t, "127.0.0.1:1")
	_, err := client.ServerInfo(ctx)
	refusal(t, err, clearance.ErrUnavailable)
}

func TestRowsOfAWrongLengthAreFound(t *testing.T) {
	ctx, client := connected(t)
	scene := must(client.CreateScene(ctx, "cell"))(t)
	robot := must(client.LoadRobot(ctx, &clearance.RobotDescription{URDF: crane}))(t)
	must(scene.Apply(ctx, clearance.AddRobot("crane", robot, nil)))(t)
	for name, states := range map[string][][]float64{
		"ragged":   {{0, 0}, {0}},
		"too wide": {{0, 0, 0, 0}},
	} {
		if _, err := scene.CheckStates(ctx, "crane", states); err == nil {
			t.Error(name)
		}
	}
	if _, err := scene.CheckMotions(ctx, "crane", [][]float64{{0, 0}}, nil); err == nil {
		t.Error("no goals")
	}
	// What the daemon itself finds has its field.
	_, err := scene.CheckStates(ctx, "crane", [][]float64{{0}})
	if odd := refusal(t, err, clearance.ErrInvalidRequest); odd.Field != "positions" {
		t.Errorf("%+v", odd)
	}
}

func TestARobotThatIsNotXMLIsRefusedBeforeAnythingIsSent(t *testing.T) {
	if _, err := clearance.MeshNames("<robot"); err == nil {
		t.Error("it is no XML")
	}
}
