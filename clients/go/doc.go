// Package clearance asks a clearance daemon how far apart things are.
//
//	client, err := clearance.Dial("127.0.0.1:50551")
//	scene, err := client.CreateScene(ctx, "cell")
//	applied, err := scene.Apply(ctx, clearance.AddBody("ball", clearance.Sphere(0.5), clearance.At(0, 0, 1)))
//
// Metres, radians, right-handed frames. Messages are those of package clearancepb, generated from proto/clearance/v1;
// what this package does not offer is asked through Client.Scenes, Client.Queries and their like. Refused calls of either
// kind return an *Error.
package clearance
