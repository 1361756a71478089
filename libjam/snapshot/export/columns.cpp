#include "libjam/snapshot/export/columns.hpp"

#include <algorithm>
#include <stdexcept>

#include "libjam/snapshot/export/output_file.hpp"

namespace jam {
namespace {

template <class Visit>
std::vector<FrameColumn> columns_of(Visit visit) {
  std::vector<FrameColumn> columns;
  visit([&](const schema::Item& item, const auto& values) { columns.push_back({&item, values.data(), values.size()}); });
  return columns;
}

template <class Number>
void append(std::string& text, const FrameColumn& column, std::size_t row, unsigned component) {
  append_number(text, static_cast<const Number*>(column.data)[row * column.width() + component]);
}

template <class Contacts>
double repulsive(const Contacts& contacts, std::size_t k) {
  const double damping = present(contacts.damping_force, contacts.size()) ? double{contacts.damping_force[k]} : 0;
  return std::max(double{contacts.normal_force[k]} + damping, 0.0);
}

}  // namespace

std::vector<FrameColumn> particle_columns(const Snapshot& snapshot) {
  return columns_of([&](auto f) { schema::visit_particles(snapshot.particles, f); });
}
std::vector<FrameColumn> pair_columns(const Snapshot& snapshot) {
  return columns_of([&](auto f) { schema::visit_pp(snapshot.pp, f); });
}
std::vector<FrameColumn> wall_contact_columns(const Snapshot& snapshot) {
  return columns_of([&](auto f) { schema::visit_pw(snapshot.pw, f); });
}

void append_value(std::string& text, const FrameColumn& column, std::size_t row, unsigned component) {
  switch (column.type()) {
    case h5::Type::f4: return append<float>(text, column, row, component);
    case h5::Type::f8: return append<double>(text, column, row, component);
    case h5::Type::u1: return append<std::uint8_t>(text, column, row, component);
    case h5::Type::u4: return append<std::uint32_t>(text, column, row, component);
    case h5::Type::u8: return append<std::uint64_t>(text, column, row, component);
    default: throw std::logic_error("a column of a frame has a type that no frame has");
  }
}

std::vector<float> compressive_force_of(const Snapshot& s) {
  if (present(s.particles.compressive_force, s.particles.size())) return s.particles.compressive_force;
  std::vector<double> sum(s.particles.size(), 0.0);
  for (std::size_t k = 0; k < s.pp.size(); ++k) {
    for (const std::uint32_t row : s.pp.row[k]) sum[row] += repulsive(s.pp, k);
  }
  for (std::size_t k = 0; k < s.pw.size(); ++k) sum[s.pw.row[k]] += repulsive(s.pw, k);
  return {sum.begin(), sum.end()};
}

std::vector<std::uint32_t> coordination_of(const Snapshot& s) {
  std::vector<std::uint32_t> count(s.particles.size(), 0);
  for (const auto& pair : s.pp.row) {
    ++count[pair[0]];
    ++count[pair[1]];
  }
  for (const std::uint32_t row : s.pw.row) ++count[row];
  return count;
}

}  // namespace jam
