package clearance

import (
	"context"

	pb "example.com/clearance/clearancepb"
)

// Scene is a scene of a daemon, by its name. Made by Client.CreateScene and Client.Scene.
type Scene struct {
	Name   string
	client *Client
}

// Apply makes all edits, in order, or none. The answer names the revision that contains them, and the ids of added bodies.
func (s *Scene) Apply(ctx context.Context, edits ...*pb.Edit) (*pb.ApplyResponse, error) {
	return s.client.Scenes.Apply(ctx, &pb.ApplyRequest{Scene: s.Name, Edits: edits})
}

// ApplyAt is Apply, only if the scene is at that revision; else ErrConflict.
func (s *Scene) ApplyAt(ctx context.Context, revision uint64, edits ...*pb.Edit) (*pb.ApplyResponse, error) {
	return s.client.Scenes.Apply(ctx, &pb.ApplyRequest{Scene: s.Name, Edits: edits, ExpectedRevision: &revision})
}

// Contents tells bodies and robots of the newest revision; of a large scene page by page, as one.
func (s *Scene) Contents(ctx context.Context) (*pb.SceneContents, error) {
	request := &pb.GetSceneRequest{Scene: s.Name}
	answer, err := s.client.Scenes.GetScene(ctx, request)
	if err != nil {
		return nil, err
	}
	contents := answer.GetScene()
	// The other pages are of the first one's state.
	epoch := contents.GetEpoch()
	request.Revision = &pb.RevisionRule{Epoch: &epoch, Rule: &pb.RevisionRule_Exactly{Exactly: contents.GetRevision()}}
	for contents.GetBodiesLeft() && len(contents.GetBodies()) > 0 {
		request.AfterBody = contents.Bodies[len(contents.Bodies)-1].GetId()
		page, err := s.client.Scenes.GetScene(ctx, request)
		if err != nil {
			return nil, err
		}
		contents.Bodies = append(contents.Bodies, page.GetScene().GetBodies()...)
		contents.BodiesLeft = page.GetScene().GetBodiesLeft()
	}
	return contents, nil
}

// Delete makes the scene be gone.
func (s *Scene) Delete(ctx context.Context) error {
	_, err := s.client.Scenes.DeleteScene(ctx, &pb.DeleteSceneRequest{Scene: s.Name})
	return err
}

// CheckStates tells whether the robot is free in these states: vectors of joint positions, radians, metres for sliding joints.
// It measures the nearest pairs unless Want says otherwise.
func (s *Scene) CheckStates(ctx context.Context, robot string, states [][]float64, options ...Option) (*States, error) {
	request, err := s.statesRequest(pb.AnswerForm_ANSWER_FORM_BULK, DistanceToo, robot, states, options)
	if err != nil {
		return nil, err
	}
	answer, err := s.client.Queries.CheckStates(ctx, request)
	if err != nil {
		return nil, err
	}
	return statesOf(answer.GetAnswer(), len(states))
}

// LookAtStates is CheckStates with everything there is to know: which pairs, and where. For a few states; a batch of thousands
// is quicker without.
func (s *Scene) LookAtStates(ctx context.Context, robot string, states [][]float64, options ...Option) (*pb.Answer, error) {
	request, err := s.statesRequest(pb.AnswerForm_ANSWER_FORM_ITEMS, WitnessToo, robot, states, options)
	if err != nil {
		return nil, err
	}
	request.Context.Wants.Pairs = true
	answer, err := s.client.Queries.CheckStates(ctx, request)
	if err != nil {
		return nil, err
	}
	return answer.GetAnswer(), checkCount("states", states, len(answer.GetAnswer().GetItems()))
}

// CheckMotions tells whether the robot is free all along straight lines of joint positions, from each start to its goal. Proved
// between states, not sampled.
func (s *Scene) CheckMotions(
	ctx context.Context, robot string, starts, goals [][]float64, options ...Option,
) (*Motions, error) {
	request, err := s.motionsRequest(robot, starts, goals, options)
	if err != nil {
		return nil, err
	}
	answer, err := s.client.Queries.CheckMotions(ctx, request)
	if err != nil {
		return nil, err
	}
	return motionsOf(answer.GetAnswer(), answer.GetBulk(), len(starts))
}

// CheckPath tells whether the robot is free all along a path, and where it is blocked first: StoppedAt of the answer.
func (s *Scene) CheckPath(ctx context.Context, robot string, waypoints [][]float64, options ...Option) (*Motions, error) {
	request, err := s.pathRequest(robot, waypoints, options)
	if err != nil {
		return nil, err
	}
	answer, err := s.client.Queries.CheckPath(ctx, request)
	if err != nil {
		return nil, err
	}
	return motionsOf(answer.GetAnswer(), answer.GetBulk(), len(waypoints)-1)
}

// Distance tells how far the nearest body is from each subject; without subjects, the nearest pair of all bodies. It tells
// points and normals unless Want says otherwise.
func (s *Scene) Distance(ctx context.Context, subjects []*pb.Subject, options ...Option) (*pb.Answer, error) {
	answer, err := s.client.Queries.Distance(ctx, s.distanceRequest(subjects, options))
	return answer.GetAnswer(), err
}

// Collide tells which bodies each subject touches; without subjects, which pairs of all bodies touch.
func (s *Scene) Collide(ctx context.Context, subjects []*pb.Subject, options ...Option) (*pb.Answer, error) {
	answer, err := s.client.Queries.Collide(ctx, s.collideRequest(subjects, options))
	return answer.GetAnswer(), err
}

// Clearance tells which bodies are within that many metres of each subject: Pairs of each item.
func (s *Scene) Clearance(
	ctx context.Context, within float64, subjects []*pb.Subject, options ...Option,
) (*pb.Answer, error) {
	answer, err := s.client.Queries.Clearance(ctx, s.clearanceRequest(within, subjects, options))
	return answer.GetAnswer(), err
}

// ClearanceOfStates tells which pairs of links, and of links and bodies, are within that many metres in each state.
func (s *Scene) ClearanceOfStates(
	ctx context.Context, robot string, states [][]float64, within float64, options ...Option,
) (*pb.Answer, error) {
	asked := s.ask(pb.AnswerForm_ANSWER_FORM_ITEMS, DistanceToo, options)
	positions, err := table("states", states)
	if err != nil {
		return nil, err
	}
	of := &pb.RobotStates{Robot: robot, Positions: positions}
	answer, err := s.client.Queries.Clearance(ctx, &pb.ClearanceRequest{
		Context: asked.Context, Within: within, Mode: asked.Mode, Subjects: &pb.ClearanceRequest_States{States: of},
	})
	if err != nil {
		return nil, err
	}
	return answer.GetAnswer(), checkCount("states", states, len(answer.GetAnswer().GetItems()))
}

// Context is what options say, for a question asked through Client.Queries.
func (s *Scene) Context(options ...Option) *pb.Context {
	return s.ask(pb.AnswerForm_ANSWER_FORM_UNSPECIFIED, VerdictOnly, options).Context
}

// Subjects of a question.

// Body is one body against the others.
func Body[N Name](body N) *pb.Subject { return &pb.Subject{Kind: &pb.Subject_Body{Body: Ref(body)}} }

// Placed is a shape that is not in the scene, against all bodies.
func Placed(shape *pb.Shape, pose *pb.Pose) *pb.Subject {
	return &pb.Subject{Kind: &pb.Subject_Shape{Shape: &pb.PlacedShape{Shape: shape, Pose: pose}}}
}

// ChangedSince is every pair of bodies that changed after a revision.
func ChangedSince(revision uint64) *pb.Subject {
	return &pb.Subject{Kind: &pb.Subject_ChangedSince{ChangedSince: &pb.ChangedSince{Revision: revision}}}
}
