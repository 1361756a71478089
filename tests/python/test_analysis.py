"""The analysis: the same as the program's, in memory and read again."""
import gc
import math
import unittest

import h5py
import numpy

import jamscope
from support import JAM_FORCE, PEA, SCRATCH, program, rows


def number(text):
    return int(text) if text.isdigit() else float(text)


class Analysis(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = SCRATCH / "analysis"
        program("analyze", PEA, "-o", cls.folder, "-q", "--set", f"jam_force={JAM_FORCE} N")
        cls.analysis = jamscope.analyze(PEA, jam_force=JAM_FORCE)

    def test_events_are_those_of_the_program(self):
        a = self.analysis
        self.assertGreater(len(a.events), 0)
        self.assertEqual(a.events_csv(), (self.folder / "events.csv").read_text())
        self.assertEqual(a.step_jams_csv(), (self.folder / "jams.csv").read_text())

    def test_tables_hold_the_numbers_of_the_csv_files(self):
        a, units = self.analysis, {"s": "s", "N": "N"}
        printed = rows((self.folder / "events.csv").read_text())
        for stream, table, members in (("global", a.events, a.event_members), ("cluster", a.cluster_events, a.cluster_event_members), ("particle", a.tracks, None)):
            those = [row for row in printed if row["stream"] == stream]
            self.assertEqual(len(those), len(table))
            self.assertGreater(len(those), 0)
            for k, row in enumerate(those):
                for column, (unit, _) in jamscope.Analysis.columns("events").items():
                    heading = column + (f"_{unit}" if unit in units else "")
                    if heading in row:
                        self.assertEqual(number(row[heading]), table[column][k], (stream, column))
                ids = [int(i) for i in row["members"].split(";")]
                self.assertEqual(ids, [table["particle"][k]] if members is None else members(k).tolist())
        printed = rows((self.folder / "jams.csv").read_text())
        for stream, table in a.step_jams.items():
            those = [row for row in printed if row["stream"] == stream]
            self.assertEqual([float(row["peak_force_N"]) for row in those], table["peak_force"].tolist())
            self.assertEqual([[int(i) for i in row["members"].split(";")] for row in those], [a.step_jam_members(stream, k).tolist() for k in range(len(table))])
        self.assertGreater(len(a.step_jams["global"]), 0)

    def assert_same(self, a, b):
        for name in ("frames", "clusters", "cluster_identity", "cluster_links", "cluster_events", "events", "tracks", "survival_classes", "jammed_histogram", "contact_life", "flow_pattern"):
            ours, theirs = getattr(a, name), getattr(b, name)
            self.assertEqual(ours.dtype, theirs.dtype)
            for column in ours.dtype.names or [None]:
                numpy.testing.assert_array_equal(ours[column] if column else ours, theirs[column] if column else theirs, f"{name} {column}")
        for k in range(len(a.tracks)):
            for column in ("frame", "position", "velocity", "compressive_force"):
                numpy.testing.assert_array_equal(a.track_points(k)[column], b.track_points(k)[column])
        self.assertEqual(set(a.metrics), set(b.metrics))
        for name in a.metrics:
            numpy.testing.assert_array_equal(a.metrics[name], b.metrics[name], name)
        self.assertEqual(a.events_csv(), b.events_csv())
        self.assertEqual(a.step_jams_csv(), b.step_jams_csv())
        self.assertEqual((a.jammed_time, a.jam_frequency, a.observed_time, a.flow_energy.total), (b.jammed_time, b.jam_frequency, b.observed_time, b.flow_energy.total))
        self.assertEqual(a.notes, b.notes)
        for stream in a.step_jams:
            ours, theirs = a.step_statistics(stream), b.step_statistics(stream)
            self.assertEqual((ours.rate.value, ours.rate.low, ours.rate.high, ours.jammed_time), (theirs.rate.value, theirs.rate.low, theirs.rate.high, theirs.jammed_time))
            numpy.testing.assert_array_equal(ours.survival.share, theirs.survival.share)

    def test_read_again_from_the_file_or_its_folder(self):
        for path in (self.folder / "jam.h5", self.folder):
            self.assert_same(self.analysis, jamscope.read_results(path))
        with self.assertRaises(jamscope.DataError):
            jamscope.read_results(PEA)
        with self.assertRaises(jamscope.UsageError):
            jamscope.read_results(self.folder).write(str(SCRATCH / "again.h5"))

    def test_written_as_the_program_writes_it(self):
        self.analysis.write(str(SCRATCH / "written.h5"))
        with h5py.File(self.folder / "jam.h5", "r") as theirs, h5py.File(SCRATCH / "written.h5", "r") as ours:
            names = []
            theirs.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
            self.assertGreater(len(names), 50)
            for name in names:
                numpy.testing.assert_array_equal(ours[name][()], theirs[name][()], name)

    def test_threads_and_ways_to_say_it_do_not_matter(self):
        run = jamscope.open(PEA)
        self.assert_same(self.analysis, jamscope.analyze(run, jam_force="500 mN", threads=1))
        criteria = SCRATCH / "criteria.toml"
        criteria.write_text('[analysis]\njam_force = "0.5 N"\n')
        self.assert_same(self.analysis, jamscope.analyze(run, criteria=criteria, threads=3))

    def test_part_of_the_frames(self):
        part = jamscope.analyze(PEA, jam_force=JAM_FORCE, frames=(1, 3))
        numpy.testing.assert_array_equal(part.frames["time"], self.analysis.frames["time"][1:])
        for frames in ((0, 4), (2, 2)):
            with self.assertRaises(jamscope.UsageError):
                jamscope.analyze(PEA, frames=frames)

    def test_every_option_reaches_the_criteria(self):
        a = jamscope.analyze(PEA, jam_force=2, end_force=0.5, hold_off=1e-4, shortest_jam="2 us", bridge_contact_share=0.2, gap_margin=1.0,
                             survival_classes=numpy.array([0.001, 0.002]), measure="max", metrics=["coordination"])
        c = a.criteria
        self.assertEqual((c.jam_force, c.end_force, c.hold_off, c.shortest_jam, c.bridge_contact_share, c.gap_margin), (2, 0.5, 1e-4, 2e-6, 0.2, 1))
        self.assertEqual((c.survival_classes, c.measure, c.metrics, c.criterion, c.threshold), ([0.001, 0.002], "max", ["coordination"], "compressive_force", None))
        self.assertEqual(list(a.metrics), ["coordination"])
        scaled = jamscope.analyze(PEA, criterion="scaled_force", threshold=1e-5).criteria
        self.assertEqual((scaled.criterion, scaled.threshold), ("scaled_force", 1e-5))

    def test_recorded_metrics_are_those_of_the_frames(self):
        for name, values in self.analysis.metrics.items():
            numpy.testing.assert_array_equal(values, [frame.metric(name) for frame in jamscope.open(PEA)] if name not in _BY_CRITERIA else values, name)
        self.assertGreater(len(self.analysis.metrics), 10)

    def test_wrong_options_are_errors_with_the_nearest_name(self):
        with self.assertRaisesRegex(jamscope.CaseError, "did you mean 'jam_force'"):
            jamscope.analyze(PEA, jam_forse=1.0)
        with self.assertRaisesRegex(jamscope.CaseError, "must be positive"):
            jamscope.analyze(PEA, jam_force=-1.0)
        with self.assertRaises(jamscope.CaseError):
            jamscope.analyze(PEA, jam_force="1 mm")
        (SCRATCH / "particles.csv").write_text("frame,time,id,x,y,z,radius\n0,0,1,0,0,0,1e-3\n0,0,2,0,0,2e-3,1e-3\n")
        (SCRATCH / "contacts.csv").write_text("frame,id1,id2,fn\n0,1,2,5\n")
        (SCRATCH / "wall_contacts.csv").write_text("frame,id,wall,fn\n0,1,floor,5\n")
        with self.assertRaisesRegex(jamscope.CriteriaError, "blade"):
            jamscope.analyze([SCRATCH / name for name in ("particles.csv", "contacts.csv", "wall_contacts.csv")])

    def test_tables_are_views_that_outlive_the_analysis(self):
        a = jamscope.analyze(PEA, jam_force=JAM_FORCE)
        tables = {"events": a.events, "tracks": a.tracks, "frames": a.frames, "clusters": a.clusters, "points": a.track_points(0), "members": a.event_members(0),
                  "histogram": a.jammed_histogram, "life": a.contact_life, "jams": a.step_jams["particle"], "energy": a.flow_energy.energy,
                  "survival": a.step_statistics().survival.time}
        copies = {name: table.copy() for name, table in tables.items()}
        self.assertTrue(numpy.shares_memory(a.events, a.events))
        del a
        gc.collect()
        for _ in range(5):
            jamscope.analyze(PEA, jam_force=JAM_FORCE)
        for name, table in tables.items():
            self.assertIsNotNone(table.base)
            with self.assertRaises(ValueError):
                table[...] = 0
            for column in table.dtype.names or [None]:
                numpy.testing.assert_array_equal(table[column] if column else table, copies[name][column] if column else copies[name], name)

    def test_columns_say_unit_and_meaning(self):
        for name in ("frames", "clusters", "cluster_links", "events", "cluster_events", "tracks", "survival_classes", "contact_life", "flow_pattern"):
            columns = jamscope.Analysis.columns(name)
            self.assertEqual(set(columns), set(getattr(self.analysis, name).dtype.names), name)
            for unit, doc in columns.values():
                self.assertTrue(unit and doc)
        self.assertEqual(set(jamscope.Analysis.columns("step_jams")), set(self.analysis.step_jams["site"].dtype.names))
        self.assertEqual(set(jamscope.Analysis.columns("track_points")), set(self.analysis.track_points(0).dtype.names))
        self.assertEqual(jamscope.Analysis.columns("events")["peak_force"][0], "N")

    def test_rates_follow_from_the_jams(self):
        a = self.analysis
        jams = a.step_jams["global"]
        s = a.step_statistics("global")
        began = int((~jams["open_at_start"]).sum())
        record = a.frames["time"][-1] - a.frames["time"][0]
        rate = jamscope.statistics.poisson_rate(began, record)
        self.assertTrue(math.isclose(s.rate.value, rate.value, rel_tol=1e-12) and math.isclose(s.rate.high, rate.high, rel_tol=1e-12))
        self.assertTrue(math.isclose(s.jammed_time, jams["duration"].sum(), rel_tol=1e-12))


# Metrics of jams depend on the jam force, which those of a frame alone take from the defaults.
_BY_CRITERIA = {row.name for row in jamscope.metrics.table() if "jam" in row.name or "jam" in row.doc}


if __name__ == "__main__":
    unittest.main()
