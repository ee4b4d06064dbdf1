#!/usr/bin/python3
"""demo.launch on a screen without a monitor. `rostest demo.test picture:=FILE.png` keeps what RViz shows of the demo."""

import os
import sys
import time

import numpy as np
import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from launched import LaunchTestCase, Launched  # noqa: E402
from scene_client import wait_until  # noqa: E402
from virtual_screen import VirtualScreen, write_png  # noqa: E402


class DemoTest(LaunchTestCase):
    def test_rviz_shows_the_scene(self):
        """RViz shows parts in their colours, the depth image and the labels, and complains of nothing."""
        picture = rospy.get_param("/picture")
        arguments = [] if picture else ["request:=" + self.request]
        with VirtualScreen() as screen, Launched("demo.launch", *arguments, environment=screen.environment) as launched:
            self.first_scene()
            coloured = 0.0

            def shown():
                nonlocal coloured
                view = screen.pixels()[70:-30, 400:-30].astype(int)  # without icons; grid and bin are grey
                coloured = np.mean(view.max(axis=2) - view.min(axis=2) > 60)
                return coloured > 0.002
            try:
                wait_until(shown, 120)
            except AssertionError:
                raise AssertionError("%.2g of the view is coloured\n%s" % (coloured, launched.output()))
            if picture:
                time.sleep(15.0)  # software draws slowly
                write_png(picture, screen.pixels())
            for topic in ("/markers", "/depth/image_rect", "/labels/image_raw"):
                wait_until(lambda: "/rviz" in dict(rospy.get_master().getSystemState()[2][1]).get(topic, []), 60, topic)
            self.assertNotIn("ERROR", launched.output())


if __name__ == "__main__":
    rospy.init_node("demo_test", anonymous=True)
    rostest.rosrun("bin_scenes", "demo", DemoTest)
