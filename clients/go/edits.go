package clearance

import pb "example.com/clearance/clearancepb"

// Name is how a body is named: by its name, or by the id the scene gave it.
type Name interface{ string | uint64 }

// Ref is a body's name as a message.
func Ref[N Name](body N) *pb.BodyRef {
	switch body := any(body).(type) {
	case string:
		return &pb.BodyRef{By: &pb.BodyRef_Name{Name: body}}
	case uint64:
		return &pb.BodyRef{By: &pb.BodyRef_Id{Id: body}}
	default:
		return nil // No other type is a Name.
	}
}

// Edits of a scene, for Scene.Apply. They are made in order, all or none. Fields that these functions leave out are set on
// the message they return, for example edit.GetAddBody().Groups.

// AddBody lets a rigid body enter the scene.
func AddBody(name string, shape *pb.Shape, pose *pb.Pose) *pb.Edit {
	return &pb.Edit{Kind: &pb.Edit_AddBody{AddBody: &pb.AddBody{Name: name, Shape: shape, Pose: pose}}}
}

// MoveBody puts a body somewhere else.
func MoveBody[N Name](body N, pose *pb.Pose) *pb.Edit {
	return &pb.Edit{Kind: &pb.Edit_MoveBody{MoveBody: &pb.MoveBody{Body: Ref(body), Pose: pose}}}
}

// RemoveBody takes a body out of the scene.
func RemoveBody[N Name](body N) *pb.Edit {
	return &pb.Edit{Kind: &pb.Edit_RemoveBody{RemoveBody: &pb.RemoveBody{Body: Ref(body)}}}
}

// ReplaceShape gives a body another shape.
func ReplaceShape[N Name](body N, shape *pb.Shape) *pb.Edit {
	return &pb.Edit{Kind: &pb.Edit_ReplaceShape{ReplaceShape: &pb.ReplaceShape{Body: Ref(body), Shape: shape}}}
}

// SetEnabled says whether a body takes part.
func SetEnabled[N Name](body N, enabled bool) *pb.Edit {
	return &pb.Edit{Kind: &pb.Edit_SetEnabled{SetEnabled: &pb.SetEnabled{Body: Ref(body), Enabled: enabled}}}
}

// InsertPoints gives a body of voxels the cells of these points too; metres, in the body's frame.
func InsertPoints[N Name](body N, points []Point) *pb.Edit {
	message := &pb.InsertPoints{Body: Ref(body), Points: Numbers(points)}
	return &pb.Edit{Kind: &pb.Edit_InsertPoints{InsertPoints: message}}
}

// ClearBox takes from a body of voxels every cell that a point of the box belongs to; metres, in the body's frame.
func ClearBox[N Name](body N, least, greatest Point) *pb.Edit {
	box := &pb.Aabb{Min: Vec3(least), Max: Vec3(greatest)}
	return &pb.Edit{Kind: &pb.Edit_ClearBox{ClearBox: &pb.ClearBox{Body: Ref(body), Box: box}}}
}

// AddRobot lets a loaded robot stand in the scene; base is the pose of its root link, nil the world's frame.
func AddRobot(name string, robot *Robot, base *pb.Pose) *pb.Edit {
	return &pb.Edit{Kind: &pb.Edit_AddRobot{AddRobot: &pb.AddRobot{Name: name, Model: robot.ID, Base: base}}}
}

// MoveRobot puts a robot's base somewhere else.
func MoveRobot(name string, base *pb.Pose) *pb.Edit {
	return &pb.Edit{Kind: &pb.Edit_MoveRobot{MoveRobot: &pb.MoveRobot{Robot: name, Base: base}}}
}

// RemoveRobot takes a robot out of the scene.
func RemoveRobot(name string) *pb.Edit {
	return &pb.Edit{Kind: &pb.Edit_RemoveRobot{RemoveRobot: &pb.RemoveRobot{Robot: name}}}
}

// AllowCollision makes an entry of the allowed-collision matrix. True: the pair is not looked at. False: it is, whatever less
// specific entries say.
func AllowCollision(a, b *pb.Party, allowed bool) *pb.Edit {
	message := &pb.SetAllowedCollision{A: a, B: b, Allowed: &allowed}
	return &pb.Edit{Kind: &pb.Edit_SetAllowedCollision{SetAllowedCollision: message}}
}

// SetPairMargin replaces the question's margin for a pair; metres.
func SetPairMargin(a, b *pb.Party, margin float64) *pb.Edit {
	message := &pb.SetPairMargin{A: a, B: b, Margin: &margin}
	return &pb.Edit{Kind: &pb.Edit_SetPairMargin{SetPairMargin: message}}
}

// DeclareEffects says what may be asked of a pair; with each effect goes what it needs. Of none the pair is not looked at, and
// answers list it in their coverage.
func DeclareEffects(a, b *pb.Party, effects ...pb.Effect) *pb.Edit {
	message := &pb.DeclareEffects{A: a, B: b, Effects: &pb.Effects{Effects: effects}}
	return &pb.Edit{Kind: &pb.Edit_DeclareEffects{DeclareEffects: message}}
}

// OneBody is a single body as one side of an entry for pairs.
func OneBody[N Name](body N) *pb.Party { return &pb.Party{Kind: &pb.Party_Body{Body: Ref(body)}} }

// OneLink is one link of a robot as one side of an entry for pairs.
func OneLink(robot, link string) *pb.Party {
	return &pb.Party{Kind: &pb.Party_Link{Link: &pb.LinkRef{Robot: robot, Link: link}}}
}

// Group is all bodies of a group as one side of an entry for pairs.
func Group(name string) *pb.Party { return &pb.Party{Kind: &pb.Party_Group{Group: name}} }

// AllLinks is a robot as one side of an entry for pairs.
func AllLinks(robot string) *pb.Party { return &pb.Party{Kind: &pb.Party_Robot{Robot: robot}} }

// Everything is every body and link as one side of an entry for pairs.
func Everything() *pb.Party {
	return &pb.Party{Kind: &pb.Party_Everything{Everything: &pb.Everything{}}}
}
