"""Checks a robot's straight-line path between two joint vectors and prints where it is first blocked.

    clearance serve &
    python straight_line_path.py

A UR5 stands over a table, beside a post. The path is proved free all along, or its first contact is bracketed.
"""

import argparse
from pathlib import Path

import numpy as np

import clearance

UR5 = Path(__file__).resolve().parents[3] / "tests" / "data" / "robot-ur5"


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
    answer = scene.check_motions("arm", [start], [goal])
    verdict, states = clearance.Verdict(answer.verdicts[0]), int(answer.states[0])
    if verdict == clearance.Verdict.FREE:
        print(f"free all the way, proved by {states} states")
        return
    print(f"{verdict.name} after {states} states; free at least up to {100 * answer.free_until[0]:.3f} % of the way")
    if verdict != clearance.Verdict.COLLISION:
        return
    first, last = answer.reached[0]
    print(f"first contact between {100 * first:.3f} % and {100 * last:.3f} %")
    contact = clearance.along(start, goal, last)
    print("joint positions:", np.array2string(contact, precision=4))
    (state,) = scene.look_at_states("arm", [contact])
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
