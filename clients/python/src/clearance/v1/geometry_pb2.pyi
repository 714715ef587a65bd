from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class MeshMode(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    MESH_MODE_UNSPECIFIED: _ClassVar[MeshMode]
    MESH_MODE_EXACT: _ClassVar[MeshMode]
    MESH_MODE_HULL: _ClassVar[MeshMode]
    MESH_MODE_SOLID: _ClassVar[MeshMode]
    MESH_MODE_DECOMPOSE: _ClassVar[MeshMode]

class MeshFormat(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    MESH_FORMAT_UNSPECIFIED: _ClassVar[MeshFormat]
    MESH_FORMAT_OBJ: _ClassVar[MeshFormat]
    MESH_FORMAT_STL: _ClassVar[MeshFormat]
    MESH_FORMAT_DAE: _ClassVar[MeshFormat]
    MESH_FORMAT_GLTF: _ClassVar[MeshFormat]
MESH_MODE_UNSPECIFIED: MeshMode
MESH_MODE_EXACT: MeshMode
MESH_MODE_HULL: MeshMode
MESH_MODE_SOLID: MeshMode
MESH_MODE_DECOMPOSE: MeshMode
MESH_FORMAT_UNSPECIFIED: MeshFormat
MESH_FORMAT_OBJ: MeshFormat
MESH_FORMAT_STL: MeshFormat
MESH_FORMAT_DAE: MeshFormat
MESH_FORMAT_GLTF: MeshFormat

class Vec3(_message.Message):
    __slots__ = ("x", "y", "z")
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    x: float
    y: float
    z: float
    def __init__(self, x: _Optional[float] = ..., y: _Optional[float] = ..., z: _Optional[float] = ...) -> None: ...

class Quaternion(_message.Message):
    __slots__ = ("w", "x", "y", "z")
    W_FIELD_NUMBER: _ClassVar[int]
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    Z_FIELD_NUMBER: _ClassVar[int]
    w: float
    x: float
    y: float
    z: float
    def __init__(self, w: _Optional[float] = ..., x: _Optional[float] = ..., y: _Optional[float] = ..., z: _Optional[float] = ...) -> None: ...

class Pose(_message.Message):
    __slots__ = ("translation", "rotation")
    TRANSLATION_FIELD_NUMBER: _ClassVar[int]
    ROTATION_FIELD_NUMBER: _ClassVar[int]
    translation: Vec3
    rotation: Quaternion
    def __init__(self, translation: _Optional[_Union[Vec3, _Mapping]] = ..., rotation: _Optional[_Union[Quaternion, _Mapping]] = ...) -> None: ...

class Aabb(_message.Message):
    __slots__ = ("min", "max")
    MIN_FIELD_NUMBER: _ClassVar[int]
    MAX_FIELD_NUMBER: _ClassVar[int]
    min: Vec3
    max: Vec3
    def __init__(self, min: _Optional[_Union[Vec3, _Mapping]] = ..., max: _Optional[_Union[Vec3, _Mapping]] = ...) -> None: ...

class Doubles(_message.Message):
    __slots__ = ("packed", "little_endian")
    PACKED_FIELD_NUMBER: _ClassVar[int]
    LITTLE_ENDIAN_FIELD_NUMBER: _ClassVar[int]
    packed: PackedDoubles
    little_endian: bytes
    def __init__(self, packed: _Optional[_Union[PackedDoubles, _Mapping]] = ..., little_endian: _Optional[bytes] = ...) -> None: ...

class PackedDoubles(_message.Message):
    __slots__ = ("values",)
    VALUES_FIELD_NUMBER: _ClassVar[int]
    values: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, values: _Optional[_Iterable[float]] = ...) -> None: ...

class Numbers(_message.Message):
    __slots__ = ("packed", "little_endian", "little_endian_f32", "sha256", "sha256_f32")
    PACKED_FIELD_NUMBER: _ClassVar[int]
    LITTLE_ENDIAN_FIELD_NUMBER: _ClassVar[int]
    LITTLE_ENDIAN_F32_FIELD_NUMBER: _ClassVar[int]
    SHA256_FIELD_NUMBER: _ClassVar[int]
    SHA256_F32_FIELD_NUMBER: _ClassVar[int]
    packed: PackedDoubles
    little_endian: bytes
    little_endian_f32: bytes
    sha256: str
    sha256_f32: str
    def __init__(self, packed: _Optional[_Union[PackedDoubles, _Mapping]] = ..., little_endian: _Optional[bytes] = ..., little_endian_f32: _Optional[bytes] = ..., sha256: _Optional[str] = ..., sha256_f32: _Optional[str] = ...) -> None: ...

class Shape(_message.Message):
    __slots__ = ("swept_radius", "sphere", "box", "capsule", "cylinder", "cone", "ellipsoid", "convex", "mesh", "mesh_asset", "compound", "point", "segment", "triangle", "half_space", "plane", "height_field", "point_cloud", "voxels")
    SWEPT_RADIUS_FIELD_NUMBER: _ClassVar[int]
    SPHERE_FIELD_NUMBER: _ClassVar[int]
    BOX_FIELD_NUMBER: _ClassVar[int]
    CAPSULE_FIELD_NUMBER: _ClassVar[int]
    CYLINDER_FIELD_NUMBER: _ClassVar[int]
    CONE_FIELD_NUMBER: _ClassVar[int]
    ELLIPSOID_FIELD_NUMBER: _ClassVar[int]
    CONVEX_FIELD_NUMBER: _ClassVar[int]
    MESH_FIELD_NUMBER: _ClassVar[int]
    MESH_ASSET_FIELD_NUMBER: _ClassVar[int]
    COMPOUND_FIELD_NUMBER: _ClassVar[int]
    POINT_FIELD_NUMBER: _ClassVar[int]
    SEGMENT_FIELD_NUMBER: _ClassVar[int]
    TRIANGLE_FIELD_NUMBER: _ClassVar[int]
    HALF_SPACE_FIELD_NUMBER: _ClassVar[int]
    PLANE_FIELD_NUMBER: _ClassVar[int]
    HEIGHT_FIELD_FIELD_NUMBER: _ClassVar[int]
    POINT_CLOUD_FIELD_NUMBER: _ClassVar[int]
    VOXELS_FIELD_NUMBER: _ClassVar[int]
    swept_radius: float
    sphere: Sphere
    box: Box
    capsule: Capsule
    cylinder: Cylinder
    cone: Cone
    ellipsoid: Ellipsoid
    convex: Convex
    mesh: Mesh
    mesh_asset: MeshAsset
    compound: Compound
    point: Point
    segment: Segment
    triangle: Triangle
    half_space: HalfSpace
    plane: Plane
    height_field: HeightField
    point_cloud: PointCloud
    voxels: Voxels
    def __init__(self, swept_radius: _Optional[float] = ..., sphere: _Optional[_Union[Sphere, _Mapping]] = ..., box: _Optional[_Union[Box, _Mapping]] = ..., capsule: _Optional[_Union[Capsule, _Mapping]] = ..., cylinder: _Optional[_Union[Cylinder, _Mapping]] = ..., cone: _Optional[_Union[Cone, _Mapping]] = ..., ellipsoid: _Optional[_Union[Ellipsoid, _Mapping]] = ..., convex: _Optional[_Union[Convex, _Mapping]] = ..., mesh: _Optional[_Union[Mesh, _Mapping]] = ..., mesh_asset: _Optional[_Union[MeshAsset, _Mapping]] = ..., compound: _Optional[_Union[Compound, _Mapping]] = ..., point: _Optional[_Union[Point, _Mapping]] = ..., segment: _Optional[_Union[Segment, _Mapping]] = ..., triangle: _Optional[_Union[Triangle, _Mapping]] = ..., half_space: _Optional[_Union[HalfSpace, _Mapping]] = ..., plane: _Optional[_Union[Plane, _Mapping]] = ..., height_field: _Optional[_Union[HeightField, _Mapping]] = ..., point_cloud: _Optional[_Union[PointCloud, _Mapping]] = ..., voxels: _Optional[_Union[Voxels, _Mapping]] = ...) -> None: ...

class Sphere(_message.Message):
    __slots__ = ("radius",)
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    radius: float
    def __init__(self, radius: _Optional[float] = ...) -> None: ...

class Box(_message.Message):
    __slots__ = ("half_extents",)
    HALF_EXTENTS_FIELD_NUMBER: _ClassVar[int]
    half_extents: Vec3
    def __init__(self, half_extents: _Optional[_Union[Vec3, _Mapping]] = ...) -> None: ...

class Capsule(_message.Message):
    __slots__ = ("radius", "half_length")
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    HALF_LENGTH_FIELD_NUMBER: _ClassVar[int]
    radius: float
    half_length: float
    def __init__(self, radius: _Optional[float] = ..., half_length: _Optional[float] = ...) -> None: ...

class Cylinder(_message.Message):
    __slots__ = ("radius", "half_length")
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    HALF_LENGTH_FIELD_NUMBER: _ClassVar[int]
    radius: float
    half_length: float
    def __init__(self, radius: _Optional[float] = ..., half_length: _Optional[float] = ...) -> None: ...

class Cone(_message.Message):
    __slots__ = ("radius", "half_length")
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    HALF_LENGTH_FIELD_NUMBER: _ClassVar[int]
    radius: float
    half_length: float
    def __init__(self, radius: _Optional[float] = ..., half_length: _Optional[float] = ...) -> None: ...

class Ellipsoid(_message.Message):
    __slots__ = ("radii",)
    RADII_FIELD_NUMBER: _ClassVar[int]
    radii: Vec3
    def __init__(self, radii: _Optional[_Union[Vec3, _Mapping]] = ...) -> None: ...

class Convex(_message.Message):
    __slots__ = ("points",)
    POINTS_FIELD_NUMBER: _ClassVar[int]
    points: _containers.RepeatedCompositeFieldContainer[Vec3]
    def __init__(self, points: _Optional[_Iterable[_Union[Vec3, _Mapping]]] = ...) -> None: ...

class Mesh(_message.Message):
    __slots__ = ("vertices", "triangles", "mode")
    VERTICES_FIELD_NUMBER: _ClassVar[int]
    TRIANGLES_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    vertices: _containers.RepeatedCompositeFieldContainer[Vec3]
    triangles: _containers.RepeatedScalarFieldContainer[int]
    mode: MeshMode
    def __init__(self, vertices: _Optional[_Iterable[_Union[Vec3, _Mapping]]] = ..., triangles: _Optional[_Iterable[int]] = ..., mode: _Optional[_Union[MeshMode, str]] = ...) -> None: ...

class MeshAsset(_message.Message):
    __slots__ = ("sha256", "format", "mode", "scale")
    SHA256_FIELD_NUMBER: _ClassVar[int]
    FORMAT_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    SCALE_FIELD_NUMBER: _ClassVar[int]
    sha256: str
    format: MeshFormat
    mode: MeshMode
    scale: Vec3
    def __init__(self, sha256: _Optional[str] = ..., format: _Optional[_Union[MeshFormat, str]] = ..., mode: _Optional[_Union[MeshMode, str]] = ..., scale: _Optional[_Union[Vec3, _Mapping]] = ...) -> None: ...

class Compound(_message.Message):
    __slots__ = ("parts",)
    PARTS_FIELD_NUMBER: _ClassVar[int]
    parts: _containers.RepeatedCompositeFieldContainer[Part]
    def __init__(self, parts: _Optional[_Iterable[_Union[Part, _Mapping]]] = ...) -> None: ...

class Part(_message.Message):
    __slots__ = ("shape", "pose")
    SHAPE_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    shape: Shape
    pose: Pose
    def __init__(self, shape: _Optional[_Union[Shape, _Mapping]] = ..., pose: _Optional[_Union[Pose, _Mapping]] = ...) -> None: ...

class HeightField(_message.Message):
    __slots__ = ("rows", "columns", "spacing_x", "spacing_y", "heights", "floor")
    ROWS_FIELD_NUMBER: _ClassVar[int]
    COLUMNS_FIELD_NUMBER: _ClassVar[int]
    SPACING_X_FIELD_NUMBER: _ClassVar[int]
    SPACING_Y_FIELD_NUMBER: _ClassVar[int]
    HEIGHTS_FIELD_NUMBER: _ClassVar[int]
    FLOOR_FIELD_NUMBER: _ClassVar[int]
    rows: int
    columns: int
    spacing_x: float
    spacing_y: float
    heights: Numbers
    floor: float
    def __init__(self, rows: _Optional[int] = ..., columns: _Optional[int] = ..., spacing_x: _Optional[float] = ..., spacing_y: _Optional[float] = ..., heights: _Optional[_Union[Numbers, _Mapping]] = ..., floor: _Optional[float] = ...) -> None: ...

class PointCloud(_message.Message):
    __slots__ = ("points", "radius")
    POINTS_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    points: Numbers
    radius: float
    def __init__(self, points: _Optional[_Union[Numbers, _Mapping]] = ..., radius: _Optional[float] = ...) -> None: ...

class Voxels(_message.Message):
    __slots__ = ("resolution", "points", "cells")
    RESOLUTION_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    CELLS_FIELD_NUMBER: _ClassVar[int]
    resolution: float
    points: Numbers
    cells: _containers.RepeatedScalarFieldContainer[int]
    def __init__(self, resolution: _Optional[float] = ..., points: _Optional[_Union[Numbers, _Mapping]] = ..., cells: _Optional[_Iterable[int]] = ...) -> None: ...

class Point(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class Segment(_message.Message):
    __slots__ = ("a", "b")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    a: Vec3
    b: Vec3
    def __init__(self, a: _Optional[_Union[Vec3, _Mapping]] = ..., b: _Optional[_Union[Vec3, _Mapping]] = ...) -> None: ...

class Triangle(_message.Message):
    __slots__ = ("a", "b", "c")
    A_FIELD_NUMBER: _ClassVar[int]
    B_FIELD_NUMBER: _ClassVar[int]
    C_FIELD_NUMBER: _ClassVar[int]
    a: Vec3
    b: Vec3
    c: Vec3
    def __init__(self, a: _Optional[_Union[Vec3, _Mapping]] = ..., b: _Optional[_Union[Vec3, _Mapping]] = ..., c: _Optional[_Union[Vec3, _Mapping]] = ...) -> None: ...

class HalfSpace(_message.Message):
    __slots__ = ("normal", "offset")
    NORMAL_FIELD_NUMBER: _ClassVar[int]
    OFFSET_FIELD_NUMBER: _ClassVar[int]
    normal: Vec3
    offset: float
    def __init__(self, normal: _Optional[_Union[Vec3, _Mapping]] = ..., offset: _Optional[float] = ...) -> None: ...

class Plane(_message.Message):
    __slots__ = ("normal", "offset")
    NORMAL_FIELD_NUMBER: _ClassVar[int]
    OFFSET_FIELD_NUMBER: _ClassVar[int]
    normal: Vec3
    offset: float
    def __init__(self, normal: _Optional[_Union[Vec3, _Mapping]] = ..., offset: _Optional[float] = ...) -> None: ...
