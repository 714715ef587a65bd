package clearance

import (
	"encoding/binary"
	"math"

	pb "example.com/clearance/clearancepb"
)

// Point is x, y, z.
type Point = [3]float64

// Vec3 is a point as a message.
func Vec3(p Point) *pb.Vec3 { return &pb.Vec3{X: p[0], Y: p[1], Z: p[2]} }

// PointOf is a message as a point; nil is the origin.
func PointOf(v *pb.Vec3) Point { return Point{v.GetX(), v.GetY(), v.GetZ()} }

// At is a pose without rotation; metres.
func At(x, y, z float64) *pb.Pose { return &pb.Pose{Translation: Vec3(Point{x, y, z})} }

// Turned is the pose with its rotation replaced by a quaternion, of any norm but zero.
func Turned(pose *pb.Pose, w, x, y, z float64) *pb.Pose {
	return &pb.Pose{Translation: pose.GetTranslation(), Rotation: &pb.Quaternion{W: w, X: x, Y: y, Z: z}}
}

// Shapes, in their own frames. Sizes are metres and may be zero; touching collides.

// Sphere is a ball.
func Sphere(radius float64) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_Sphere{Sphere: &pb.Sphere{Radius: radius}}}
}

// Box is the points with |x| <= halfX, and so for y and z.
func Box(halfX, halfY, halfZ float64) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_Box{Box: &pb.Box{HalfExtents: Vec3(Point{halfX, halfY, halfZ})}}}
}

// Capsule is a ball swept along the axis z; halfLength is that of the core segment.
func Capsule(radius, halfLength float64) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_Capsule{Capsule: &pb.Capsule{Radius: radius, HalfLength: halfLength}}}
}

// Cylinder has the axis z and is centred.
func Cylinder(radius, halfLength float64) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_Cylinder{Cylinder: &pb.Cylinder{Radius: radius, HalfLength: halfLength}}}
}

// Cone has the axis z: apex at halfLength, base disc at -halfLength.
func Cone(radius, halfLength float64) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_Cone{Cone: &pb.Cone{Radius: radius, HalfLength: halfLength}}}
}

// Ellipsoid has semi-axes along x, y, z.
func Ellipsoid(x, y, z float64) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_Ellipsoid{Ellipsoid: &pb.Ellipsoid{Radii: Vec3(Point{x, y, z})}}}
}

// Convex is the convex hull of points.
func Convex(points []Point) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_Convex{Convex: &pb.Convex{Points: vectors(points)}}}
}

// Mesh is triangles, as indices of vertices, counter-clockwise from outside. The mode says what they stand for.
func Mesh(vertices []Point, triangles [][3]uint32, mode pb.MeshMode) *pb.Shape {
	mesh := &pb.Mesh{Vertices: vectors(vertices), Mode: mode}
	for _, triangle := range triangles {
		mesh.Triangles = append(mesh.Triangles, triangle[:]...)
	}
	return &pb.Shape{Core: &pb.Shape_Mesh{Mesh: mesh}}
}

// Compound is the union of placed shapes.
func Compound(parts ...*pb.Part) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_Compound{Compound: &pb.Compound{Parts: parts}}}
}

// Part is one part of a compound.
func Part(shape *pb.Shape, pose *pb.Pose) *pb.Part { return &pb.Part{Shape: shape, Pose: pose} }

// PointCloud is the union of balls around points.
func PointCloud(points []Point, radius float64) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_PointCloud{PointCloud: &pb.PointCloud{Points: Numbers(points), Radius: radius}}}
}

// Voxels is the occupied cells of a grid of side resolution: those of the points. Without points it is a map that nothing
// touches yet.
func Voxels(resolution float64, points []Point) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_Voxels{Voxels: &pb.Voxels{Resolution: resolution, Points: Numbers(points)}}}
}

// HalfSpace is the solid normal . x <= offset.
func HalfSpace(normal Point, offset float64) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_HalfSpace{HalfSpace: &pb.HalfSpace{Normal: Vec3(normal), Offset: offset}}}
}

// Plane is the thin, two-sided normal . x = offset.
func Plane(normal Point, offset float64) *pb.Shape {
	return &pb.Shape{Core: &pb.Shape_Plane{Plane: &pb.Plane{Normal: Vec3(normal), Offset: offset}}}
}

// BallSwept makes a shape larger by a ball, rounded at corners and edges. It changes the shape and returns it.
func BallSwept(shape *pb.Shape, radius float64) *pb.Shape {
	shape.SweptRadius += radius
	return shape
}

// Numbers is points as a message, as bytes.
func Numbers(points []Point) *pb.Numbers {
	bytes := make([]byte, 0, 24*len(points))
	for _, point := range points {
		bytes = appendDoubles(bytes, point[:])
	}
	return &pb.Numbers{Form: &pb.Numbers_LittleEndian{LittleEndian: bytes}}
}

func vectors(points []Point) []*pb.Vec3 {
	result := make([]*pb.Vec3, len(points))
	for i, point := range points {
		result[i] = Vec3(point)
	}
	return result
}

func appendDoubles(bytes []byte, numbers []float64) []byte {
	for _, number := range numbers {
		bytes = binary.LittleEndian.AppendUint64(bytes, math.Float64bits(number))
	}
	return bytes
}

// doublesOf is the numbers of a bulk answer; none of an empty field.
func doublesOf(bytes []byte) []float64 {
	numbers := make([]float64, len(bytes)/8)
	for i := range numbers {
		numbers[i] = math.Float64frombits(binary.LittleEndian.Uint64(bytes[8*i:]))
	}
	return numbers
}
