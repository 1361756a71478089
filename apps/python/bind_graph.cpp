// The contact network of a frame.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <numeric>

#include "apps/python/arrays.hpp"
#include "apps/python/bindings.hpp"

namespace jamscope::python {
namespace {

struct Graph {
  std::shared_ptr<Frame> frame;
  const jam::ContactGraph& graph() const { return frame->graph(); }

  jam::ContactGraph::Vertex vertex(std::ptrdiff_t row) const {
    const auto n = std::ptrdiff_t(graph().vertex_count());
    if (row < 0 || row >= n) throw py::index_error(fmt::format("there is no particle in row {}: the frame has {}", row, n));
    return jam::ContactGraph::Vertex(row);
  }
};

using Mask = py::array_t<bool, py::array::c_style | py::array::forcecast>;

std::vector<std::uint8_t> as_flags(const std::optional<Mask>& mask, std::size_t rows, const char* name) {
  if (!mask) return std::vector<std::uint8_t>(rows, 1);
  if (mask->ndim() != 1 || std::size_t(mask->size()) != rows)
    throw py::value_error(fmt::format("{} has {} values in {} dimensions, expected [{}]", name, mask->size(), mask->ndim(), rows));
  return {mask->data(), mask->data() + rows};
}

jam::WallRole role_named(const std::string& name) {
  if (name == "blade") return jam::WallRole::blade;
  if (name == "vessel") return jam::WallRole::vessel;
  if (name == "other") return jam::WallRole::other;
  throw py::value_error("role '" + name + "', expected blade, vessel or other");
}

}  // namespace

void bind_graph(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(jam::ContactGraph::Neighbor, vertex, contact);

  py::class_<jam::Components, std::shared_ptr<jam::Components>>(m, "Components", "Connected components: the largest is 0, ties go to the one with the smallest id.")
      .def_readonly_static("none", &jam::Components::none, "Label of particles that were left out.")
      .def_property_readonly("label", [](const py::object& self) { return view(self.cast<const jam::Components&>().label, self); }, "[N] component of each particle")
      .def_property_readonly("size", [](const py::object& self) { return view(self.cast<const jam::Components&>().size, self); }, "[K] particles of each component, descending")
      .def("__len__", [](const jam::Components& c) { return c.size.size(); });

  py::class_<Graph>(m, "ContactGraph",
                    "The contact network of a frame. A vertex is the particle's row, an edge the row of `frame.contacts`; walls are labelled ends, never vertices. Every recorded "
                    "contact is an edge, adhesive necks too.")
      .def_property_readonly("vertex_count", [](const Graph& g) { return g.graph().vertex_count(); }, "Particles.")
      .def_property_readonly("edge_count", [](const Graph& g) { return g.graph().edge_count(); }, "Contacts of two particles.")
      .def_property_readonly("wall_contact_count", [](const Graph& g) { return g.graph().wall_contact_count(); }, "Contacts with walls.")
      .def_property_readonly("edges", [](const py::object& self) { return view(self.cast<const Graph&>().frame->snapshot->pp.row, self); }, "[C,2] rows of the two particles of each contact")
      .def_property_readonly(
          "degree",
          [](const Graph& g) {
            std::vector<std::uint32_t> degree(g.graph().vertex_count());
            for (std::uint32_t v = 0; v < degree.size(); ++v) degree[v] = std::uint32_t(g.graph().degree(v));
            return owned(std::move(degree));
          },
          "[N] contacts of each particle with others")
      .def(
          "neighbors",
          [](const py::object& self, std::ptrdiff_t row) {
            const auto& g = self.cast<const Graph&>();
            const auto found = g.graph().neighbors(g.vertex(row));
            return read_only(py::dtype::of<jam::ContactGraph::Neighbor>(), {py::ssize_t(found.size())}, {py::ssize_t(sizeof(jam::ContactGraph::Neighbor))}, found.data(), self);
          },
          py::arg("row"), "Those that touch the particle in this row, ascending: structured, `vertex` is the row of the other, `contact` that of frame.contacts.")
      .def(
          "wall_contacts",
          [](const py::object& self, std::ptrdiff_t row, const std::optional<std::string>& role) {
            const auto& g = self.cast<const Graph&>();
            const auto found = role ? g.graph().wall_contacts(g.vertex(row), role_named(*role)) : g.graph().wall_contacts(g.vertex(row));
            return view(found.data(), found.size(), self);
          },
          py::arg("row"), py::arg("role") = py::none(), "Rows of frame.wall_contacts of the particle in this row: by role, then ascending; or of walls of one role only.")
      .def(
          "components",
          [](const Graph& g, const std::optional<Mask>& particles, const std::optional<Mask>& contacts) {
            const auto keep_vertex = as_flags(particles, g.graph().vertex_count(), "particles"), keep_contact = as_flags(contacts, g.graph().edge_count(), "contacts");
            return std::make_shared<jam::Components>(jam::connected_components(g.graph(), keep_vertex, keep_contact));
          },
          py::arg("particles") = py::none(), py::arg("contacts") = py::none(),
          "Connected components of the particles where the mask `particles`, [N], is true, joined by the contacts where `contacts`, [C], is; of all without masks. For example "
          "those under load: components(contacts=frame.contacts.normal_force > 1)")
      .def("__repr__", [](const Graph& g) { return fmt::format("<jamscope.ContactGraph of {} particles, {} contacts, {} with walls>", g.graph().vertex_count(), g.graph().edge_count(), g.graph().wall_contact_count()); });

  py::class_<Frame, std::shared_ptr<Frame>> frame = m.attr("Frame");
  frame.def_property_readonly("graph", [](const std::shared_ptr<Frame>& f) { return Graph{f}; }, "The contact network.");
}

}  // namespace jamscope::python
