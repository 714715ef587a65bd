"""Shapes in their own frames, as messages. Sizes in metres; they may be zero, and touching collides.

Every shape may be grown by a ball: `ball_swept(box([1, 1, 1]), 0.1)`.
"""

from __future__ import annotations

from typing import Any, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .poses import Vector, vec3
from .v1 import geometry_pb2 as geometry
from .v1.geometry_pb2 import Shape

MESH_MODES = {
    "exact": geometry.MESH_MODE_EXACT,
    "hull": geometry.MESH_MODE_HULL,
    "solid": geometry.MESH_MODE_SOLID,
    "decompose": geometry.MESH_MODE_DECOMPOSE,
}


MESH_FORMATS = {
    "obj": geometry.MESH_FORMAT_OBJ,
    "stl": geometry.MESH_FORMAT_STL,
    "dae": geometry.MESH_FORMAT_DAE,
    "gltf": geometry.MESH_FORMAT_GLTF,
}


def mesh_format(name: str) -> geometry.MeshFormat:
    """How the bytes of a mesh file are read: `obj`, `stl`, `dae` or `gltf`."""
    if name not in MESH_FORMATS:
        raise ValueError(f"format: is {name!r}, known are {', '.join(MESH_FORMATS)}")
    return MESH_FORMATS[name]


def mesh_mode(name: str) -> geometry.MeshMode:
    """`exact` (the surface), `hull` (the convex hull), `solid` (the surface and its inside) or `decompose` (a few convex hulls)."""
    if name not in MESH_MODES:
        raise ValueError(f"mode: is {name!r}, known are {', '.join(MESH_MODES)}")
    return MESH_MODES[name]


def sphere(radius: float) -> Shape:
    return Shape(sphere=geometry.Sphere(radius=radius))


def point() -> Shape:
    return Shape(point=geometry.Point())


def box(half_extents: Vector) -> Shape:
    """`|x| <= half_extents[0]`, and so for y and z."""
    return Shape(box=geometry.Box(half_extents=vec3("half_extents", half_extents)))


def capsule(radius: float, half_length: float) -> Shape:
    """A ball swept along the axis z; `half_length` is that of the core segment."""
    return Shape(capsule=geometry.Capsule(radius=radius, half_length=half_length))


def cylinder(radius: float, half_length: float) -> Shape:
    """Axis z, centred."""
    return Shape(cylinder=geometry.Cylinder(radius=radius, half_length=half_length))


def cone(radius: float, half_length: float) -> Shape:
    """Axis z: apex at `half_length`, base disc at `-half_length`."""
    return Shape(cone=geometry.Cone(radius=radius, half_length=half_length))


def ellipsoid(radii: Vector) -> Shape:
    """Semi-axes along x, y, z."""
    return Shape(ellipsoid=geometry.Ellipsoid(radii=vec3("radii", radii)))


def convex(points: ArrayLike) -> Shape:
    """The convex hull of `points`, shape (n, 3)."""
    return Shape(convex=geometry.Convex(points=_points("points", points)))


def mesh(vertices: ArrayLike, triangles: ArrayLike, mode: str = "exact") -> Shape:
    """Triangles as indices of vertices, shape (m, 3), counter-clockwise from outside. `mode`: see :func:`mesh_mode`."""
    indices = np.asarray(triangles)
    if indices.ndim != 2 or indices.shape[1] != 3 or not np.issubdtype(indices.dtype, np.integer):
        raise ValueError(f"triangles: needs integers of shape (m, 3), has {indices.dtype} of shape {indices.shape}")
    if indices.size and indices.min() < 0:
        raise ValueError("triangles: an index is negative")
    message = geometry.Mesh(vertices=_points("vertices", vertices), triangles=indices.ravel(), mode=mesh_mode(mode))
    return Shape(mesh=message)


def compound(parts: Sequence[tuple[Shape, geometry.Pose]]) -> Shape:
    """The union of placed shapes."""
    return Shape(compound=geometry.Compound(parts=[geometry.Part(shape=s, pose=p) for s, p in parts]))


def height_field(heights: ArrayLike, spacing: Sequence[float], floor: float) -> Shape:
    """Terrain, solid from its surface down to `floor`.

    `heights[row, column]` is the z of the sample at `x = column * spacing[0]`, `y = row * spacing[1]`. An array of float32 is sent as it is,
    in half the bytes.
    """
    array = np.asarray(heights)
    if array.ndim != 2:
        raise ValueError(f"heights: needs shape (rows, columns), has {array.shape}")
    if len(spacing) != 2:
        raise ValueError(f"spacing: needs 2 numbers, has {len(spacing)}")
    rows, columns = array.shape
    x, y = spacing
    message = geometry.HeightField(
        rows=rows, columns=columns, spacing_x=x, spacing_y=y, heights=numbers("heights", array), floor=floor
    )
    return Shape(height_field=message)


def point_cloud(points: ArrayLike, radius: float = 0.0) -> Shape:
    """The union of balls of `radius` around `points`, shape (n, 3). An array of float32 is sent in half the bytes."""
    return Shape(point_cloud=geometry.PointCloud(points=numbers("points", _triples("points", points)), radius=radius))


def voxels(resolution: float, points: Optional[ArrayLike] = None, cells: Optional[ArrayLike] = None) -> Shape:
    """The occupied cells of a grid of side `resolution`: those of `points`, shape (n, 3), and `cells`, integers of shape (m, 3).

    Without either it is a map that nothing touches yet; see :func:`insert_points` and :func:`clear_box`.
    """
    message = geometry.Voxels(resolution=resolution)
    if points is not None:
        message.points.CopyFrom(numbers("points", _triples("points", points)))
    if cells is not None:
        indices = _triples("cells", cells)
        if not np.issubdtype(indices.dtype, np.integer):
            raise ValueError(f"cells: needs integers, has {indices.dtype}")
        message.cells.extend(indices.ravel().tolist())
    return Shape(voxels=message)


def points_message(name: str, points: ArrayLike) -> geometry.Numbers:
    """Points, shape (n, 3), as bytes."""
    return numbers(name, _triples(name, points))


def segment(a: Vector, b: Vector) -> Shape:
    return Shape(segment=geometry.Segment(a=vec3("a", a), b=vec3("b", b)))


def triangle(a: Vector, b: Vector, c: Vector) -> Shape:
    return Shape(triangle=geometry.Triangle(a=vec3("a", a), b=vec3("b", b), c=vec3("c", c)))


def half_space(normal: Vector, offset: float) -> Shape:
    """The solid `normal . x <= offset`."""
    return Shape(half_space=geometry.HalfSpace(normal=vec3("normal", normal), offset=offset))


def plane(normal: Vector, offset: float) -> Shape:
    """The thin, two-sided `normal . x = offset`."""
    return Shape(plane=geometry.Plane(normal=vec3("normal", normal), offset=offset))


def ball_swept(shape: Shape, radius: float) -> Shape:
    """The shape grown by a ball of `radius` metres, rounded at corners and edges."""
    grown = Shape()
    grown.CopyFrom(shape)
    grown.swept_radius += radius
    return grown


def _points(name: str, values: ArrayLike) -> list[geometry.Vec3]:
    array = _triples(name, values).astype(float)
    return [geometry.Vec3(x=x, y=y, z=z) for x, y, z in array.tolist()]


def _triples(name: str, values: ArrayLike) -> NDArray[Any]:
    array = np.asarray(values)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: needs shape (n, 3), has {array.shape}")
    return array


def numbers(name: str, array: NDArray[Any]) -> geometry.Numbers:
    """Numbers row by row, as bytes."""
    if not (np.issubdtype(array.dtype, np.floating) or np.issubdtype(array.dtype, np.integer)):
        raise ValueError(f"{name}: needs numbers, has {array.dtype}")
    if array.dtype.kind == "f" and array.dtype.itemsize == 4:
        return geometry.Numbers(little_endian_f32=array.astype("<f4").tobytes())
    return geometry.Numbers(little_endian=array.astype("<f8").tobytes())
