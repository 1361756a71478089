#include "apps/jamscope/figure_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <regex>
#include <sstream>

namespace jamscope {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

FigureFile curve_figure() {
  return {"force", "Force", {"Time", "s"}, {"Force", "N"}, {{"one", {0, 1, 2}, {0, 10, 5}, {0, 8, 4}, {1, 12, 6}}, {"two <b>", {0, 2}, {1, nan}, {}, {}}}, {}};
}

// Throws where it is no XML.
void parse(const std::string& svg) {
  std::istringstream in(svg);
  boost::property_tree::ptree tree;
  boost::property_tree::read_xml(in, tree);
}

TEST(AxisTicks, AreRoundAndInside) {
  EXPECT_THAT(axis_ticks(0, 10, false), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(axis_ticks(0, 0.0285, false), testing::SizeIs(6));
  EXPECT_THAT(axis_ticks(0.5, 2000, true), ElementsAre(1, 10, 100, 1000));
  EXPECT_THAT(axis_ticks(3, 30, true), ElementsAre(5, 10, 20));
  for (const double v : axis_ticks(1.234e-7, 5.6e-7, false)) EXPECT_TRUE(v >= 1.234e-7 && v <= 5.6e-7);
}

TEST(FigureFile, WritesItsNumbersAsCsvWithUnits) {
  EXPECT_EQ(csv_of(curve_figure()), "curve,Time (s),Force (N),low,high\r\none,0,0,0,1\r\none,1,10,8,12\r\none,2,5,4,6\r\ntwo <b>,0,1,,\r\ntwo <b>,2,,,\r\n");
  const FigureFile bars{"bars", "Bars", {"Class, \"long\"", "ms"}, {"Rate", "Hz"}, {}, {{"0-10", 2.5, 1, 4}, {">= 10", 0}}};
  EXPECT_EQ(csv_of(bars), "\"Class, \"\"long\"\" (ms)\",Rate (Hz),low,high\r\n0-10,2.5,1,4\r\n>= 10,0,,\r\n");
}

TEST(FigureFile, IsWellFormedSvgWithAxesUnitsAndEscapedText) {
  const std::string svg = svg_of(curve_figure());
  EXPECT_NO_THROW(parse(svg));
  EXPECT_THAT(svg, HasSubstr(">Time (s)<"));
  EXPECT_THAT(svg, HasSubstr(">Force (N)<"));
  EXPECT_THAT(svg, HasSubstr("two &lt;b&gt;"));
  EXPECT_EQ(svg.find("<b>"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  // A tick for 10 N, where the curve has its peak: at the same height.
  std::smatch tick, line;
  ASSERT_TRUE(std::regex_search(svg, tick, std::regex("y=\"([0-9.]+)\" text-anchor=\"end\">10<")));
  ASSERT_TRUE(std::regex_search(svg, line, std::regex("<path d=\"M[0-9.]+ [0-9.]+L[0-9.]+ ([0-9.]+)L[0-9.]+ [0-9.]+\" fill=\"none\" stroke=\"#0072b2\" stroke-width")));
  EXPECT_NEAR(std::stod(tick[1]) - 4, std::stod(line[1]), 0.11);
}

TEST(FigureFile, DrawsBarsFromZeroWithTheirErrors) {
  const std::string svg = svg_of({"bars", "Bars", {"Class", "ms"}, {"Rate", "Hz"}, {}, {{"a", 2, 1, 4}, {"b", 1, nan, nan}}});
  EXPECT_NO_THROW(parse(svg));
  const std::regex bar("<rect x=\"[0-9.]+\" y=\"[0-9.]+\" width=\"[0-9.]+\" height=\"([0-9.]+)\" fill=\"#0072b2\"");
  std::vector<double> heights;
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), bar); it != std::sregex_iterator(); ++it) heights.push_back(std::stod((*it)[1]));
  ASSERT_EQ(heights.size(), 2u);
  EXPECT_NEAR(heights[0] / heights[1], 2, 0.01);
}

TEST(FigureFile, LosesNoPeakOfALongCurve) {
  FigureFile f = curve_figure();
  f.curves = {{"long", {}, {}, {}, {}}};
  for (int k = 0; k < 100000; ++k) {
    f.curves[0].x.push_back(k);
    f.curves[0].y.push_back(k == 54321 ? 100 : 1);
  }
  const std::string svg = svg_of(f);
  EXPECT_LT(svg.size(), 100'000u);
  std::smatch tick;
  ASSERT_TRUE(std::regex_search(svg, tick, std::regex("y=\"([0-9.]+)\" text-anchor=\"end\">100<")));
  const double at = std::stod(tick[1]) - 4;
  bool reached = false;
  const std::regex point("L[0-9.]+ ([0-9.]+)");
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), point); it != std::sregex_iterator(); ++it) reached |= std::abs(std::stod((*it)[1]) - at) < 0.11;
  EXPECT_TRUE(reached);
}

TEST(FigureFile, OfALogarithmicAxisLeavesOutWhatIsNotPositive) {
  FigureFile f = curve_figure();
  f.y.log = true;
  const std::string svg = svg_of(f);
  EXPECT_NO_THROW(parse(svg));
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Figures, OfAnAnalysisAreThoseItHasDataFor) {
  jam::Analysis a;
  for (int k = 0; k < 4; ++k) {
    jam::FrameSummary f;
    f.time = 0.002 * k;
    f.largest_compressive_force = k == 1 ? 40 : 2;
    f.mean_compressive_force = 0.1;
    a.frames.push_back(f);
  }
  a.metrics = {{"coordination", "1", "contacts per grain", {4, 4, 4, 4}}, {"never", "1", "not defined", {nan, nan, nan, nan}}};
  a.jammed_histogram = {3, 1};
  std::map<std::string, FigureFile> figures;
  for (const FigureFile& f : figure_files({}, a, {})) figures[f.name] = f;
  EXPECT_EQ(figures.count("blade-force"), 0u);
  EXPECT_EQ(figures.count("survival-frequency"), 0u);
  EXPECT_EQ(figures.count("metric-never"), 0u);
  EXPECT_EQ(figures.at("metric-coordination").curves[0].y, (std::vector<double>{4, 4, 4, 4}));
  EXPECT_EQ(figures.at("grain-force").curves[0].y[1], 40);
  ASSERT_EQ(figures.at("jammed-histogram").bars.size(), 1u);
  EXPECT_EQ(figures.at("jammed-histogram").bars[0].value, 1);
  for (const auto& [name, figure] : figures) EXPECT_NO_THROW(parse(svg_of(figure))) << name;
}

}  // namespace
}  // namespace jamscope
