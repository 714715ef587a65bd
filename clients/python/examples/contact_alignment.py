"""Moves bodies until they touch where they should, following derivatives of their nearest points: which derivatives get there?

    clearance serve &
    python contact_alignment.py [--shapes ellipsoids|hulls] [--starts 100]

The example of J. Carpentier's and L. Montaut's lecture. A is fixed, B at a place T; x1(T) and x2(T) are their nearest points, and

    |x1(T) - t1|^2 + |x2(T) - T t2|^2 + |x1(T) - x2(T)|^2

is made small by Levenberg's and Marquardt's method, from many starts at once: every step is one batch of questions.
"""

import argparse
import time

import numpy as np

import clearance

METHODS = ["exact", "finite_difference", "smoothed_0", "smoothed_1_gaussian", "smoothed_1_gumbel"]
#: Samples there and back of the random ones.
SAMPLES = {"smoothed_0": 12, "smoothed_1_gaussian": 32}
#: Residuals below this part of the size are no error any more.
REACHED = 1e-3
#: A step is no longer than this part of the size.
LONGEST = 1.0
#: A step helps if the cost is below one of so many before it: what leaps from feature to feature does not fall from step to step.
MEMORY = 5


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--address", default=clearance.DEFAULT_ADDRESS, help="of the daemon (default: %(default)s)")
    arguments.add_argument("--shapes", choices=["ellipsoids", "hulls"], default="hulls", help="(default: %(default)s)")
    arguments.add_argument("--starts", type=int, default=100, help="places to start from (default: %(default)s)")
    arguments.add_argument("--steps", type=int, default=150, help="batches at most (default: %(default)s)")
    given = arguments.parse_args()
    random = np.random.default_rng(7)
    with clearance.Client(given.address) as client:
        scene = client.create_scene(f"contact alignment {random.integers(1 << 60)}-{time.time_ns()}")
        try:
            a, b = shape(given.shapes, random), shape(given.shapes, random)
            scene.apply(clearance.add_body("a", a))
            targets = [contact(scene, b, random) for _ in range(given.starts)]
            starts = [(unit(random) * 3.0, turn(random)) for _ in range(given.starts)]
            print(f"{given.shapes}: from {given.starts} starts")
            for method in METHODS:
                begun = time.perf_counter()
                reached, separations = follow(scene, b, targets, starts, method, given.steps)
                seconds = time.perf_counter() - begun
                print(f"{method:22} reached {reached:4} of {given.starts}, {separations} separations, {seconds:.2f} s")
        finally:
            scene.delete()


def follow(scene, b, targets, starts, method, steps) -> tuple[int, int]:
    """How many starts reach their target, and what was asked of pairs on the way."""
    places = [(np.array(at), np.array(q)) for at, q in starts]
    damping, epsilon = np.full(len(places), 1e-3), 0.3
    costs = [[] for _ in places]
    separations = 0
    here = None
    for step in range(steps):
        how = clearance.derivatives(method, epsilon=epsilon, samples=SAMPLES.get(method), seed=step)
        pairs, asked = look(scene, b, places, how)
        separations += asked
        here = [residuals(pair, place, target) for pair, place, target in zip(pairs, places, targets)]
        left = [i for i, r in enumerate(here) if not is_reached(r)]
        if not left:
            break
        # One step each, tried where it leads; what does not help is damped more.
        moves = [newton(pairs[i], places[i], here[i], targets[i], damping[i]) for i in left]
        tried = [moved(places[i], move) for i, move in zip(left, moves)]
        after, asked = look(scene, b, tried, None)
        separations += asked
        for i, place, pair in zip(left, tried, after):
            costs[i] = [*costs[i], np.sum(here[i] ** 2)][-MEMORY:]
            helps = np.sum(residuals(pair, place, targets[i]) ** 2) < max(costs[i])
            damping[i] = max(0.3 * damping[i], 1e-9) if helps else 4.0 * damping[i]
            if damping[i] > 1e2:
                damping[i] = 1e-3  # Less smoothing, or other samples, may say something else.
            if helps:
                places[i] = place
        epsilon = max(0.98 * epsilon, 1e-3)
    return sum(is_reached(r) for r in here), separations


def look(scene, b, places, how):
    """The nearest pair of B in each place and A. A bare shape of a question is side A of its pairs: here it is B."""
    subjects = [(b, clearance.pose(at, q)) for at, q in places]
    answer = scene.distance(*subjects, want="witness", derivatives=how)
    again = sum(item.cost.derivative_separations for item in answer)
    return [item.nearest for item in answer], len(places) + again


def residuals(pair, place, target) -> np.ndarray:
    on_a, on_b = target
    x1, x2 = pair.point_on_b, pair.point_on_a
    at, q = place
    return np.concatenate([x1 - on_a, x2 - (at + rotation(q) @ on_b), x1 - x2])


def is_reached(r) -> bool:
    return max(np.linalg.norm(part) for part in r.reshape(3, 3)) < REACHED


def newton(pair, place, r, target, damping) -> np.ndarray:
    """A twist of B about its origin, from how both nearest points change with it."""
    of_b = pair.derivatives.of_a
    d1, d2 = of_b.point_on_b, of_b.point_on_a
    arm = rotation(place[1]) @ target[1]
    wanted = np.hstack([np.eye(3), -cross(arm)])
    jacobian = np.vstack([d1, d2 - wanted, d1 - d2])
    square = jacobian.T @ jacobian
    step = -np.linalg.solve(square + damping * max(square.max(), 1e-12) * np.eye(6), jacobian.T @ r)
    return step * min(1.0, LONGEST / max(np.linalg.norm(step), 1e-12))


def moved(place, twist):
    at, q = place
    v, w = twist[:3], twist[3:]
    half = 0.5 * np.linalg.norm(w)
    small = np.concatenate([[np.cos(half)], 0.5 * w * np.sinc(half / np.pi)])
    return at + v, product(small, q)


def contact(scene, b, random):
    """Where B touches A in one point when it comes from somewhere: a target that can be reached; in the world, and in B's frame."""
    at, q = unit(random) * 4.0, turn(random)
    for _ in range(60):
        (pair,), _ = look(scene, b, [(at, q)], clearance.derivatives("exact"))
        if abs(pair.signed_distance) < 1e-9:
            break
        at = at + pair.normal * pair.signed_distance
    return pair.point_on_b, rotation(q).T @ (pair.point_on_a - at)


def shape(kind, random):
    radii = random.uniform(0.4, 1.0, 3)
    if kind == "ellipsoids":
        return clearance.ellipsoid(radii)
    points = random.normal(size=(20, 3))
    return clearance.convex(points / np.linalg.norm(points, axis=1, keepdims=True) * radii)


def unit(random) -> np.ndarray:
    v = random.normal(size=3)
    return v / np.linalg.norm(v)


def turn(random) -> np.ndarray:
    q = random.normal(size=4)
    return q / np.linalg.norm(q)


def cross(v) -> np.ndarray:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def rotation(q) -> np.ndarray:
    w, v = q[0], q[1:]
    return np.eye(3) + 2.0 * (w * cross(v) + cross(v) @ cross(v)) / (q @ q)


def product(p, q) -> np.ndarray:
    return np.concatenate([[p[0] * q[0] - p[1:] @ q[1:]], p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:])])


if __name__ == "__main__":
    main()
