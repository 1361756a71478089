// The figures of a report as files, for journals and for comparisons: NAME.svg with axes and units, NAME.csv with the numbers behind it.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "libjam/analysis.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jamscope {

// NaN breaks a curve and is an empty cell.
struct FigureCurve {
  enum class Kind { line, dashes, steps, points };
  std::string label;
  std::vector<double> x, y;
  std::vector<double> low, high;  // edges of a band, or absent
  Kind kind = Kind::line;
};
struct FigureBar {
  std::string label;
  double value = 0;
  double low = std::numeric_limits<double>::quiet_NaN(), high = low;  // ends of an error bar
};
struct Axis {
  std::string quantity, unit;
  bool log = false;
  std::string title() const { return unit.empty() ? quantity : quantity + " (" + unit + ")"; }
};
struct FigureFile {
  std::string name, title;  // of the file; of the figure
  Axis x, y;
  std::vector<FigureCurve> curves;  // or bars
  std::vector<FigureBar> bars;
};

// What these data have figures of.
std::vector<FigureFile> figure_files(const jam::RunInfo& info, const jam::Analysis& analysis, const jam::Series& series);

std::string svg_of(const FigureFile& figure);
std::string csv_of(const FigureFile& figure);

// About five round values in [low, high]; of a log axis powers of ten, with their halves and fifths where there are few.
std::vector<double> axis_ticks(double low, double high, bool log);

// Makes the folder. Returns the number of figures. Throws UsageError, jam::DataError where the disk refuses.
std::size_t write_figures(const std::string& folder, const jam::RunInfo& info, const jam::Analysis& analysis, const jam::Series& series);

}  // namespace jamscope
