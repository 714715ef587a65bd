"""Contacts that are watched, and pairs changed since a revision."""

import threading

import clearance
from clearance import ContactKind, ContactState

from .daemon import DaemonTest


class Contacts(DaemonTest):
    def balls(self, *centres: float) -> tuple[int, ...]:
        add = (clearance.add_body(f"{i}", clearance.sphere(0.5), clearance.pose([x, 0, 0])) for i, x in enumerate(centres))
        return self.scene.apply(*add).added

    def test_contacts_begin_stay_and_end(self) -> None:
        a, b, c = self.balls(0.0, 0.9, 5.0)
        with self.scene.watch_contacts(stays=True, want="witness") as watch:
            first = next(watch)
            self.assertEqual((first.from_revision, first.revision, first.contacts), (None, 1, 1))
            (event,) = first.events
            self.assertEqual((event.a, event.b, event.kind, event.before), (a, b, ContactKind.BEGIN, ContactState.APART))
            self.assertAlmostEqual(event.pair.signed_distance, -0.1, places=9)
            self.scene.apply(clearance.move_body("2", clearance.pose([1.8, 0, 0])))
            second = next(watch)
            kinds = [(event.a, event.b, event.kind) for event in second.events]
            self.assertEqual(kinds, [(a, b, ContactKind.STAY), (b, c, ContactKind.BEGIN)])
            self.scene.apply(clearance.remove_body("0"))
            third = next(watch)
            self.assertEqual([(event.kind, event.reason) for event in third.events], [
                (ContactKind.END, "REMOVED"),
                (ContactKind.STAY, None),
            ])
            self.assertEqual((third.from_revision, third.revision), (2, 3))

    def test_a_margin_counts_where_it_is_given(self) -> None:
        self.balls(0.0, 1.1)
        with self.scene.watch_contacts() as touching, self.scene.watch_contacts(margin=0.2) as near:
            self.assertEqual((next(touching).contacts, next(near).contacts), (0, 1))

    def test_a_watch_that_is_closed_ends_the_iteration(self) -> None:
        self.balls(0.0)
        watch = self.scene.watch_contacts()
        threading.Timer(0.2, watch.close).start()
        self.assertEqual([step.revision for step in watch], [1])

    def test_a_deleted_scene_is_an_error(self) -> None:
        scene = self.client.create_scene("for a moment")
        watch = scene.watch_contacts()
        next(watch)
        scene.delete()
        with self.assertRaises(clearance.NotFound):
            next(watch)

    def test_a_timeout_is_an_error(self) -> None:
        with self.assertRaises(clearance.DeadlineExceeded):
            list(self.scene.watch_contacts(timeout=0.3))

    def test_bad_margins_are_refused_by_name(self) -> None:
        with self.assertRaises(clearance.InvalidRequest) as caught:
            next(self.scene.watch_contacts(margin=-1.0))
        self.assertEqual(caught.exception.field, "context.margin")

    def test_changed_pairs(self) -> None:
        a, b, c, d = self.balls(0.0, 0.9, 5.0, 5.9)
        moved = self.scene.apply(clearance.move_body("1", clearance.pose([0.8, 0, 0])))
        since = clearance.changed_since(moved.revision - 1)
        (changed,) = self.scene.collide(since)
        self.assertEqual([(pair.a.id, pair.b.id) for pair in changed.pairs], [(a, b)])
        (nothing,) = self.scene.distance(clearance.changed_since(moved.revision))
        self.assertIsNone(nothing.nearest)
        with self.assertRaises(clearance.InvalidRequest) as caught:
            self.scene.collide(clearance.changed_since(99))
        self.assertEqual(caught.exception.field, "items[0].changed_since")
