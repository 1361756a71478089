"""Runs and frames: the numbers of the file, as views that keep them alive."""
import gc
import unittest

import numpy

import jamscope
import read_run
from support import DATA, PEA, ROOT


class Frames(unittest.TestCase):
    def setUp(self):
        self.run = jamscope.open(PEA)

    def test_a_run_is_a_sequence_of_frames(self):
        self.assertEqual(len(self.run), 3)
        self.assertEqual([f.number for f in self.run], [0, 1, 2])
        self.assertEqual(self.run[-1].step, self.run[2].step)
        self.assertEqual([f.time for f in self.run[::-2]], [self.run[2].time, self.run[0].time])
        self.assertLess(self.run[0].time, self.run[1].time)
        for outside in (3, -4):
            with self.assertRaises(IndexError):
                self.run[outside]

    def test_paths_may_be_path_or_text_or_a_list(self):
        for paths in (PEA, str(PEA), [PEA]):
            self.assertEqual(len(jamscope.open(paths)), 3)

    def test_columns_say_unit_and_meaning(self):
        import h5py

        with h5py.File(PEA, "r", swmr=True) as file:
            for group, table in (("particles", jamscope.Particles), ("contacts/pp", jamscope.Contacts), ("contacts/pw", jamscope.WallContacts),
                                 ("series", jamscope.Series), ("series/walls/blade", jamscope.WallSeries), ("excursions", jamscope.Excursions)):
                for name, data in file[group].items():
                    if not isinstance(data, h5py.Dataset):
                        continue
                    self.assertEqual(table.units[name], data.attrs["unit"].decode().rstrip("\0"), name)
                    self.assertIn(data.attrs["doc"].decode().rstrip("\0"), getattr(table, name).__doc__)

    def test_what_a_source_does_not_know_is_none(self):
        folder = DATA / "formats" / "csv"
        run = jamscope.open([folder / "particles.csv", folder / "contacts.csv", folder / "wall_contacts.csv"])
        particles = run[0].particles
        self.assertGreater(len(particles), 0)
        self.assertEqual(particles.position.shape, (len(particles), 3))
        self.assertIsNone(particles.angular_velocity)
        self.assertNotIn("angular_velocity", particles.columns())
        self.assertEqual(len(run.series), 0)

    def test_dumps_of_other_programs_open_with_a_map(self):
        formats = DATA / "formats"
        run = jamscope.open([formats / "liggghts.particles.dump.xz", formats / "liggghts.pair.local.xz", formats / "liggghts.wall.local.xz"],
                            map=DATA / "maps" / "liggghts.toml")
        self.assertGreater(len(run), 0)
        self.assertIn("blade", {wall.role for wall in run.walls.values()})
        self.assertGreater(len(run[0].contacts), 0)

    def test_roles_can_be_given(self):
        run = jamscope.open(PEA, vessel="floor")
        self.assertEqual({name: wall.role for name, wall in run.walls.items()}, {"floor": "vessel", "cylinder": "other", "blade": "blade"})
        with self.assertRaisesRegex(jamscope.UsageError, "did you mean 'blade'"):
            jamscope.open(PEA, blade="blaed")

    def test_errors_are_typed(self):
        with self.assertRaisesRegex(jamscope.DataError, "no such file"):
            jamscope.open("no/such/run.h5")
        with self.assertRaises(jamscope.DataError):
            jamscope.open(ROOT / "README.md")
        for error in (jamscope.DataError, jamscope.CaseError, jamscope.CriteriaError, jamscope.PhysicsError, jamscope.UsageError):
            self.assertTrue(issubclass(error, jamscope.Error))
        self.assertTrue(issubclass(jamscope.GeometryError, jamscope.CaseError))


def arrays_of(run):
    """Every array that a run and its last frame give, by name."""
    frame = run[-1]
    tables = {"particles": frame.particles, "contacts": frame.contacts, "wall_contacts": frame.wall_contacts, "series": run.series, "excursions": run.excursions}
    arrays = {f"{name}.{column}": values for name, table in tables.items() for column, values in table.columns().items()}
    arrays.update({f"series.{wall}.{c}": v for wall, s in run.series.walls.items() for c, v in s.columns().items()})
    for name, wall in frame.walls.items():
        arrays.update({f"{name}.{c}": getattr(wall, c) for c in ("position", "velocity", "angular_velocity", "force", "torque")})
    for name, wall in run.walls.items():
        arrays.update({f"{name}.{c}": getattr(wall, c) for c in ("point", "axis", "vertices", "triangles", "triangle_label", "sphere_centre", "sphere_radius")})
    arrays["gravity"] = run.info.gravity
    arrays["edges"] = frame.graph.edges
    arrays["neighbors"] = frame.graph.neighbors(0)
    return arrays


class Views(unittest.TestCase):
    def test_arrays_are_views_that_cannot_be_written(self):
        arrays = arrays_of(jamscope.open(PEA))
        self.assertGreater(len(arrays), 60)
        for name, values in arrays.items():
            with self.subTest(name):
                self.assertIsNotNone(values.base)
                self.assertFalse(values.flags.owndata)
                with self.assertRaises(ValueError):
                    values[...] = 0
                with self.assertRaises(ValueError):
                    values.flags.writeable = True

    def test_the_same_memory_each_time(self):
        frame = jamscope.open(PEA)[0]
        for ask in (lambda: frame.particles.position, lambda: frame.contacts.normal_force, lambda: frame.walls["blade"].position, lambda: frame.graph.neighbors(5)):
            self.assertTrue(numpy.shares_memory(ask(), ask()))
        self.assertTrue(numpy.shares_memory(frame.graph.edges, frame.contacts.row))

    def test_arrays_outlive_what_they_come_from(self):
        run = jamscope.open(PEA)
        arrays = arrays_of(run)
        copies = {name: values.copy() for name, values in arrays.items()}
        del run
        gc.collect()
        for _ in range(20):  # would take the memory, were it free
            again = jamscope.open(PEA)
            again[0].metric("coordination")
        for name, values in arrays.items():
            numpy.testing.assert_array_equal(values, copies[name], name)


class TwoReaders(unittest.TestCase):
    """The compiled reader and read_run.py, which is h5py and nothing else, see the same arrays."""

    def assert_same(self, theirs, ours, what):
        self.assertEqual(set(theirs), set(ours), what)
        for name in theirs:
            self.assertEqual(theirs[name].dtype, ours[name].dtype, f"{what}.{name}")
            numpy.testing.assert_array_equal(theirs[name], ours[name], f"{what}.{name}")

    def test_frames_and_walls(self):
        run = jamscope.open(PEA)
        with read_run.open_run(PEA) as file:
            self.assertEqual(read_run.frame_count(file), len(run))
            for k, frame in enumerate(run):
                theirs = read_run.read_frame(file, k)
                self.assertEqual((theirs["time"], theirs["step"]), (frame.time, frame.step))
                self.assert_same(theirs["particles"], frame.particles.columns(), "particles")
                self.assert_same(theirs["contacts"], frame.contacts.columns(), "contacts")
                self.assert_same(theirs["wall_contacts"], frame.wall_contacts.columns(), "wall_contacts")
                self.assertEqual(set(theirs["walls"]), set(frame.walls))
                for name, wall in frame.walls.items():
                    state = theirs["walls"][name]
                    for column, ours in (("pose_position", wall.position), ("pose_quaternion", wall.quaternion), ("velocity", wall.velocity),
                                         ("angular_velocity", wall.angular_velocity), ("force", wall.force), ("torque", wall.torque)):
                        numpy.testing.assert_array_equal(state[column], ours, f"{name}.{column}")
            for name, static in read_run.wall_info(file).items():
                wall = run.walls[name]
                self.assertEqual((static["id"], static["kind"], static["role"], static["material"]), (wall.id, wall.kind, wall.role, wall.material))
            numpy.testing.assert_array_equal(read_run.wall_info(file)["blade"]["triangles"], run.walls["blade"].triangles)

    def test_series_and_excursions(self):
        run = jamscope.open(PEA)
        with read_run.open_run(PEA) as file:
            theirs = read_run.read_series(file)
            walls = theirs.pop("walls")
            self.assert_same(theirs, run.series.columns(), "series")
            self.assertEqual(set(walls), set(run.series.walls))
            for name, wall in run.series.walls.items():
                self.assert_same(walls[name], wall.columns(), name)
            self.assert_same(read_run.read_excursions(file), run.excursions.columns(), "excursions")


if __name__ == "__main__":
    unittest.main()
