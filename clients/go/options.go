package clearance

import (
	"time"

	pb "example.com/clearance/clearancepb"
)

// Option says how a question is to be answered.
type Option func(*Asked)

// Asked is what options change. Whatever of Context no function of this package sets is set by an Option of your own.
type Asked struct {
	Context *pb.Context
	Mode    pb.Mode
	Effort  *pb.MotionEffort
}

// Wanted is what an answer has beside its verdicts.
type Wanted func() *pb.Wants

// VerdictOnly wants nothing else, and is the quickest.
func VerdictOnly() *pb.Wants { return &pb.Wants{} }

// DistanceToo wants brackets of the nearest pairs; loose ones of pairs that overlap.
func DistanceToo() *pb.Wants { return &pb.Wants{Distance: true} }

// DepthToo wants tight brackets of pairs that overlap as well.
func DepthToo() *pb.Wants { return &pb.Wants{Distance: true, Depth: true} }

// WitnessToo wants points and normals as well.
func WitnessToo() *pb.Wants { return &pb.Wants{Distance: true, Depth: true, Witness: true} }

// Want replaces what the method would want.
func Want(wanted Wanted) Option {
	return func(a *Asked) {
		wants := wanted()
		wants.Pairs = a.Context.GetWants().GetPairs()
		wants.Derivatives = a.Context.GetWants().GetDerivatives()
		a.Context.Wants = wants
	}
}

// Derivatives wants, as well, how pairs that have points and normals change when their bodies move; nil: exact ones.
func Derivatives(options *pb.DerivativeOptions) Option {
	return func(a *Asked) {
		if a.Context.Wants == nil {
			a.Context.Wants = &pb.Wants{}
		}
		a.Context.Wants.Derivatives = true
		a.Context.Derivatives = options
	}
}

// Margin in metres: a pair apart but nearer than this is MARGIN.
func Margin(metres float64) Option { return func(a *Asked) { a.Context.Margin = metres } }

// CutOff in metres: pairs farther than this need no distance.
func CutOff(metres float64) Option { return func(a *Asked) { a.Context.CutOff = &metres } }

// AtLeast waits for a revision until the deadline.
func AtLeast(revision uint64) Option {
	return func(a *Asked) {
		a.Context.Revision = &pb.RevisionRule{Rule: &pb.RevisionRule_AtLeast{AtLeast: revision}}
	}
}

// Exactly asks one revision.
func Exactly(revision uint64) Option {
	return func(a *Asked) {
		a.Context.Revision = &pb.RevisionRule{Rule: &pb.RevisionRule_Exactly{Exactly: revision}}
	}
}

// StopAtFirst leaves items after the first hit NOT_RUN; StoppedAt of the answer names it.
func StopAtFirst() Option { return func(a *Asked) { a.Mode = pb.Mode_MODE_STOP_AT_FIRST } }

// Budget is how long the daemon may look; items not looked at by then are NOT_RUN.
func Budget(time time.Duration) Option {
	return func(a *Asked) {
		seconds := time.Seconds()
		a.Context.TimeBudget = &seconds
	}
}

// MaxPairs is how many pairs are listed for an item at most.
func MaxPairs(count uint32) Option { return func(a *Asked) { a.Context.MaxPairs = &count } }

// Ignore leaves bodies out.
func Ignore[N Name](bodies ...N) Option {
	return func(a *Asked) {
		if a.Context.Filter == nil {
			a.Context.Filter = &pb.Filter{}
		}
		for _, body := range bodies {
			a.Context.Filter.Ignore = append(a.Context.Filter.Ignore, Ref(body))
		}
	}
}

// WhatIf makes edits that only this question sees.
func WhatIf(overlay *pb.Overlay) Option { return func(a *Asked) { a.Context.Overlay = overlay } }

// Effort says how far motions are followed.
func Effort(effort *pb.MotionEffort) Option { return func(a *Asked) { a.Effort = effort } }

func (s *Scene) ask(form pb.AnswerForm, wanted Wanted, options []Option) *Asked {
	asked := &Asked{Context: &pb.Context{Scene: s.Name, Wants: wanted(), AnswerForm: form}}
	for _, option := range options {
		option(asked)
	}
	return asked
}
