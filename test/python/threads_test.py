#!/usr/bin/python3
"""The Python module among threads, signals and processes: who waits, who is refused, what ends."""
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

from python_scenes import PACKAGES, TOOL, endless, nuts

from bin_scenes import Error, Generator

LONG = 60.0  # s: no test waits so long for what works
HERE = os.path.dirname(os.path.abspath(__file__))


def later(seconds, call):
    timer = threading.Timer(seconds, call)
    timer.daemon = True
    timer.start()
    return timer


def wait_for(condition):
    end = time.monotonic() + LONG
    while not condition():
        if time.monotonic() > end:
            raise AssertionError("nothing happened for %d s" % LONG)
        time.sleep(0.005)


def script(code, **how):
    """Another Python with the same two arguments; `code` finds what python_scenes has."""
    return subprocess.Popen([sys.executable, "-c", "from python_scenes import *\nfrom bin_scenes import *\n" + code, PACKAGES,
                             TOOL], cwd=HERE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **how)


class Waiting(unittest.TestCase):
    def test_other_threads_go_on(self):
        """The interpreter's lock is released: this loop counts while a call computes."""
        counted, done = 0, threading.Event()
        with Generator() as g:
            heap = g.heap(endless())
            thread = threading.Thread(target=lambda: (self.assertRaises(Error, heap.settle), done.set()))
            thread.start()
            for _ in range(1000):
                counted += 1
                time.sleep(0)
            self.assertFalse(done.is_set())
        thread.join(LONG)
        self.assertTrue(done.is_set())  # close() ended it
        self.assertEqual(counted, 1000)

    def interrupted(self, call):
        """KeyboardInterrupt comes out of the call, although what it waits for has no end."""
        timer = later(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
        with self.assertRaises(KeyboardInterrupt):
            call()
        timer.join()

    def test_ctrl_c_ends_a_loop_and_the_generator_lives_on(self):
        with Generator() as g:
            scenes = g.generate(endless(), scenes=10, prefetch=2)
            self.interrupted(lambda: next(scenes))
            self.assertEqual(list(scenes), [])
            self.assertTrue(next(g.generate(nuts(3))).at_rest)

    def test_ctrl_c_ends_a_heap_and_it_can_be_settled_further(self):
        with Generator() as g:
            heap = g.heap(endless())
            self.interrupted(heap.settle)
            self.assertEqual(len(heap.scene(images=False).ids), 400)

    def test_ctrl_c_ends_the_program(self):
        child = script("print('on', flush=True)\nwith Generator() as g:\n  for s in g.generate(endless()): pass\n")
        child.stdout.readline()
        time.sleep(0.5)
        child.send_signal(signal.SIGINT)
        begin = time.monotonic()
        _, errors = child.communicate(timeout=LONG)
        print("Ctrl-C to the end of the program: %.2f s" % (time.monotonic() - begin))
        self.assertEqual(child.returncode, -signal.SIGINT, errors)
        self.assertIn("KeyboardInterrupt", errors)

    def test_the_interpreter_ends_with_scenes_in_the_making(self):
        child = script("g = Generator()\nkept = g.generate(endless(), scenes=9, prefetch=3)\nheap = Generator().heap(nuts(3))\n")
        _, errors = child.communicate(timeout=LONG)
        self.assertEqual((child.returncode, errors), (0, ""))


class Ahead(unittest.TestCase):
    def test_as_many_as_asked_for_are_made_ahead(self):
        with Generator() as g:
            scenes = g.generate(nuts(3), scenes=8, prefetch=3)
            self.assertEqual(next(scenes).index, 0)
            wait_for(lambda: scenes.ready == 3)
            time.sleep(0.2)
            self.assertEqual(scenes.ready, 3)
            self.assertEqual([s.index for s in scenes], [1, 2, 3, 4, 5, 6, 7])

    def test_none_without_prefetch(self):
        with Generator() as g:
            scenes = g.generate(nuts(3), scenes=4)
            next(scenes)
            time.sleep(0.5)
            self.assertEqual(scenes.ready, 0)

    def test_leaving_the_loop_stops_it(self):
        """The generator is free again at once, although the request goes on without end."""
        with Generator() as g:
            for scene in g.generate(nuts(3), scenes=10**9, prefetch=4):
                if scene.index == 2:
                    break
            self.assertEqual(next(g.generate(nuts(3))).index, 0)

    def test_what_was_made_before_an_error_comes_first(self):
        """A queue ends with its error, once; here with that of close()."""
        g = Generator()
        scenes = g.generate(nuts(3), scenes=3, prefetch=3)
        wait_for(lambda: scenes.ready == 3)
        self.assertEqual(len(list(scenes)), 3)
        self.assertEqual(list(scenes), [])
        g.close()
        with self.assertRaisesRegex(Error, "closed"):
            next(scenes)


class Together(unittest.TestCase):
    def refused(self, call, what):
        with self.assertRaises(Error) as caught:
            call()
        self.assertIn(what, caught.exception.what)
        self.assertTrue(caught.exception.where and caught.exception.remedy)

    def test_a_generator_serves_one_caller(self):
        with Generator() as g:
            heap = g.heap(nuts(2))
            scenes, refused = g.generate(endless()), []

            def other():
                for call in (heap.settle, heap.scene, lambda: heap.remove([1]), lambda: g.heap(nuts()), lambda: g.generate(nuts())):
                    self.refused(call, "in use")
                    refused.append(call)
            thread = threading.Thread(target=other)
            thread.start()
            thread.join(LONG)
            self.assertEqual(len(refused), 5)
            scenes.close()
            self.assertTrue(heap.settle())

    def test_two_threads_ask_one_loop(self):
        with Generator() as g:
            scenes = g.generate(endless())
            thread = threading.Thread(target=lambda: self.assertRaises(Error, lambda: next(scenes)))
            thread.start()
            time.sleep(0.5)
            self.refused(lambda: next(scenes), "another thread")
            g.close()
            thread.join(LONG)

    def test_a_loop_within_a_loop_takes_a_second_generator(self):
        with Generator() as g, Generator() as other:
            for scene in g.generate(nuts(2), scenes=2):
                self.refused(lambda: g.heap(nuts(2)), "in use")
                self.assertEqual([s.index for s in other.generate(nuts(2), scenes=2)], [0, 1])
            g.heap(nuts(2)).settle()

    def test_after_a_fork(self):
        """The child is told, and ends without waiting for threads that it does not have."""
        child = script("""
import os
g = Generator()
heap, scenes = g.heap(nuts(2)), g.generate(nuts(2), scenes=5, prefetch=1)
next(scenes)
if os.fork() == 0:
    for call in (heap.settle, lambda: next(scenes), lambda: g.generate(nuts()), Generator):
        try:
            call()
        except Error as error:
            print(error.where, "|", error.what, flush=True)
    del heap, scenes, g
    raise SystemExit(0)
print("child:", os.wait()[1])
scenes.close()
print("parent:", heap.settle())
""")
        out, errors = child.communicate(timeout=LONG)
        self.assertEqual((child.returncode, errors), (0, ""))
        lines = out.splitlines()
        self.assertEqual([line.split(" | ")[0] for line in lines[:4]], ["Heap.settle", "Generator.generate", "Generator", "Generator"])
        self.assertTrue(all("process" in line for line in lines[:4]), out)
        self.assertEqual(lines[4:], ["child: 0", "parent: True"])


if __name__ == "__main__":
    unittest.main()
