// [wall.NAME] tables of a case file: walls beside those of a rheometer, or all walls of another scene.
#pragma once
#include <string>
#include <vector>

#include "apps/jamscope/toml_reader.hpp"
#include "libdem/scene/scene.hpp"

namespace jamscope {

// `walls` is the section [wall]; materials are looked up in `c`; relative file names are relative to the folder of `path`. Problems
// go to the document, with file, line and column; what is returned is then incomplete.
std::vector<dem::SceneWall> read_walls(Section walls, const dem::Case& c, const std::string& path, Document& document);

// Reads a blade of twisted arms; used for [blade] and for walls of that kind.
void read_twisted(Section& section, dem::TwistedBlade& blade);

// Reads `file` and `file_unit`.
void read_mesh_file(Section& section, const std::string& path, Document& document, dem::MeshFile& mesh);

// A list of three, "x", "y", "z".
bool read_vector(Section& section, Document& document, std::string_view key, const Dimension& dimension, dem::Vec3& out,
                 Need need = Need::required);

// A table of poses from a CSV file with the header time,x,y,z,qw,qx,qy,qz: s, m, and the quaternion that turns the body frame.
// Throws dem::CaseError, naming file and line.
dem::PoseTable read_pose_table(const std::string& path);

}  // namespace jamscope
