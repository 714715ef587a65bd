package clearance

import (
	"encoding/xml"
	"fmt"
	"math"
	"os"
	"path/filepath"
	"sort"
	"strings"

	pb "example.com/clearance/clearancepb"
)

// RobotDescription is what a robot is loaded from. ReadRobot makes one from files.
type RobotDescription struct {
	// URDF and SRDF are texts; without an SRDF only adjacent links may touch.
	URDF, SRDF string
	// Meshes that the URDF's collision shapes name.
	Meshes []MeshFile
	// MeshMode says what meshes stand for; ReadRobot sets the convex hull.
	MeshMode pb.MeshMode
	// Padding grows every link's shapes, metres, after they were scaled by Scale; 0 is no scaling.
	Padding, Scale float64
	// Links has choices for single links.
	Links []*pb.LinkOptions
}

// MeshFile is one mesh file of a robot.
type MeshFile struct {
	// Filename as it stands in the URDF.
	Filename string
	Data     []byte
}

// ReadRobot reads a robot from this machine's disk; srdf may be empty. A mesh `package://NAME/rest` is `rest` in
// packages[NAME], else in the URDF's own folder; any other name is a path from that folder.
func ReadRobot(urdf, srdf string, packages map[string]string) (*RobotDescription, error) {
	text, err := os.ReadFile(urdf)
	if err != nil {
		return nil, err
	}
	description := &RobotDescription{URDF: string(text), MeshMode: pb.MeshMode_MESH_MODE_HULL}
	if srdf != "" {
		text, err := os.ReadFile(srdf)
		if err != nil {
			return nil, err
		}
		description.SRDF = string(text)
	}
	names, err := MeshNames(description.URDF)
	if err != nil {
		return nil, fmt.Errorf("%s: %w", urdf, err)
	}
	for _, name := range names {
		data, err := os.ReadFile(meshPath(name, filepath.Dir(urdf), packages))
		if err != nil {
			return nil, fmt.Errorf("%s: mesh %q: %w", urdf, name, err)
		}
		description.Meshes = append(description.Meshes, MeshFile{Filename: name, Data: data})
	}
	return description, nil
}

// MeshNames tells the mesh files that the collision shapes of a URDF name, each once, sorted.
func MeshNames(urdf string) ([]string, error) {
	var robot struct {
		Names []struct {
			Filename string `xml:"filename,attr"`
		} `xml:"link>collision>geometry>mesh"`
	}
	if err := xml.Unmarshal([]byte(urdf), &robot); err != nil {
		return nil, fmt.Errorf("is not XML: %w", err)
	}
	seen := map[string]bool{}
	var names []string
	for _, mesh := range robot.Names {
		if !seen[mesh.Filename] {
			seen[mesh.Filename] = true
			names = append(names, mesh.Filename)
		}
	}
	sort.Strings(names)
	return names, nil
}

func meshPath(name, folder string, packages map[string]string) string {
	if rest := strings.TrimPrefix(name, "package://"); rest != name {
		parts := strings.SplitN(rest, "/", 2)
		if len(parts) < 2 {
			parts = append(parts, "")
		}
		if known, ok := packages[parts[0]]; ok {
			folder = known
		}
		return filepath.Join(folder, parts[1])
	}
	name = strings.TrimPrefix(name, "file://")
	if filepath.IsAbs(name) {
		return name
	}
	return filepath.Join(folder, name)
}

// Robot is a model that the daemon has loaded. It may stand in any number of scenes.
type Robot struct {
	// ID names the model in the daemon.
	ID string
	// Name as in the URDF.
	Name string
	// DegreesOfFreedom is how many numbers a vector of joint positions has.
	DegreesOfFreedom int
	// Links by the indices that answers use.
	Links []string
	// Lower and Upper are the limits of each number of a vector of joint positions; infinite where there are none.
	Lower, Upper []float64
	// Model is everything known of it.
	Model *pb.RobotModel
}

func robotOf(model *pb.RobotModel) *Robot {
	robot := &Robot{
		ID:               model.GetId(),
		Name:             model.GetName(),
		DegreesOfFreedom: int(model.GetDegreesOfFreedom()),
		Model:            model,
	}
	for _, link := range model.GetLinks() {
		robot.Links = append(robot.Links, link.GetName())
	}
	for _, joint := range model.GetJoints() {
		lower, upper := math.Inf(-1), math.Inf(1)
		if joint.Lower != nil {
			lower = joint.GetLower()
		}
		if joint.Upper != nil {
			upper = joint.GetUpper()
		}
		for i := uint32(0); i < joint.GetWidth(); i++ {
			robot.Lower = append(robot.Lower, lower)
			robot.Upper = append(robot.Upper, upper)
		}
	}
	return robot
}
