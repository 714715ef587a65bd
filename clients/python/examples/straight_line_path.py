"""Checks a robot's straight-line path between two joint vectors and prints where it is first blocked.

    clearance serve &
    python straight_line_path.py

A UR5 stands over a table, beside a post. States are checked at steps along the path; what lies between two steps is not
looked at.
"""

import argparse
from pathlib import Path

import numpy as np

import clearance

UR5 = Path(__file__).resolve().parents[3] / "tests" / "data" / "robot-ur5"
STEPS = 1000


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--address", default=clearance.DEFAULT_ADDRESS, help="of the daemon (default: %(default)s)")
    arguments.add_argument("--urdf", default=UR5 / "ur5.urdf")
    arguments.add_argument("--srdf", default=UR5 / "ur5.srdf")
    arguments.add_argument("--start", type=numbers, default="1.57 -0.6 0 -1.57 -1.57 3.14", help="(default: %(default)s)")
    arguments.add_argument("--goal", type=numbers, default="-1.57 -0.6 0 -1.57 -1.57 3.14", help="(default: %(default)s)")
    given = arguments.parse_args()
    with clearance.Client(given.address) as client:
        robot = client.load_robot(given.urdf, given.srdf)
        scene = client.create_scene(f"straight line path {np.random.default_rng().integers(1 << 60)}")
        try:
            applied = scene.apply(
                clearance.add_robot("arm", robot),
                clearance.add_body("table", clearance.box([1.0, 1.0, 0.02]), clearance.pose([0.0, 0.0, 0.85])),
                clearance.add_body("post", clearance.capsule(0.05, 0.3), clearance.pose([0.5, 0.3, 1.2])),
            )
            bodies = dict(zip(applied.added, ["table", "post"]))
            report(scene, robot, bodies, given.start, given.goal)
        finally:
            scene.delete()


def report(scene, robot, bodies, start, goal) -> None:
    along = np.linspace(0.0, 1.0, STEPS)[:, None]
    path = (1.0 - along) * start + along * goal
    answer = scene.check_states("arm", path, want="verdict", stop_at_first=True)
    if answer.stopped_at is None:
        nearest = scene.check_states("arm", path).lower
        closest = int(np.argmin(nearest))
        print(f"free at all {STEPS} steps; nearest at step {closest}, {nearest[closest]:.6f} m or more")
        return
    blocked = answer.stopped_at
    (state,) = scene.look_at_states("arm", path[blocked : blocked + 1])
    print(f"blocked at step {blocked} of {STEPS}, {100 * along[blocked, 0]:.1f} % of the way: {state.verdict.name}")
    print("joint positions:", np.array2string(path[blocked], precision=4))
    for pair in state.pairs:
        print(f"  {name(pair.a, robot, bodies)} and {name(pair.b, robot, bodies)}: {pair.signed_distance:.6f} m")


def name(side, robot, bodies) -> str:
    if side.kind == "link":
        return robot.links[side.id]
    return bodies[side.id]


def numbers(text: str) -> np.ndarray:
    return np.array([float(word) for word in text.split()])


if __name__ == "__main__":
    main()
