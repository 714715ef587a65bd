package clearance

import (
	"context"
	"crypto/sha256"
	"encoding/hex"

	pb "example.com/clearance/clearancepb"
	"google.golang.org/grpc"
)

// DefaultAddress is where `clearance serve` listens unless told otherwise.
const DefaultAddress = "127.0.0.1:50551"

// chunk is how many bytes of an upload go in one message.
const chunk = 1 << 20

// Client is a connection to a daemon. It may be used by any number of goroutines.
//
// Deadlines are those of the contexts given to its methods. The services are there for what methods do not offer.
type Client struct {
	Scenes  pb.ScenesClient
	Assets  pb.AssetsClient
	Robots  pb.RobotsClient
	Queries pb.QueriesClient
	Server  pb.ServerClient

	conn *grpc.ClientConn
}

// Dial makes a client of the daemon at HOST:PORT, http://HOST:PORT, https://HOST:PORT or unix:PATH. The connection is made
// when it is needed: a daemon that is not there shows with the first call.
func Dial(address string, options ...DialOption) (*Client, error) {
	conn, err := connect(address, options)
	if err != nil {
		return nil, err
	}
	return &Client{
		Scenes:  pb.NewScenesClient(conn),
		Assets:  pb.NewAssetsClient(conn),
		Robots:  pb.NewRobotsClient(conn),
		Queries: pb.NewQueriesClient(conn),
		Server:  pb.NewServerClient(conn),
		conn:    conn,
	}, nil
}

// Close ends the connection. Calls under way fail.
func (c *Client) Close() error { return c.conn.Close() }

// Conn is the connection, for stubs of other services such as health. Its calls bring the token and return *Error, too.
func (c *Client) Conn() grpc.ClientConnInterface { return c.conn }

// ServerInfo tells version, doors, limits, scenes and their epochs.
func (c *Client) ServerInfo(ctx context.Context) (*pb.GetServerInfoResponse, error) {
	return c.Server.GetServerInfo(ctx, &pb.GetServerInfoRequest{})
}

// CreateScene makes a new, empty scene.
func (c *Client) CreateScene(ctx context.Context, name string) (*Scene, error) {
	if _, err := c.Scenes.CreateScene(ctx, &pb.CreateSceneRequest{Name: name}); err != nil {
		return nil, err
	}
	return c.Scene(name), nil
}

// Scene is a scene that is there already. Whether it is shows with the first call.
func (c *Client) Scene(name string) *Scene { return &Scene{Name: name, client: c} }

// ListScenes tells of all scenes, in the order of their names.
func (c *Client) ListScenes(ctx context.Context) ([]*pb.SceneSummary, error) {
	answer, err := c.Scenes.ListScenes(ctx, &pb.ListScenesRequest{})
	return answer.GetScenes(), err
}

// LoadRobot uploads the meshes that the daemon does not have, and loads the robot.
func (c *Client) LoadRobot(ctx context.Context, description *RobotDescription) (*Robot, error) {
	files := make([][]byte, 0, len(description.Meshes))
	request := &pb.LoadRobotRequest{
		Urdf:     description.URDF,
		MeshMode: description.MeshMode,
		Padding:  description.Padding,
		Links:    description.Links,
	}
	if description.SRDF != "" {
		request.Srdf = &description.SRDF
	}
	if description.Scale != 0 {
		request.Scale = &description.Scale
	}
	for _, mesh := range description.Meshes {
		files = append(files, mesh.Data)
		request.Meshes = append(request.Meshes, &pb.MeshBinding{Filename: mesh.Filename})
	}
	hashes, err := c.Upload(ctx, files...)
	if err != nil {
		return nil, err
	}
	for i, hash := range hashes {
		request.Meshes[i].Sha256 = hash
	}
	answer, err := c.Robots.LoadRobot(ctx, request)
	if err != nil {
		return nil, err
	}
	return robotOf(answer.GetRobot()), nil
}

// Upload brings files to the daemon that it does not have yet. It returns the SHA-256 of each, by which messages name them.
func (c *Client) Upload(ctx context.Context, files ...[]byte) ([]string, error) {
	if len(files) == 0 {
		return nil, nil
	}
	hashes := make([]string, len(files))
	for i, data := range files {
		sum := sha256.Sum256(data)
		hashes[i] = hex.EncodeToString(sum[:])
	}
	answer, err := c.Assets.HasAssets(ctx, &pb.HasAssetsRequest{Sha256: hashes})
	if err != nil {
		return nil, err
	}
	here := make(map[string]bool, len(files))
	for i, present := range answer.GetPresent() {
		here[hashes[i]] = present
	}
	for i, data := range files {
		if here[hashes[i]] {
			continue
		}
		if err := c.putAsset(ctx, hashes[i], data); err != nil {
			return nil, err
		}
		here[hashes[i]] = true
	}
	return hashes, nil
}

func (c *Client) putAsset(ctx context.Context, hash string, data []byte) error {
	stream, err := c.Assets.PutAsset(ctx)
	if err != nil {
		return err
	}
	header := &pb.AssetHeader{Sha256: hash, Bytes: uint64(len(data))}
	// A refused upload shows as io.EOF here; CloseAndRecv has the reason.
	err = stream.Send(&pb.PutAssetRequest{Part: &pb.PutAssetRequest_Header{Header: header}})
	for err == nil && len(data) > 0 {
		part := data
		if len(part) > chunk {
			part = part[:chunk]
		}
		data = data[len(part):]
		err = stream.Send(&pb.PutAssetRequest{Part: &pb.PutAssetRequest_Chunk{Chunk: part}})
	}
	_, err = stream.CloseAndRecv()
	return err
}
