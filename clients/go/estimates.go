package clearance

import (
	"context"
	"time"

	pb "example.com/clearance/clearancepb"
)

// Prices says what an estimate measures. Empty, the daemon measures every output that the question has at a ladder of tolerances.
type Prices struct {
	// Tolerances are how wide a bracket may be, metres; 0 is as narrow as rounding lets it be. Of motions the resolution, too,
	// and positive.
	Tolerances []float64
	// Outputs are what to compute, one at a time.
	Outputs []pb.Output
	// Sample is how many items to measure at most; 0, or beyond the daemon's cap, as many as that is.
	Sample uint32
	// Time is how long to measure at most; 0, or beyond the daemon's cap, as long as that is.
	Time time.Duration
}

// EstimateStates tells what CheckStates would cost: one row for each output and tolerance. The daemon asks a sample of the items
// and times it. Options are those of the question; what it wants, its accuracy and StopAtFirst do not count, as each row has its
// own.
func (s *Scene) EstimateStates(
	ctx context.Context, robot string, states [][]float64, prices Prices, options ...Option,
) (*pb.EstimateResponse, error) {
	request, err := s.statesRequest(pb.AnswerForm_ANSWER_FORM_BULK, DistanceToo, robot, states, options)
	if err != nil {
		return nil, err
	}
	question := &pb.EstimateRequest_CheckStates{CheckStates: request}
	return s.estimateRows(ctx, &pb.EstimateRequest{Question: question}, prices, "states", len(states))
}

// EstimateMotions tells what CheckMotions would cost.
func (s *Scene) EstimateMotions(
	ctx context.Context, robot string, starts, goals [][]float64, prices Prices, options ...Option,
) (*pb.EstimateResponse, error) {
	request, err := s.motionsRequest(robot, starts, goals, options)
	if err != nil {
		return nil, err
	}
	question := &pb.EstimateRequest_CheckMotions{CheckMotions: request}
	return s.estimateRows(ctx, &pb.EstimateRequest{Question: question}, prices, "motions", len(starts))
}

// EstimatePath tells what CheckPath would cost.
func (s *Scene) EstimatePath(
	ctx context.Context, robot string, waypoints [][]float64, prices Prices, options ...Option,
) (*pb.EstimateResponse, error) {
	request, err := s.pathRequest(robot, waypoints, options)
	if err != nil {
		return nil, err
	}
	question := &pb.EstimateRequest_CheckPath{CheckPath: request}
	return s.estimateRows(ctx, &pb.EstimateRequest{Question: question}, prices, "motions", len(waypoints)-1)
}

// EstimateDistance tells what Distance would cost; without subjects, of all pairs as one item.
func (s *Scene) EstimateDistance(
	ctx context.Context, subjects []*pb.Subject, prices Prices, options ...Option,
) (*pb.EstimateResponse, error) {
	question := &pb.EstimateRequest_Distance{Distance: s.distanceRequest(subjects, options)}
	return s.estimate(ctx, &pb.EstimateRequest{Question: question}, prices)
}

// EstimateCollide tells what Collide would cost.
func (s *Scene) EstimateCollide(
	ctx context.Context, subjects []*pb.Subject, prices Prices, options ...Option,
) (*pb.EstimateResponse, error) {
	question := &pb.EstimateRequest_Collide{Collide: s.collideRequest(subjects, options)}
	return s.estimate(ctx, &pb.EstimateRequest{Question: question}, prices)
}

// EstimateClearance tells what Clearance would cost.
func (s *Scene) EstimateClearance(
	ctx context.Context, within float64, subjects []*pb.Subject, prices Prices, options ...Option,
) (*pb.EstimateResponse, error) {
	question := &pb.EstimateRequest_Clearance{Clearance: s.clearanceRequest(within, subjects, options)}
	return s.estimate(ctx, &pb.EstimateRequest{Question: question}, prices)
}

func (s *Scene) estimate(
	ctx context.Context, request *pb.EstimateRequest, prices Prices,
) (*pb.EstimateResponse, error) {
	request.Tolerances, request.Outputs = prices.Tolerances, prices.Outputs
	if prices.Sample != 0 {
		request.Sample = &prices.Sample
	}
	if prices.Time != 0 {
		seconds := prices.Time.Seconds()
		request.Time = &seconds
	}
	return s.client.Queries.Estimate(ctx, request)
}

// estimateRows is estimate of rows of joint positions, whose number has to be what was asked.
func (s *Scene) estimateRows(
	ctx context.Context, request *pb.EstimateRequest, prices Prices, name string, asked int,
) (*pb.EstimateResponse, error) {
	answer, err := s.estimate(ctx, request, prices)
	if err != nil {
		return nil, err
	}
	if got := int(answer.GetItems()); got != asked {
		return nil, countProblem(name, asked, got)
	}
	return answer, nil
}
