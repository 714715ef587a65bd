"""The shapes of the pairs: each as numbers for the file, and as Coal has it, which is asked when pairs are placed."""

import coal
import numpy as np
from scipy.spatial import ConvexHull

HULL, SPHERE, BOX, CAPSULE, CYLINDER, CONE, ELLIPSOID, MESH = range(8)


class Shapes:
    """Grows by one shape a call; a shape is known by its index. Lengths in metres, axes along z, sizes are halves."""

    def __init__(self, random):
        self.random = random
        self.records = []
        self.in_coal = []

    def add(self, kind, params=(), vertices=None, triangles=None):
        params = [*params, *[0.0] * (4 - len(params))]
        vertices = np.zeros((0, 3)) if vertices is None else np.ascontiguousarray(vertices, np.float64)
        triangles = np.zeros((0, 3), np.uint32) if triangles is None else np.ascontiguousarray(triangles, np.uint32)
        self.records.append((kind, params, vertices, triangles))
        self.in_coal.append(in_coal(kind, params, vertices, triangles))
        return len(self.records) - 1

    def sizes(self, least, greatest, count):
        return [self.random.uniform(least, greatest) for _ in range(count)]

    def box(self):
        return self.add(BOX, self.random.uniform(0.2, 1, 3))

    def capsule(self):
        return self.add(CAPSULE, [self.random.uniform(0.1, 0.5), self.random.uniform(0.1, 0.8)])

    def sphere(self):
        return self.add(SPHERE, self.sizes(0.1, 0.8, 1))

    def cylinder(self):
        return self.add(CYLINDER, self.sizes(0.2, 0.8, 2))

    def cone(self):
        return self.add(CONE, self.sizes(0.2, 0.8, 2))

    def ellipsoid(self):
        return self.add(ELLIPSOID, self.random.uniform(0.2, 1, 3))

    def box_hull(self):
        """A box as the hull of its corners."""
        half = self.random.uniform(0.2, 1.0, 3)
        corners = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        return self.hull(np.array(corners) * half)

    def ellipsoid_hull(self, count):
        """`count` points on an ellipsoid, all of them corners."""
        radii = self.random.uniform(0.3, 1.0, 3)
        points = self.random.normal(size=(count, 3))
        return self.hull(points / np.linalg.norm(points, axis=1)[:, None] * radii)

    def hull(self, points):
        return self.add(HULL, vertices=points, triangles=outward_faces(points))

    def bumpy_sphere(self, around, rows, seed):
        """A closed mesh of 2 * around * (rows - 1) triangles that is nowhere near convex."""
        return self.add(MESH, **bumpy_sphere(around, rows, np.random.default_rng(seed)))


def in_coal(kind, params, vertices, triangles):
    if kind == HULL:
        points, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
        for vertex in vertices:
            points.append(vertex)
        for a, b, c in triangles:
            faces.append(coal.Triangle(int(a), int(b), int(c)))
        return coal.Convex(points, faces)
    makers = {
        SPHERE: lambda: coal.Sphere(params[0]),
        BOX: lambda: coal.Box(*(2 * half for half in params[:3])),
        CAPSULE: lambda: coal.Capsule(params[0], 2 * params[1]),
        CYLINDER: lambda: coal.Cylinder(params[0], 2 * params[1]),
        CONE: lambda: coal.Cone(params[0], 2 * params[1]),
        ELLIPSOID: lambda: coal.Ellipsoid(*params[:3]),
        MESH: lambda: None,
    }
    return makers[kind]()


def outward_faces(points):
    """Triangles of the convex hull, counter-clockwise from outside."""
    faces, centre = ConvexHull(points).simplices.copy(), points.mean(0)
    for index, (a, b, c) in enumerate(faces):
        normal = np.cross(points[b] - points[a], points[c] - points[a])
        if normal @ (points[a] - centre) < 0:
            faces[index] = a, c, b
    return faces


def bumpy_sphere(around, rows, random):
    waves = random.uniform(-1, 1, (6, 3)) * 4
    phases = random.uniform(0, 6.28, 6)
    vertices = []
    for row in range(rows + 1):
        polar = np.pi * row / rows
        for column in range(around):
            azimuth = 2 * np.pi * column / around
            out = np.array([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)])
            vertices.append(out * (1 + 0.08 * np.sum(np.sin(waves @ out + phases))))
    triangles = []
    for row in range(rows):
        for column in range(around):
            a, b = row * around + column, row * around + (column + 1) % around
            c, d = a + around, b + around
            if row > 0:
                triangles.append((a, d, b))
            if row < rows - 1:
                triangles.append((a, c, d))
    vertices, triangles = np.array(vertices), np.array(triangles)
    # A pole is one vertex, not a ring of equal ones.
    last_ring = rows * around
    for first in (0, last_ring):
        vertices[first : first + around] = vertices[first : first + around].mean(0)
    triangles[triangles < around] = 0
    triangles[triangles >= last_ring] = last_ring
    return {"vertices": vertices, "triangles": triangles}
