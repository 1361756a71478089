"""Files whose writer is at work or was killed: both readers see the complete frames, and the same ones."""
import os
import signal
import subprocess
import time
import unittest

import numpy

import jamscope
import read_run
from support import BEDS, PROGRAM, SCRATCH, SHORT, simulate, small_case


class Unfinished(unittest.TestCase):
    def test_a_run_that_is_at_work_and_then_killed(self):
        simulate(SCRATCH / "bed", until=1e-6)  # the bed is in its store
        output = SCRATCH / "killed"
        overrides = [f"--set={key}={value}" for key, value in {**SHORT, "run.duration": "40 ms", "output.frame_interval": "0.02 ms"}.items()]
        command = [PROGRAM, "simulate", small_case(), "-o", output, "-q", "--threads", "1", "--bed-cache", BEDS, *overrides]
        path = output / "run.h5"
        with subprocess.Popen(command) as running:
            try:
                counts = []
                deadline = time.monotonic() + 120
                while len(counts) < 3 and time.monotonic() < deadline:
                    self.assertIsNone(running.poll(), "the run ended by itself")
                    if path.exists():
                        try:
                            with read_run.open_run(path) as file:
                                count = read_run.frame_count(file)
                                if count > 0 and count not in counts:
                                    frame = read_run.read_frame(file, -1)
                                    self.assertTrue((frame["particles"]["radius"] > 0).all())
                                    counts.append(count)
                        except OSError:  # the moment in which the file is made, or replaced by one with more columns
                            pass
                    time.sleep(0.005)
                self.assertEqual(counts, sorted(counts))
                self.assertGreaterEqual(len(counts), 3)
            finally:
                os.kill(running.pid, signal.SIGKILL)
        run = jamscope.open(path)
        with read_run.open_run(path) as file:
            self.assertEqual(read_run.frame_count(file), len(run))
            self.assertGreaterEqual(len(run), counts[-1])
            for k, frame in enumerate(run):
                theirs = read_run.read_frame(file, k)
                for name, ours in frame.particles.columns().items():
                    numpy.testing.assert_array_equal(theirs["particles"][name], ours)
                for name, ours in frame.contacts.columns().items():
                    numpy.testing.assert_array_equal(theirs["contacts"][name], ours)
            series = read_run.read_series(file)
            numpy.testing.assert_array_equal(series["step"], run.series.step)
            self.assertEqual(len(read_run.read_excursions(file)["particle"]), len(run.excursions))

    def test_what_is_no_run_is_refused(self):
        with self.assertRaises(OSError):
            read_run.open_run(__file__)
        simulate(SCRATCH / "results", until=1e-4)
        with self.assertRaises(ValueError):
            read_run.open_run(SCRATCH / "results" / "jam.h5")
        with read_run.open_run(SCRATCH / "results" / "run.h5") as file:
            for outside in (2, -3):
                with self.assertRaises(IndexError):
                    read_run.read_frame(file, outside)


if __name__ == "__main__":
    unittest.main()
