// The arrays of a frame as columns with the names and units of the schema, whatever their type.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "libjam/snapshot/hdf5.hpp"
#include "libjam/snapshot/schema.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// A column of a frame; refers to the snapshot.
struct FrameColumn {
  const schema::Item* item;
  const void* data;
  std::size_t rows;  // that of the frame, or 0 where the source does not know the quantity

  std::string_view name() const { return item->path.substr(item->path.rfind('/') + 1); }
  h5::Type type() const { return item->type; }
  unsigned width() const { return item->width; }
};

// In the order of the schema. Among the first columns are the keys: id; row; row and wall.
std::vector<FrameColumn> particle_columns(const Snapshot& snapshot);
std::vector<FrameColumn> pair_columns(const Snapshot& snapshot);
std::vector<FrameColumn> wall_contact_columns(const Snapshot& snapshot);

// Appends one number of a column as text.
void append_value(std::string& text, const FrameColumn& column, std::size_t row, unsigned component);

// N a particle: what the source recorded, or the sum of the repulsive normal forces of its contacts (damping included).
std::vector<float> compressive_force_of(const Snapshot& snapshot);
// Contacts a particle, with walls too, necks too.
std::vector<std::uint32_t> coordination_of(const Snapshot& snapshot);

}  // namespace jam
