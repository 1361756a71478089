// jamscope report: the page of one folder of results again, or one page of several, and the figures as files.
#pragma once
#include <string>
#include <vector>

namespace jamscope {

struct ReportOptions {
  std::vector<std::string> folders;  // of results
  std::string output;                // file; empty: report.html in the folder, of several folders in the current one
  bool figures = false;              // write FOLDER/figures/*.svg and *.csv too
  bool quiet = false;
};

// Writes the page and prints where it is. Throws UsageError, and jam::DataError where a folder holds no results.
int report(const ReportOptions& options);

}  // namespace jamscope
