#include "calibrate/friction_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/units.h"
#include "config/reader.h"
#include "design/design.h"

namespace papilla::calibrate {
namespace {

namespace fs = std::filesystem;

constexpr double kLargestCoefficient = 10;  // friction over load that a table may say
enum Column { kDesign, kHumidity, kAmplitude, kFrequency, kLoad, kOff, kOffSd, kOn, kOnSd };
const std::vector<std::string> kColumns{
    "design",  "relative_humidity", "amplitude_V", "frequency_Hz", "load_N",
    "F_off_N", "F_off_sd_N",        "F_on_N",      "F_on_sd_N"};

// One line of the table by our columns, in whatever order the user's stand.
struct Row {
  const std::vector<std::string>& cells;
  const std::vector<std::size_t>& place_of;  // of each of kColumns

  const std::string& operator[](Column column) const { return cells[place_of[column]]; }
  int place(Column column) const { return static_cast<int>(place_of[column]) + 1; }
};

class FrictionReader {
 public:
  explicit FrictionReader(const std::string& path) : path_(path) {}

  std::vector<FrictionDatum> read() {
    std::istringstream text(read_bytes(path_, std::size_t{1} << 24));
    std::vector<FrictionDatum> out;
    std::string line;
    std::vector<std::size_t> column;  // of each of kColumns
    std::size_t columns = 0;
    while (std::getline(text, line)) {
      ++line_;
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
      if (line.find_first_not_of(" \t,") == std::string::npos || line[0] == '#') continue;
      const std::vector<std::string> cells = split(line, ',');
      if (column.empty()) {
        if (cells.size() == 1 && line.find_first_of(";\t") != std::string::npos) {
          problem("", "the separator is a comma, decimals a point");
          break;
        }
        columns = cells.size();
        if (!header(cells, column)) break;
        continue;
      }
      if (cells.size() != columns) {
        problem("", fmt::format("expected {} cells, got {}", columns, cells.size()));
        continue;
      }
      row(cells, column, out);
    }
    if (column.empty() && problems_.empty()) problem("", "no header line");
    if (out.empty() && problems_.empty()) problem("", "no rows below the header");
    if (problems_.empty()) check_order(out);
    if (!problems_.empty()) throw InputError(problems_);
    return out;
  }

 private:
  void problem(const std::string& key, const std::string& message, int cell = 0) {
    problems_.push_back({path_, line_, cell, key, message});
  }

  bool header(const std::vector<std::string>& cells, std::vector<std::size_t>& column) {
    bool good = true;
    for (const std::string& name : kColumns) {
      const auto found = std::find(cells.begin(), cells.end(), name);
      column.push_back(static_cast<std::size_t>(found - cells.begin()));
      if (found != cells.end()) continue;
      std::vector<std::string> unknown;  // a column that has its own name is not this one misspelt
      for (const std::string& cell : cells) {
        if (std::find(kColumns.begin(), kColumns.end(), cell) == kColumns.end())
          unknown.push_back(cell);
      }
      const std::string near = nearest_name(name, unknown);
      problem(name, near.empty() ? "no such column; expected " + join_names(kColumns)
                                 : fmt::format("no such column, is it `{}`?", near));
      good = false;
    }
    for (const std::string& cell : cells) {
      if (std::find(kColumns.begin(), kColumns.end(), cell) != kColumns.end()) continue;
      problem(cell, "unknown column; expected " + join_names(kColumns));
      good = false;
    }
    return good;
  }

  void row(const std::vector<std::string>& cells, const std::vector<std::size_t>& column,
           std::vector<FrictionDatum>& out) {
    const std::size_t before = problems_.size();
    const Row row{cells, column};
    FrictionDatum d;
    d.line = line_;
    d.design = design_file(row);
    d.relative_humidity = number(row, kHumidity, 0, 1, false);
    d.amplitude = number(row, kAmplitude, 0, 1e5, true);
    d.frequency = number(row, kFrequency, 0, 1e9, d.amplitude == 0);
    d.load = number(row, kLoad, 1e-6, 100, false);
    if (row[kOff].empty() && !row[kOn].empty()) {
      problem("F_off_N", "a row under voltage needs the friction without it too, of the same touch",
              row.place(kOff));
    } else {
      d.off = number(row, kOff, 0, 1e3, false);
      d.off_sd = number(row, kOffSd, 1e-9, 1e3, false);
    }
    if (!row[kOn].empty()) {
      d.on = number(row, kOn, 0, 1e3, false);
      d.on_sd = number(row, kOnSd, 1e-9, 1e3, false);
      if (d.amplitude == 0)
        problem("F_on_N", "a friction under voltage, but amplitude_V is 0", row.place(kOn));
    }
    if (problems_.size() == before) {
      check_size(row, kOff, d.off, d.load);
      check_size(row, kOn, d.on, d.load);
    }
    if (problems_.size() == before) out.push_back(d);
  }

  // The file that the first cell names: beside the table, else among the designs.
  std::string design_file(const Row& row) {
    const std::string& name = row[kDesign];
    const fs::path beside = fs::path(path_).parent_path() / name;
    std::error_code error;
    if (!name.empty() && fs::is_regular_file(beside, error)) return beside.string();
    const std::string found = find_beside(name, path_, design_roots());
    if (name.empty() || found.empty())
      problem("design", fmt::format("no file \"{}\" beside the table", name), row.place(kDesign));
    return found;
  }

  double number(const Row& row, Column column, double low, double high, bool may_be_empty) {
    const std::string& text = row[column];
    if (text.empty() && may_be_empty) return 0;
    double value = 0;
    if (const auto q = parse_quantity(text); column == kHumidity && q && q->unit == "%") {
      value = q->si;
    } else {
      try {
        std::size_t used = 0;
        value = std::stod(text, &used);
        if (used != text.size()) throw std::invalid_argument("");
      } catch (const std::exception&) {
        problem(kColumns[column], fmt::format("expected a number, got \"{}\"", text),
                row.place(column));
        return 0;
      }
    }
    if (!(value >= low && value <= high)) {
      problem(kColumns[column],
              fmt::format("{} lies outside {} to {}{}", text, low, high,
                          column == kHumidity && value >= 2 && value <= 100
                              ? fmt::format(": write it as \"{} %\"", text)
                              : std::string()),
              row.place(column));
    }
    return value;
  }

  // No skin rubs at ten times its load (coefficients are 0.1 to 3): it is another unit.
  void check_size(const Row& row, Column column, double force, double load) {
    if (force <= kLargestCoefficient * load) return;
    const std::string guess =
        force > 50 * load ? fmt::format("; are these mN? Then {:.4g} N is meant", force / 1000)
                          : "; no finger rubs so";
    problem(kColumns[column],
            fmt::format("{:.6g} N is {:.3g} times the load of {:.3g} N{}", force, force / load,
                        load, guess),
            row.place(column));
  }

  // A voltage draws the finger to the surface: columns that say the contrary are exchanged.
  void check_order(const std::vector<FrictionDatum>& data) {
    double off = 0, on = 0;
    for (const FrictionDatum& d : data) {
      if (d.on_sd <= 0) continue;
      off += d.off;
      on += d.on;
    }
    if (!(on < off)) return;
    line_ = 1;
    problem("F_on_N",
            "under voltage the finger rubs less on average than without it: are F_off_N and "
            "F_on_N exchanged?");
  }

  std::string path_;
  int line_ = 0;
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<FrictionDatum> read_friction(const std::string& path) {
  return FrictionReader(path).read();
}

}  // namespace papilla::calibrate
