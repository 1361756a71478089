#include "libjam/snapshot/export/graphml.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "libjam/snapshot/export/columns.hpp"
#include "libjam/snapshot/export/output_file.hpp"

namespace jam {
namespace {

// The attributes that a file declares; ids are unique in it, as GraphML wants.
struct Key {
  const char* id;
  const char* owner;  // "graph", "node", "edge"
  const char* name;
  const char* type;
};
constexpr Key keys[] = {
    {"g_frame", "graph", "frame", "long"},
    {"g_step", "graph", "step", "long"},
    {"g_time", "graph", "time", "double"},
    {"n_label", "node", "label", "string"},
    {"n_kind", "node", "kind", "string"},
    {"n_role", "node", "role", "string"},
    {"n_id", "node", "particle", "long"},
    {"n_x", "node", "x", "double"},
    {"n_y", "node", "y", "double"},
    {"n_z", "node", "z", "double"},
    {"n_radius", "node", "radius", "double"},
    {"n_material", "node", "material", "string"},
    {"n_force", "node", "compressive_force", "double"},
    {"n_coordination", "node", "coordination", "long"},
    {"e_weight", "edge", "weight", "double"},
    {"e_normal", "edge", "normal_force", "double"},
    {"e_damping", "edge", "damping_force", "double"},
    {"e_tangential", "edge", "tangential_force", "double"},
    {"e_overlap", "edge", "overlap", "double"},
    {"e_birth", "edge", "birth_step", "long"},
    {"e_flags", "edge", "flags", "long"},
    {"e_facet", "edge", "facet", "long"},
};

const char* word(WallRole role) {
  switch (role) {
    case WallRole::blade: return "blade";
    case WallRole::vessel: return "vessel";
    case WallRole::other: break;
  }
  return "other";
}

void data(std::string& text, const char* key, const std::string& value) {
  text.append("<data key=\"").append(key).append("\">").append(xml_text(value)).append("</data>");
}
template <class Number>
requires std::is_arithmetic_v<Number>
void data(std::string& text, const char* key, Number value) {
  text.append("<data key=\"").append(key).append("\">");
  append_number(text, value);
  text += "</data>";
}

template <class Contacts>
void edge_data(std::string& text, const Contacts& c, std::size_t k) {
  const auto has = [&](const auto& column) { return present(column, c.size()); };
  const double damping = has(c.damping_force) ? double{c.damping_force[k]} : 0;
  data(text, "e_weight", std::max(double{c.normal_force[k]} + damping, 0.0));
  data(text, "e_normal", c.normal_force[k]);
  if (has(c.damping_force)) data(text, "e_damping", c.damping_force[k]);
  if (has(c.tangential_force)) data(text, "e_tangential", c.tangential_force[k].norm());
  if (has(c.overlap)) data(text, "e_overlap", c.overlap[k]);
  if (has(c.birth_step)) data(text, "e_birth", c.birth_step[k]);
  if (has(c.flags)) data(text, "e_flags", c.flags[k]);
}

class GraphmlExporter final : public SnapshotExporter {
 public:
  GraphmlExporter(const RunInfo& info, const std::filesystem::path& folder) : info_(info), folder_(folder) {}

  void add(std::size_t number, const Snapshot& s) override {
    std::string digits = std::to_string(number);
    digits.insert(0, 6 - std::min<std::size_t>(6, digits.size()), '0');
    OutputFile file(folder_ / ("frame_" + digits + ".graphml"));
    std::string& text = file.text();
    text +=
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\" "
        "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" xsi:schemaLocation=\"http://graphml.graphdrawing.org/xmlns "
        "http://graphml.graphdrawing.org/xmlns/1.0/graphml.xsd\">\n";
    for (const Key& key : keys) {
      text.append("<key id=\"").append(key.id).append("\" for=\"").append(key.owner).append("\" attr.name=\"");
      text.append(key.name).append("\" attr.type=\"").append(key.type).append("\"/>\n");
    }
    text += "<graph id=\"contacts\" edgedefault=\"undirected\">\n";
    data(text, "g_frame", number);
    data(text, "g_step", s.step);
    data(text, "g_time", s.time);
    text += '\n';
    add_nodes(file, s);
    add_edges(file, s);
    text += "</graph>\n</graphml>\n";
    file.finish();
    if (files_.empty()) files_.push_back(file.path());
  }

  std::vector<std::filesystem::path> finish() override { return files_; }

 private:
  void add_nodes(OutputFile& file, const Snapshot& s) const {
    std::string& text = file.text();
    const Particles& p = s.particles;
    const std::vector<float> force = compressive_force_of(s);
    const std::vector<std::uint32_t> coordination = coordination_of(s);
    const bool material_known = present(p.material, p.size());
    for (std::size_t i = 0; i < p.size(); ++i) {
      const std::string id = std::to_string(p.id[i]);
      text.append("<node id=\"p").append(id).append("\">");
      data(text, "n_label", id);
      data(text, "n_kind", std::string("particle"));
      data(text, "n_id", p.id[i]);
      data(text, "n_x", p.position[i].x());
      data(text, "n_y", p.position[i].y());
      data(text, "n_z", p.position[i].z());
      data(text, "n_radius", p.radius[i]);
      if (material_known) data(text, "n_material", info_.materials[p.material[i]].name);
      data(text, "n_force", force[i]);
      data(text, "n_coordination", coordination[i]);
      text += "</node>\n";
      file.flush_if_large();
    }
    for (std::size_t w = 0; w < info_.walls.size(); ++w) {
      if (std::find(s.pw.wall.begin(), s.pw.wall.end(), w) == s.pw.wall.end()) continue;
      text.append("<node id=\"w").append(std::to_string(w)).append("\">");
      data(text, "n_label", info_.walls[w].name);
      data(text, "n_kind", std::string("wall"));
      data(text, "n_role", std::string(word(info_.walls[w].role)));
      text += "</node>\n";
    }
  }

  static void add_edges(OutputFile& file, const Snapshot& s) {
    std::string& text = file.text();
    // Two edges between the same nodes are told apart by their ids.
    std::size_t number = 0;
    const auto begin = [&](ParticleId source, const char* kind, std::uint64_t target) {
      text.append("<edge id=\"c").append(std::to_string(number++)).append("\" source=\"p").append(std::to_string(source));
      text.append("\" target=\"").append(kind).append(std::to_string(target)).append("\">");
    };
    for (std::size_t k = 0; k < s.pp.size(); ++k) {
      begin(s.particles.id[s.pp.row[k][0]], "p", s.particles.id[s.pp.row[k][1]]);
      edge_data(text, s.pp, k);
      text += "</edge>\n";
      file.flush_if_large();
    }
    for (std::size_t k = 0; k < s.pw.size(); ++k) {
      begin(s.particles.id[s.pw.row[k]], "w", s.pw.wall[k]);
      edge_data(text, s.pw, k);
      if (present(s.pw.facet, s.pw.size())) data(text, "e_facet", s.pw.facet[k]);
      text += "</edge>\n";
      file.flush_if_large();
    }
  }

  RunInfo info_;
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace

std::unique_ptr<SnapshotExporter> export_graphml(const RunInfo& info, const std::filesystem::path& folder) {
  return std::make_unique<GraphmlExporter>(info, folder);
}

}  // namespace jam
