package clearance

import (
	"fmt"

	pb "example.com/clearance/clearancepb"
)

// Requests of questions, as they are asked and as their prices are.

func (s *Scene) statesRequest(
	form pb.AnswerForm, wanted Wanted, robot string, states [][]float64, options []Option,
) (*pb.CheckStatesRequest, error) {
	asked := s.ask(form, wanted, options)
	positions, err := table("states", states)
	if err != nil {
		return nil, err
	}
	return &pb.CheckStatesRequest{Context: asked.Context, Robot: robot, Positions: positions, Mode: asked.Mode}, nil
}

func (s *Scene) motionsRequest(
	robot string, starts, goals [][]float64, options []Option,
) (*pb.CheckMotionsRequest, error) {
	asked := s.ask(pb.AnswerForm_ANSWER_FORM_BULK, VerdictOnly, options)
	positions, err := edges(starts, goals)
	if err != nil {
		return nil, err
	}
	return &pb.CheckMotionsRequest{
		Context: asked.Context, Robot: robot, Positions: positions, Mode: asked.Mode, Effort: asked.Effort,
	}, nil
}

func (s *Scene) pathRequest(robot string, waypoints [][]float64, options []Option) (*pb.CheckPathRequest, error) {
	asked := s.ask(pb.AnswerForm_ANSWER_FORM_BULK, VerdictOnly, options)
	positions, err := table("waypoints", waypoints)
	if err != nil {
		return nil, err
	}
	return &pb.CheckPathRequest{
		Context: asked.Context, Robot: robot, Waypoints: positions, Mode: asked.Mode, Effort: asked.Effort,
	}, nil
}

func (s *Scene) distanceRequest(subjects []*pb.Subject, options []Option) *pb.DistanceRequest {
	asked := s.ask(pb.AnswerForm_ANSWER_FORM_ITEMS, WitnessToo, options)
	return &pb.DistanceRequest{Context: asked.Context, Items: orAllPairs(subjects), Mode: asked.Mode}
}

func (s *Scene) collideRequest(subjects []*pb.Subject, options []Option) *pb.CollideRequest {
	asked := s.ask(pb.AnswerForm_ANSWER_FORM_ITEMS, VerdictOnly, options)
	return &pb.CollideRequest{Context: asked.Context, Items: orAllPairs(subjects), Mode: asked.Mode}
}

func (s *Scene) clearanceRequest(within float64, subjects []*pb.Subject, options []Option) *pb.ClearanceRequest {
	asked := s.ask(pb.AnswerForm_ANSWER_FORM_ITEMS, DistanceToo, options)
	items := &pb.ClearanceSubjects{Items: orAllPairs(subjects)}
	return &pb.ClearanceRequest{
		Context: asked.Context, Within: within, Mode: asked.Mode, Subjects: &pb.ClearanceRequest_Items{Items: items},
	}
}

func orAllPairs(subjects []*pb.Subject) []*pb.Subject {
	if len(subjects) > 0 {
		return subjects
	}
	return []*pb.Subject{{Kind: &pb.Subject_AllPairs{AllPairs: &pb.AllPairs{}}}}
}

// table is rows of joint positions as a message.
func table(name string, rows [][]float64) (*pb.Doubles, error) {
	var bytes []byte
	for i, row := range rows {
		if len(row) != len(rows[0]) {
			return nil, fmt.Errorf("%s[%d]: has %d numbers, the first has %d", name, i, len(row), len(rows[0]))
		}
		bytes = appendDoubles(bytes, row)
	}
	return &pb.Doubles{Form: &pb.Doubles_LittleEndian{LittleEndian: bytes}}, nil
}

// edges is starts and goals, one after the other.
func edges(starts, goals [][]float64) (*pb.Doubles, error) {
	if len(starts) != len(goals) {
		return nil, fmt.Errorf("goals: are %d, starts are %d", len(goals), len(starts))
	}
	rows := make([][]float64, 0, 2*len(starts))
	for i := range starts {
		rows = append(rows, starts[i], goals[i])
	}
	return table("starts and goals", rows)
}
