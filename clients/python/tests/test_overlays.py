"""What-if questions: as if edits had been applied, and nobody is told."""

import math
import tempfile
from pathlib import Path

import numpy as np

import clearance
from clearance import Verdict, WhatIf

from .daemon import DaemonTest

#: A rod of 1 m that turns about z, with a ball at its end that a slide moves along z.
CRANE = """<robot name="crane">
  <link name="foot"/>
  <link name="boom"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="hook"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="foot"/><child link="boom"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
  <joint name="lower" type="prismatic"><parent link="boom"/><child link="hook"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="0" velocity="1" effort="1"/></joint>
</robot>"""


class Overlays(DaemonTest):
    def test_an_overlay_is_answered_as_if_it_were_applied(self) -> None:
        ball, at = clearance.sphere(0.5), clearance.pose
        self.scene.apply(clearance.add_body("a", ball, at([0, 0, 0])), clearance.add_body("b", ball, at([2, 0, 0])))
        edits = [clearance.move_body("b", at([1.5, 0, 0])), clearance.add_body("c", ball, at([0.9, 0, 0]))]
        what_if = WhatIf(clearance.overlay(*edits))
        supposed = self.scene.distance("a", "c", what_if=what_if)
        self.assertEqual(supposed.added, {(0, 3): "c"})
        with self.assertRaises(clearance.NotFound):
            self.scene.distance("c")
        self.scene.apply(*edits)
        applied = self.scene.distance("a", "c")
        self.assertEqual([item.nearest.bracket for item in supposed], [item.nearest.bracket for item in applied])
        self.assertEqual(applied.added, {})

    def test_items_have_alternatives(self) -> None:
        self.scene.apply(clearance.add_body("a", clearance.sphere(0.5)))
        near = clearance.overlay(clearance.add_body("n", clearance.sphere(0.5), clearance.pose([0.9, 0, 0])))
        far = clearance.overlay(clearance.add_body("n", clearance.sphere(0.5), clearance.pose([9, 0, 0])))
        answers = self.scene.collide("a", "a", "a", what_if=WhatIf(alternatives=[near, far], of_items=[0, 1, 2]))
        self.assertEqual([item.verdict for item in answers], [Verdict.FREE, Verdict.COLLISION, Verdict.FREE])
        with self.assertRaises(clearance.InvalidRequest) as caught:
            self.scene.collide("a", what_if=WhatIf(alternatives=[near], of_items=[2]))
        self.assertEqual(caught.exception.field, "context.item_alternatives[0]")
        with self.assertRaises(clearance.Conflict) as refused:
            self.scene.collide("a", what_if=WhatIf(clearance.overlay(clearance.remove_body("z"))))
        self.assertEqual(refused.exception.field, "context.overlay.edits[0].body")

    def test_a_robot_holds_a_body(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            urdf = Path(folder) / "crane.urdf"
            urdf.write_text(CRANE)
            crane = self.client.load_robot(urdf)
        self.scene.apply(
            clearance.add_robot("arm", crane),
            clearance.add_body("rod", clearance.box([0.5, 0.02, 0.02]), clearance.pose([9, 0, 0])),
            clearance.add_body("post", clearance.box([0.1, 0.1, 2]), clearance.pose([0, 1.5, 0])),
        )
        rod = clearance.attach("rod", "arm", "hook", clearance.pose([0.55, 0, 0]))
        holding = WhatIf(clearance.overlay(attached=[rod]))
        states = np.array([[math.pi / 2, -0.5], [0.0, -0.5]])
        empty = self.scene.check_states("arm", states)
        full = self.scene.check_states("arm", states, what_if=holding)
        self.assertEqual(empty.verdicts.tolist(), [Verdict.FREE, Verdict.FREE])
        self.assertEqual(full.verdicts.tolist(), [Verdict.COLLISION, Verdict.FREE])
        motion = self.scene.check_motions("arm", states[1:], states[:1], what_if=holding)
        self.assertEqual(motion.verdicts.tolist(), [Verdict.COLLISION])
        (state,) = self.scene.look_at_states("arm", states[:1], what_if=holding)
        self.assertEqual([(pair.a.kind, pair.a.id, pair.b.id) for pair in state.pairs], [("body", 1, 2)])
