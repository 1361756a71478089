#include "libjam/snapshot/export/csv_tables.hpp"

#include "libjam/snapshot/export/output_file.hpp"
#include "libjam/snapshot/export/text_columns.hpp"

namespace jam {
namespace {

// The name of a wall as a cell: what would need quotes is replaced, and a number keeps names apart that became the same.
std::string cell_of(const std::string& name, std::size_t number) {
  std::string cell = name;
  bool changed = false;
  for (char& c : cell) {
    const bool plain = static_cast<unsigned char>(c) > 0x20 || c == ' ';
    if (plain && c != ',' && c != '"') continue;
    c = '_';
    changed = true;
  }
  changed |= cell.empty() || cell.front() == ' ' || cell.back() == ' ';  // readers drop blanks around a cell
  return changed ? "_" + cell + "_" + std::to_string(number) : cell;
}

struct CsvTable {
  explicit CsvTable(const std::filesystem::path& path) : file(path) {}
  OutputFile file;
  TableColumns columns;
  std::string header;  // of the last frame, as long as the file has none
  bool has_header = false;
};

class CsvExporter final : public SnapshotExporter {
 public:
  CsvExporter(const RunInfo& info, const std::filesystem::path& folder)
      : info_(info),
        particles_(folder / "particles.csv"),
        contacts_(folder / "contacts.csv"),
        map_(map_of_run(info, "csv", 0)) {
    if (info.walls.empty()) return;
    wall_contacts_.emplace(folder / "wall_contacts.csv");
    walls_.emplace(folder / "walls.csv");
    for (std::size_t w = 0; w < info.walls.size(); ++w) {
      wall_cells_.push_back(cell_of(info.walls[w].name, w));
      if (wall_cells_.back() != info.walls[w].name) map_.walls[w].source_name = wall_cells_.back();
    }
  }

  void add(std::size_t number, const Snapshot& s) override {
    const Particles& p = s.particles;
    const bool known_material = present(p.material, p.size());
    if (p.size() > 0) material_known_ = known_material;
    add_rows(particles_, number, s, particle_columns(s), p.size(), known_material ? "id,material" : "id",
             [&](std::string& text, std::size_t row) {
               append_number(text, p.id[row]);
               if (!known_material) return;
               text += ',';
               append_number(text, p.material[row]);
             });
    add_rows(contacts_, number, s, pair_columns(s), s.pp.size(), "id1,id2", [&](std::string& text, std::size_t row) {
      append_number(text, p.id[s.pp.row[row][0]]);
      text += ',';
      append_number(text, p.id[s.pp.row[row][1]]);
    });
    if (!walls_) return;
    add_rows(*wall_contacts_, number, s, wall_contact_columns(s), s.pw.size(), "id,wall",
             [&](std::string& text, std::size_t row) {
               append_number(text, p.id[s.pw.row[row]]);
               text.append(",").append(wall_cells_[s.pw.wall[row]]);
             });
    const WallColumns states(s, info_);
    add_rows(*walls_, number, s, states.columns(), s.walls.size(), "wall",
             [&](std::string& text, std::size_t row) { text += wall_cells_[row]; });
  }

  std::vector<std::filesystem::path> finish() override {
    std::vector<std::filesystem::path> files;
    for (CsvTable* table :
         {&particles_, &contacts_, wall_contacts_ ? &*wall_contacts_ : nullptr, walls_ ? &*walls_ : nullptr}) {
      if (table == nullptr) continue;
      if (!table->has_header) table->file.text().append(table->header).append("\n");
      table->file.finish();
      files.push_back(table->file.path());
    }
    // The importer's frames are the steps, so that steps stay what they were.
    const auto with = [](ColumnMap fields, std::initializer_list<const char*> keys) {
      fields["frame"] = "step";
      for (const char* key : keys) fields[key] = key;
      return fields;
    };
    map_.particles.columns = with(particles_.columns.fields(), {"id"});
    map_.particles.columns["time"] = time_heading;
    if (material_known_) map_.particles.columns["material"] = "material";
    map_.pair_contacts.columns = with(contacts_.columns.fields(), {"id1", "id2"});
    if (walls_) {
      map_.wall_contacts.columns = with(wall_contacts_->columns.fields(), {"id", "wall"});
      map_.wall_states.columns = with(walls_->columns.fields(), {"wall"});
    }
    return files;
  }

  std::optional<ImportMap> map() const override { return map_; }

 private:
  template <class WriteKeys>
  void add_rows(CsvTable& table, std::size_t number, const Snapshot& s, const std::vector<FrameColumn>& columns,
                std::size_t rows, const std::string& keys, WriteKeys write_keys) {
    const std::vector<TextColumn> cells = text_columns(columns, rows, Headings::with_units);
    table.columns.agree(cells, rows, number, table.file.path().string());
    std::string& text = table.file.text();
    // Which columns there are is known from the first frame with rows on.
    if (!table.has_header) {
      table.header = std::string("frame,step,") + time_heading + "," + keys;
      for (const TextColumn& cell : cells) table.header.append(",").append(cell.heading);
      if (rows > 0) text.append(table.header).append("\n");
      table.has_header = rows > 0;
    }
    std::string first_cells;
    append_number(first_cells, number);
    first_cells += ',';
    append_number(first_cells, s.step);
    first_cells += ',';
    append_number(first_cells, s.time);
    first_cells += ',';
    for (std::size_t row = 0; row < rows; ++row) {
      text += first_cells;
      write_keys(text, row);
      for (const TextColumn& cell : cells) {
        text += ',';
        append_value(text, cell.column, row, cell.component);
      }
      text += '\n';
      table.file.flush_if_large();
    }
  }

  static constexpr const char* time_heading = "time [s]";
  RunInfo info_;
  CsvTable particles_, contacts_;
  std::optional<CsvTable> wall_contacts_, walls_;
  std::vector<std::string> wall_cells_;
  bool material_known_ = false;
  ImportMap map_;
};

}  // namespace

std::unique_ptr<SnapshotExporter> export_csv(const RunInfo& info, const std::filesystem::path& folder) {
  return std::make_unique<CsvExporter>(info, folder);
}

}  // namespace jam
