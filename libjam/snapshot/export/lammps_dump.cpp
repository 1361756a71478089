#include "libjam/snapshot/export/lammps_dump.hpp"

#include <algorithm>

#include "libjam/snapshot/export/output_file.hpp"
#include "libjam/snapshot/export/text_columns.hpp"

namespace jam {
namespace {

// The bounds of a frame: those of its particles. Not periodic.
std::string box_of(const Particles& particles) {
  Vec3 low = Vec3::Zero(), high = Vec3::Ones();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3 x = particles.position[i].cast<double>(), r = Vec3::Constant(double{particles.radius[i]});
    low = i == 0 ? Vec3(x - r) : low.cwiseMin(x - r);
    high = i == 0 ? Vec3(x + r) : high.cwiseMax(x + r);
  }
  std::string text = "ITEM: BOX BOUNDS ff ff ff\n";
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    append_number(text, low[axis]);
    text += ' ';
    append_number(text, high[axis]);
    text += '\n';
  }
  return text;
}

class LammpsExporter final : public SnapshotExporter {
 public:
  LammpsExporter(const RunInfo& info, const std::filesystem::path& folder)
      : info_(info),
        atoms_(folder / "atoms.dump"),
        pairs_(folder / "pairs.dump"),
        map_(map_of_run(info, "lammps", 1)) {
    if (info.walls.empty()) return;
    wall_contacts_.emplace(folder / "wall_contacts.dump");
    walls_.emplace(folder / "walls.dump");
  }

  void add(std::size_t number, const Snapshot& s) override {
    const std::string box = box_of(s.particles);
    const auto add_table = [&](OutputFile& file, TableColumns& table, const char* what, const char* count_of,
                               const std::vector<FrameColumn>& columns, std::size_t rows, const std::string& keys,
                               auto write_keys) {
      const std::vector<TextColumn> cells = text_columns(columns, rows, Headings::lammps);
      table.agree(cells, rows, number, file.path().string());
      std::string& text = file.text();
      // LAMMPS writes the time first, and its own reader takes no other order.
      text += "ITEM: TIME\n";
      append_number(text, s.time);
      text += "\nITEM: TIMESTEP\n";
      append_number(text, s.step);
      text.append("\nITEM: NUMBER OF ").append(count_of).append("\n");
      append_number(text, rows);
      text.append("\n").append(box).append("ITEM: ").append(what).append(" ").append(keys);
      for (const TextColumn& cell : cells) text.append(" ").append(cell.heading);
      text += '\n';
      for (std::size_t row = 0; row < rows; ++row) {
        write_keys(text, row);
        for (const TextColumn& cell : cells) {
          text += ' ';
          append_value(text, cell.column, row, cell.component);
        }
        text += '\n';
        file.flush_if_large();
      }
    };

    const Particles& p = s.particles;
    const bool typed = present(p.material, p.size());
    if (p.size() > 0) typed_ = typed;
    add_table(atoms_, atom_columns_, "ATOMS", "ATOMS", particle_columns(s), p.size(), "id type",
              [&](std::string& text, std::size_t row) {
                append_number(text, p.id[row]);
                text += ' ';
                append_number(text, typed ? p.material[row] + 1 : 1);
              });
    add_table(pairs_, pair_columns_, "ENTRIES", "ENTRIES", pair_columns(s), s.pp.size(), "id1 id2",
              [&](std::string& text, std::size_t row) {
                append_number(text, p.id[s.pp.row[row][0]]);
                text += ' ';
                append_number(text, p.id[s.pp.row[row][1]]);
              });
    if (!walls_) return;
    const bool points = present(s.pw.point, s.pw.size());
    add_table(*wall_contacts_, wall_contact_columns_, points ? "ATOMS" : "ENTRIES", points ? "ATOMS" : "ENTRIES",
              wall_contact_columns(s), s.pw.size(), points ? "id type particle wall" : "particle wall",
              [&](std::string& text, std::size_t row) {
                if (points) {
                  append_number(text, row + 1);
                  text += ' ';
                  append_number(text, s.pw.wall[row] + 1);
                  text += ' ';
                }
                append_number(text, p.id[s.pw.row[row]]);
                text += ' ';
                append_number(text, s.pw.wall[row]);
              });
    const WallColumns states(s, info_);
    add_table(*walls_, wall_columns_, "ENTRIES", "ENTRIES", states.columns(), s.walls.size(), "wall",
              [](std::string& text, std::size_t row) { append_number(text, row); });
  }

  std::vector<std::filesystem::path> finish() override {
    std::vector<std::filesystem::path> files;
    for (OutputFile* file : {&atoms_, &pairs_, wall_contacts_ ? &*wall_contacts_ : nullptr, walls_ ? &*walls_ : nullptr}) {
      if (file == nullptr) continue;
      file->finish();
      files.push_back(file->path());
    }
    const auto with = [](ColumnMap fields, std::initializer_list<std::pair<const char*, const char*>> keys) {
      for (const auto& [field, column] : keys) fields[field] = column;
      return fields;
    };
    map_.particles.columns = with(atom_columns_.fields(), {{"id", "id"}});
    if (typed_) map_.particles.columns["material"] = "type";
    map_.pair_contacts.columns = with(pair_columns_.fields(), {{"id1", "id1"}, {"id2", "id2"}});
    if (walls_) {
      map_.wall_contacts.columns = with(wall_contact_columns_.fields(), {{"id", "particle"}, {"mesh", "wall"}});
      map_.wall_states.columns = with(wall_columns_.fields(), {{"mesh", "wall"}});
    }
    return files;
  }

  std::optional<ImportMap> map() const override { return map_; }

 private:
  RunInfo info_;
  OutputFile atoms_, pairs_;
  std::optional<OutputFile> wall_contacts_, walls_;
  TableColumns atom_columns_, pair_columns_, wall_contact_columns_, wall_columns_;
  bool typed_ = false;  // particles have materials
  ImportMap map_;
};

}  // namespace

std::unique_ptr<SnapshotExporter> export_lammps(const RunInfo& info, const std::filesystem::path& folder) {
  return std::make_unique<LammpsExporter>(info, folder);
}

}  // namespace jam
