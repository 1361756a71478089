// Runs, their frames, and the arrays of both. The columns are those of the schema's table, so a new one is here for nothing.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

#include "apps/jamscope/stored_run.hpp"
#include "apps/python/arrays.hpp"
#include "apps/python/bindings.hpp"
#include "libjam/snapshot/schema.hpp"

namespace jamscope::python {

const jam::ContactGraph& Frame::graph() {
  std::call_once(graph_once, [this] { made_graph.emplace(*snapshot, run->walls); });
  return *made_graph;
}

jam::FrameNetwork& Frame::network() {
  if (!made_network) made_network.emplace(graph(), *run);
  return *made_network;
}

namespace {

namespace schema = jam::schema;

// The tables of columns. `Owner` is what keeps the numbers; `rows` how many there are.
struct ParticleTable {
  using Owner = Frame;
  using Data = jam::Particles;
  static constexpr std::string_view prefix = "/particles/", rows_named = "N";
  static const Data& data(const Owner& f, std::size_t) { return f.snapshot->particles; }
  static std::size_t rows(const Owner& f, std::size_t) { return f.snapshot->particles.size(); }
  template <class F>
  static void visit(const Data& d, F&& f) { schema::visit_particles(d, f); }
};
struct ContactTable {
  using Owner = Frame;
  using Data = jam::ParticleContacts;
  static constexpr std::string_view prefix = "/contacts/pp/", rows_named = "C";
  static const Data& data(const Owner& f, std::size_t) { return f.snapshot->pp; }
  static std::size_t rows(const Owner& f, std::size_t) { return f.snapshot->pp.size(); }
  template <class F>
  static void visit(const Data& d, F&& f) { schema::visit_pp(d, f); }
};
struct WallContactTable {
  using Owner = Frame;
  using Data = jam::WallContacts;
  static constexpr std::string_view prefix = "/contacts/pw/", rows_named = "W";
  static const Data& data(const Owner& f, std::size_t) { return f.snapshot->pw; }
  static std::size_t rows(const Owner& f, std::size_t) { return f.snapshot->pw.size(); }
  template <class F>
  static void visit(const Data& d, F&& f) { schema::visit_pw(d, f); }
};
struct SeriesTable {
  using Owner = Run;
  using Data = jam::Series;
  static constexpr std::string_view prefix = "/series/", rows_named = "S";
  static const Data& data(const Owner& r, std::size_t) { return r.source.series; }
  static std::size_t rows(const Owner& r, std::size_t) { return r.source.series.size(); }
  template <class F>
  static void visit(const Data& d, F&& f) { schema::visit_series(d, f); }
};
struct WallSeriesTable {
  using Owner = Run;
  using Data = jam::Series::WallSeries;
  static constexpr std::string_view prefix = "/series/walls/*/", rows_named = "S";
  static const Data& data(const Owner& r, std::size_t wall) { return r.source.series.walls[wall]; }
  static std::size_t rows(const Owner& r, std::size_t) { return r.source.series.size(); }
  template <class F>
  static void visit(const Data& d, F&& f) { schema::visit_wall_series(d, f); }
};
struct ExcursionTable {
  using Owner = Run;
  using Data = jam::Excursions;
  static constexpr std::string_view prefix = "/excursions/", rows_named = "E";
  static const Data& data(const Owner& r, std::size_t) { return r.source.series.excursions; }
  static std::size_t rows(const Owner& r, std::size_t) { return r.source.series.excursions.size(); }
  template <class F>
  static void visit(const Data& d, F&& f) { schema::visit_excursions(d, f); }
};

// A table of one owner; `wall` where there is one for each wall.
template <class Table>
struct View {
  std::shared_ptr<typename Table::Owner> owner;
  std::size_t wall = 0;
  const typename Table::Data& data() const { return Table::data(*owner, wall); }
  std::size_t rows() const { return Table::rows(*owner, wall); }
};

template <class Table>
std::string column_name(const schema::Item& item) {
  std::string name(item.path.substr(Table::prefix.size()));
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

template <class Table>
auto bind_table(py::module_& m, const char* name, const char* doc) {
  using Class = View<Table>;
  py::class_<Class, std::shared_ptr<Class>> c(m, name, doc);
  const typename Table::Data none{};
  py::dict units;
  Table::visit(none, [&](const schema::Item& item, const auto&) {
    const std::string column = column_name<Table>(item);
    units[column.c_str()] = item.unit;
    const std::string shape = item.width == 1 ? fmt::format("[{}]", Table::rows_named) : fmt::format("[{},{}]", Table::rows_named, item.width);
    const std::string text = fmt::format("{} {}: {}{}", shape, item.unit, item.doc, item.need == schema::optional ? "; None where the source does not know it" : "");
    c.def_property_readonly(
        column.c_str(),
        [path = item.path](const py::object& self) -> py::object {
          const auto& table_view = self.cast<const Class&>();
          py::object found = py::none();
          Table::visit(table_view.data(), [&](const schema::Item& i, const auto& values) {
            if (i.path == path && jam::present(values, table_view.rows())) found = view(values, self);
          });
          return found;
        },
        text.c_str());
  });
  c.def("__len__", &Class::rows);
  c.def(
      "columns",
      [](const py::object& self) {
        const auto& table_view = self.cast<const Class&>();
        py::dict all;
        Table::visit(table_view.data(), [&](const schema::Item& i, const auto& values) {
          if (jam::present(values, table_view.rows())) all[column_name<Table>(i).c_str()] = view(values, self);
        });
        return all;
      },
      "All columns that are there, by name: what pandas.DataFrame takes, but for those with several numbers a row.");
  c.attr("units") = units;
  return c;
}

// A wall in a frame.
struct WallState {
  std::shared_ptr<Frame> frame;
  std::size_t wall;
  const jam::WallState& state() const { return frame->snapshot->walls[wall]; }
};

// A wall of a run, as it does not change.
struct Wall {
  std::shared_ptr<const jam::RunInfo> run;
  std::size_t number;
  const jam::Wall& wall() const { return run->walls[number]; }
};

struct Info {
  std::shared_ptr<const jam::RunInfo> run;
};

std::string role_name(jam::WallRole role) {
  switch (role) {
    case jam::WallRole::blade: return "blade";
    case jam::WallRole::vessel: return "vessel";
    case jam::WallRole::other: break;
  }
  return "other";
}

template <double jam::Interaction::*member>
py::array interactions(const jam::RunInfo& run) {
  const auto n = py::ssize_t(run.interactions.size());
  py::array_t<double> values({n, n});
  for (py::ssize_t i = 0; i < n; ++i)
    for (py::ssize_t j = 0; j < n; ++j) values.mutable_at(i, j) = run.interactions[std::size_t(i)][std::size_t(j)].*member;
  return values;
}

// A member of a wall or its state, as an array that its Python object owns.
template <class Class, class Get>
auto array_of(Get get) {
  return [get](const py::object& self) { return view(get(self.cast<const Class&>()), self); };
}

void bind_walls(py::module_& m) {
  py::class_<WallState>(m, "WallState", "Where a wall is in a frame, how it moves, and what loads it. Vectors are [3], in the laboratory frame.")
      .def_property_readonly("name", [](const WallState& w) { return w.frame->run->walls[w.wall].name; }, "Name of the wall.")
      .def_property_readonly("position", array_of<WallState>([](const WallState& w) -> const auto& { return w.state().position; }), "m, origin of the body frame")
      .def_property_readonly(
          "quaternion",
          [](const WallState& w) {
            const Eigen::Quaterniond& q = w.state().orientation;
            return owned(std::vector<double>{q.w(), q.x(), q.y(), q.z()});
          },
          "[4] w, x, y, z: body frame to laboratory frame")
      .def_property_readonly("velocity", array_of<WallState>([](const WallState& w) -> const auto& { return w.state().velocity; }), "m/s, of that origin")
      .def_property_readonly("angular_velocity", array_of<WallState>([](const WallState& w) -> const auto& { return w.state().angular_velocity; }), "rad/s")
      .def_property_readonly(
          "force",
          [](const py::object& self) -> py::object {
            const auto& w = self.cast<const WallState&>();
            if (!w.frame->run->wall_loads_known) return py::none();
            return view(w.state().force, self);
          },
          "N, on the wall; None where the source does not know it")
      .def_property_readonly(
          "torque",
          [](const py::object& self) -> py::object {
            const auto& w = self.cast<const WallState&>();
            if (!w.frame->run->wall_loads_known) return py::none();
            return view(w.state().torque, self);
          },
          "N m, on the wall about `position`; None where the source does not know it");

  py::class_<Wall>(m, "Wall", "A wall of a run, in its body frame. What its kind does not have is 0 or empty.")
      .def_property_readonly("id", [](const Wall& w) { return w.number; }, "Number in the column `wall` of contacts.")
      .def_property_readonly("name", [](const Wall& w) { return w.wall().name; }, "Name.")
      .def_property_readonly("kind", [](const Wall& w) { return w.wall().kind; }, "plane, cylinder, cone, disc, spheres or mesh")
      .def_property_readonly("role", [](const Wall& w) { return role_name(w.wall().role); }, "blade, vessel or other: jams are bridges from a blade to a vessel")
      .def_property_readonly("material", [](const Wall& w) { return w.wall().material; }, "Name of the material, or empty.")
      .def_property_readonly("free_side", [](const Wall& w) { return w.wall().free_side; }, "inside or outside, of cylinders and cones; or empty")
      .def_property_readonly("point", array_of<Wall>([](const Wall& w) -> const auto& { return w.wall().point; }), "m, of a plane, on an axis, centre of a disc")
      .def_property_readonly("axis", array_of<Wall>([](const Wall& w) -> const auto& { return w.wall().axis; }), "unit vector: axis, or normal into the free side")
      .def_property_readonly("radius", [](const Wall& w) { return w.wall().radius; }, "m, of a cone at `low`")
      .def_property_readonly("high_radius", [](const Wall& w) { return w.wall().high_radius; }, "m, of a cone at `high`")
      .def_property_readonly("hole_radius", [](const Wall& w) { return w.wall().hole_radius; }, "m, of a disc")
      .def_property_readonly("low", [](const Wall& w) { return w.wall().low; }, "m, end along the axis from `point`; -inf: none")
      .def_property_readonly("high", [](const Wall& w) { return w.wall().high; }, "m, end along the axis from `point`; inf: none")
      .def_property_readonly("vertices", array_of<Wall>([](const Wall& w) -> const auto& { return w.wall().vertices; }), "[V,3] m, of a mesh")
      .def_property_readonly("triangles", array_of<Wall>([](const Wall& w) -> const auto& { return w.wall().triangles; }), "[F,3] rows of `vertices`, counter-clockwise from outside")
      .def_property_readonly("triangle_label", array_of<Wall>([](const Wall& w) -> const auto& { return w.wall().triangle_label; }), "[F] 0 face, 1 edge, 2 tip, 3 hub; or empty")
      .def_property_readonly("sphere_centre", array_of<Wall>([](const Wall& w) -> const auto& { return w.wall().sphere_centre; }), "[G,3] m, of glued spheres")
      .def_property_readonly("sphere_radius", array_of<Wall>([](const Wall& w) -> const auto& { return w.wall().sphere_radius; }), "[G] m, of glued spheres")
      .def("__repr__", [](const Wall& w) { return fmt::format("<jamscope.Wall '{}': {}, {}>", w.wall().name, w.wall().kind, role_name(w.wall().role)); });
}

py::dict walls_of(const std::shared_ptr<const jam::RunInfo>& run) {
  py::dict walls;
  for (std::size_t k = 0; k < run->walls.size(); ++k) walls[run->walls[k].name.c_str()] = Wall{run, k};
  return walls;
}

void bind_info(py::module_& m) {
  py::class_<jam::Material>(m, "Material", "A material of a run.")
      .def_readonly("name", &jam::Material::name, "Name.")
      .def_readonly("density", &jam::Material::density, "kg/m^3")
      .def_readonly("young", &jam::Material::young, "Pa, Young's modulus")
      .def_readonly("poisson", &jam::Material::poisson, "1, Poisson's ratio");
  py::class_<jam::Gap>(m, "Gap", "The clearance between the blade's tip and the vessel, in which jams are looked for; all 0 where it is not known.")
      .def_readonly("tip_radius", &jam::Gap::tip_radius, "m, largest distance of the blade from its axis")
      .def_readonly("vessel_radius", &jam::Gap::vessel_radius, "m")
      .def_readonly("z_low", &jam::Gap::z_low, "m, lower end of the blade, relative to its position")
      .def_readonly("z_high", &jam::Gap::z_high, "m, upper end of the blade, relative to its position");
  py::class_<Info>(m, "RunInfo", "What is known about a run as a whole.")
      .def_property_readonly("creator", [](const Info& i) { return i.run->creator; }, "Program that computed the run.")
      .def_property_readonly("creator_version", [](const Info& i) { return i.run->creator_version; }, "Its version.")
      .def_property_readonly("commit", [](const Info& i) { return i.run->commit; }, "Its source revision.")
      .def_property_readonly("created_utc", [](const Info& i) { return i.run->created_utc; }, "Start of the run, ISO 8601.")
      .def_property_readonly("case_toml", [](const Info& i) { return i.run->case_toml; }, "The exact case file; empty for the data of other programs.")
      .def_property_readonly("case_sha256", [](const Info& i) { return i.run->case_sha256; }, "SHA-256 of `case_toml`.")
      .def_property_readonly("argv", [](const Info& i) { return i.run->argv; }, "Command line of the run.")
      .def_property_readonly("seed", [](const Info& i) { return i.run->seed; }, "Seed of every random choice.")
      .def_property_readonly("gravity", [](const py::object& self) { return view(self.cast<const Info&>().run->gravity, self); }, "[3] m/s^2")
      .def_property_readonly("dt", [](const Info& i) { return i.run->dt; }, "s, time step of the source; 0 where it is not known")
      .def_property_readonly("watch_force", [](const Info& i) { return i.run->watch_force; }, "N, excursions are stays of particles above it; 0 where there are none")
      .def_property_readonly("watch_radius", [](const Info& i) { return i.run->watch_radius; }, "m, of a particle that is watched above watch_force, others above one that goes with the square of the radius; 0: watch_force is that of all")
      .def_property_readonly("watch_stride", [](const Info& i) { return i.run->watch_stride; }, "Steps between two looks at the particles.")
      .def_property_readonly("wall_loads_known", [](const Info& i) { return i.run->wall_loads_known; }, "Were force and torque of the walls recorded?")
      .def_property_readonly("materials", [](const Info& i) { return i.run->materials; }, "The materials; the column `material` of particles counts them.")
      .def_property_readonly("gap", [](const Info& i) { return i.run->gap; }, "Where jams are looked for.")
      .def_property_readonly(
          "interactions",
          [](const Info& i) {
            py::dict d;
            d["restitution"] = interactions<&jam::Interaction::restitution>(*i.run);
            d["friction"] = interactions<&jam::Interaction::friction>(*i.run);
            d["rolling"] = interactions<&jam::Interaction::rolling>(*i.run);
            d["work_of_adhesion"] = interactions<&jam::Interaction::work_of_adhesion>(*i.run);
            return d;
          },
          "[M,M] of each pair of materials: restitution, friction, rolling (1) and work_of_adhesion (J/m^2)");
}

std::shared_ptr<Frame> read_frame(const Run& run, std::size_t number) {
  auto frame = std::make_shared<Frame>();
  frame->run = run.info;
  frame->snapshot = std::make_shared<const jam::Snapshot>(run.source.read(number));
  frame->number = number;
  return frame;
}

struct FrameIterator {
  std::shared_ptr<Run> run;
  std::size_t next = 0;
};

}  // namespace

void bind_run(py::module_& m) {
  bind_table<ParticleTable>(m, "Particles", "The particles of a frame, by ascending id: read-only views of the frame's own numbers.");
  bind_table<ContactTable>(m, "Contacts", "The contacts of two particles of a frame, sorted by `row`: read-only views of the frame's own numbers.");
  bind_table<WallContactTable>(m, "WallContacts", "The contacts of particles with walls of a frame, sorted by row, wall, facet: read-only views of the frame's own numbers.");
  bind_table<WallSeriesTable>(m, "WallSeries", "A wall in each window of steps.");
  bind_table<ExcursionTable>(m, "Excursions",
                             "Stays of particles above `info.watch_force`, from every step. A row that is `open` had not ended when it was written; a later one with the same "
                             "particle and first_step takes its place.");
  bind_table<SeriesTable>(m, "Series", "One row for each window of steps, so that nothing between two frames is lost.")
      .def_property_readonly(
          "walls",
          [](const View<SeriesTable>& series) {
            py::dict walls;
            for (std::size_t w = 0; w < series.data().walls.size() && w < series.owner->info->walls.size(); ++w)
              walls[series.owner->info->walls[w].name.c_str()] = std::make_shared<View<WallSeriesTable>>(View<WallSeriesTable>{series.owner, w});
            return walls;
          },
          "The walls' own columns, by name.");
  bind_walls(m);
  bind_info(m);

  py::class_<Frame, std::shared_ptr<Frame>>(m, "Frame", "One recorded instant of a run.")
      .def_property_readonly("number", [](const Frame& f) { return f.number; }, "Which one of the run, counted from 0.")
      .def_property_readonly("time", [](const Frame& f) { return f.snapshot->time; }, "s")
      .def_property_readonly("step", [](const Frame& f) { return f.snapshot->step; }, "Step of the source's own time stepping.")
      .def_property_readonly("info", [](const Frame& f) { return Info{f.run}; }, "What is known about the run.")
      .def_property_readonly("particles", [](const std::shared_ptr<Frame>& f) { return std::make_shared<View<ParticleTable>>(View<ParticleTable>{f}); }, "The particles.")
      .def_property_readonly("contacts", [](const std::shared_ptr<Frame>& f) { return std::make_shared<View<ContactTable>>(View<ContactTable>{f}); }, "The contacts of two particles.")
      .def_property_readonly("wall_contacts", [](const std::shared_ptr<Frame>& f) { return std::make_shared<View<WallContactTable>>(View<WallContactTable>{f}); }, "The contacts with walls.")
      .def_property_readonly(
          "walls",
          [](const std::shared_ptr<Frame>& f) {
            py::dict walls;
            for (std::size_t w = 0; w < f->snapshot->walls.size(); ++w) walls[f->run->walls[w].name.c_str()] = WallState{f, w};
            return walls;
          },
          "Where the walls are, by name.")
      .def("__repr__", [](const Frame& f) {
        return fmt::format("<jamscope.Frame {} at {:.6g} s: {} particles, {} contacts, {} with walls>", f.number, f.snapshot->time, f.snapshot->particles.size(),
                           f.snapshot->pp.size(), f.snapshot->pw.size());
      });

  py::class_<FrameIterator>(m, "FrameIterator", "Reads the frames of a run one after the other.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", [](FrameIterator& i) {
        if (i.next >= i.run->source.frames) throw py::stop_iteration();
        return read_frame(*i.run, i.next++);
      });

  py::class_<Run, std::shared_ptr<Run>>(m, "Run", "A stored run: a sequence of frames, each read when it is asked for.")
      .def("__len__", [](const Run& r) { return r.source.frames; })
      .def(
          "__getitem__",
          [](const Run& r, std::ptrdiff_t k) {
            const auto frames = std::ptrdiff_t(r.source.frames);
            if (k < -frames || k >= frames) throw py::index_error(fmt::format("there is no frame {}: the run has {}", k, frames));
            return read_frame(r, std::size_t(k < 0 ? k + frames : k));
          },
          py::arg("frame"), "The frame with this number; negative ones count from the end.")
      .def(
          "__getitem__",
          [](const Run& r, const py::slice& slice) {
            std::size_t start = 0, stop = 0, step = 0, count = 0;
            if (!slice.compute(r.source.frames, &start, &stop, &step, &count)) throw py::error_already_set();
            std::vector<std::shared_ptr<Frame>> frames;
            for (std::size_t k = 0; k < count; ++k, start += step) frames.push_back(read_frame(r, start));
            return frames;
          },
          py::arg("frames"), "These frames, all of them read now.")
      .def("__iter__", [](const std::shared_ptr<Run>& r) { return FrameIterator{r}; })
      .def_property_readonly("info", [](const Run& r) { return Info{r.info}; }, "What is known about the run.")
      .def_property_readonly("walls", [](const Run& r) { return walls_of(r.info); }, "The walls, by name.")
      .def_property_readonly("series", [](const std::shared_ptr<Run>& r) { return std::make_shared<View<SeriesTable>>(View<SeriesTable>{r}); }, "One row per window of steps; empty where the source has none.")
      .def_property_readonly("excursions", [](const std::shared_ptr<Run>& r) { return std::make_shared<View<ExcursionTable>>(View<ExcursionTable>{r}); }, "Stays above the watched force, from every step; empty where the source has none.")
      .def_property_readonly("warnings", [](const Run& r) { return r.source.warnings; }, "What is odd about the data, for example an unfinished frame.")
      .def("__repr__", [](const Run& r) { return fmt::format("<jamscope.Run of {} frames>", r.source.frames); });

  m.def(
      "open_run",
      [](const std::vector<std::string>& paths, const std::string& map, const std::string& blade, const std::string& vessel) {
        auto run = std::make_shared<Run>();
        run->source = open_stored_run({paths, map, blade, vessel});
        // HDF5 does one thing at a time: whoever reads holds the interpreter's lock, as h5py does, also where an analysis has let go of it.
        run->source.read = [read = std::move(run->source.read)](std::size_t k) {
          const py::gil_scoped_acquire lock;
          return read(k);
        };
        run->info = std::make_shared<const jam::RunInfo>(run->source.info);
        return run;
      },
      py::arg("paths"), py::arg("map") = "", py::arg("blade") = "", py::arg("vessel") = "", "Opens files as one run; see jamscope.open.");
}

}  // namespace jamscope::python
