package clearance

import (
	"context"
	"errors"
	"fmt"
	"io"
	"regexp"
	"strconv"
	"strings"
	"time"

	pb "example.com/clearance/clearancepb"
	"google.golang.org/grpc"
	"google.golang.org/grpc/codes"
	"google.golang.org/grpc/metadata"
	"google.golang.org/grpc/status"
)

// Kinds of errors, for errors.Is. Geometry is never an error: it is a verdict.
var (
	// ErrInvalidRequest: a field cannot be as it is; Field and Item say which.
	ErrInvalidRequest = errors.New("invalid request")
	// ErrNotFound: a scene, body, robot, model, asset or group is not there.
	ErrNotFound = errors.New("not found")
	// ErrConflict: the scene is not as the request needs it: a taken name, an edit that does not fit, another revision or epoch.
	ErrConflict = errors.New("conflict")
	// ErrRevisionGone: the revision asked for is not kept any more; OldestRevision is.
	ErrRevisionGone = errors.New("revision gone")
	// ErrLimitExceeded: a cap of the daemon; Limit, Asked and Allowed say which, RetryAfter when to ask again if time helps.
	ErrLimitExceeded = errors.New("limit exceeded")
	// ErrNotAllowed: the daemon wants a token, does not know this one, or it lacks Scope; Reason says which.
	ErrNotAllowed = errors.New("not allowed")
	// ErrDeadlineExceeded: nothing could be answered in time. Is context.DeadlineExceeded, too.
	ErrDeadlineExceeded = errors.New("deadline exceeded")
	// ErrUnavailable: no daemon there, one that shuts down, or a revision that did not come in time.
	ErrUnavailable = errors.New("unavailable")
)

// Error is a request that was refused or could not be delivered. What the daemon did not say is empty.
type Error struct {
	// Code is gRPC's kind of error.
	Code codes.Code
	// Reason is for programs, for example INVALID_FIELD; see ErrorReason in service.proto.
	Reason string
	// Message is for people.
	Message string
	// Field that cannot be as it is, for example `items[3].shape.box.half_extents.x`.
	Field string
	// Item is the element of a list of edits, subjects or the like that the field is in; -1: none.
	Item int
	// Limit that was hit, how much was asked, how much is allowed.
	Limit          string
	Asked, Allowed uint64
	// RetryAfter is when the limit lets this client in again; 0: it does not say.
	RetryAfter time.Duration
	// Scope that the token lacks, `read` or `write`.
	Scope string
	// The scene as it is now, where it is not as was expected.
	Epoch, Revision, OldestRevision uint64
}

func (e *Error) Error() string { return fmt.Sprintf("%s: %s", e.Code, e.Message) }

// GRPCStatus makes status.FromError work.
func (e *Error) GRPCStatus() *status.Status { return status.New(e.Code, e.Message) }

// Is tells the kind of the error.
func (e *Error) Is(kind error) bool {
	switch e.Code {
	case codes.InvalidArgument:
		return kind == ErrInvalidRequest
	case codes.NotFound:
		return kind == ErrNotFound
	case codes.AlreadyExists, codes.FailedPrecondition, codes.Aborted:
		return kind == ErrConflict
	case codes.OutOfRange:
		return kind == ErrRevisionGone
	case codes.ResourceExhausted:
		return kind == ErrLimitExceeded
	case codes.Unauthenticated, codes.PermissionDenied:
		return kind == ErrNotAllowed
	case codes.DeadlineExceeded:
		return kind == ErrDeadlineExceeded || kind == context.DeadlineExceeded
	case codes.Canceled:
		return kind == context.Canceled
	case codes.Unavailable:
		return kind == ErrUnavailable
	default:
		return false
	}
}

// Refused is the error of one question of a stream, as a call of its own would have returned it.
func Refused(refusal *pb.QueryError) *Error {
	reason := strings.TrimPrefix(refusal.GetReason().String(), "ERROR_REASON_")
	details := refusal.GetDetails()
	return newError(codes.Code(refusal.GetCode()), refusal.GetMessage(), func(key string) string {
		if key == "clearance-reason" {
			return reason
		}
		return details[key]
	})
}

var item = regexp.MustCompile(`^\w+\[(\d+)\]`)

func newError(code codes.Code, message string, of func(string) string) *Error {
	number := func(key string) uint64 {
		n, _ := strconv.ParseUint(of(key), 10, 64)
		return n
	}
	e := &Error{
		Code:           code,
		Message:        message,
		Reason:         of("clearance-reason"),
		Field:          of("clearance-field"),
		Item:           -1,
		Limit:          of("clearance-limit"),
		Asked:          number("clearance-asked"),
		Allowed:        number("clearance-allowed"),
		RetryAfter:     time.Duration(number("clearance-retry-after-ms")) * time.Millisecond,
		Scope:          of("clearance-scope"),
		Epoch:          number("clearance-epoch"),
		Revision:       number("clearance-revision"),
		OldestRevision: number("clearance-oldest-revision"),
	}
	if found := item.FindStringSubmatch(e.Field); found != nil {
		if n, err := strconv.Atoi(found[1]); err == nil {
			e.Item = n
		}
	}
	return e
}

// translated turns gRPC's error into an *Error.
func translated(err error, trailer metadata.MD) error {
	if err == nil || err == io.EOF {
		return err
	}
	var known *Error
	if errors.As(err, &known) {
		return err
	}
	of := func(key string) string {
		if values := trailer.Get(key); len(values) > 0 {
			return values[0]
		}
		return ""
	}
	said := status.Convert(err)
	return newError(said.Code(), said.Message(), of)
}

func unaryErrors(
	ctx context.Context, method string, request, answer interface{}, conn *grpc.ClientConn,
	invoke grpc.UnaryInvoker, options ...grpc.CallOption,
) error {
	var trailer metadata.MD
	err := invoke(ctx, method, request, answer, conn, append(options, grpc.Trailer(&trailer))...)
	return translated(err, trailer)
}

func streamErrors(
	ctx context.Context, desc *grpc.StreamDesc, conn *grpc.ClientConn, method string,
	open grpc.Streamer, options ...grpc.CallOption,
) (grpc.ClientStream, error) {
	stream, err := open(ctx, desc, conn, method, options...)
	if err != nil {
		return nil, translated(err, nil)
	}
	return translatingStream{stream}, nil
}

type translatingStream struct{ grpc.ClientStream }

func (s translatingStream) RecvMsg(message interface{}) error {
	err := s.ClientStream.RecvMsg(message)
	if err == nil || err == io.EOF {
		return err
	}
	return translated(err, s.Trailer())
}

func (s translatingStream) SendMsg(message interface{}) error {
	return translated(s.ClientStream.SendMsg(message), nil)
}
