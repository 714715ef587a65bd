package clearance_test

import (
	"bufio"
	"context"
	"encoding/hex"
	"errors"
	"fmt"
	"io"
	"os"
	"path/filepath"
	"strings"
	"testing"

	"example.com/clearance"
	pb "example.com/clearance/clearancepb"
	"google.golang.org/grpc/codes"
	"google.golang.org/protobuf/proto"
	"google.golang.org/protobuf/reflect/protoreflect"
	"google.golang.org/protobuf/reflect/protoregistry"
)

// TestTheRecordedAnswersAreBrought asks what tests/data/conformance has, and wants the same bytes. What a line means is said in
// tests/clients/record.rs.
func TestTheRecordedAnswersAreBrought(t *testing.T) {
	ctx, client := connected(t)
	file := must(os.Open(filepath.Join(repository(), "tests", "data", "conformance", "records.txt")))(t)
	defer file.Close()
	lines := bufio.NewScanner(file)
	lines.Buffer(nil, 1<<20)
	count := map[string]int{}
	for lines.Scan() {
		words := strings.SplitN(lines.Text(), " ", 4)
		if words[0] == "#" {
			continue
		}
		count[words[0]]++
		switch words[0] {
		case "asset":
			data := must(os.ReadFile(filepath.Join(repository(), words[1])))(t)
			must(client.Upload(ctx, data))(t)
		case "ask":
			answer := must(ask(ctx, t, client, words[1], words[2]))(t)
			if got := canonical(t, answer); got != words[3] {
				t.Errorf("%s %s\nbrought  %s\nrecorded %s", words[1], words[2], got, words[3])
			}
		case "refuse":
			_, err := ask(ctx, t, client, words[1], words[2])
			var refused *clearance.Error
			if !errors.As(err, &refused) {
				t.Errorf("%s %s: %v", words[1], words[2], err)
				continue
			}
			field := refused.Field
			if field == "" {
				field = "-"
			}
			if got := fmt.Sprintf("%s %s %s", codeName(refused.Code), refused.Reason, field); got != words[3] {
				t.Errorf("%s %s\nbrought  %s\nrecorded %s", words[1], words[2], got, words[3])
			}
		case "stream":
			if got := stream(ctx, t, client, strings.Split(words[2], ",")); got != words[3] {
				t.Errorf("stream\nbrought  %s\nrecorded %s", got, words[3])
			}
		default:
			t.Fatalf("no record: %s", words[0])
		}
	}
	if lines.Err() != nil || count["asset"] == 0 || count["ask"] == 0 || count["refuse"] == 0 || count["stream"] == 0 {
		t.Errorf("%v %v", lines.Err(), count)
	}
}

// ask calls SERVICE/METHOD with a message in hexadecimal digits.
func ask(ctx context.Context, t *testing.T, client *clearance.Client, method, request string) (proto.Message, error) {
	t.Helper()
	parts := strings.Split(method, "/")
	service := must(protoregistry.GlobalFiles.FindDescriptorByName(protoreflect.FullName("clearance.v1." + parts[0])))(t)
	found := service.(protoreflect.ServiceDescriptor).Methods().ByName(protoreflect.Name(parts[1]))
	create := func(of protoreflect.MessageDescriptor) proto.Message {
		return must(protoregistry.GlobalTypes.FindMessageByName(of.FullName()))(t).New().Interface()
	}
	question, answer := create(found.Input()), create(found.Output())
	if err := proto.Unmarshal(digits(t, request), question); err != nil {
		t.Fatal(err)
	}
	return answer, client.Conn().Invoke(ctx, "/clearance.v1."+method, question, answer)
}

func stream(ctx context.Context, t *testing.T, client *clearance.Client, requests []string) string {
	t.Helper()
	stream := must(client.Queries.QueryStream(ctx))(t)
	for _, request := range requests {
		question := &pb.QueryStreamRequest{}
		if err := proto.Unmarshal(digits(t, request), question); err != nil {
			t.Fatal(err)
		}
		if err := stream.Send(question); err != nil {
			t.Fatal(err)
		}
	}
	if err := stream.CloseSend(); err != nil {
		t.Fatal(err)
	}
	var answers []string
	for {
		answer, err := stream.Recv()
		if err == io.EOF {
			return strings.Join(answers, ",")
		}
		answers = append(answers, canonical(t, must(answer, err)(t)))
	}
}

func digits(t *testing.T, text string) []byte {
	t.Helper()
	return must(hex.DecodeString(strings.TrimPrefix(text, "-")))(t)
}

// canonical is the message's bytes as digits, without epochs and counts of nodes.
func canonical(t *testing.T, message proto.Message) string {
	t.Helper()
	clear(message.ProtoReflect())
	data := must(proto.MarshalOptions{Deterministic: true}.Marshal(message))(t)
	if len(data) == 0 {
		return "-"
	}
	return hex.EncodeToString(data)
}

func clear(message protoreflect.Message) {
	message.Range(func(field protoreflect.FieldDescriptor, value protoreflect.Value) bool {
		isNodes := field.Name() == "nodes" && message.Descriptor().Name() == "Cost"
		switch {
		case field.Name() == "epoch" || isNodes:
			message.Clear(field)
		case field.Message() == nil || field.IsMap():
		case field.IsList():
			for i := 0; i < value.List().Len(); i++ {
				clear(value.List().Get(i).Message())
			}
		default:
			clear(value.Message())
		}
		return true
	})
}

// codeName is gRPC's, which the library has only in another spelling.
func codeName(code codes.Code) string {
	return map[codes.Code]string{
		codes.InvalidArgument: "INVALID_ARGUMENT", codes.NotFound: "NOT_FOUND", codes.AlreadyExists: "ALREADY_EXISTS",
		codes.FailedPrecondition: "FAILED_PRECONDITION", codes.Aborted: "ABORTED", codes.OutOfRange: "OUT_OF_RANGE",
	}[code]
}
