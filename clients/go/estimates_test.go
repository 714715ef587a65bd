package clearance_test

import (
	"context"
	"math"
	"testing"
	"time"

	"example.com/clearance"
	pb "example.com/clearance/clearancepb"
)

// cones are three bodies in a row, 2 m from one to the next, each turned otherwise: their brackets have to be narrowed.
func cones(t *testing.T) (context.Context, *clearance.Scene, []*pb.Subject) {
	t.Helper()
	ctx, client := connected(t)
	scene := must(client.CreateScene(ctx, "cell"))(t)
	var edits []*pb.Edit
	var subjects []*pb.Subject
	for i, name := range []string{"a", "b", "c"} {
		pose := clearance.Turned(clearance.At(2*float64(i), 0, 0), 1, 0, 0.3*float64(i), 0)
		edits = append(edits, clearance.AddBody(name, clearance.Cone(0.3, 0.4), pose))
		subjects = append(subjects, clearance.Body(name))
	}
	must(scene.Apply(ctx, edits...))(t)
	return ctx, scene, subjects
}

// measured finds a row without times or counters.
func measured(t *testing.T, row *pb.Price) {
	t.Helper()
	if !row.Complete || row.MeanCost == nil || row.Times.GetMedian() == 0 || row.Times.GetMedian() > row.Times.GetP99() {
		t.Error(row)
	}
}

func TestAnEstimateHasARowForEachTolerance(t *testing.T) {
	ctx, scene, subjects := cones(t)
	tolerances := []float64{1e-2, 1e-6}
	distance := clearance.Prices{Tolerances: tolerances, Outputs: []pb.Output{pb.Output_OUTPUT_DISTANCE}}
	told := must(scene.EstimateDistance(ctx, subjects, distance))(t)
	if told.Items != 3 || told.Sample != 3 || told.Revision != 1 || told.End != pb.EstimateEnd_ESTIMATE_END_COMPLETE || len(told.Rows) != 2 {
		t.Fatal(told)
	}
	for i, row := range told.Rows {
		measured(t, row)
		if row.Output != pb.Output_OUTPUT_DISTANCE || row.GetTolerance() != tolerances[i] || row.Verdicts.Free != 3 {
			t.Error(row)
		}
		if row.Widths.Items != 3 || row.Widths.Wider != 0 || !(row.Widths.Largest <= tolerances[i]) {
			t.Error(row.Widths)
		}
	}
	// Of a sample, and left to itself on the daemon's ladder.
	ladder := clearance.Prices{Outputs: distance.Outputs, Sample: 2}
	told = must(scene.EstimateDistance(ctx, subjects, ladder))(t)
	if told.Sample != 2 || len(told.Rows) != 10 || told.Rows[0].GetTolerance() != 0.1 || told.Rows[9].Tolerance == nil {
		t.Error(told)
	}
	// No machine has measured anything after a nanosecond.
	hurried := must(scene.EstimateDistance(ctx, subjects, clearance.Prices{Tolerances: tolerances, Time: 1}))(t)
	if hurried.End != pb.EstimateEnd_ESTIMATE_END_TIME || hurried.Rows[0].Times != nil {
		t.Error(hurried)
	}
}

func TestAnEstimateIsOfTheQuestionAsAsked(t *testing.T) {
	ctx, scene, subjects := cones(t)
	prices := clearance.Prices{Tolerances: []float64{1e-3}, Outputs: []pb.Output{pb.Output_OUTPUT_DISTANCE}, Time: time.Second}
	counts := func(options ...clearance.Option) *pb.VerdictCounts {
		t.Helper()
		return must(scene.EstimateDistance(ctx, subjects, prices, options...))(t).Rows[0].Verdicts
	}
	if near := counts(clearance.Margin(10), clearance.StopAtFirst()); near.Margin != 3 {
		t.Error(near)
	}
	overlay := &pb.Overlay{Edits: []*pb.Edit{clearance.MoveBody("a", clearance.At(2, 0, 0))}}
	if what := counts(clearance.WhatIf(overlay)); what.Collision != 2 || what.Free != 1 {
		t.Error(what)
	}
	// Cones are nothing for separating axes.
	axes := func(a *clearance.Asked) { a.Context.Solver = pb.Solver_SOLVER_SAT }
	if odd := counts(axes); odd.InvalidInput != 3 {
		t.Error(odd)
	}
	// Each question has its own outputs; without subjects all pairs are one item.
	prices.Outputs = nil
	if told := must(scene.EstimateCollide(ctx, nil, prices))(t); told.Items != 1 || len(told.Rows) != 6 {
		t.Error(told)
	}
	if told := must(scene.EstimateClearance(ctx, 2, subjects, prices))(t); told.Items != 3 || len(told.Rows) != 5 {
		t.Error(told)
	}
}

func TestEstimatesOfARobot(t *testing.T) {
	ctx, client := connected(t)
	scene := must(client.CreateScene(ctx, "cell"))(t)
	robot := must(client.LoadRobot(ctx, &clearance.RobotDescription{URDF: crane}))(t)
	must(scene.Apply(ctx,
		clearance.AddRobot("crane", robot, nil),
		clearance.AddBody("wall", clearance.Box(0.1, 0.5, 0.5), clearance.At(0, 1, 0)),
	))(t)
	prices := clearance.Prices{Tolerances: []float64{1e-2, 1e-3}}
	states := [][]float64{{0, -0.5}, {math.Pi / 2, -0.5}, {-1, -0.5}}
	// Verdict and pairs, which no tolerance changes; distance, witness, depth, patch and derivatives.
	of := must(scene.EstimateStates(ctx, "crane", states, prices))(t)
	if of.Items != 3 || len(of.Rows) != 2+5*2 || of.Rows[0].Output != pb.Output_OUTPUT_VERDICT || of.Rows[0].Tolerance != nil {
		t.Error(of)
	}
	motions := must(scene.EstimateMotions(ctx, "crane", states[:2], [][]float64{{0.2, -0.5}, {1, -0.5}}, prices))(t)
	if motions.Items != 2 || len(motions.Rows) != 6*2 || motions.Rows[0].GetTolerance() != 1e-2 {
		t.Error(motions)
	}
	path := must(scene.EstimatePath(ctx, "crane", [][]float64{{-1, 0}, {0, 0}, {math.Pi / 2, 0}, {3, 0}}, prices))(t)
	if path.Items != 3 || len(path.Rows) != 6*2 {
		t.Error(path)
	}
	for _, row := range append(append(of.Rows, motions.Rows...), path.Rows...) {
		measured(t, row)
	}
	if first := of.Rows[0].Verdicts; first.Free != 2 || first.Collision != 1 {
		t.Error(first)
	}
	if first := motions.Rows[0].Verdicts; first.Free != 1 || first.Collision != 1 {
		t.Error(first)
	}
	for name, wrong := range map[string][][]float64{"ragged": {{0, 0}, {0}}, "too wide": {{0, 0, 0, 0}}} {
		if _, err := scene.EstimateStates(ctx, "crane", wrong, prices); err == nil {
			t.Error(name)
		}
	}
}

func TestWhatCannotBeEstimatedIsNamed(t *testing.T) {
	ctx, scene, subjects := cones(t)
	_, err := scene.EstimateDistance(ctx, subjects, clearance.Prices{Tolerances: []float64{1, math.NaN()}})
	if odd := refusal(t, err, clearance.ErrInvalidRequest); odd.Field != "tolerances[1]" {
		t.Errorf("%+v", odd)
	}
	_, err = scene.EstimateDistance(ctx, subjects, clearance.Prices{}, clearance.Margin(-1))
	if odd := refusal(t, err, clearance.ErrInvalidRequest); odd.Field != "question.context.margin" {
		t.Errorf("%+v", odd)
	}
	_, err = scene.EstimateDistance(ctx, subjects, clearance.Prices{Outputs: []pb.Output{pb.Output_OUTPUT_VERDICT}})
	if odd := refusal(t, err, clearance.ErrInvalidRequest); odd.Field != "outputs[0]" {
		t.Errorf("%+v", odd)
	}
}
