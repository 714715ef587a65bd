"""The usual way to ask the same questions: pinocchio for kinematics, Coal for collisions, both in C++ below one call a state.

Reads a robot workload (tests/data/robot-ur5), makes one geometry model for each of its scenes (the robot's hulls, the
scene's objects, every pair that the SRDF leaves), and answers each state with `computeCollisions` (stop at the first)
and with `computeDistances`. For each line on standard input it makes one pass over all states and prints one line of
JSON: {"verdict": states a second, "distance": states a second, "wrong_verdicts": n, "wrong_distances": n}.

Needs `pin`, `coal` and `numpy` from PyPI; `benches/peers/setup` installs them.
"""

import json
import re
import sys
import time
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin


def coal_shape(shape):
    kind, params = shape["type"], shape["params"]
    if kind == "box":
        return coal.Box(*(2 * h for h in params["half_extents"]))
    if kind == "cylinder":
        return coal.Cylinder(params["radius"], 2 * params["half_length"])
    if kind == "sphere":
        return coal.Sphere(params["radius"])
    sys.exit(f"the workload has a {kind}")


def placement(pose):
    w, x, y, z = pose["q"]
    return pin.SE3(pin.Quaternion(w, x, y, z).normalized().matrix(), np.array(pose["t"]))


def robot_geometry(folder, name, model):
    """Collision geometry of the robot, each mesh as its convex hull."""
    urdf = (folder / f"{name}.urdf").read_text().replace(f"package://{name}/", f"{folder}/")
    geometry = pin.buildGeomFromUrdfString(model, urdf, pin.GeometryType.COLLISION)
    for item in geometry.geometryObjects:
        if isinstance(item.geometry, coal.BVHModelBase):
            item.geometry.buildConvexRepresentation(False)
            item.geometry = item.geometry.convex
    return geometry


def scene_models(folder, name, model):
    """One geometry model a scene, with the pairs that are looked at."""
    robot = robot_geometry(folder, name, model)
    links = [item.name.rsplit("_", 1)[0] for item in robot.geometryObjects]
    srdf = (folder / f"{name}.srdf").read_text()
    disabled = {frozenset(pair) for pair in re.findall(r'link1="([^"]+)" link2="([^"]+)"', srdf)}
    count = len(links)
    own = [(i, j) for i in range(count) for j in range(i + 1, count) if frozenset((links[i], links[j])) not in disabled]
    models = []
    for scene in json.loads((folder / "scenes.json").read_text()):
        geometry = robot.copy()
        for item in scene["objects"]:
            shape = coal_shape(item["shape"])
            geometry.addGeometryObject(pin.GeometryObject(item["name"], 0, 0, placement(item["pose"]), shape))
        scene_pairs = [(i, j) for i in range(count) for j in range(count, geometry.ngeoms)]
        for i, j in own + scene_pairs:
            geometry.addCollisionPair(pin.CollisionPair(i, j))
        models.append((geometry, geometry.createData()))
    return models


def lines(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def main():
    folder, name = Path(sys.argv[1]).resolve(), sys.argv[2]
    model = pin.buildModelFromUrdf(str(folder / f"{name}.urdf"))
    data, scenes = model.createData(), scene_models(folder, name, model)
    queries, truth = lines(folder / "queries.jsonl"), lines(folder / "truth.jsonl")
    states = [(*scenes[q["scene"]], np.array(q["q"]), t) for q, t in zip(queries, truth, strict=True)]

    def collides(geometry, geometry_data, positions, t):
        return pin.computeCollisions(model, data, geometry, geometry_data, positions, True) == t["in_collision"]

    def distance(geometry, geometry_data, positions, t):
        nearest = pin.computeDistances(model, data, geometry, geometry_data, positions)
        return abs(geometry_data.distanceResults[nearest].min_distance - t["min_distance"]) <= 1e-5

    print("ready", flush=True)
    for _ in sys.stdin:
        answer = {}
        for what, ask in (("verdict", collides), ("distance", distance)):
            start = time.perf_counter()
            wrong = sum(not ask(*state) for state in states)
            answer[what] = len(states) / (time.perf_counter() - start)
            answer[f"wrong_{what}s"] = wrong
        print(json.dumps(answer), flush=True)


main()
