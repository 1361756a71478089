"""Network metrics: every row of the tables, and the numbers that the program prints."""
import threading
import unittest

import numpy

import jamscope
from support import PEA, program, rows


class Metrics(unittest.TestCase):
    def setUp(self):
        self.run = jamscope.open(PEA)

    def test_every_metric_of_the_tables_is_there(self):
        frame, before = self.run[2], self.run[1]
        sizes = {"particles": len(frame.particles), "contacts": len(frame.contacts)}
        total = 0
        for of in ("frames", "changes", "particles", "contacts"):
            for row in jamscope.metrics.table(of):
                with self.subTest(of=of, metric=row.name):
                    total += 1
                    self.assertTrue(row.doc and row.unit)
                    self.assertIn(row.doc, jamscope.metrics.doc(row.name, of))
                    value = frame.change(before, row.name) if of == "changes" else frame.metric(row.name, of=of)
                    if of in sizes:
                        self.assertEqual((value.dtype, value.shape), (numpy.dtype(float), (sizes[of],)))
                    else:
                        self.assertIsInstance(value, float)
        self.assertGreater(total, 80)

    def test_numbers_are_those_of_the_command_line(self):
        for of in ("frames", "changes", "particles", "contacts"):
            printed = rows(program("metrics", PEA, "--of", of, "--all", "-q"))
            names = jamscope.metrics.names(of)
            for k, frame in enumerate(self.run):
                those = [row for row in printed if int(row["frame"]) == k]
                if of == "changes" and k == 0:
                    self.assertEqual(those, [])
                    continue
                for row in jamscope.metrics.table(of):
                    value = frame.change(self.run[k - 1], row.name) if of == "changes" else frame.metric(row.name, of=of)
                    expected = [float(r[f"{row.name} [{row.unit}]"]) for r in those]
                    numpy.testing.assert_array_equal(numpy.atleast_1d(value), expected, f"{of} {row.name} of frame {k}")
            self.assertEqual([c.split(" ")[0] for c in printed[0]][-len(names):], names)

    def test_those_without_a_star_come_together(self):
        frame = self.run[1]
        low = [row.name for row in jamscope.metrics.table() if row.low_cost]
        together = frame.metrics()
        self.assertEqual(list(together), low)
        self.assertEqual(together["coordination"], 2 * len(frame.contacts) / len(frame.particles))
        self.assertEqual(list(frame.metrics(["core_number"], of="particles")), ["core_number"])

    def test_names_that_are_wrong_or_not_enough(self):
        with self.assertRaisesRegex(jamscope.UsageError, "did you mean 'coordination'"):
            self.run[0].metric("cordination")
        with self.assertRaisesRegex(jamscope.UsageError, "say which"):
            self.run[0].metric("betweenness")
        with self.assertRaises(ValueError):
            self.run[0].metric("coordination", of="grains")
        with self.assertRaises(KeyError):
            jamscope.metrics.doc("cordination")

    def test_threads_may_ask_one_frame(self):
        frame, found = self.run[2], {}

        def ask(name):
            found[name] = frame.metric(name, of="particles")

        names = jamscope.metrics.names("particles")
        threads = [threading.Thread(target=ask, args=(name,)) for name in names]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for name in names:
            numpy.testing.assert_array_equal(found[name], self.run[2].metric(name, of="particles"), name)


class Graph(unittest.TestCase):
    def setUp(self):
        self.frame = jamscope.open(PEA)[2]
        self.graph = self.frame.graph

    def test_neighbors_are_the_contacts(self):
        pairs = self.frame.contacts.row
        n = len(self.frame.particles)
        self.assertEqual((self.graph.vertex_count, self.graph.edge_count, self.graph.wall_contact_count), (n, len(pairs), len(self.frame.wall_contacts)))
        numpy.testing.assert_array_equal(self.graph.degree, numpy.bincount(pairs.ravel(), minlength=n))
        for v in range(n):
            contacts = numpy.flatnonzero((pairs == v).any(axis=1))
            found = self.graph.neighbors(v)
            self.assertEqual(set(zip(found["vertex"].tolist(), found["contact"].tolist())), {(int(pairs[c].sum()) - v, int(c)) for c in contacts})
            self.assertTrue((numpy.diff(found["vertex"].astype(int)) > 0).all())
        for outside in (-1, n):
            with self.assertRaises(IndexError):
                self.graph.neighbors(outside)

    def test_wall_contacts_by_role(self):
        contacts, walls = self.frame.wall_contacts, jamscope.open(PEA).walls
        role_of = {wall.id: wall.role for wall in walls.values()}
        for v in range(self.graph.vertex_count):
            expected = numpy.flatnonzero(contacts.row == v)
            self.assertEqual(sorted(self.graph.wall_contacts(v)), expected.tolist())
            for role in ("blade", "vessel", "other"):
                self.assertEqual(self.graph.wall_contacts(v, role).tolist(), [c for c in expected if role_of[contacts.wall[c]] == role])
        with self.assertRaises(ValueError):
            self.graph.wall_contacts(0, "wing")

    def test_components_of_all_and_of_parts(self):
        n, pairs = self.graph.vertex_count, self.frame.contacts.row
        loaded = self.frame.contacts.normal_force > 0.01
        chosen = numpy.arange(n) % 5 != 0
        for particles, contacts in ((None, None), (None, loaded), (chosen, loaded), (chosen, None)):
            root = list(range(n))

            def find(v):
                while root[v] != v:
                    v = root[v]
                return v

            kept = numpy.ones(n, bool) if particles is None else particles
            for c, (a, b) in enumerate(pairs.tolist()):
                if (contacts is None or contacts[c]) and kept[a] and kept[b]:
                    root[max(find(a), find(b))] = min(find(a), find(b))
            groups = {}
            for v in numpy.flatnonzero(kept).tolist():
                groups.setdefault(find(v), []).append(v)
            expected = sorted(groups.values(), key=lambda g: (-len(g), g[0]))
            found = self.graph.components(particles, contacts)
            self.assertEqual(len(found), len(expected))
            self.assertEqual(found.size.tolist(), [len(g) for g in expected])
            for label, group in enumerate(expected):
                self.assertEqual(numpy.flatnonzero(found.label == label).tolist(), group)
            self.assertTrue((found.label[~kept] == jamscope.Components.none).all())
        with self.assertRaises(ValueError):
            self.graph.components(contacts=[True])


if __name__ == "__main__":
    unittest.main()
