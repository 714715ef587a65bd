package clearance

import (
	"fmt"
	"strings"

	pb "example.com/clearance/clearancepb"
)

// Verdict is what a bracket decides.
type Verdict int32

// Verdicts.
const (
	Free          = Verdict(pb.Verdict_VERDICT_FREE)
	InMargin      = Verdict(pb.Verdict_VERDICT_MARGIN)
	Collision     = Verdict(pb.Verdict_VERDICT_COLLISION)
	Indeterminate = Verdict(pb.Verdict_VERDICT_INDETERMINATE)
	NotRun        = Verdict(pb.Verdict_VERDICT_NOT_RUN)
	InvalidInput  = Verdict(pb.Verdict_VERDICT_INVALID_INPUT)
)

// String is for example `COLLISION`.
func (v Verdict) String() string { return strings.TrimPrefix(pb.Verdict(v).String(), "VERDICT_") }

// Brackets of all items of a batch, metres; NaN where an item has no such pair, empty where none was wanted.
type Brackets struct {
	// The signed distance is, in the truth, between Lower and Upper; negative is depth.
	Lower, Upper []float64
	// SignedDistance is the best estimate inside.
	SignedDistance []float64
}

// States is the answer to a batch of a robot's states, one element a state.
type States struct {
	// The state of the scene that was asked.
	Epoch, Revision uint64
	Verdicts        []Verdict
	// Of the nearest pair at all, of two links, of a link and a body.
	Nearest, NearestSelf, NearestScene Brackets
	// Problems of states that are InvalidInput: which field, and what is wrong with it.
	Problems map[int]string
	// StoppedAt is the state that stopped the batch, with StopAtFirst; -1: none.
	StoppedAt int
	// OutOfTime: states not looked at are NotRun.
	OutOfTime bool
	Cost      *pb.Cost
}

// Motions is the answer to a batch of motions, one element a motion. Times are fractions of a motion: 0 at its start, 1 at its
// goal; NaN where a motion has no such time.
type Motions struct {
	// The state of the scene that was asked.
	Epoch, Revision uint64
	Verdicts        []Verdict
	// FreeUntil: every state before this is proved farther than the margins.
	FreeUntil []float64
	// Of collisions: all before ReachedFrom is proved apart, and the state at ReachedTo collides. Of InMargin the same for coming
	// within a margin.
	ReachedFrom, ReachedTo []float64
	// Of Indeterminate: the first stretch that nothing decides.
	UndecidedFrom, UndecidedTo []float64
	// States that each motion was looked at in, count.
	States []float64
	// Problems of motions that are InvalidInput: which field, and what is wrong with it.
	Problems map[int]string
	// StoppedAt is the motion that stopped the batch, of a path the first that is blocked; -1: none.
	StoppedAt int
	// OutOfTime: motions not looked at are NotRun.
	OutOfTime bool
	Cost      *pb.Cost
}

func statesOf(answer *pb.Answer, asked int) (*States, error) {
	bulk := answer.GetBulk()
	if got := len(bulk.GetVerdicts()); got != asked {
		return nil, countProblem("states", asked, got)
	}
	return &States{
		Epoch:        answer.GetEpoch(),
		Revision:     answer.GetRevision(),
		Verdicts:     verdictsOf(bulk),
		Nearest:      bracketsOf(bulk.GetNearest()),
		NearestSelf:  bracketsOf(bulk.GetNearestSelf()),
		NearestScene: bracketsOf(bulk.GetNearestScene()),
		Problems:     problemsOf(bulk),
		StoppedAt:    stoppedAt(answer),
		OutOfTime:    answer.GetOutOfTime(),
		Cost:         answer.GetCost(),
	}, nil
}

func motionsOf(answer *pb.Answer, motions *pb.BulkMotions, asked int) (*Motions, error) {
	bulk := answer.GetBulk()
	if got := len(bulk.GetVerdicts()); got != asked {
		return nil, countProblem("motions", asked, got)
	}
	return &Motions{
		Epoch:         answer.GetEpoch(),
		Revision:      answer.GetRevision(),
		Verdicts:      verdictsOf(bulk),
		FreeUntil:     doublesOf(motions.GetFreeUntil()),
		ReachedFrom:   doublesOf(motions.GetReachedFrom()),
		ReachedTo:     doublesOf(motions.GetReachedTo()),
		UndecidedFrom: doublesOf(motions.GetUndecidedFrom()),
		UndecidedTo:   doublesOf(motions.GetUndecidedTo()),
		States:        doublesOf(motions.GetStates()),
		Problems:      problemsOf(bulk),
		StoppedAt:     stoppedAt(answer),
		OutOfTime:     answer.GetOutOfTime(),
		Cost:          answer.GetCost(),
	}, nil
}

func verdictsOf(bulk *pb.BulkAnswer) []Verdict {
	verdicts := make([]Verdict, len(bulk.GetVerdicts()))
	for i, number := range bulk.GetVerdicts() {
		verdicts[i] = Verdict(number)
	}
	return verdicts
}

func bracketsOf(bulk *pb.BulkBrackets) Brackets {
	return Brackets{
		Lower:          doublesOf(bulk.GetLower()),
		Upper:          doublesOf(bulk.GetUpper()),
		SignedDistance: doublesOf(bulk.GetSignedDistance()),
	}
}

func problemsOf(bulk *pb.BulkAnswer) map[int]string {
	problems := make(map[int]string, len(bulk.GetProblems()))
	for _, problem := range bulk.GetProblems() {
		problems[int(problem.GetItem())] = problem.GetProblem()
	}
	return problems
}

func stoppedAt(answer *pb.Answer) int {
	if answer.StoppedAt == nil {
		return -1
	}
	return int(answer.GetStoppedAt())
}

// checkCount finds rows of a wrong length: the daemon sees one list of numbers and cuts it by the robot's joints.
func checkCount(name string, rows [][]float64, got int) error {
	if got == len(rows) {
		return nil
	}
	return countProblem(name, len(rows), got)
}

func countProblem(name string, asked, got int) error {
	return fmt.Errorf("%s: %d were asked and %d answered: they do not have as many numbers as the robot takes", name, asked, got)
}
