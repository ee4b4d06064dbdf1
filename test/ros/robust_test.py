#!/usr/bin/python3
"""Random goals, cancels, picks, wrong requests, several clients at once, and a node that is killed. The arguments of
robust.test say how many of them; a soak prints tables of how they ended and of what the node takes."""

import collections
import os
import random
import signal
import sys
import threading
import time

import rosgraph
import rospy
import rostest
from actionlib import TerminalState

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from scene_client import CAMERA, ENDLESS, SMALL, Client, Doors, NodeTestCase, wait_until  # noqa: E402
from bin_scenes.msg import Bin, ErrorCode, PartLine, SceneRequest, Sensor  # noqa: E402

NODE = "/bin_scenes"
TYPED = (ErrorCode.NONE, ErrorCode.SET_APART, ErrorCode.INPUT, ErrorCode.ENVIRONMENT, ErrorCode.CANCELLED)


def pid_of_node():
    import xmlrpc.client
    return xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(NODE)).getPid("/test")[2]


def taken(pid):
    """(memory in MB, descriptors, threads) of a process."""
    status = open("/proc/%d/status" % pid).read()
    fields = dict(line.split(":", 1) for line in status.splitlines())
    return int(fields["VmRSS"].split()[0]) / 1000.0, len(os.listdir("/proc/%d/fd" % pid)), int(fields["Threads"])


def malformed(rng):
    """A request that is wrong in one of many ways."""
    junk = "".join(chr(rng.choice([rng.randrange(32, 127), rng.randrange(1, 0x2000)])) for _ in range(rng.randrange(200)))
    number = rng.choice([-1, 0, 1e300, float("nan"), float("inf"), -1e-300, 2 ** 31 - 1])
    part = PartLine(model="nut_hex.stl", unit="mm", count=1)
    return rng.choice([
        lambda: SceneRequest(yaml="{" + junk),
        lambda: SceneRequest(yaml="parts: " + "[" * rng.randrange(1, 5000)),
        lambda: SceneRequest(yaml="a" * 10 ** rng.randrange(7)),
        lambda: SceneRequest(file=rng.choice(["/etc/passwd", "../../../../etc/passwd", "/dev/zero", "http://127.0.0.1/a",
                                              "package://../x", junk + ".yaml", "/proc/self/mem"])),
        lambda: SceneRequest(parts=[PartLine(model=rng.choice(["/etc/passwd", "file:///etc/passwd", "package://a", "\x01" + junk,
                                                               "../" * 50 + "etc/passwd"]))]),
        lambda: SceneRequest(parts=[PartLine(model="nut_hex.stl", unit=junk or "x", count=1)]),
        lambda: SceneRequest(parts=[PartLine(model="nut_hex.stl", unit="mm", count=rng.choice([-5, 2 ** 31 - 1]))]),
        lambda: SceneRequest(parts=[PartLine(model="nut_hex.stl", unit="mm", count=1, density=rng.choice([-1.0, 1e300]))]),
        lambda: SceneRequest(parts=[part], seed=[1, 2]),
        lambda: SceneRequest(parts=[part], bin=Bin(kind=junk or "x")),
        lambda: SceneRequest(parts=[part], bin=Bin(wall_thickness=[-1.0])),
        lambda: SceneRequest(parts=[part], sensors=[Sensor(name="c", width=2 ** 31, height=2 ** 31)]),
        lambda: SceneRequest(parts=[part], sensors=[Sensor(name=junk + "/", width=10, height=10)]),
        lambda: SceneRequest(parts=[part], sensors=[Sensor(name="a-b"), Sensor(name="a_b")]),
        lambda: SceneRequest(parts=[part], solver=junk or "x"),
        lambda: SceneRequest(parts=[part], set=["pour.limit=%s" % (number if number in (-1, 0) else "x"), junk]),
        lambda: SceneRequest(parts=[part], set=["no.such.key=1"]),
        lambda: SceneRequest(),
    ])()


class RobustTest(NodeTestCase):
    @classmethod
    def setUpClass(cls):
        cls.doors = Doors()
        cls.client = Client()

    def test_random_goals_and_cancels_all_end_in_a_typed_state(self):
        rng = random.Random(1)
        ends = {}
        for i in range(rospy.get_param("/goals")):
            goal = self.client.send(rng.choice([SMALL, ENDLESS, ENDLESS, CAMERA, "parts: [{model: nowhere.stl}]"]), seed=[i])
            time.sleep(rng.choice([0, 0, 0.01, 0.1, 0.3]))
            goal.cancel()
            state, result = goal.result(60)
            self.assertIn(state, (TerminalState.SUCCEEDED, TerminalState.PREEMPTED, TerminalState.ABORTED))
            self.assertIn(result.error_code.value, TYPED)
            self.assertEqual(state == TerminalState.SUCCEEDED, result.success)
            ends[state] = ends.get(state, 0) + 1
        print("%d goals: %s" % (sum(ends.values()), ", ".join(
            "%s %d" % (TerminalState.to_string(state).lower(), count) for state, count in sorted(ends.items()))))
        self.assertGreater(ends.get(TerminalState.PREEMPTED, 0), 0)
        self.doors.scene()

    def test_malformed_requests_are_refused_with_a_reason(self):
        rng = random.Random(2)
        pid = pid_of_node()
        codes = collections.Counter()
        for _ in range(rospy.get_param("/malformed")):
            request = malformed(rng)
            response = self.doors.generate(request)
            self.assertFalse(response.success, request)
            self.assertIn(response.error_code.value, (ErrorCode.INPUT, ErrorCode.ENVIRONMENT), (request, response.message))
            self.assertGreater(len(response.message), 10)
            self.assertLess(len(response.message), 2000)
            codes["input" if response.error_code.value == ErrorCode.INPUT else "environment"] += 1
        print("%d malformed requests, refused: %s" % (sum(codes.values()), dict(codes)))
        self.assertEqual(pid_of_node(), pid)
        self.doors.scene()

    def test_three_clients_at_once_get_what_they_asked_for(self):
        wrong = []

        def work(seed):
            try:
                doors, rng = Doors(), random.Random(seed)
                for _ in range(max(2, rospy.get_param("/mixed") // 20)):
                    scene = doors.scene(seed=[seed])
                    if scene.seed != seed:
                        wrong.append((seed, scene.seed))
                    if rng.random() < 0.5:
                        doors.pick(ids=[rng.randrange(5)])  # of whoever's heap it is
            except Exception as error:  # noqa: B902
                wrong.append(error)

        threads = [threading.Thread(target=work, args=(seed,)) for seed in (1, 2, 3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(240)
        self.assertEqual(wrong, [])

    def test_mixed_work_takes_no_more_and_more(self):
        rng = random.Random(3)
        pid = pid_of_node()

        def work(count):
            for _ in range(count):
                rng.choice([
                    lambda: self.doors.generate(SceneRequest(yaml=CAMERA, render=True)),
                    lambda: self.doors.generate(malformed(rng)),
                    lambda: self.doors.pick(ids=[rng.randrange(5)]),
                    lambda: self.doors.clear(),
                    lambda: self.client.send(ENDLESS).cancel(),
                ])()
            wait_until(lambda: self.doors.clear().success, 30)

        count = rospy.get_param("/mixed")
        work(max(10, count // 4))  # what is taken once
        before = taken(pid)
        print("requests  memory (MB)  descriptors  threads")
        for share in range(5):
            after = taken(pid)
            print("%8d  %11.1f  %11d  %7d" % ((count * share // 4,) + after))
            if share < 4:
                work(count // 4)
        allocators_share = 0 if count >= 1000 else 30  # MB that a short run has not touched before
        self.assertLess(after[0], 1.05 * before[0] + allocators_share)
        self.assertLessEqual(after[1], before[1] + 3)
        self.assertLessEqual(after[2], before[2] + 1)

    def test_z_a_node_that_was_killed_serves_again(self):
        pid = pid_of_node()
        os.kill(pid, signal.SIGKILL)

        def answers():
            try:
                return pid_of_node() != pid and self.doors.generate(SceneRequest(yaml=SMALL)).success
            except (rospy.ServiceException, rosgraph.MasterException, OSError, rospy.ROSException):
                return False
        wait_until(answers, 60)
        self.assertEqual(len(self.doors.latched().parts), 5)


if __name__ == "__main__":
    rospy.init_node("robust_test", anonymous=True)
    rostest.rosrun("bin_scenes", "robust", RobustTest)
