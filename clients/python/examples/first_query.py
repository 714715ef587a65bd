"""A robot in a cell: which of its states are free, how near is the nearest, and what does the daemon say of a mistake?

    clearance serve &
    python first_query.py [ADDRESS [FOLDER]]

FOLDER holds a robot's `ur5.urdf`, `ur5.srdf` and meshes. The examples of all clients print the same text.
"""

import os
import sys
from pathlib import Path

import clearance

UR5 = Path(__file__).resolve().parents[3] / "tests" / "data" / "robot-ur5"

# Joint positions, radians.
STATES = [
    [-1.6, -0.6, 0.0, -1.57, -1.57, 3.14],
    [-1.2, -0.6, 0.0, -1.57, -1.57, 3.14],
    [0.4, -0.3, 0.2, -1.57, -1.57, 3.14],
]


def main(address: str, folder: Path) -> None:
    with clearance.Client(address) as client:
        robot = client.load_robot(folder / "ur5.urdf", folder / "ur5.srdf")
        print(f"robot {robot.name}: {robot.degrees_of_freedom} numbers a state, {len(robot.links)} links")
        scene = client.create_scene(f"first query {os.getpid()}")
        try:
            ask(scene, robot)
        finally:
            scene.delete()


def ask(scene: clearance.Scene, robot: clearance.Robot) -> None:
    applied = scene.apply(
        clearance.add_robot("arm", robot),
        clearance.add_body("table", clearance.box([1.0, 1.0, 0.02]), clearance.pose([0.0, 0.0, 0.7])),
        clearance.add_body("post", clearance.capsule(0.05, 0.3), clearance.pose([0.5, 0.3, 1.2])),
        clearance.add_body("ball", clearance.ellipsoid([0.3, 0.2, 0.1]), clearance.pose([0.2, 0.8, 1.3], [0.8, 0.2, 0.4, 0.4])),
    )
    names = dict(zip(applied.added, ["table", "post", "ball"]))
    print("the scene is at revision", applied.revision)

    # A batch of states: verdicts and proved brackets as arrays.
    states = scene.check_states("arm", STATES, want="depth", at_least=applied.revision)
    for i, verdict in enumerate(states.verdicts):
        nearest = bracket(states.nearest_scene.lower[i], states.nearest_scene.upper[i])
        print(f"state {i}: {clearance.Verdict(verdict).name}, to the scene {nearest}")
    print(int(states.free.sum()), "are free")

    # A state with everything there is to know.
    (state,) = scene.look_at_states("arm", STATES[1:2])
    for pair in state.pairs:
        print(f"state 1: {robot.links[pair.a.id]} and {names[pair.b.id]}, {pair.verdict.name}")

    # Bodies.
    (apart,) = scene.distance("ball")
    pair = apart.nearest
    print(f"{names[pair.a.id]} and {names[pair.b.id]}: {bracket(pair.bracket.lower, pair.bracket.upper)}")
    print(f"from {point(pair.point_on_a)} to {point(pair.point_on_b)}")

    # An edit, and a question that sees it.
    applied = scene.apply(clearance.move_body("ball", clearance.pose([0.5, 0.3, 1.6])))
    (touching,) = scene.collide("ball", at_least=applied.revision)
    pairs = ", ".join(f"{names[pair.a.id]} and {names[pair.b.id]}" for pair in touching.pairs)
    print(f"at revision {applied.revision} {touching.verdict.name}: {pairs}")

    try:
        flag = clearance.add_body("flag", clearance.box([1.0, -1.0, 0.1]))
        scene.apply(clearance.move_body("table", clearance.pose([0.0, 0.0, 0.6])), flag)
    except clearance.InvalidRequest as error:
        print(f"refused: {error.reason}, item {error.item}, field {error.field}")


def bracket(lower: float, upper: float) -> str:
    """Enough digits to see both ends; `+ 0.0` takes the sign off zero."""
    return f"[{lower + 0.0:.17f}, {upper + 0.0:.17f}] m"


def point(p) -> str:
    return "(" + ", ".join(f"{x + 0.0:.9f}" for x in p) + ")"


if __name__ == "__main__":
    main(
        sys.argv[1] if len(sys.argv) > 1 else clearance.DEFAULT_ADDRESS,
        Path(sys.argv[2]) if len(sys.argv) > 2 else UR5,
    )
