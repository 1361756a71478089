#include "apps/jamscope/case_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <tuple>

#include "apps/jamscope/toml_reader.hpp"
#include "apps/jamscope/wall_tables.hpp"
#include "libdem/case/automatic_step.hpp"
#include "libdem/case/check_case.hpp"
#include "libdem/contact/laws.hpp"
#include "libdem/errors.hpp"
#include "libjam/jamming/jam_criteria.hpp"
#include "libjam/metrics/metrics.hpp"

namespace jamscope {
namespace {

using enum Need;

void read_about(Section about, const std::string& path, dem::Case& c) {
  c.name = std::filesystem::path(path).stem().string();
  about.text("name", c.name, optional);
  about.text("description", c.description, optional);
  about.finish();
}

bool is_name(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

void read_materials(Section materials, Document& document, dem::Case& c) {
  for (auto& [name, section] : materials.named_sections()) {
    if (!is_name(name))
      document.problem(section.path(), fmt::format("material names have only letters, digits and '_', got '{}'", name));
    dem::Material m;
    m.name = name;
    section.quantity("density", dimension::density, m.density);
    section.quantity("young", dimension::pressure, m.young);
    section.number("poisson", m.poisson);
    section.finish();
    c.materials.push_back(m);
  }
  if (materials && c.materials.size() > 255) document.problem("material", "at most 255 materials are possible");
  materials.finish();
  c.interactions.assign(c.materials.size(), std::vector<dem::Interaction>(c.materials.size()));
}

std::vector<std::string> material_names(const dem::Case& c) {
  std::vector<std::string> names;
  for (const dem::Material& m : c.materials) names.push_back(m.name);
  return names;
}

// The index, or -1 after reporting that the material is unknown.
int find_material(const dem::Case& c, const std::string& name, const std::string& key, Document& document,
                  bool at_key = false) {
  const std::vector<std::string> names = material_names(c);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  document.problem(key, fmt::format("unknown material '{}'{}", name, suggestion(name, names)), at_key);
  return -1;
}

using Given = std::vector<std::vector<std::string>>;  // [M][M] name of the table that gave the pair, "" for none

Given read_interactions(Section interactions, Document& document, dem::Case& c) {
  Given given(c.materials.size(), std::vector<std::string>(c.materials.size()));
  for (auto& [pair, section] : interactions.named_sections()) {
    dem::Interaction i;
    section.number("restitution", i.restitution);
    section.number("friction", i.friction);
    section.number("rolling_friction", i.rolling_friction, optional);
    section.quantity("work_of_adhesion", dimension::surface_energy, i.work_of_adhesion, optional);
    section.number("rolling_damping", i.rolling_damping, optional);
    section.finish();

    const std::size_t hyphen = pair.find('-');
    if (hyphen == std::string::npos || pair.find('-', hyphen + 1) != std::string::npos) {
      document.problem(section.path(), fmt::format("'{}' names no pair, expected [interaction.ONE-OTHER]", pair), true);
      continue;
    }
    const int a = find_material(c, pair.substr(0, hyphen), section.path(), document, true);
    const int b = find_material(c, pair.substr(hyphen + 1), section.path(), document, true);
    if (a < 0 || b < 0) continue;
    const auto row = static_cast<std::size_t>(a), column = static_cast<std::size_t>(b);
    if (!given[row][column].empty()) {
      document.problem(section.path(),
                       fmt::format("[interaction.{}] was given before, as [interaction.{}]", pair, given[row][column]),
                       true);
      continue;
    }
    given[row][column] = given[column][row] = pair;
    c.interactions[row][column] = c.interactions[column][row] = i;
  }
  interactions.finish();
  return given;
}

// Names of parts are checked here, so that the message can point at them.
void read_contact(Section contact, Document& document, dem::Case& c) {
  dem::ContactModel& m = c.contact;
  const auto part = [&]<class Table>(const char* key, std::type_identity<Table>, std::string& out) {
    std::vector<std::pair<std::string, std::string>> words;
    for (const std::string& name : dem::part_names<Table>()) words.emplace_back(name, name);
    contact.choice(key, words, out, optional);
  };
  part("normal", std::type_identity<dem::NormalLaws>{}, m.normal);
  part("damping", std::type_identity<dem::DampingLaws>{}, m.damping);
  part("friction_limit", std::type_identity<dem::FrictionLimits>{}, m.friction_limit);
  part("tangential", std::type_identity<dem::TangentialLaws>{}, m.tangential);
  part("rolling", std::type_identity<dem::RollingLaws>{}, m.rolling);
  contact.choice("wall_curvature", {{"flat", false}, {"true", true}}, m.wall_curvature, optional);
  bool surface = false;
  contact.choice("adhesion", {{"work", false}, {"surface", true}}, surface, optional);
  contact.finish();
  try {
    dem::choose_law(m);
  } catch (const dem::CaseError& error) {
    document.problem("contact.friction_limit", error.what());
  }
  // A surface energy gamma of both bodies makes the work W = 2 gamma of their pair.
  if (surface)
    for (auto& row : c.interactions)
      for (dem::Interaction& i : row) i.work_of_adhesion *= 2;
}

void read_vessel(Section vessel, dem::Vessel& v) {
  vessel.text("material", v.material);
  vessel.quantity("diameter", dimension::length, v.diameter);
  vessel.finish();
}

void read_blade(Section blade, const std::string& path, Document& document, dem::Blade& b) {
  if (!blade) return;
  blade.text("material", b.material);
  blade.quantity("start_height", dimension::length, b.start_height);
  std::string kind;
  const std::vector<std::pair<std::string, std::string>> kinds{{"twisted", "twisted"}, {"stl", "stl"}};
  if (!blade.choice("kind", kinds, kind)) {
    // Which keys belong here is not known.
    if (!document.has_problems()) blade.finish();
    return;
  }
  if (kind == "twisted") {
    dem::TwistedBlade t;
    read_twisted(blade, t);
    b.shape = t;
  } else {
    dem::MeshFile mesh;
    read_mesh_file(blade, path, document, mesh);
    b.shape = mesh;
  }
  blade.finish();
}

void read_motion(Section motion, dem::Motion& m) {
  motion.quantity("tip_speed", dimension::speed, m.tip_speed);
  motion.quantity("helix_angle", dimension::angle, m.helix_angle);
  motion.choice("rotation", {{"clockwise", true}, {"counter-clockwise", false}}, m.clockwise);
  motion.finish();
}

void read_bed(Section bed, Document& document, dem::Bed& b) {
  bed.text("material", b.material);
  bed.quantity("mean_diameter", dimension::length, b.mean_diameter);
  bed.number("size_low", b.size_low);
  bed.number("size_high", b.size_high);
  using Sizes = dem::Bed::Sizes;
  bed.choice("sizes", {{"number", Sizes::by_number}, {"mass", Sizes::by_mass}}, b.sizes, optional);
  bed.quantity("depth", dimension::length, b.depth);
  bed.whole_number("seed", b.seed, optional);
  std::vector<double> x, y;
  const bool has_x = bed.quantities("x", dimension::length, x, optional);
  const bool has_y = bed.quantities("y", dimension::length, y, optional);
  for (const auto& [key, given, values] : {std::tuple{"x", has_x, &x}, std::tuple{"y", has_y, &y}})
    if (given && values->size() != 2)
      document.problem(fmt::format("bed.{}", key),
                       fmt::format("'{}' wants two ends like [\"-5 mm\", \"5 mm\"], got {}", key, values->size()));
  if (has_x != has_y) document.problem("bed", "a bed between planes wants both 'x' and 'y'");
  if (x.size() == 2 && y.size() == 2) b.box = dem::BoxRegion{x[0], x[1], y[0], y[1]};
  bed.finish();
}

void read_run(Section run, Document& document, dem::Case& c) {
  run.quantity("duration", dimension::time, c.duration);
  run.quantity_or("auto", &c.automatic_step, "step", dimension::time, c.step);
  std::uint64_t levels = c.levels;
  if (run.whole_number("levels", levels, optional) && c.automatic_step)
    document.problem("run.levels", "'levels' follow from step = \"auto\"; give one of the two");
  c.levels = std::uint8_t(std::min<std::uint64_t>(levels, 255));
  run.number("accuracy", c.accuracy, optional);
  double gravity = -c.gravity.z();
  if (run.quantity("gravity", dimension::acceleration, gravity, optional)) c.gravity = {0, 0, -gravity};
  run.finish();
}

void read_output(Section output, dem::Output& o) {
  output.quantity("frame_interval", dimension::time, o.frame_interval);
  output.quantity("series_interval", dimension::time, o.series_interval);
  output.quantity("checkpoint_interval", dimension::time, o.checkpoint_interval);
  output.truth("energy_ledger", o.energy_ledger, optional);
  output.quantity("capture_interval", dimension::time, o.capture.interval, optional);
  output.quantity("capture_before", dimension::time, o.capture.before, optional);
  output.quantity("capture_after", dimension::time, o.capture.after, optional);
  if (double gigabytes = 0; output.number("capture_gigabytes", gigabytes, optional)) o.capture.most_bytes = 1e9 * gigabytes;
  output.finish();
}

void read_analysis(Section analysis, Document& document, jam::Criteria& criteria) {
  using Measure = jam::CompressiveMeasure;
  analysis.choice("measure", {{"sum", Measure::sum}, {"max", Measure::max}, {"signed", Measure::signed_}},
                  criteria.measure, optional);
  analysis.quantity("jam_force", dimension::force, criteria.jam_force, optional);
  std::vector<std::pair<std::string, std::string>> criteria_by_name;
  for (const jam::JamCriterion& row : jam::jam_criteria()) criteria_by_name.emplace_back(row.name, row.name);
  analysis.choice("criterion", criteria_by_name, criteria.criterion, optional);
  if (double threshold = 0; analysis.number("threshold", threshold, optional)) criteria.threshold = threshold;
  if (double force = 0; analysis.quantity("end_force", dimension::force, force, optional)) criteria.end_force = force;
  analysis.quantity("hold_off", dimension::time, criteria.hold_off, optional);
  analysis.quantity("shortest_jam", dimension::time, criteria.shortest_jam, optional);
  analysis.number("bridge_contact_share", criteria.bridge_contact_share, optional);
  analysis.number("gap_margin", criteria.gap_margin, optional);
  analysis.quantities("survival_classes", dimension::time, criteria.survival_classes, optional);
  if (std::vector<std::string> names; analysis.texts("metrics", names, optional)) criteria.metrics = names;
  analysis.finish();

  const auto refuse = [&](const char* key, const std::string& message) {
    document.problem(std::string("analysis.") + key, fmt::format("'{}' {}", key, message));
  };
  if (!(criteria.jam_force > 0)) refuse("jam_force", fmt::format("must be positive, got {} N", criteria.jam_force));
  if (criteria.threshold && criteria.criterion == "compressive_force") refuse("threshold", "belongs to the criteria without a unit; of compressive_force it is jam_force");
  if (criteria.threshold && !(*criteria.threshold >= 0)) refuse("threshold", fmt::format("must not be negative, got {}", *criteria.threshold));
  if (criteria.end_force && !(*criteria.end_force > 0 && *criteria.end_force <= criteria.jam_force))
    refuse("end_force", fmt::format("must be positive and at most jam_force = {} N, got {} N", criteria.jam_force, *criteria.end_force));
  if (!(criteria.hold_off >= 0)) refuse("hold_off", fmt::format("must not be negative, got {} s", criteria.hold_off));
  if (!(criteria.shortest_jam >= 0)) refuse("shortest_jam", fmt::format("must not be negative, got {} s", criteria.shortest_jam));
  if (!(criteria.bridge_contact_share >= 0 && criteria.bridge_contact_share <= 1))
    refuse("bridge_contact_share", fmt::format("must lie in [0, 1], got {}", criteria.bridge_contact_share));
  if (!(criteria.gap_margin >= 0))
    refuse("gap_margin", fmt::format("must not be negative, got {}", criteria.gap_margin));
  for (const std::string& name : criteria.metrics.value_or(std::vector<std::string>{})) {
    if (jam::find_metric(name) != nullptr) continue;
    std::vector<std::string> known;
    for (const jam::Metric& metric : jam::metrics()) known.emplace_back(metric.name);
    refuse("metrics", fmt::format("names '{}', which is no metric of frames{}", name, suggestion(name, known)));
  }
  double bound = 0;
  for (const double next : criteria.survival_classes) {
    if (!(next > bound)) {
      refuse("survival_classes", fmt::format("must be positive and rising, got {} s after {} s", next, bound));
      break;
    }
    bound = next;
  }
  if (criteria.survival_classes.empty()) refuse("survival_classes", "must hold at least one bound, got none");
}

// Of a scene without a vessel.
void read_domain(Section domain, Document& document, dem::Case& c) {
  if (!domain) return;
  read_vector(domain, document, "low", dimension::length, c.domain_low);
  read_vector(domain, document, "high", dimension::length, c.domain_high);
  domain.finish();
}

// Grains touch grains and walls; other pairs never meet.
void require_pairs(const CaseFile& file, const Given& given, Document& document) {
  const dem::Case& c = file.physics;
  const auto index = [&](const std::string& material, const char* key) {
    return material.empty() ? -1 : find_material(c, material, key, document);
  };
  const int grain = index(c.bed.material, "bed.material");
  std::vector<std::pair<int, std::string>> walls{{grain, "grains"}};
  if (c.rheometer) {
    walls.emplace_back(index(c.vessel.material, "vessel.material"), "the vessel");
    walls.emplace_back(index(c.blade.material, "blade.material"), "the blade");
  }
  for (const dem::SceneWall& w : file.walls) walls.emplace_back(int(w.wall.material), "wall '" + w.wall.name + "'");
  if (document.has_problems()) return;  // a pair may be missing only because its name is misspelt
  std::vector<int> reported;
  for (const auto& [other, what] : walls) {
    if (grain < 0 || other < 0 || std::find(reported.begin(), reported.end(), other) != reported.end()) continue;
    if (!given[static_cast<std::size_t>(grain)][static_cast<std::size_t>(other)].empty()) continue;
    document.problem("interaction",
                     fmt::format("missing table [interaction.{0}-{1}]: grains of {0} touch {2} of {1}", c.bed.material,
                                 c.materials[static_cast<std::size_t>(other)].name, what));
    reported.push_back(other);
  }
}

// A pair may be written either way round in the file.
std::string key_in_file(const std::string& key, const Given& given, const dem::Case& c) {
  for (std::size_t a = 0; a < given.size(); ++a)
    for (std::size_t b = a; b < given.size(); ++b) {
      const std::string prefix = fmt::format("interaction.{}-{}.", c.materials[a].name, c.materials[b].name);
      if (key.starts_with(prefix) && !given[a][b].empty())
        return fmt::format("interaction.{}.{}", given[a][b], key.substr(prefix.size()));
    }
  return key;
}

std::string written_out(const Document& document) {
  std::ostringstream out;
  out << document.table() << '\n';
  return out.str();
}

}  // namespace

CaseFile read_case_text(std::string_view text, const std::string& path, const std::vector<std::string>& overrides) {
  Document document(text, path, overrides);
  CaseFile file;
  file.path = path;
  dem::Case& c = file.physics;

  Section root = document.root();
  read_about(root.section("case", optional), path, c);
  read_materials(root.section("material"), document, c);
  const Given given = read_interactions(root.section("interaction"), document, c);
  read_contact(root.section("contact", optional), document, c);
  // A rheometer as soon as one of its tables is there, or where no walls are given one by one.
  const toml::table& top = document.table();
  c.rheometer = top.contains("vessel") || top.contains("blade") || top.contains("motion") || !top.contains("wall");
  if (c.rheometer) {
    read_vessel(root.section("vessel"), c.vessel);
    read_blade(root.section("blade"), path, document, c.blade);
    read_motion(root.section("motion"), c.motion);
  } else {
    read_domain(root.section("domain"), document, c);
  }
  file.walls = read_walls(root.section("wall", optional), c, path, document);
  read_bed(root.section("bed"), document, c.bed);
  read_run(root.section("run"), document, c);
  read_output(root.section("output"), c.output);
  read_analysis(root.section("analysis", optional), document, file.criteria);
  root.finish();
  if (!c.materials.empty()) require_pairs(file, given, document);
  document.throw_problems();

  const auto fatal = [](const dem::CaseProblem& p) { return p.fatal; };
  std::vector<dem::CaseProblem> problems = dem::case_problems(c);
  if (c.automatic_step && std::none_of(problems.begin(), problems.end(), fatal)) {
    const dem::StepChoice choice = dem::choose_steps(c);
    c.step = choice.step;
    c.levels = choice.levels;
    problems = dem::case_problems(c);
  }
  for (const dem::CaseProblem& p : problems) {
    const std::string key = key_in_file(p.key, given, c);
    const std::string message = fmt::format("'{}' {}", key.substr(key.rfind('.') + 1), p.message);
    if (p.fatal)
      document.problem(key, message);
    else
      file.warnings.push_back(document.place(key) + ": " + message);
  }
  document.throw_problems();
  file.text = overrides.empty() ? std::string(text) : written_out(document);
  return file;
}

CaseFile read_case_file(const std::string& path, const std::vector<std::string>& overrides) {
  return read_case_text(read_text_file(path), path, overrides);
}

jam::Criteria read_criteria_text(std::string_view text, const std::string& path, const jam::Criteria& base,
                                 const std::vector<std::string>& overrides) {
  std::vector<std::string> full;
  for (const std::string& override : overrides)
    full.push_back(override.starts_with("analysis.") ? override : "analysis." + override);
  Document document(text, path, full);
  jam::Criteria criteria = base;
  Section root = document.root();
  read_analysis(root.section("analysis", optional), document, criteria);
  root.finish();
  document.throw_problems();
  return criteria;
}

jam::Criteria read_criteria_file(const std::string& path, const jam::Criteria& base,
                                 const std::vector<std::string>& overrides) {
  return read_criteria_text(read_text_file(path), path, base, overrides);
}

jam::Criteria read_case_criteria(std::string_view text, const std::string& path) {
  Document document(text, path, {});
  jam::Criteria criteria;
  read_analysis(document.root().section("analysis", optional), document, criteria);
  document.throw_problems();
  return criteria;
}

}  // namespace jamscope
