#include "calibrate/friction_table.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "config/reader.h"
#include "design/design.h"
#include "scene/measured_table.h"

namespace papilla::calibrate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestTable = std::size_t{1} << 24;  // [bytes]

class FrictionReader {
 public:
  explicit FrictionReader(const std::string& path)
      : path_(path), table_(read_measured_table(read_bytes(path, kLargestTable), path)) {}

  FrictionTable read() {
    check_columns();
    if (problems_.empty()) {
      for (const MeasuredRow& row : table_.rows) take(row);
      if (empty_ > 0)
        out_.notes.push_back(
            fmt::format("{} without a friction are left out", counted(empty_, "row")));
      if (out_.rows.empty() && problems_.empty()) problem(1, "F_off", "no row has a friction");
    }
    if (!problems_.empty()) throw InputError(problems_);
    out_.notes.insert(out_.notes.begin(), table_.notes.begin(), table_.notes.end());
    return std::move(out_);
  }

 private:
  void problem(int line, const std::string& key, const std::string& message) {
    problems_.push_back({path_, line, 0, key, message});
  }

  // Said once, not with every row.
  void check_columns() {
    const auto needed = [&](const std::string& column, const std::string& what) {
      if (table_.has(column)) return;
      problem(1, column,
              fmt::format("no such column: {}{}", what,
                          table_.unread.empty()
                              ? std::string()
                              : "; columns that are not read: " + join_names(table_.unread)));
    };
    needed("design", "the file of the surface, beside the table or a shipped one");
    needed("load", "write load_N");
    if (!table_.has("relative_humidity"))
      needed("humidity", "write humidity_percent, or relative_humidity with \"35 %\" or 0.35");
    needed("F_off", "write F_off_N, the friction without voltage");
    needed("F_off_sd",
           "write F_off_sd_N, one standard deviation of the value: of repeats what they scatter");
    if (!table_.has("F_on")) return;
    needed("F_on_sd", "write F_on_sd_N, one standard deviation of the value");
    needed("voltage", "write voltage_V, the amplitude");
    needed("frequency", "write frequency_Hz");
  }

  void take(const MeasuredRow& row) {
    if (!row.measured()) {
      ++empty_;
      return;
    }
    const std::size_t before = problems_.size();
    const auto needed = [&](const std::optional<double>& value, const char* key) {
      if (!value) problem(row.line, key, "expected a number, got \"\"");
      return value.value_or(0);
    };
    FrictionDatum d;
    d.line = row.line;
    d.design = design_file(row);
    d.relative_humidity = needed(row.relative_humidity, "humidity");
    d.load = needed(row.load, "load");
    d.amplitude = row.on ? needed(row.voltage, "voltage") : row.voltage.value_or(0);
    d.frequency = d.amplitude > 0 ? needed(row.frequency, "frequency") : row.frequency.value_or(0);
    d.state = row.state;
    if (row.off) {
      d.off = *row.off;
      d.off_sd = needed(row.off_sd, "F_off_sd");
    }
    if (row.on) {
      d.on = *row.on;
      d.on_sd = needed(row.on_sd, "F_on_sd");
    }
    check_finger(row);
    if (problems_.size() == before) out_.rows.push_back(std::move(d));
  }

  // The file that the cell names: beside the table, else among the designs.
  std::string design_file(const MeasuredRow& row) {
    const fs::path beside = fs::path(path_).parent_path() / row.design;
    std::error_code error;
    if (!row.design.empty() && fs::is_regular_file(beside, error)) return beside.string();
    const std::string found = find_beside(row.design, path_, design_roots());
    if (row.design.empty() || found.empty())
      problem(row.line, "design", fmt::format("no file \"{}\" beside the table", row.design));
    return found;
  }

  void check_finger(const MeasuredRow& row) {
    if (!first_) first_ = &row;
    if (row.finger != first_->finger)
      problem(row.line, "finger",
              fmt::format("\"{}\", and \"{}\" in line {}: a fit is of one finger, so a table each",
                          row.finger, first_->finger, first_->line));
  }

  std::string path_;
  MeasuredTable table_;
  const MeasuredRow* first_ = nullptr;  // with a friction
  int empty_ = 0;
  FrictionTable out_;
  std::vector<Problem> problems_;
};

}  // namespace

FrictionTable read_friction(const std::string& path) { return FrictionReader(path).read(); }

}  // namespace papilla::calibrate
