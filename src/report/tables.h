// Tables as text: the CSV that this program writes and reads again, and Markdown.
#pragma once

#include <string>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"

namespace papilla::report {

// One line per row, no quotes; lines of '#' before or between them are comments.
struct CsvTable {
  std::string path;
  std::vector<std::string> comments, header;
  std::vector<std::vector<std::string>> rows;  // as long as the header

  bool has(const std::string& name) const;
  std::size_t column(const std::string& name) const;  // throws InputError
  std::vector<std::string> texts(const std::string& name) const;
  std::vector<double> numbers(const std::string& name) const;  // NaN where a cell is no number
};
// Throws InputError with the place of a row that is not as long as the header.
CsvTable read_csv(const std::string& path);
CsvTable read_csv(const Folder& folder, const std::string& name);

// A text as one cell of such a table: commas become semicolons.
std::string csv_cell(std::string text);

// "mean(adhesion) [mN]": of numbers in a unit; the name alone of a share.
std::string name_with_unit(const std::string& name, const std::string& unit);

// "| a | b |" and, for a head, the line below it; with the ends of lines.
std::string markdown_row(const std::vector<std::string>& cells);
std::string markdown_head(const std::vector<std::string>& names);

}  // namespace papilla::report
