package clearance_test

import (
	"bytes"
	"errors"
	"io"
	"math"
	"path/filepath"
	"reflect"
	"testing"

	"example.com/clearance"
	pb "example.com/clearance/clearancepb"
)

// A rod of 1 m along x that turns about z, with a ball at its end that slides along z.
const crane = `<robot name="crane">
  <link name="foot"/>
  <link name="boom"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="hook"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="foot"/><child link="boom"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="lower" type="prismatic"><parent link="boom"/><child link="hook"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="0" velocity="1" effort="1"/></joint>
</robot>`

func within(t *testing.T, lower, truth, upper float64) {
	t.Helper()
	if !(lower <= truth && truth <= upper && upper-lower < 1e-6) {
		t.Errorf("%v is not tightly in [%v, %v]", truth, lower, upper)
	}
}

func TestDistanceAndDepthOfBalls(t *testing.T) {
	ctx, client := connected(t)
	scene := must(client.CreateScene(ctx, "cell"))(t)
	applied := must(scene.Apply(ctx,
		clearance.AddBody("a", clearance.Sphere(0.5), clearance.At(0, 0, 0)),
		clearance.AddBody("b", clearance.BallSwept(clearance.Sphere(0.25), 0.25), clearance.At(3, 0, 0)),
	))(t)
	if applied.Revision != 1 || len(applied.Added) != 2 {
		t.Fatal(applied)
	}
	apart := must(scene.Distance(ctx, nil))(t).Items[0].Nearest
	within(t, apart.Bracket.Lower, 2, apart.Bracket.Upper)
	if p := clearance.PointOf(apart.Witness.PointOnB); math.Abs(p[0]-2.5) > 1e-9 {
		t.Error(p)
	}
	moved := must(scene.Distance(ctx, nil, clearance.Derivatives(nil), clearance.Want(clearance.WitnessToo)))(t).Items[0].Nearest
	exact := moved.GetDerivatives()
	for column, truth := range []float64{1, 0, 0, 0, 0, 0} {
		if d := exact.GetOfB().GetSignedDistance(); len(d) != 6 || math.Abs(d[column]-truth) > 1e-9 {
			t.Error(d)
		}
	}
	if exact.Method != pb.DerivativeMethod_DERIVATIVE_METHOD_EXACT || len(exact.OfA.Normal) != 18 || apart.Derivatives != nil {
		t.Error(exact)
	}
	options := &pb.DerivativeOptions{Method: pb.DerivativeMethod_DERIVATIVE_METHOD_FINITE_DIFFERENCE}
	if told := must(scene.Distance(ctx, nil, clearance.Derivatives(options)))(t).Items[0].Nearest.Derivatives; told.Method != options.Method {
		t.Error(told)
	}
	inside := clearance.Placed(clearance.Sphere(0.1), clearance.At(0.5, 0, 0))
	probed := must(scene.Distance(ctx, []*pb.Subject{inside}, clearance.Want(clearance.DepthToo)))(t).Items[0]
	if clearance.Verdict(probed.Verdict) != clearance.Collision {
		t.Error(probed.Verdict)
	}
	within(t, probed.Nearest.Bracket.Lower, -0.1, probed.Nearest.Bracket.Upper)
	// What the question ignores, it does not see.
	ignoring := must(scene.Collide(ctx, []*pb.Subject{inside}, clearance.Ignore("a")))(t)
	if clearance.Verdict(ignoring.Items[0].Verdict) != clearance.Free {
		t.Error(ignoring)
	}
	near := must(scene.Clearance(ctx, 2.1, nil))(t).Items[0].Pairs
	if len(near) != 1 || near[0].A.GetBody().GetId() != applied.Added[0] {
		t.Error(near)
	}
	if far := must(scene.Clearance(ctx, 1.9, nil))(t).Items[0].Pairs; len(far) != 0 {
		t.Error(far)
	}
	contents := must(scene.Contents(ctx))(t)
	if len(contents.Bodies) != 2 || contents.Bodies[1].Name != "b" {
		t.Error(contents)
	}
}

func TestEveryEditAndShapeIsTaken(t *testing.T) {
	ctx, client := connected(t)
	scene := must(client.CreateScene(ctx, "cell"))(t)
	model := must(client.LoadRobot(ctx, &clearance.RobotDescription{URDF: crane}))(t)
	corners := []clearance.Point{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}
	faces := [][3]uint32{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}
	shapes := map[string]*pb.Shape{
		"sphere":      clearance.Sphere(0.1),
		"box":         clearance.Box(0.1, 0.2, 0.3),
		"capsule":     clearance.Capsule(0.1, 0.2),
		"cylinder":    clearance.Cylinder(0.1, 0.2),
		"cone":        clearance.Cone(0.1, 0.2),
		"ellipsoid":   clearance.Ellipsoid(0.1, 0.2, 0.3),
		"convex":      clearance.Convex(corners),
		"mesh":        clearance.Mesh(corners, faces, pb.MeshMode_MESH_MODE_SOLID),
		"compound":    clearance.Compound(clearance.Part(clearance.Sphere(0.1), clearance.At(1, 0, 0)), clearance.Part(clearance.Box(1, 1, 1), nil)),
		"point_cloud": clearance.PointCloud(corners, 0.01),
		"voxels":      clearance.Voxels(0.1, nil),
		"half_space":  clearance.HalfSpace(clearance.Point{0, 0, 1}, -50),
		"plane":       clearance.Plane(clearance.Point{1, 0, 0}, 90),
	}
	var edits []*pb.Edit
	x := 0.0
	for kind, shape := range shapes {
		x += 3
		edits = append(edits, clearance.AddBody(kind, shape, clearance.At(x, 0, 5)))
	}
	applied := must(scene.Apply(ctx, edits...))(t)
	for _, body := range must(scene.Contents(ctx))(t).Bodies {
		if body.ShapeKind != body.Name {
			t.Errorf("%s is a %s", body.Name, body.ShapeKind)
		}
	}
	must(scene.ApplyAt(ctx, applied.Revision,
		clearance.AddRobot("arm", model, clearance.At(0, 0, 0)),
		clearance.MoveRobot("arm", clearance.At(-50, 0, 0)),
		clearance.MoveBody("box", clearance.At(0, 50, 0)),
		clearance.MoveBody(applied.Added[0], clearance.At(0, 60, 0)),
		clearance.ReplaceShape("cone", clearance.Sphere(0.2)),
		clearance.InsertPoints("voxels", corners),
		clearance.ClearBox("voxels", clearance.Point{-1, -1, -1}, clearance.Point{2, 2, 0.5}),
		clearance.SetEnabled("mesh", false),
		clearance.AllowCollision(clearance.OneBody("box"), clearance.AllLinks("arm"), true),
		clearance.AllowCollision(clearance.OneLink("arm", "boom"), clearance.Group("fixtures"), false),
		clearance.SetPairMargin(clearance.OneBody("box"), clearance.Everything(), 0.1),
		clearance.DeclareEffects(clearance.OneBody("box"), clearance.Everything(), pb.Effect_EFFECT_MARGIN),
		clearance.RemoveBody("plane"),
	))(t)
	if got := must(scene.Contents(ctx))(t); len(got.Robots) != 1 || len(got.Bodies) != len(shapes)-1 {
		t.Error(got)
	}
	must(scene.Apply(ctx, clearance.RemoveRobot("arm")))(t)
}

func TestStatesMotionsAndPathsOfARobot(t *testing.T) {
	ctx, client := connected(t)
	scene := must(client.CreateScene(ctx, "cell"))(t)
	robot := must(client.LoadRobot(ctx, &clearance.RobotDescription{URDF: crane}))(t)
	if robot.DegreesOfFreedom != 2 || !reflect.DeepEqual(robot.Links, []string{"foot", "boom", "hook"}) {
		t.Error(robot)
	}
	if !reflect.DeepEqual([][]float64{robot.Lower, robot.Upper}, [][]float64{{-3, -1}, {3, 0}}) {
		t.Error(robot.Lower, robot.Upper)
	}
	applied := must(scene.Apply(ctx,
		clearance.AddRobot("crane", robot, nil),
		clearance.AddBody("wall", clearance.Box(0.1, 0.5, 0.5), clearance.At(0, 1, 0)),
	))(t)
	states := [][]float64{{0, -0.5}, {math.Pi / 2, -0.5}, {-1, -0.5}}
	checked := must(scene.CheckStates(ctx, "crane", states, clearance.AtLeast(applied.Revision)))(t)
	if want := []clearance.Verdict{clearance.Free, clearance.Collision, clearance.Free}; !reflect.DeepEqual(checked.Verdicts, want) {
		t.Error(checked.Verdicts)
	}
	if checked.StoppedAt != -1 || checked.OutOfTime || checked.Cost.GetPairs() == 0 || checked.Nearest.Lower[0] <= 0 {
		t.Errorf("%+v", checked)
	}
	first := must(scene.CheckStates(ctx, "crane", states, clearance.StopAtFirst(), clearance.Want(clearance.VerdictOnly)))(t)
	if first.StoppedAt != 1 || first.Verdicts[2] != clearance.NotRun || len(first.NearestSelf.Lower) != 0 {
		t.Errorf("%+v", first)
	}
	seen := must(scene.LookAtStates(ctx, "crane", states[1:2]))(t)
	if len(seen.Items[0].Pairs) == 0 || seen.Items[0].Pairs[0].Witness == nil {
		t.Error(seen)
	}
	motions := must(scene.CheckMotions(ctx, "crane", states[:2], [][]float64{{0.2, -0.5}, {1, -0.5}}))(t)
	if want := []clearance.Verdict{clearance.Free, clearance.Collision}; !reflect.DeepEqual(motions.Verdicts, want) {
		t.Error(motions.Verdicts)
	}
	if motions.FreeUntil[0] != 1 || !math.IsNaN(motions.ReachedFrom[0]) || motions.ReachedTo[1] != 0 {
		t.Errorf("%+v", motions)
	}
	path := must(scene.CheckPath(ctx, "crane", [][]float64{{-1, 0}, {0, 0}, {math.Pi / 2, 0}, {3, 0}}))(t)
	if path.StoppedAt != 1 || path.Verdicts[2] != clearance.NotRun {
		t.Errorf("%+v", path)
	}
	near := must(scene.ClearanceOfStates(ctx, "crane", states[:1], 10, clearance.MaxPairs(1)))(t)
	if len(near.Items) != 1 || len(near.Items[0].Pairs) != 1 || !near.Items[0].Truncated {
		t.Error(near)
	}
	// Only this question sees the wall elsewhere.
	overlay := &pb.Overlay{Edits: []*pb.Edit{clearance.MoveBody("wall", clearance.At(0, 9, 0))}}
	if what := must(scene.CheckStates(ctx, "crane", states[1:2], clearance.WhatIf(overlay)))(t); what.Verdicts[0] != clearance.Free {
		t.Error(what.Verdicts)
	}
}

func TestMeshesAreUploadedOnce(t *testing.T) {
	ctx, client := connected(t)
	folder := filepath.Join(repository(), "tests", "data", "robot-ur5")
	description := must(clearance.ReadRobot(filepath.Join(folder, "ur5.urdf"), filepath.Join(folder, "ur5.srdf"), nil))(t)
	if len(description.Meshes) != 17 {
		t.Fatal(len(description.Meshes))
	}
	robot := must(client.LoadRobot(ctx, description))(t)
	// The same again is the same model.
	if again := must(client.LoadRobot(ctx, description))(t); again.ID != robot.ID {
		t.Error(again.ID, robot.ID)
	}
	// More than one message, and a file that is there twice.
	large := bytes.Repeat([]byte("clearance"), 300_000)
	hashes := must(client.Upload(ctx, large, []byte("small"), large))(t)
	if hashes[0] != hashes[2] || hashes[0] == hashes[1] {
		t.Error(hashes)
	}
	answer := must(client.Assets.HasAssets(ctx, &pb.HasAssetsRequest{Sha256: hashes}))(t)
	if !reflect.DeepEqual(answer.Present, []bool{true, true, true}) {
		t.Error(answer)
	}
	packages := map[string]string{"ur5": t.TempDir()}
	if _, err := clearance.ReadRobot(filepath.Join(folder, "ur5.urdf"), "", packages); err == nil {
		t.Error("the package has no meshes")
	}
}

func TestStreamsOfTheGeneratedStubs(t *testing.T) {
	ctx, client := connected(t)
	scene := must(client.CreateScene(ctx, "cell"))(t)
	must(scene.Apply(ctx, clearance.AddBody("a", clearance.Sphere(1), clearance.At(0, 0, 0))))(t)
	watch := must(client.Scenes.Watch(ctx, &pb.WatchRequest{Scene: "cell"}))(t)
	if step := must(watch.Recv())(t); step.Revision != 1 || len(step.Bodies) != 1 {
		t.Error(step)
	}
	stream := must(client.Queries.QueryStream(ctx))(t)
	probe := []*pb.Subject{clearance.Placed(clearance.Sphere(1), clearance.At(1, 0, 0))}
	asked := []*pb.QueryStreamRequest{
		{Question: &pb.QueryStreamRequest_Options{Options: &pb.QueryStreamOptions{InOrder: true}}},
		{Id: 7, Question: &pb.QueryStreamRequest_Collide{Collide: &pb.CollideRequest{Context: scene.Context(), Items: probe}}},
		{Id: 8, Question: &pb.QueryStreamRequest_Collide{Collide: &pb.CollideRequest{
			Context: scene.Context(clearance.Margin(-1)), Items: probe,
		}}},
	}
	for _, question := range asked {
		if err := stream.Send(question); err != nil {
			t.Fatal(err)
		}
	}
	if err := stream.CloseSend(); err != nil {
		t.Fatal(err)
	}
	answer := must(stream.Recv())(t)
	if answer.Id != 7 || clearance.Verdict(answer.GetCollide().Answer.Items[0].Verdict) != clearance.Collision {
		t.Error(answer)
	}
	refused := clearance.Refused(must(stream.Recv())(t).GetError())
	if !errors.Is(refused, clearance.ErrInvalidRequest) || refused.Field != "context.margin" || refused.Reason != "INVALID_FIELD" {
		t.Error(refused)
	}
	if _, err := stream.Recv(); err != io.EOF {
		t.Error(err)
	}
	if err := scene.Delete(ctx); err != nil {
		t.Error(err)
	}
	if _, err := watch.Recv(); !errors.Is(err, clearance.ErrNotFound) {
		t.Error(err)
	}
}
