"""Simulations run from Python: the same as the program's, seen frame by frame, stopped and resumed."""
import os
import signal
import threading
import time
import unittest

import h5py
import numpy

import jamscope
import read_run
from support import SCRATCH, SHORT, simulate, simulate_by_program, small_case


def data_sets(path):
    """All data sets of a run but the command line, and the attributes that do not say when."""
    found = {}
    with h5py.File(path, "r", swmr=True) as file:
        def visit(name, item):
            for key, value in item.attrs.items():
                found[f"{name}@{key}"] = numpy.asarray(value)
            if isinstance(item, h5py.Dataset) and name != "case/argv":
                found[name] = item[()]

        file.visititems(visit)
    return found


class Simulate(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        simulate_by_program(SCRATCH / "program")

    def assert_same_run(self, one, other):
        ours, theirs = data_sets(one / "run.h5"), data_sets(other / "run.h5")
        self.assertEqual(set(ours), set(theirs))
        for name, values in ours.items():
            self.assertEqual(values.tobytes() if hasattr(values, "tobytes") else values, theirs[name].tobytes() if hasattr(values, "tobytes") else theirs[name], name)

    def test_the_same_bytes_as_the_program_whatever_the_threads_and_the_callback(self):
        frames = []
        done = simulate(SCRATCH / "python", frames.append, threads=2)
        self.assertTrue(done.finished)
        self.assertAlmostEqual(done.time, 0.5e-3, 12)
        self.assert_same_run(SCRATCH / "python", SCRATCH / "program")
        for name in ("events.csv", "jams.csv"):
            self.assertEqual((SCRATCH / "python" / name).read_text(), (SCRATCH / "program" / name).read_text())
        self.assertEqual(done.analysis.events_csv(), (SCRATCH / "program" / "events.csv").read_text())
        self.assertGreater(len(done.analysis.step_jams["particle"]), 0)
        # What the callback saw is what is stored, and stays so after the run.
        stored = jamscope.open(SCRATCH / "program" / "run.h5")
        self.assertEqual(len(stored), 6)
        self.assertEqual([f.number for f in frames], list(range(6)))
        for live, frame in zip(frames, stored):
            self.assertEqual((live.time, live.step), (frame.time, frame.step))
            for table in ("particles", "contacts", "wall_contacts"):
                ours, theirs = getattr(live, table).columns(), getattr(frame, table).columns()
                self.assertEqual(set(ours), set(theirs))
                for column in ours:
                    numpy.testing.assert_array_equal(ours[column], theirs[column], f"{table}.{column}")
            self.assertEqual(live.metric("coordination"), frame.metric("coordination"))
            numpy.testing.assert_array_equal(live.walls["blade"].force, frame.walls["blade"].force)

    def test_false_stops_it_and_resume_goes_on_to_the_same_bytes(self):
        seen = []

        def two(frame):
            seen.append(frame.number)
            return frame.number < 1

        stopped = simulate(SCRATCH / "stopped", two)
        self.assertFalse(stopped.finished)
        self.assertEqual(seen, [0, 1])
        self.assertEqual(len(jamscope.open(SCRATCH / "stopped" / "run.h5")), 2)
        self.assertEqual(len(jamscope.read_results(SCRATCH / "stopped").frames), 2)
        rest = simulate(SCRATCH / "stopped", lambda frame: seen.append(frame.number), resume=True)
        self.assertTrue(rest.finished)
        self.assertEqual(seen, [0, 1, 2, 3, 4, 5])
        self.assertEqual((SCRATCH / "stopped" / "events.csv").read_text(), (SCRATCH / "program" / "events.csv").read_text())
        one, other = (jamscope.open(SCRATCH / name / "run.h5")[-1] for name in ("stopped", "program"))
        self.assertEqual(one.particles.position.tobytes(), other.particles.position.tobytes())
        self.assertEqual(one.contacts.tangential_force.tobytes(), other.contacts.tangential_force.tobytes())

    def test_exceptions_of_the_callback_come_out_and_leave_a_sound_folder(self):
        class Mine(Exception):
            pass

        for at in (0, 3, 5):
            def fail(frame):
                if frame.number == at:
                    raise Mine(f"at frame {at}")

            output = SCRATCH / f"failed{at}"
            with self.assertRaisesRegex(Mine, f"at frame {at}"):
                simulate(output, fail)
            self.assertEqual(len(jamscope.open(output / "run.h5")), at + 1)
            self.assertEqual(len(jamscope.read_results(output).frames), at + 1)
        self.assertTrue(simulate(SCRATCH / "failed3", resume=True).finished)

    def test_the_callback_may_read_the_file(self):
        output, counts = SCRATCH / "read_meanwhile", []

        def read(frame):
            with read_run.open_run(output / "run.h5") as file:
                position = read_run.read_frame(file, -1)["particles"]["position"]
                run = jamscope.open(output / "run.h5")
                counts.append((read_run.frame_count(file), len(run), bool((position == frame.particles.position).all() and (position == run[-1].particles.position).all())))

        simulate(output, read, until=0.2e-3)
        self.assertEqual(counts, [(k, k, True) for k in (1, 2, 3)])

    def test_until(self):
        self.assertAlmostEqual(simulate(SCRATCH / "until", until=0.2e-3).time, 0.2e-3, 12)
        self.assertAlmostEqual(simulate(SCRATCH / "until", until="0.3 ms", resume=True).time, 0.3e-3, 12)
        with self.assertRaises(jamscope.UsageError):
            simulate(SCRATCH / "never", until="3 mm")

    def interrupt_during(self, output, ready, **options):
        """Sends Ctrl-C when ready() is true; returns how long it took from there, s."""
        sent = []
        over = threading.Event()

        def send():
            while not ready():
                if over.wait(0.002):
                    return
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        watcher = threading.Thread(target=send)
        watcher.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                simulate(output, set={**SHORT, "run.duration": "40 ms"}, **options)
            return time.monotonic() - sent[0]
        finally:
            over.set()
            watcher.join()

    def test_ctrl_c_while_it_steps(self):
        frames = []
        took = self.interrupt_during(SCRATCH / "interrupted", lambda: len(frames) > 2, callback=frames.append)
        self.assertLess(took, 30)
        run = jamscope.open(SCRATCH / "interrupted" / "run.h5")
        self.assertGreater(len(run), 2)
        self.assertTrue((SCRATCH / "interrupted" / "run.restart.h5").exists())
        self.assertEqual(len(jamscope.read_results(SCRATCH / "interrupted").frames), len(run))
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)

    def test_ctrl_c_while_the_bed_settles(self):
        begin = time.monotonic()
        output = SCRATCH / "settling"
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            jamscope.simulate(small_case(), output, set={**SHORT, "bed.depth": "30 mm", "vessel.diameter": "20 mm"}, bed_cache="")
        self.assertLess(time.monotonic() - begin, 60)
        self.assertFalse((output / "run.h5").exists())

    def test_other_threads_run_while_it_steps(self):
        counted = [0]
        over = threading.Event()

        def count():
            while not over.is_set():
                counted[0] += 1
                time.sleep(0.001)

        counter = threading.Thread(target=count)
        counter.start()
        at = []
        try:
            simulate(SCRATCH / "threads", lambda frame: at.append(counted[0]), threads=1)
        finally:
            over.set()
            counter.join()
        self.assertTrue((numpy.diff(at) > 0).all(), at)

    def test_errors(self):
        with self.assertRaisesRegex(jamscope.CaseError, "did you mean 'depth'"):
            simulate(SCRATCH / "wrong", set={**SHORT, "bed.depht": "4 mm"})
        with self.assertRaises(jamscope.CaseError):
            jamscope.simulate(SCRATCH / "none.toml", SCRATCH / "wrong")
        with self.assertRaises(jamscope.UsageError):  # holds a run
            simulate(SCRATCH / "program")
        with self.assertRaises(jamscope.UsageError):
            simulate(SCRATCH / "wrong", threads=-1)
        with self.assertRaises(jamscope.CaseError):
            jamscope.check(small_case(), set={"run.step": "1 mm"})
        self.assertIn("will be crushed there", jamscope.check(small_case())[0])
        with self.assertWarnsRegex(UserWarning, "will be crushed there"):
            simulate(SCRATCH / "warned", until=1e-6)
        self.assertFalse((SCRATCH / "wrong").exists())

    def test_a_run_that_physics_stops_says_so_and_keeps_its_last_frame(self):
        case = SCRATCH / "piston.toml"
        case.write_text(PISTON)
        frames = []
        with self.assertRaisesRegex(jamscope.PhysicsError, "has left the domain"):
            jamscope.simulate(case, SCRATCH / "piston", frames.append, bed_cache="")
        run = jamscope.open(SCRATCH / "piston" / "run.h5")
        self.assertEqual(len(frames), len(run))
        self.assertGreater(run[-1].particles.position[:, 2].max(), 0.04)


# A piston that throws grains out of the domain.
PISTON = """
[material.glass]
density = "2500 kg/m3"
young = "63 GPa"
poisson = 0.2
[interaction.glass-glass]
restitution = 0.9
friction = 0.5
[bed]
material = "glass"
mean_diameter = "1 mm"
size_low = 0.8
size_high = 1.2
depth = "2 mm"
x = ["-2 mm", "2 mm"]
y = ["-2 mm", "2 mm"]
[domain]
low = ["-1 cm", "-1 cm", "-1 cm"]
high = ["1 cm", "1 cm", "4 cm"]
[run]
duration = "4 ms"
step = "50 ns"
[output]
frame_interval = "0.5 ms"
series_interval = "0.5 ms"
checkpoint_interval = "1 ms"
[wall.pipe]
material = "glass"
kind = "cylinder"
radius = "4 mm"
[wall.piston]
material = "glass"
kind = "disc"
radius = "4 mm"
velocity = ["0 m/s", "0 m/s", "20 m/s"]
"""


if __name__ == "__main__":
    unittest.main()
