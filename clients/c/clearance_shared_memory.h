/* Messages of the shared-memory door, layout for layout; docs/wire.md explains them.
 * Made from src/transports/shared_memory/layout.rs by `cargo test --test service header`; do not edit.
 * Little-endian machines only. */
#ifndef CLEARANCE_SHARED_MEMORY_H
#define CLEARANCE_SHARED_MEMORY_H

#include <assert.h>
#include <stddef.h>
#include <stdint.h>

#define CLEARANCE_MAGIC {0x43, 0x4c, 0x52, 0x53, 0x48, 0x4d, 0x0d, 0x0a}
#define CLEARANCE_ABI_HASH UINT64_C(0x24304ff8578aafb9)
#define CLEARANCE_VERSION 1
#define CLEARANCE_ALIGNMENT 64
#define CLEARANCE_MOST_SECTIONS 64

typedef struct clearance_request_header {
    uint8_t magic[8]; /* the bytes 43 4c 52 53 48 4d 0d 0a */
    uint64_t abi_hash; /* hash of this layout; another one is refused */
    uint32_t version; /* of the layout: 1 */
    uint32_t sections; /* entries of the table of sections, which follows the header */
    uint64_t total_bytes; /* length of the message, header and table included */
    uint8_t nonce[16]; /* random for each request; the answer has the same, and one with another is not the caller's */
    uint8_t client[16]; /* the client's own: its listener for answers has these bytes as its name, in lower-case hexadecimal */
    uint32_t question; /* 1 states, 2 motions, 3 path, 4 collide, 5 distance, 6 rays, 7 any rpc by its name */
    uint32_t mode; /* 0 all items, 1 stop at the first hit; of rays: 0 the first body met, 1 every one, 2 whether there is any */
    uint32_t flags; /* bits that say which optional fields are given: 1 epoch, 2 cut_off, 4 accuracy, 8 max_pairs, 16 layers, 32 mask, 64 resolution, 128 max_states, 256 time_budget_ns; and 512: disregard allowed collisions */
    uint32_t items; /* rows of the columns of items: states, motions, waypoints of a path, subjects or rays */
    uint32_t revision_rule; /* 0 the latest, 1 exactly `revision`, 2 at least `revision` */
    uint32_t wants; /* bits: 1 distance, 2 witness, 4 depth, 8 pairs, 16 the sides of the nearest pair */
    uint64_t epoch; /* the epoch that is meant, where given */
    uint64_t revision; /* the revision that is meant */
    uint64_t timeout_ns; /* nanoseconds from the arrival of the request until nobody listens any more; 0: the daemon's longest */
    uint64_t time_budget_ns; /* nanoseconds after which the caller wants what is there, where given */
    double margin; /* metres: a pair apart but nearer than this is MARGIN */
    double cut_off; /* metres: pairs farther than this need no distance, where given */
    double accuracy_absolute; /* metres, where given */
    double accuracy_relative; /* a factor, where given */
    double resolution; /* metres: of motions, where given */
    uint32_t solver; /* who measures a pair: the numbers of `Solver` in query.proto */
    uint32_t max_pairs; /* pairs or hits listed for an item, where given */
    uint32_t layers; /* of bare shapes and rays: bits of the layers they are in, where given */
    uint32_t mask; /* of bare shapes and rays: bits of the layers they meet, where given */
    uint32_t find; /* of motions: 0 the first contact, 1 any contact */
    uint32_t max_states; /* of motions: states looked at for one of them, where given */
    uint8_t kept_free[72]; /* zeros */
} clearance_request_header;

static_assert(offsetof(clearance_request_header, magic) == 0, "magic");
static_assert(offsetof(clearance_request_header, abi_hash) == 8, "abi_hash");
static_assert(offsetof(clearance_request_header, version) == 16, "version");
static_assert(offsetof(clearance_request_header, sections) == 20, "sections");
static_assert(offsetof(clearance_request_header, total_bytes) == 24, "total_bytes");
static_assert(offsetof(clearance_request_header, nonce) == 32, "nonce");
static_assert(offsetof(clearance_request_header, client) == 48, "client");
static_assert(offsetof(clearance_request_header, question) == 64, "question");
static_assert(offsetof(clearance_request_header, mode) == 68, "mode");
static_assert(offsetof(clearance_request_header, flags) == 72, "flags");
static_assert(offsetof(clearance_request_header, items) == 76, "items");
static_assert(offsetof(clearance_request_header, revision_rule) == 80, "revision_rule");
static_assert(offsetof(clearance_request_header, wants) == 84, "wants");
static_assert(offsetof(clearance_request_header, epoch) == 88, "epoch");
static_assert(offsetof(clearance_request_header, revision) == 96, "revision");
static_assert(offsetof(clearance_request_header, timeout_ns) == 104, "timeout_ns");
static_assert(offsetof(clearance_request_header, time_budget_ns) == 112, "time_budget_ns");
static_assert(offsetof(clearance_request_header, margin) == 120, "margin");
static_assert(offsetof(clearance_request_header, cut_off) == 128, "cut_off");
static_assert(offsetof(clearance_request_header, accuracy_absolute) == 136, "accuracy_absolute");
static_assert(offsetof(clearance_request_header, accuracy_relative) == 144, "accuracy_relative");
static_assert(offsetof(clearance_request_header, resolution) == 152, "resolution");
static_assert(offsetof(clearance_request_header, solver) == 160, "solver");
static_assert(offsetof(clearance_request_header, max_pairs) == 164, "max_pairs");
static_assert(offsetof(clearance_request_header, layers) == 168, "layers");
static_assert(offsetof(clearance_request_header, mask) == 172, "mask");
static_assert(offsetof(clearance_request_header, find) == 176, "find");
static_assert(offsetof(clearance_request_header, max_states) == 180, "max_states");
static_assert(sizeof(clearance_request_header) == 256, "clearance_request_header");

typedef struct clearance_response_header {
    uint8_t magic[8]; /* the bytes 43 4c 52 53 48 4d 0d 0a */
    uint64_t abi_hash; /* hash of this layout */
    uint32_t version; /* of the layout: 1 */
    uint32_t sections; /* entries of the table of sections, which follows the header */
    uint64_t total_bytes; /* length of the message, header and table included */
    uint8_t nonce[16]; /* of the request */
    uint32_t code; /* 0 an answer; else an error, the number of its gRPC status, and the sections of errors say more */
    uint32_t question; /* of the request */
    uint32_t items; /* rows of the columns of items */
    uint32_t flags; /* bits: 1 `stopped_at` is given, 2 the time ran out and the items not looked at are NOT_RUN */
    uint64_t epoch; /* which life of the scene was asked */
    uint64_t revision; /* which state of it */
    uint32_t stopped_at; /* the item that stopped the batch, where given */
    uint32_t reserved; /* zero */
    uint64_t supports; /* support points of a Minkowski difference, count, over all items */
    uint64_t gjk_iterations; /* rounds of GJK, count */
    uint64_t epa_iterations; /* rounds of EPA, count */
    uint64_t nodes; /* nodes of trees that were opened, count */
    uint64_t pairs; /* pairs of convex shapes that were looked at, count */
    uint64_t escalations; /* pairs that doubles left open and a higher precision took over, count */
    uint8_t kept_free[120]; /* zeros */
} clearance_response_header;

static_assert(offsetof(clearance_response_header, magic) == 0, "magic");
static_assert(offsetof(clearance_response_header, abi_hash) == 8, "abi_hash");
static_assert(offsetof(clearance_response_header, version) == 16, "version");
static_assert(offsetof(clearance_response_header, sections) == 20, "sections");
static_assert(offsetof(clearance_response_header, total_bytes) == 24, "total_bytes");
static_assert(offsetof(clearance_response_header, nonce) == 32, "nonce");
static_assert(offsetof(clearance_response_header, code) == 48, "code");
static_assert(offsetof(clearance_response_header, question) == 52, "question");
static_assert(offsetof(clearance_response_header, items) == 56, "items");
static_assert(offsetof(clearance_response_header, flags) == 60, "flags");
static_assert(offsetof(clearance_response_header, epoch) == 64, "epoch");
static_assert(offsetof(clearance_response_header, revision) == 72, "revision");
static_assert(offsetof(clearance_response_header, stopped_at) == 80, "stopped_at");
static_assert(offsetof(clearance_response_header, reserved) == 84, "reserved");
static_assert(offsetof(clearance_response_header, supports) == 88, "supports");
static_assert(offsetof(clearance_response_header, gjk_iterations) == 96, "gjk_iterations");
static_assert(offsetof(clearance_response_header, epa_iterations) == 104, "epa_iterations");
static_assert(offsetof(clearance_response_header, nodes) == 112, "nodes");
static_assert(offsetof(clearance_response_header, pairs) == 120, "pairs");
static_assert(offsetof(clearance_response_header, escalations) == 128, "escalations");
static_assert(sizeof(clearance_response_header) == 256, "clearance_response_header");

typedef struct clearance_section {
    uint32_t kind; /* which column */
    uint32_t stride; /* bytes of one row */
    uint64_t offset; /* where the section begins, bytes from the start of the message; a multiple of 64 */
    uint64_t bytes; /* its length; a multiple of the stride */
    uint64_t reserved; /* zero */
} clearance_section;

static_assert(offsetof(clearance_section, kind) == 0, "kind");
static_assert(offsetof(clearance_section, stride) == 4, "stride");
static_assert(offsetof(clearance_section, offset) == 8, "offset");
static_assert(offsetof(clearance_section, bytes) == 16, "bytes");
static_assert(offsetof(clearance_section, reserved) == 24, "reserved");
static_assert(sizeof(clearance_section) == 32, "clearance_section");

enum clearance_section_kind {
    CLEARANCE_SCENE = 1, /* request, but for any rpc: the scene's name, UTF-8; must be there */
    CLEARANCE_ROBOT = 2, /* request for states, motions, path: the robot's name in the scene, UTF-8; must be there */
    CLEARANCE_POSITIONS = 3, /* request for states, motions, path: joint positions in the robot's order, radians or metres; a row a state or waypoint, or start and goal of a motion one after the other */
    CLEARANCE_GROUPS = 4, /* request: names of the groups that are looked at, UTF-8, a zero byte after each */
    CLEARANCE_IGNORE = 5, /* request: ids of bodies that are left out, unsigned */
    CLEARANCE_SUBJECT_KINDS = 6, /* request to collide, distance: 1 all pairs, 2 a body, 3 a shape at a pose, 4 what changed since a revision, 5 the shape of a body at another pose */
    CLEARANCE_SUBJECT_IDS = 7, /* request to collide, distance, unsigned: the body's id (2, 5) or the revision (4); else zero */
    CLEARANCE_POSES = 8, /* request to collide, distance: of subjects 3 and 5: translation x y z, metres, and quaternion w x y z, of the shape in the world; else not read */
    CLEARANCE_SHAPE_KINDS = 9, /* request to collide, distance: of subject 3: 1 sphere, 2 box, 3 capsule, 4 cylinder, 5 cone, 6 ellipsoid, 7 point; else not read */
    CLEARANCE_SHAPE_PARAMETERS = 10, /* request to collide, distance: of subject 3, metres: three numbers (radius; half extents x y z; radius, half length; radii x y z), then the swept radius; else not read */
    CLEARANCE_ORIGINS = 11, /* request for rays: where each begins, metres, world */
    CLEARANCE_DIRECTIONS = 12, /* request for rays: of any length but zero, world */
    CLEARANCE_LENGTHS = 13, /* request for rays: how far each goes, metres; one row for all, or one each */
    CLEARANCE_RPC = 14, /* request for any rpc: its service and method, for example `Queries/CastShapes`, UTF-8; must be there */
    CLEARANCE_MESSAGE = 15, /* request for any rpc: its request message, protobuf; absent: an empty one. Of `Assets/PutAsset` the messages of the stream, each behind its length as a varint */
    CLEARANCE_VERDICTS = 32, /* an item's verdict: the numbers of `Verdict`, of rays of `CastVerdict` */
    CLEARANCE_INDETERMINACIES = 33, /* why an item is INDETERMINATE: the numbers of `Indeterminacy` */
    CLEARANCE_NEAREST_LOWER = 34, /* distance wanted, metres: of the pair of least signed distance; NaN: no such pair */
    CLEARANCE_NEAREST_UPPER = 35, /* the same: upper end of the bracket */
    CLEARANCE_NEAREST_SIGNED_DISTANCE = 36, /* the same: best estimate inside the bracket */
    CLEARANCE_SELF_LOWER = 37, /* of states, distance wanted, metres: of two links; NaN: no such pair */
    CLEARANCE_SELF_UPPER = 38, /* the same: upper end of the bracket */
    CLEARANCE_SELF_SIGNED_DISTANCE = 39, /* the same: best estimate inside the bracket */
    CLEARANCE_SCENE_LOWER = 40, /* of states, distance wanted, metres: of a link and a body; NaN: no such pair */
    CLEARANCE_SCENE_UPPER = 41, /* the same: upper end of the bracket */
    CLEARANCE_SCENE_SIGNED_DISTANCE = 42, /* the same: best estimate inside the bracket */
    CLEARANCE_PROBLEM_ITEMS = 43, /* indices of the items that are INVALID_INPUT, unsigned */
    CLEARANCE_PROBLEM_TEXTS = 44, /* what is wrong with each of them, UTF-8, a zero byte after each */
    CLEARANCE_TRUNCATED = 45, /* pairs wanted, and of rays: 1 where an item had more pairs or hits than are listed */
    CLEARANCE_FREE_UNTIL = 46, /* of motions, a part of it; of rays, metres: up to here is proved free */
    CLEARANCE_REACHED_FROM = 47, /* of motions, a part of it: proved apart before; NaN: no contact */
    CLEARANCE_REACHED_TO = 48, /* of motions, a part of it: proved in contact here; NaN: no contact */
    CLEARANCE_UNDECIDED_FROM = 49, /* of motions, a part of it: the first stretch that is not proved; NaN: none */
    CLEARANCE_UNDECIDED_TO = 50, /* of motions, a part of it: its end; NaN: none */
    CLEARANCE_STATES = 51, /* of motions: states that pairs were measured in, count, a double; NaN: not run */
    CLEARANCE_RESPONSE = 52, /* of any rpc: its response message, protobuf */
    CLEARANCE_DECLARED_EMPTY = 53, /* pairs that the scene declares empty and that no item says anything about: the names of both sides, one after the other, UTF-8, a zero byte after each; absent: none */
    CLEARANCE_DECLARED_EMPTY_NOT_LISTED = 54, /* how many more such pairs there are than `max_pairs` lets that column have, one unsigned number; absent: none */
    CLEARANCE_NEAREST_A_KIND = 64, /* sides wanted, side A of the nearest pair: 0 no pair, 1 a link, 2 the question's shape, 3 a body */
    CLEARANCE_NEAREST_A_ID = 65, /* the same: index of the link, id of the body, unsigned */
    CLEARANCE_NEAREST_A_SHAPE = 66, /* the same: which shape of the link, unsigned */
    CLEARANCE_NEAREST_A_SUBSHAPE = 67, /* the same: triangle, part, column or point, unsigned */
    CLEARANCE_NEAREST_B_KIND = 68, /* side B of the nearest pair */
    CLEARANCE_NEAREST_B_ID = 69, /* the same: index of the link, id of the body, unsigned */
    CLEARANCE_NEAREST_B_SHAPE = 70, /* the same: which shape of the link, unsigned */
    CLEARANCE_NEAREST_B_SUBSHAPE = 71, /* the same: triangle, part, column or point, unsigned */
    CLEARANCE_NEAREST_VERDICT = 72, /* sides wanted: of the nearest pair alone; 0: no pair */
    CLEARANCE_NEAREST_INDETERMINACY = 73, /* sides wanted: why the nearest pair is INDETERMINATE */
    CLEARANCE_NEAREST_TERMINATION = 74, /* sides wanted: how the work on the nearest pair stopped, the numbers of `Termination`; 0: no pair */
    CLEARANCE_NEAREST_POINT_ON_A = 75, /* witness wanted, metres, world: of the nearest pair; NaN: none */
    CLEARANCE_NEAREST_POINT_ON_B = 76, /* the same, on side B */
    CLEARANCE_NEAREST_NORMAL = 77, /* witness wanted, world: unit vector from A to B; NaN: none */
    CLEARANCE_NEAREST_POINT_ERROR = 78, /* witness wanted, metres: how far at most the points are off; NaN: none */
    CLEARANCE_NEAREST_NORMAL_ERROR = 79, /* witness wanted, radians: how far at most the normal is turned; NaN: none */
    CLEARANCE_PAIR_COUNTS = 96, /* pairs wanted: how many of the listed pairs belong to each item, unsigned; the columns after this have a row a listed pair */
    CLEARANCE_PAIR_A_KIND = 97, /* listed pairs, side A, as for the nearest pair */
    CLEARANCE_PAIR_A_ID = 98, /* the same: index of the link, id of the body, unsigned */
    CLEARANCE_PAIR_A_SHAPE = 99, /* the same: which shape of the link, unsigned */
    CLEARANCE_PAIR_A_SUBSHAPE = 100, /* the same: triangle, part, column or point, unsigned */
    CLEARANCE_PAIR_B_KIND = 101, /* listed pairs, side B */
    CLEARANCE_PAIR_B_ID = 102, /* the same: index of the link, id of the body, unsigned */
    CLEARANCE_PAIR_B_SHAPE = 103, /* the same: which shape of the link, unsigned */
    CLEARANCE_PAIR_B_SUBSHAPE = 104, /* the same: triangle, part, column or point, unsigned */
    CLEARANCE_PAIR_VERDICT = 105, /* listed pairs: the verdict of each */
    CLEARANCE_PAIR_INDETERMINACY = 106, /* listed pairs: why one is INDETERMINATE */
    CLEARANCE_PAIR_TERMINATION = 107, /* listed pairs: how the work stopped */
    CLEARANCE_PAIR_LOWER = 108, /* listed pairs, metres: lower end of the bracket */
    CLEARANCE_PAIR_UPPER = 109, /* listed pairs, metres: upper end of the bracket */
    CLEARANCE_PAIR_SIGNED_DISTANCE = 110, /* listed pairs, metres: best estimate inside the bracket */
    CLEARANCE_HIT_COUNTS = 128, /* of rays: how many of the hits belong to each ray, unsigned; the next columns have a row a hit */
    CLEARANCE_HIT_BODIES = 129, /* of rays: ids of the bodies met, unsigned */
    CLEARANCE_HIT_SUBSHAPES = 130, /* of rays: triangle, part, column or point, unsigned */
    CLEARANCE_HIT_LOWER = 131, /* of rays, metres along the ray: not met before */
    CLEARANCE_HIT_UPPER = 132, /* of rays, metres along the ray: met at the latest here */
    CLEARANCE_HIT_AT_START = 133, /* of rays: 1 where the ray begins in the body */
    CLEARANCE_HIT_POINTS = 134, /* of rays: metres, world */
    CLEARANCE_HIT_NORMALS = 135, /* of rays: unit vectors out of the body, world */
    CLEARANCE_GRAZED_COUNTS = 136, /* of rays: how many of the grazed bodies belong to each ray, unsigned; the next columns have a row each */
    CLEARANCE_GRAZED_BODIES = 137, /* of rays: ids of bodies that are perhaps met, unsigned */
    CLEARANCE_GRAZED_LOWER = 138, /* of rays, metres along the ray: not met before */
    CLEARANCE_GRAZED_UPPER = 139, /* of rays, metres along the ray: not met after */
    CLEARANCE_GRAZED_INDETERMINACIES = 140, /* of rays: why it is left open */
    CLEARANCE_ERROR_REASON = 160, /* of errors: a name of `ErrorReason` in service.proto without its prefix, ASCII */
    CLEARANCE_ERROR_MESSAGE = 161, /* of errors: for people, UTF-8 */
    CLEARANCE_ERROR_FIELD = 162, /* of errors with a field at fault: its path, UTF-8 */
    CLEARANCE_ERROR_DETAILS = 163, /* of errors: key=value lines as in gRPC's metadata, without `clearance-`, UTF-8 */
};

#endif
