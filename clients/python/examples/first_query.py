"""Two ellipsoids at random poses: do they collide, and how far apart are they?

    clearance serve &
    python first_query.py
"""

import argparse

import numpy as np

import clearance

arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
arguments.add_argument("--address", default=clearance.DEFAULT_ADDRESS, help="of the daemon (default: %(default)s)")

chance = np.random.default_rng()
with clearance.Client(arguments.parse_args().address) as client:
    scene = client.create_scene(f"first query {chance.integers(1 << 60)}")
    scene.apply(
        clearance.add_body("a", clearance.ellipsoid([0.5, 0.3, 0.2]), clearance.random_pose(chance)),
        clearance.add_body("b", clearance.ellipsoid([0.4, 0.4, 0.1]), clearance.random_pose(chance)),
    )
    (answer,) = scene.distance()
    print("collide?", answer.verdict.name)
    print("how far?", answer.nearest.signed_distance, "m, proved to be in", answer.nearest.bracket)
    print("where?  ", answer.nearest.point_on_a, "on a,", answer.nearest.point_on_b, "on b")
    scene.delete()
