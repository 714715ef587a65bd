//! The numeric constants that proofs and several files rest on: value, unit, reason, and what breaks if it is changed.
//! A constant that one algorithm alone uses stands at the top of its file.

/// Unit roundoff of `f64`: the largest relative error of one correctly rounded operation.
pub const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Whether answers are proved. A build with `CLEARANCE_UNPROVED` set goes without errors, outward rounding and higher precision:
/// its brackets prove nothing. It exists for `benches/instructions`, which tells by it what the proof costs.
pub const PROVED: bool = option_env!("CLEARANCE_UNPROVED").is_none();

/// Error of one support value or one Minkowski vertex, in units of [`UNIT_ROUNDOFF`] times the extent
/// S = r_A + r_B + |t|. `docs/derivations/bracket.md` adds up the pose (matrix from quaternion, product of two matrices,
/// rotated difference of positions), the support point and the dot product, and arrives at it. Smaller could let a
/// bracket miss the truth; larger only widens it.
pub const SUPPORT_ERROR_ULPS: f64 = 112.0;

/// Largest coordinate or size of a shape or position, metres. Squares of such lengths, and sums of a dozen of them, are
/// still finite; anything larger would turn bounds into infinities.
pub const LARGEST_LENGTH: f64 = 1e152;

/// A pair is rescaled by a power of two when its extent leaves this range, metres. Inside it, products of
/// six lengths neither overflow nor underflow; outside, volumes would.
pub const UNSCALED_EXTENT: (f64, f64) = (1e-20, 1e20);

/// Relative width at which a bracket counts as closed when the caller does not say.
pub const DEFAULT_RELATIVE_TOLERANCE: f64 = 1e-9;

/// By how much a face or an edge may lean against the plane across the normal and still be part of a contact patch, when the caller does not
/// say; radians, some 0.6 degrees. A body that rests on its face is turned by less: by what a solver lets it sink in (1 mm in 10 cm),
/// or by poses stored in 32 bits. Smaller, and such a body would be told to stand on an edge or a corner; larger, and a wedge of
/// a few degrees would be told to lie on its side. It chooses which corners make the patch; what is said of each corner holds for any.
pub const PATCH_TILT: f64 = 0.01;
