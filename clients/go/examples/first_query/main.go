// A robot in a cell: which of its states are free, how near is the nearest, and what does the daemon say of a mistake?
//
//	clearance serve &
//	first_query [ADDRESS [FOLDER]]
//
// FOLDER holds a robot's ur5.urdf, ur5.srdf and meshes. The examples of all clients print the same text.
package main

import (
	"context"
	"errors"
	"fmt"
	"log"
	"os"
	"path/filepath"
	"strings"
	"time"

	"example.com/clearance"
	pb "example.com/clearance/clearancepb"
)

// Joint positions, radians.
var states = [][]float64{
	{-1.6, -0.6, 0.0, -1.57, -1.57, 3.14},
	{-1.2, -0.6, 0.0, -1.57, -1.57, 3.14},
	{0.4, -0.3, 0.2, -1.57, -1.57, 3.14},
}

func main() {
	address, folder := clearance.DefaultAddress, "tests/data/robot-ur5"
	if len(os.Args) > 1 {
		address = os.Args[1]
	}
	if len(os.Args) > 2 {
		folder = os.Args[2]
	}
	ctx, cancel := context.WithTimeout(context.Background(), time.Minute)
	defer cancel()
	if err := run(ctx, address, folder); err != nil {
		log.Fatal(err)
	}
}

func run(ctx context.Context, address, folder string) error {
	client, err := clearance.Dial(address)
	if err != nil {
		return err
	}
	defer client.Close()
	files, err := clearance.ReadRobot(filepath.Join(folder, "ur5.urdf"), filepath.Join(folder, "ur5.srdf"), nil)
	if err != nil {
		return err
	}
	robot, err := client.LoadRobot(ctx, files)
	if err != nil {
		return err
	}
	fmt.Printf("robot %s: %d numbers a state, %d links\n", robot.Name, robot.DegreesOfFreedom, len(robot.Links))
	scene, err := client.CreateScene(ctx, fmt.Sprintf("first query %d", os.Getpid()))
	if err != nil {
		return err
	}
	defer scene.Delete(ctx)
	return ask(ctx, scene, robot)
}

func ask(ctx context.Context, scene *clearance.Scene, robot *clearance.Robot) error {
	applied, err := scene.Apply(ctx,
		clearance.AddRobot("arm", robot, nil),
		clearance.AddBody("table", clearance.Box(1.0, 1.0, 0.02), clearance.At(0.0, 0.0, 0.7)),
		clearance.AddBody("post", clearance.Capsule(0.05, 0.3), clearance.At(0.5, 0.3, 1.2)),
		clearance.AddBody("ball", clearance.Ellipsoid(0.3, 0.2, 0.1), clearance.Turned(clearance.At(0.2, 0.8, 1.3), 0.8, 0.2, 0.4, 0.4)),
	)
	if err != nil {
		return err
	}
	names := map[uint64]string{}
	for i, name := range []string{"table", "post", "ball"} {
		names[applied.Added[i]] = name
	}
	fmt.Println("the scene is at revision", applied.Revision)

	// A batch of states: verdicts and proved brackets as slices.
	checked, err := scene.CheckStates(ctx, "arm", states, clearance.Want(clearance.DepthToo), clearance.AtLeast(applied.Revision))
	if err != nil {
		return err
	}
	free := 0
	for i, verdict := range checked.Verdicts {
		nearest := bracket(checked.NearestScene.Lower[i], checked.NearestScene.Upper[i])
		fmt.Printf("state %d: %v, to the scene %s\n", i, verdict, nearest)
		if verdict == clearance.Free {
			free++
		}
	}
	fmt.Println(free, "are free")

	// A state with everything there is to know.
	seen, err := scene.LookAtStates(ctx, "arm", states[1:2])
	if err != nil {
		return err
	}
	for _, pair := range seen.Items[0].Pairs {
		link, body := pair.GetA().GetLink(), pair.GetB().GetBody()
		fmt.Printf("state 1: %s and %s, %v\n", robot.Links[link.GetLink()], names[body.GetId()], clearance.Verdict(pair.Verdict))
	}

	// Bodies.
	apart, err := scene.Distance(ctx, []*pb.Subject{clearance.Body("ball")})
	if err != nil {
		return err
	}
	nearest := apart.Items[0].Nearest
	fmt.Printf("%s: %s\n", pairNames(nearest, names), bracket(nearest.Bracket.Lower, nearest.Bracket.Upper))
	fmt.Printf("from %s to %s\n", point(nearest.Witness.PointOnA), point(nearest.Witness.PointOnB))

	// An edit, and a question that sees it.
	applied, err = scene.Apply(ctx, clearance.MoveBody("ball", clearance.At(0.5, 0.3, 1.6)))
	if err != nil {
		return err
	}
	touching, err := scene.Collide(ctx, []*pb.Subject{clearance.Body("ball")}, clearance.AtLeast(applied.Revision))
	if err != nil {
		return err
	}
	var pairs []string
	for _, pair := range touching.Items[0].Pairs {
		pairs = append(pairs, pairNames(pair, names))
	}
	verdict := clearance.Verdict(touching.Items[0].Verdict)
	fmt.Printf("at revision %d %v: %s\n", applied.Revision, verdict, strings.Join(pairs, ", "))

	_, err = scene.Apply(ctx,
		clearance.MoveBody("table", clearance.At(0.0, 0.0, 0.6)),
		clearance.AddBody("flag", clearance.Box(1.0, -1.0, 0.1), clearance.At(0.0, 0.0, 0.0)),
	)
	var refused *clearance.Error
	if !errors.As(err, &refused) {
		return fmt.Errorf("a negative box is refused, not %v", err)
	}
	fmt.Printf("refused: %s, item %d, field %s\n", refused.Reason, refused.Item, refused.Field)
	return nil
}

func pairNames(pair *pb.PairAnswer, names map[uint64]string) string {
	return names[pair.GetA().GetBody().GetId()] + " and " + names[pair.GetB().GetBody().GetId()]
}

// bracket has enough digits to see both ends; adding 0 takes the sign off zero.
func bracket(lower, upper float64) string { return fmt.Sprintf("[%.17f, %.17f] m", lower+0, upper+0) }

func point(v *pb.Vec3) string {
	p := clearance.PointOf(v)
	return fmt.Sprintf("(%.9f, %.9f, %.9f)", p[0]+0, p[1]+0, p[2]+0)
}
