#include "libjam/snapshot/formats/assemble.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "libjam/errors.hpp"

namespace jam {
namespace {

using RowPair = std::array<std::uint32_t, 2>;

// A whole number from 0 to `most`.
std::uint64_t to_whole(const Table& table, std::size_t row, int field, std::uint64_t most) {
  const double value = table.at(row, field);
  if (!(value >= 0 && value <= static_cast<double>(most)) || value != std::floor(value)) {
    table.fail(row, table.fields[static_cast<std::size_t>(field)] + " is " + std::to_string(value) +
                        ", expected a whole number from 0 to " + std::to_string(most));
  }
  return static_cast<std::uint64_t>(value);
}

std::uint32_t to_id(const Table& table, std::size_t row, int field) {
  return static_cast<std::uint32_t>(to_whole(table, row, field, 4294967295U));
}

constexpr std::uint64_t most_steps = std::uint64_t{1} << 53;  // the last whole number that a double holds with all before it
constexpr std::uint64_t all_flags = contact_sliding | contact_neck | contact_recovered | contact_merged;

// The columns that contacts with particles and with walls have in common and that are taken as they stand.
struct RecordedFields {
  int damping = -1, birth_step = -1, flags = -1;
  explicit RecordedFields(const Table& table)
      : damping(table.find("damping")), birth_step(table.find("birth_step")), flags(table.find("flags")) {}
};

// Particles in double precision, sorted by id.
struct Bodies {
  std::vector<ParticleId> id;
  std::vector<Vec3> position, force;
  std::vector<double> radius, mass;
  std::vector<std::size_t> source;  // row of the table
  bool has_force = false, has_mass = false;

  std::uint32_t row_of(const Table& table, std::size_t row, int field) const {
    const std::uint32_t wanted = to_id(table, row, field);
    const auto found = std::lower_bound(id.begin(), id.end(), wanted);
    if (found == id.end() || *found != wanted) {
      table.fail(row, "the contact names particle " + std::to_string(wanted) + ", which is not among the " +
                          std::to_string(id.size()) + " particles of this frame");
    }
    return static_cast<std::uint32_t>(found - id.begin());
  }
};

std::vector<std::size_t> material_rows(const Table& table, const ImportMap& map) {
  std::vector<std::size_t> material(table.rows(), 0);
  const int type = table.find("material");
  if (type < 0) {
    for (std::size_t m = 0; m < map.materials.size(); ++m) {
      if (map.materials[m].type < 0) {
        std::fill(material.begin(), material.end(), m);
        break;
      }
    }
    return material;
  }
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto found = std::find_if(map.materials.begin(), map.materials.end(), [&](const ImportMaterial& m) {
      return m.type >= 0 && static_cast<double>(m.type) == table.at(row, type);
    });
    if (found == map.materials.end()) {
      table.fail(row, "material " + std::to_string(table.at(row, type)) + " is the type of no material of the map");
    }
    material[row] = static_cast<std::size_t>(found - map.materials.begin());
  }
  return material;
}

Bodies read_bodies(const Table& table, const ImportMap& map, Particles& particles) {
  const std::size_t n = table.rows();
  const int id = table.find("id"), x = table.find("x"), v = table.find("vx"), w = table.find("wx");
  const int radius = table.find("radius"), diameter = table.find("diameter"), volume = table.find("volume"),
            f = table.find("fx");
  const int compressive = table.find("compressive_force");
  const double length = map.units.length;

  std::vector<ParticleId> ids(n);
  for (std::size_t row = 0; row < n; ++row) ids[row] = to_id(table, row, id);
  Bodies bodies;
  bodies.source.resize(n);
  std::iota(bodies.source.begin(), bodies.source.end(), std::size_t{0});
  std::stable_sort(bodies.source.begin(), bodies.source.end(),
                   [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  const std::vector<std::size_t> material = material_rows(table, map);

  bodies.has_force = f >= 0;
  bodies.has_mass = !map.materials.empty() && std::all_of(material.begin(), material.end(), [&](std::size_t m) {
    return map.materials[m].material.density > 0;
  });
  for (const std::size_t row : bodies.source) {
    if (!bodies.id.empty() && bodies.id.back() == ids[row]) {
      table.fail(row, "particle " + std::to_string(ids[row]) + " is listed twice in this frame");
    }
    const double r = length * (radius >= 0     ? table.at(row, radius)
                               : diameter >= 0 ? table.at(row, diameter) / 2
                                               : std::cbrt(table.at(row, volume) * 3 / (4 * std::numbers::pi)));
    if (!(r > 0))
      table.fail(row,
                 "the radius of particle " + std::to_string(ids[row]) + " is " + std::to_string(r) + ", expected > 0");
    bodies.id.push_back(ids[row]);
    bodies.position.push_back(length * table.vector_at(row, x));
    bodies.radius.push_back(r);
    if (bodies.has_force) bodies.force.push_back(map.units.force * table.vector_at(row, f));
    if (bodies.has_mass) {
      bodies.mass.push_back(map.materials[material[row]].material.density * 4.0 / 3.0 * std::numbers::pi * r * r * r);
    }
    particles.position.push_back(bodies.position.back().cast<float>());
    particles.radius.push_back(static_cast<float>(r));
    if (v >= 0) particles.velocity.push_back((map.units.velocity * table.vector_at(row, v)).cast<float>());
    if (w >= 0)
      particles.angular_velocity.push_back((map.units.angular_velocity * table.vector_at(row, w)).cast<float>());
    if (!map.materials.empty()) particles.material.push_back(static_cast<std::uint8_t>(material[row]));
    if (compressive >= 0)
      particles.compressive_force.push_back(static_cast<float>(map.units.force * table.at(row, compressive)));
  }
  particles.id = bodies.id;
  return bodies;
}

// The three ways to give a contact's force, in one: normal force along `normal` (from the first body to the second; the
// force is the one on the first), and what of it is tangential.
struct ContactForce {
  double normal_force = 0;
  Vec3 tangential = Vec3::Zero();
};

struct ForceFields {
  int total = -1, normal_vector = -1, normal = -1, tangential = -1;
  explicit ForceFields(const Table& table)
      : total(table.find("f_x")),
        normal_vector(table.find("fn_x")),
        normal(table.find("fn")),
        tangential(table.find("ft_x")) {}
  bool knows_tangential() const { return total >= 0 || tangential >= 0; }
  ContactForce at(const Table& table, std::size_t row, const Vec3& normal_direction, double unit) const {
    ContactForce force;
    if (tangential >= 0) force.tangential = unit * table.vector_at(row, tangential);
    if (total < 0 && normal_vector < 0) {
      force.normal_force = unit * table.at(row, normal);
      return force;
    }
    const Vec3 vector = unit * table.vector_at(row, total >= 0 ? total : normal_vector);
    force.normal_force = -vector.dot(normal_direction);
    // The part across the normal: all of the tangential force, or the rounding of a normal vector, kept so that the sum
    // of the contact forces stays what the source printed.
    if (knows_tangential()) force.tangential += vector + force.normal_force * normal_direction;
    return force;
  }
};

// Shortest of the periodic images.
Vec3 branch(const Vec3& from, const Vec3& to, const Vec3& period) {
  Vec3 d = to - from;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (period[axis] > 0) d[axis] -= period[axis] * std::round(d[axis] / period[axis]);
  }
  return d;
}

void read_pairs(const Table& table, const ImportMap& map, const Bodies& bodies, std::vector<Residual>& residual,
                ParticleContacts& contacts) {
  struct Row {
    RowPair row;
    double normal_force, overlap;
    Vec3 tangential;
    std::size_t source;
  };
  const int id1 = table.find("id1"), id2 = table.find("id2"), overlap = table.find("overlap"),
            distance = table.find("distance");
  const ForceFields fields(table);
  const RecordedFields recorded(table);
  const Vec3 period = map.units.length * table.period;
  std::vector<Row> rows;
  rows.reserve(table.rows());
  for (std::size_t r = 0; r < table.rows(); ++r) {
    std::uint32_t a = bodies.row_of(table, r, id1), b = bodies.row_of(table, r, id2);
    if (a == b) table.fail(r, "particle " + std::to_string(bodies.id[a]) + " touches itself, expected two particles");
    const Vec3 d = branch(bodies.position[a], bodies.position[b], period);
    const double centres = d.norm(), radii = bodies.radius[a] + bodies.radius[b];
    if (!(centres > 0)) table.fail(r, "the two particles have the same centre, the contact has no normal");
    if (centres > 2 * radii) {
      table.fail(r, "particles " + std::to_string(bodies.id[a]) + " and " + std::to_string(bodies.id[b]) + " are " +
                        std::to_string(centres / radii) +
                        " times the sum of their radii apart; the ids or the unit of length are wrong");
    }
    const ContactForce force = fields.at(table, r, d / centres, map.units.force);
    const double damping = recorded.damping >= 0 ? map.units.force * table.at(r, recorded.damping) : 0;
    const Vec3 on_a = force.tangential - (force.normal_force + damping) * d / centres;
    residual[a].force -= on_a;
    residual[b].force += on_a;
    residual[a].magnitude += on_a.norm();
    residual[b].magnitude += on_a.norm();
    double depth = radii - centres;
    if (overlap >= 0) depth = map.units.length * table.at(r, overlap);
    if (distance >= 0) depth = radii - map.units.length * table.at(r, distance);
    Row row{{a, b}, force.normal_force, depth, force.tangential, r};
    if (a > b) {
      std::swap(row.row[0], row.row[1]);
      row.tangential = -row.tangential;
    }
    rows.push_back(row);
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& p, const Row& q) { return p.row < q.row; });
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    if (k > 0 && rows[k - 1].row == row.row) {
      table.fail(row.source, "the contact of particles " + std::to_string(bodies.id[row.row[0]]) + " and " +
                                 std::to_string(bodies.id[row.row[1]]) + " is listed twice in this frame");
    }
    contacts.row.push_back(row.row);
    contacts.normal_force.push_back(static_cast<float>(row.normal_force));
    if (fields.knows_tangential()) contacts.tangential_force.push_back(row.tangential.cast<float>());
    contacts.overlap.push_back(static_cast<float>(row.overlap));
    std::uint64_t flags = row.overlap < 0 ? contact_neck : 0;
    if (recorded.flags >= 0) flags = to_whole(table, row.source, recorded.flags, all_flags);
    contacts.flags.push_back(static_cast<std::uint8_t>(flags));
    if (recorded.damping >= 0)
      contacts.damping_force.push_back(static_cast<float>(map.units.force * table.at(row.source, recorded.damping)));
    if (recorded.birth_step >= 0)
      contacts.birth_step.push_back(to_whole(table, row.source, recorded.birth_step, most_steps));
  }
}

// What the listed wall contacts know; a column of WallContacts is present when all of them do.
struct Known {
  bool facet = true, feature = true, point = true, normal = true, tangential = true, overlap = true;
  bool damping = false, birth_step = false;
};

// The wall of a row, by the number in the field `mesh` or the place of its name in the field `wall`.
std::size_t wall_of(const Table& table, std::size_t row, int mesh, int name, const ImportMap& map) {
  std::size_t wall = 0;
  if (name >= 0) {
    wall = static_cast<std::size_t>(table.at(row, name));
  } else if (mesh >= 0) {
    const double number = table.at(row, mesh);
    const auto holds = [&](const ImportWall& w) {
      return w.mesh_id >= 0 && number >= w.mesh_id && number < double{1} * w.mesh_id + w.mesh_count;
    };
    while (wall < map.walls.size() && !holds(map.walls[wall])) ++wall;
  }
  if (wall >= map.walls.size())
    table.fail(row, "mesh " + std::to_string(table.at(row, mesh)) + " is the mesh_id of no wall of the map");
  return wall;
}

// Poses, velocities and loads of all walls in one frame.
void read_wall_states(const Table& table, const ImportMap& map, std::vector<WallState>& states) {
  const int mesh = table.find("mesh"), name = table.find("wall"), x = table.find("x"), q = table.find("qw");
  const int v = table.find("vx"), w = table.find("wx"), force = table.find("fx"), torque = table.find("tx");
  std::vector<char> found(map.walls.size(), 0);
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const std::size_t wall = wall_of(table, r, mesh, name, map);
    if (found[wall]++ != 0) table.fail(r, "the wall " + map.walls[wall].wall.name + " is listed twice in this frame");
    WallState& state = states[wall] = {};
    state.position = map.units.length * table.vector_at(r, x);
    const Eigen::Quaterniond turned(table.at(r, q), table.at(r, q + 1), table.at(r, q + 2), table.at(r, q + 3));
    if (!(std::abs(turned.norm() - 1) < 1e-3))
      table.fail(r, "the quaternion has length " + std::to_string(turned.norm()) + ", expected 1");
    // What was printed with all its digits is left as it is.
    state.orientation = std::abs(turned.norm() - 1) < 1e-12 ? turned : turned.normalized();
    if (map.walls[wall].recover &&
        (!state.position.isZero(0) || std::abs(state.orientation.w()) < 1 - printed_precision)) {
      table.fail(r, "the wall " + map.walls[wall].wall.name +
                        " is not at the origin; contacts of walls at rest only can be recovered from the force balance");
    }
    if (v >= 0) state.velocity = map.units.velocity * table.vector_at(r, v);
    if (w >= 0) state.angular_velocity = map.units.angular_velocity * table.vector_at(r, w);
    if (force >= 0) state.force = map.units.force * table.vector_at(r, force);
    if (torque >= 0) state.torque = map.units.torque * table.vector_at(r, torque);
  }
  for (std::size_t wall = 0; wall < found.size(); ++wall) {
    if (found[wall] == 0)
      table.fail(0, "the frame of step " + std::to_string(table.step) + " has no row for the wall " +
                        map.walls[wall].wall.name);
  }
}

void read_wall_list(const Table& table, const ImportMap& map, const RunInfo& info, const std::vector<WallState>& states,
                    const Bodies& bodies, std::vector<WallRecord>& records, Known& known, FrameCheck* check) {
  const int id = table.find("id"), mesh = table.find("mesh"), name = table.find("wall"), facet = table.find("facet");
  const int point = table.find("px"), normal = table.find("nx"), overlap = table.find("overlap");
  const ForceFields fields(table);
  const RecordedFields recorded(table);
  const int feature = table.find("feature");
  known.damping = recorded.damping >= 0;
  known.birth_step = recorded.birth_step >= 0;
  // What is known of one wall only is not known, in every frame, whether that wall is touched or not: frames of a run have
  // the same quantities.
  for (const ImportWall& entry : map.walls) {
    const bool numbers = facet >= 0 || (mesh >= 0 && name < 0 && entry.mesh_count > 1);
    const bool analytic = entry.wall.kind == "plane" || entry.wall.kind == "cylinder";
    if (entry.recover || !entry.array.empty()) continue;
    if (entry.wall.kind == "mesh") {
      if (!numbers) known.facet = false;
      if (!numbers || point < 0 || entry.wall.triangles.empty()) known.feature = false;
    }
    if (point < 0 && !analytic) known.point = false;
    if (point < 0 && normal < 0 && !analytic) known.normal = false;
    if (point < 0 && overlap < 0 && !analytic) known.overlap = false;
  }
  const double length = map.units.length;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    WallRecord record;
    record.row = bodies.row_of(table, r, id);
    const Vec3& centre = bodies.position[record.row];
    const double radius = bodies.radius[record.row];

    const std::size_t wall = wall_of(table, r, mesh, name, map);
    record.wall = static_cast<std::uint8_t>(wall);
    const Wall& shape = info.walls[wall];

    const bool numbered = facet < 0 && mesh >= 0 && name < 0 && map.walls[wall].mesh_count > 1;
    if (facet >= 0 || numbered) {
      record.facet = facet >= 0 ? to_id(table, r, facet)
                                : static_cast<std::uint32_t>(table.at(r, mesh) - map.walls[wall].mesh_id);
      if (!shape.triangles.empty() && record.facet >= shape.triangles.size()) {
        table.fail(r, "triangle " + std::to_string(record.facet) + ", but the mesh of wall " + shape.name + " has " +
                          std::to_string(shape.triangles.size()));
      }
    }
    bool has_normal = false;
    if (point >= 0) {
      record.point = length * table.vector_at(r, point);
      const double centres = (record.point - centre).norm();
      if (centres > 2 * radius) {
        table.fail(r, "the contact point is " + std::to_string(centres / radius) +
                          " radii from the centre of particle " + std::to_string(bodies.id[record.row]) +
                          "; the columns or the unit of length are wrong");
      }
      if (centres > 0) {
        record.normal = (record.point - centre) / centres;
        has_normal = true;
      }
      record.overlap = radius - centres;
    }
    if (normal >= 0) {
      const Vec3 n = table.vector_at(r, normal);
      if (!(std::abs(n.norm() - 1) < 1e-3))
        table.fail(r, "the normal has length " + std::to_string(n.norm()) + ", expected 1");
      // A unit vector of 32-bit numbers is left as it was recorded.
      record.normal = std::abs(n.norm() - 1) < 2e-7 ? n : n.normalized();
      has_normal = true;
    }
    if (shape.kind != "mesh" && (point < 0 || !has_normal)) {
      const WallState& state = states[wall];
      Nearest nearest = nearest_point(shape, state.orientation.conjugate() * (centre - state.position));
      nearest.point = state.position + state.orientation * nearest.point;
      nearest.normal = state.orientation * nearest.normal;
      if (std::isfinite(nearest.distance)) {
        if (point < 0) record.point = nearest.point;
        if (!has_normal) record.normal = nearest.normal;
        record.overlap = radius - nearest.distance;
        has_normal = true;
      }
    } else if (point < 0) {
      known.point = false;
      if (overlap < 0) known.overlap = false;
    }
    if (!has_normal) known.normal = false;
    if (!has_normal && fields.normal < 0) {
      table.fail(r, "the direction of the contact is not known: map px py pz or nx ny nz of wall " + shape.name);
    }
    const ContactForce force = fields.at(table, r, record.normal, map.units.force);
    record.normal_force = force.normal_force;
    record.tangential_force = force.tangential;
    if (overlap >= 0) record.overlap = length * table.at(r, overlap);
    if (!fields.knows_tangential()) known.tangential = false;
    if (shape.kind == "mesh") {
      if (facet < 0 && !numbered) known.facet = false;
      if ((facet >= 0 || numbered) && point >= 0 && !shape.triangles.empty()) {
        const Vec3 body = states[wall].orientation.conjugate() * (record.point - states[wall].position);
        const NearestOnTriangle nearest = nearest_on_triangle(shape, record.facet, body, 1e-3 * radius);
        record.feature = static_cast<std::uint8_t>(nearest.feature);
        if (check != nullptr) {
          ++check->points;
          // On an edge the distance is measured to the edge itself, so the tolerance above does not hide an error.
          check->largest_point_error = std::max(check->largest_point_error, nearest.distance);
        }
      } else {
        known.feature = false;
      }
    }
    if (feature >= 0) record.feature = static_cast<std::uint8_t>(to_whole(table, r, feature, 2));
    if (known.damping) record.damping_force = map.units.force * table.at(r, recorded.damping);
    if (known.birth_step) record.birth_step = to_whole(table, r, recorded.birth_step, most_steps);
    if (recorded.flags >= 0) {
      record.flags = static_cast<std::uint8_t>(to_whole(table, r, recorded.flags, all_flags));
      record.flags_known = true;
    }
    records.push_back(record);
  }
  if (feature >= 0) known.feature = true;
}

void read_wall_arrays(const Table& table, const ImportMap& map, const Bodies& bodies, std::vector<WallRecord>& records,
                      Known& known) {
  const int id = table.find("id");
  for (const ImportWall& entry : map.walls) {
    if (!entry.array.empty() && entry.wall.kind == "mesh") known.facet = known.feature = false;
  }
  for (std::size_t r = 0; r < table.rows(); ++r) {
    int field = 1;
    for (std::size_t wall = 0; wall < map.walls.size(); ++wall) {
      if (map.walls[wall].array.empty()) continue;
      const int group = field;
      field += 8;
      const double flag = table.at(r, group);
      if (flag == 0) continue;
      if (flag != 1)
        table.fail(
            r, "the flag of wall " + map.walls[wall].wall.name + " is " + std::to_string(flag) + ", expected 0 or 1");
      WallRecord record;
      record.row = bodies.row_of(table, r, id);
      record.wall = static_cast<std::uint8_t>(wall);
      const Vec3 force = map.units.force * table.vector_at(r, group + 1);
      record.point = map.units.length * table.vector_at(r, group + 4);
      const Vec3 d = record.point - bodies.position[record.row];
      const double distance = d.norm(), radius = bodies.radius[record.row];
      if (!(distance > 0) || distance > 2 * radius) {
        table.fail(r, "the contact point with wall " + map.walls[wall].wall.name + " is " +
                          std::to_string(distance / radius) + " radii from the centre of particle " +
                          std::to_string(bodies.id[record.row]));
      }
      record.normal = d / distance;
      record.normal_force = -force.dot(record.normal);
      record.tangential_force = force + record.normal_force * record.normal;
      record.overlap = radius - distance;
      records.push_back(record);
    }
  }
}

void store(const std::vector<WallRecord>& records, const Known& known, WallContacts& contacts) {
  for (const WallRecord& record : records) {
    contacts.row.push_back(record.row);
    contacts.wall.push_back(record.wall);
    contacts.normal_force.push_back(static_cast<float>(record.normal_force));
    if (known.facet) contacts.facet.push_back(record.facet);
    if (known.feature) contacts.feature.push_back(record.feature);
    if (known.point) contacts.point.push_back(record.point.cast<float>());
    if (known.normal) contacts.normal.push_back(record.normal.cast<float>());
    if (known.tangential) contacts.tangential_force.push_back(record.tangential_force.cast<float>());
    if (known.overlap) contacts.overlap.push_back(static_cast<float>(record.overlap));
    if (known.damping) contacts.damping_force.push_back(static_cast<float>(record.damping_force));
    if (known.birth_step) contacts.birth_step.push_back(record.birth_step);
    const bool neck = !record.flags_known && known.overlap && record.overlap < 0;
    contacts.flags.push_back(static_cast<std::uint8_t>(record.flags | (neck ? contact_neck : 0)));
  }
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void need(const ColumnMap& columns, const std::vector<std::string>& any_of, const std::string& table,
          const std::string& origin) {
  for (const std::string& field : any_of) {
    if (columns.count(field) > 0) return;
  }
  throw DataError(origin + ": " + table + " maps no column to " + (any_of.size() > 1 ? "any of " : "") +
                  join_names(any_of));
}

}  // namespace

const std::vector<std::string>& known_particle_fields() {
  static const std::vector<std::string> names{"frame",  "time",     "id",       "x",  "y",  "z",
                                              "radius", "diameter", "vx",       "vy", "vz", "wx",
                                              "wy",     "wz",       "material", "fx", "fy", "fz",
                                              "compressive_force", "volume"};
  return names;
}

const std::vector<std::string>& known_pair_fields() {
  static const std::vector<std::string> names{"frame", "id1", "id2",  "f_x",  "f_y",  "f_z",     "fn_x",    "fn_y",
                                              "fn_z",  "fn",  "ft_x", "ft_y", "ft_z", "overlap", "distance",
                                              "damping", "birth_step", "flags"};
  return names;
}

const std::vector<std::string>& known_wall_fields() {
  static const std::vector<std::string> names{"frame", "id",   "mesh", "wall", "facet", "f_x",    "f_y",  "f_z",
                                              "fn_x",  "fn_y", "fn_z", "fn",   "ft_x",  "ft_y",   "ft_z", "px",
                                              "py",    "pz",   "nx",   "ny",   "nz",    "overlap", "damping",
                                              "birth_step", "flags", "feature"};
  return names;
}

const std::vector<std::string>& known_wall_state_fields() {
  static const std::vector<std::string> names{"frame", "mesh", "wall", "x",  "y",  "z",  "qw", "qx", "qy", "qz", "vx",
                                              "vy",    "vz",   "wx",   "wy", "wz", "fx", "fy", "fz", "tx", "ty", "tz"};
  return names;
}

void check_map(const ImportMap& map) {
  const std::string origin = map.origin.empty() ? "map" : map.origin;
  const auto positive = [&](double value, const std::string& name) {
    if (!(value > 0) || !std::isfinite(value))
      throw DataError(origin + ": " + name + " is " + std::to_string(value) + ", expected > 0");
  };
  const auto finite = [&](const Vec3& value, const std::string& name) {
    if (!value.allFinite()) throw DataError(origin + ": " + name + " is not finite");
  };
  positive(map.units.length, "units.length");
  positive(map.units.time, "units.time");
  positive(map.units.velocity, "units.velocity");
  positive(map.units.angular_velocity, "units.angular_velocity");
  positive(map.units.force, "units.force");
  positive(map.units.torque, "units.torque");
  if (!(map.dt >= 0) || !std::isfinite(map.dt))
    throw DataError(origin + ": dt is " + std::to_string(map.dt) + ", expected >= 0");
  if (!(map.touch_tolerance >= 0 && map.touch_tolerance < 1)) {
    throw DataError(origin + ": touch_tolerance is " + std::to_string(map.touch_tolerance) +
                    ", expected 0 <= value < 1");
  }
  finite(map.gravity, "gravity");

  ordered_fields(map.particles.columns, known_particle_fields(), origin + ": particles");
  need(map.particles.columns, {"id"}, "particles", origin);
  need(map.particles.columns, {"x"}, "particles", origin);
  need(map.particles.columns, {"radius", "diameter", "volume"}, "particles", origin);
  if (map.pair_contacts.used()) {
    ordered_fields(map.pair_contacts.columns, known_pair_fields(), origin + ": pair_contacts");
    need(map.pair_contacts.columns, {"id1"}, "pair_contacts", origin);
    need(map.pair_contacts.columns, {"id2"}, "pair_contacts", origin);
    need(map.pair_contacts.columns, {"f_x", "fn_x", "fn"}, "pair_contacts", origin);
  }
  if (map.wall_contacts.used()) {
    ordered_fields(map.wall_contacts.columns, known_wall_fields(), origin + ": wall_contacts");
    need(map.wall_contacts.columns, {"id"}, "wall_contacts", origin);
    need(map.wall_contacts.columns, {"f_x", "fn_x", "fn"}, "wall_contacts", origin);
    if (map.walls.empty()) throw DataError(origin + ": wall_contacts is mapped but the map has no walls");
    if (map.walls.size() > 1) need(map.wall_contacts.columns, {"mesh", "wall"}, "wall_contacts", origin);
  }
  if (map.wall_arrays.used()) need(map.wall_arrays.columns, {"id"}, "wall_arrays", origin);
  if (map.wall_states.used()) {
    ordered_fields(map.wall_states.columns, known_wall_state_fields(), origin + ": wall_states");
    if (map.walls.size() > 1) need(map.wall_states.columns, {"mesh", "wall"}, "wall_states", origin);
    for (const char* field : {"x", "qw", "qx", "qy", "qz"})
      need(map.wall_states.columns, {field}, "wall_states", origin);
  }
  if (map.wall_loads.used()) {
    for (const char* field : {"time", "fx", "fy", "fz", "tx", "ty", "tz"})
      need(map.wall_loads.columns, {field}, "wall_loads", origin);
  }
  if (map.walls.size() > 255)
    throw DataError(origin + ": " + std::to_string(map.walls.size()) + " walls, expected at most 255");
  if (map.materials.size() > 255)
    throw DataError(origin + ": " + std::to_string(map.materials.size()) + " materials, expected at most 255");
  std::set<std::string> names;
  bool any_recovered = false, any_array = false, any_loads = false;
  for (const ImportWall& entry : map.walls) {
    const Wall& wall = entry.wall;
    const std::string name = "wall " + wall.name;
    if (wall.name.empty()) throw DataError(origin + ": a wall has no name");
    if (!names.insert(wall.name).second) throw DataError(origin + ": two walls are called " + wall.name);
    if (wall.kind != "plane" && wall.kind != "cylinder" && wall.kind != "cone" && wall.kind != "disc" &&
        wall.kind != "spheres" && wall.kind != "mesh") {
      throw DataError(origin + ": " + name + " is of kind '" + wall.kind +
                      "', expected plane, cylinder, cone, disc, spheres or mesh");
    }
    if (entry.mesh_count < 1) throw DataError(origin + ": " + name + " has a mesh_count below 1");
    if (wall.kind == "cylinder" || wall.kind == "disc") positive(wall.radius, name + ": radius");
    if (wall.kind != "mesh" && wall.kind != "spheres" && !(wall.axis.norm() > 0))
      throw DataError(origin + ": " + name + " has a zero normal or axis");
    finite(wall.point, name + ": point");
    finite(wall.axis, name + ": axis");
    finite(entry.position, name + ": position");
    finite(entry.velocity, name + ": velocity");
    finite(entry.angular_velocity, name + ": angular_velocity");
    if (!std::isfinite(entry.motion_start)) throw DataError(origin + ": " + name + ": motion_start is not finite");
    for (const Vec3& vertex : wall.vertices) finite(vertex, name + ": a vertex");
    for (const auto& triangle : wall.triangles) {
      for (const std::uint32_t vertex : triangle) {
        if (vertex >= wall.vertices.size())
          throw DataError(origin + ": " + name + ": a triangle names vertex " + std::to_string(vertex));
      }
    }
    if (!wall.material.empty() &&
        std::none_of(map.materials.begin(), map.materials.end(),
                     [&](const ImportMaterial& m) { return m.material.name == wall.material; })) {
      throw DataError(origin + ": " + name + " is of material '" + wall.material +
                      "', which the map does not describe");
    }
    if (entry.recover && wall.kind != "plane" && wall.kind != "cylinder") {
      throw DataError(origin + ": " + name + " is a " + wall.kind +
                      "; only planes and cylinders can be recovered from the force balance");
    }
    if (entry.recover && (entry.velocity.norm() > 0 || entry.angular_velocity.norm() > 0)) {
      throw DataError(origin + ": " + name + " moves; only walls at rest can be recovered from the force balance");
    }
    any_recovered |= entry.recover;
    any_array |= !entry.array.empty();
    if (entry.has_load_series && any_loads)
      throw DataError(origin + ": two walls have a load series, expected one at most");
    any_loads |= entry.has_load_series;
  }
  if (any_recovered) {
    need(map.particles.columns, {"fx"}, "particles (total forces are needed to recover wall contacts)", origin);
    if (map.materials.empty() || std::any_of(map.materials.begin(), map.materials.end(), [](const ImportMaterial& m) {
          return m.material.density < 0 || !std::isfinite(m.material.density);
        })) {
      throw DataError(origin + ": recovering wall contacts needs materials with a density");
    }
  }
  if (map.wall_arrays.used() && !any_array)
    throw DataError(origin + ": wall_arrays is mapped but no wall has an array");
  if (map.wall_loads.used() && !any_loads)
    throw DataError(origin + ": wall_loads is mapped but no wall has a load series");
  if (!map.interactions.empty()) {
    bool square = map.interactions.size() == map.materials.size();
    for (const auto& row : map.interactions) square = square && row.size() == map.materials.size();
    if (!square) throw DataError(origin + ": interactions are not one row and column a material");
  }
}

std::vector<Field> array_fields(const ImportMap& map) {
  std::vector<Field> fields = ordered_fields(map.wall_arrays.columns, {"id"}, "wall_arrays");
  for (std::size_t wall = 0; wall < map.walls.size(); ++wall) {
    if (map.walls[wall].array.empty()) continue;
    for (int k = 1; k <= 8; ++k) {
      const std::string column = map.walls[wall].array + "[" + std::to_string(k) + "]";
      fields.push_back({column, column});
    }
  }
  return fields;
}

RunInfo run_info(const ImportMap& map) {
  RunInfo info;
  info.creator = map.creator.empty() ? map.format : map.creator;
  info.gravity = map.gravity;
  info.dt = map.dt;
  for (const ImportMaterial& material : map.materials) info.materials.push_back(material.material);
  info.interactions = map.interactions;
  info.case_toml = map.case_toml;
  info.case_sha256 = map.case_sha256;
  for (const ImportWall& wall : map.walls) {
    info.walls.push_back(wall.wall);
    if (std::abs(wall.wall.axis.norm() - 1) > 1e-12) info.walls.back().axis.normalize();
  }
  info.gap = map.gap;
  if (info.gap.tip_radius == 0) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const ImportWall& wall : map.walls) {
      if (wall.wall.role != WallRole::blade || wall.wall.vertices.empty()) continue;
      const Vec3 axis = wall.angular_velocity.norm() > 0 ? Vec3(wall.angular_velocity.normalized()) : Vec3::UnitZ();
      for (const Vec3& vertex : wall.wall.vertices) {
        info.gap.tip_radius = std::max(info.gap.tip_radius, (vertex - vertex.dot(axis) * axis).norm());
        low = std::min(low, vertex.z());
        high = std::max(high, vertex.z());
      }
    }
    if (info.gap.tip_radius > 0) {
      info.gap.z_low = low;
      info.gap.z_high = high;
    }
  }
  if (info.gap.vessel_radius == 0) {
    for (const Wall& wall : info.walls) {
      if (wall.role == WallRole::vessel && wall.kind == "cylinder")
        info.gap.vessel_radius = std::max(info.gap.vessel_radius, wall.radius);
    }
  }
  return info;
}

Snapshot assemble(const FrameTables& tables, const ImportMap& map, const RunInfo& info, FrameCheck* check) {
  Snapshot snapshot;
  snapshot.time = tables.time;
  snapshot.step = tables.particles.step;
  for (const ImportWall& wall : map.walls) snapshot.walls.push_back(wall_state(wall, tables.time));
  if (tables.wall_states) read_wall_states(*tables.wall_states, map, snapshot.walls);
  const bool loads_listed = tables.wall_states && tables.wall_states->has("fx") && tables.wall_states->has("tx");
  const Bodies bodies = read_bodies(tables.particles, map, snapshot.particles);
  const std::size_t n = bodies.id.size();

  std::vector<Residual> residual(n);
  for (std::size_t row = 0; row < n; ++row) {
    residual[row] = {Vec3::Zero(), 0.0};
    if (!bodies.has_force || !bodies.has_mass) continue;
    const Vec3 weight = bodies.mass[row] * map.gravity;
    residual[row].force = bodies.force[row] - weight;
    residual[row].magnitude = bodies.force[row].norm() + weight.norm();
  }
  if (tables.pairs) read_pairs(*tables.pairs, map, bodies, residual, snapshot.pp);

  std::vector<WallRecord> records;
  Known known;
  if (tables.walls) read_wall_list(*tables.walls, map, info, snapshot.walls, bodies, records, known, check);
  if (tables.arrays) read_wall_arrays(*tables.arrays, map, bodies, records, known);
  const auto by_place = [](const WallRecord& a, const WallRecord& b) {
    return std::tie(a.row, a.wall, a.facet) < std::tie(b.row, b.wall, b.facet);
  };
  std::stable_sort(records.begin(), records.end(), by_place);
  for (const WallRecord& record : records) {
    const Vec3 force = record.tangential_force - (record.normal_force + record.damping_force) * record.normal;
    residual[record.row].force -= force;
    residual[record.row].magnitude += force.norm();
  }
  if (known.point && known.normal && !map.one_record_a_touch) merge_shared_edges(records, info.walls, snapshot.walls, bodies.radius);

  std::vector<char> touches(n, 0);
  const bool balance_known = bodies.has_force && bodies.has_mass && tables.pairs && known.tangential;
  if (balance_known) {
    recover_contacts(map.walls, bodies.position, bodies.radius, residual, map.touch_tolerance, records, touches);
    std::stable_sort(records.begin(), records.end(), by_place);
  }
  store(records, known, snapshot.pw);

  if (known.normal && !loads_listed) {
    for (const WallRecord& record : records) {
      WallState& wall = snapshot.walls[record.wall];
      const Vec3 on_wall = (record.normal_force + record.damping_force) * record.normal - record.tangential_force;
      wall.force += on_wall;
      if (known.point) wall.torque += (record.point - wall.position).cross(on_wall);
    }
  }

  if (check != nullptr) {
    check->loads_known = loads_listed || ((tables.walls || tables.arrays) && known.normal && known.tangential);
    double radii = 0;
    for (const double r : bodies.radius) radii += r;
    check->mean_radius = n > 0 ? radii / static_cast<double>(n) : 0;
    if (balance_known) {
      std::vector<double> left, load;
      for (std::size_t row = 0; row < n; ++row) {
        if (touches[row] != 0) continue;
        left.push_back(residual[row].force.norm());
        load.push_back(residual[row].magnitude);
        if (left.back() > check->largest_residual) {
          check->largest_residual = left.back();
          check->largest_id = bodies.id[row];
        }
      }
      check->balanced = left.size();
      check->median_residual = median(left);
      check->median_load = median(load);
    }
  }
  return snapshot;
}

}  // namespace jam
