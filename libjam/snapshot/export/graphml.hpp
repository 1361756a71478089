// The contact network of each frame as GraphML, which networkx, igraph and Gephi read.
//
// A node a particle, "pID", and a node a wall that is touched, "wNUMBER": walls are labelled ends of the network
// (kind = "wall", with name and role), particles have kind = "particle", position, radius, compressive_force. An undirected
// edge a contact; a particle that touches a wall in two places has two edges to it. `weight` is the repulsive normal force,
// 0 for contacts that pull.
#pragma once
#include <filesystem>
#include <memory>

#include "libjam/snapshot/export/export_formats.hpp"

namespace jam {

std::unique_ptr<SnapshotExporter> export_graphml(const RunInfo& info, const std::filesystem::path& folder);

}  // namespace jam
