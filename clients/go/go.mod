// The repository has no public address yet; until it has one, a program says where its checkout is:
//
//	go mod edit -require example.com/clearance@v0.1.0 -replace example.com/clearance=../clearance/clients/go
module example.com/clearance

go 1.19

require (
	google.golang.org/grpc v1.33.3
	google.golang.org/protobuf v1.28.1
)
