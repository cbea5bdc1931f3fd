#include "calibrate/friction_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <tuple>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "config/reader.h"
#include "design/design.h"
#include "estimate/voltage.h"
#include "scene/measured_table.h"

namespace papilla::calibrate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestTable = std::size_t{1} << 24;  // [bytes]
// Of its value: a standard deviation beyond it says nothing, and is another unit where most are.
constexpr double kLargestDeviation = 3;
// Standard deviations of a difference beyond which rows of the same conditions are remarked.
constexpr double kFarApart = 5;

// What two rows of the same conditions have in common.
using RowConditions =
    std::tuple<std::string, double, double, double, double, std::optional<FingerState>>;

RowConditions row_conditions(const FrictionDatum& d) {
  return {d.design, d.relative_humidity, d.amplitude, d.frequency, d.load, d.state};
}

// A friction of a row and its column.
struct MeasuredForce {
  const char* name;
  double FrictionDatum::*value;
  double FrictionDatum::*sd;
};
constexpr MeasuredForce kForces[] = {{"F_off", &FrictionDatum::off, &FrictionDatum::off_sd},
                                     {"F_on", &FrictionDatum::on, &FrictionDatum::on_sd}};

class FrictionReader {
 public:
  FrictionReader(const std::string& path, const std::string& finger)
      : path_(path),
        finger_(finger),
        table_(read_measured_table(read_bytes(path, kLargestTable), path)) {}

  FrictionTable read() {
    check_columns();
    if (problems_.empty()) {
      for (const MeasuredRow& row : table_.rows) take(row);
      if (empty_ > 0)
        out_.notes.push_back(
            fmt::format("{} without a friction are left out", counted(empty_, "row")));
      if (others_ > 0)
        out_.notes.push_back(fmt::format("{} of other fingers ({}) are left out",
                                         counted(others_, "row"), join_names(other_fingers_)));
      if (out_.rows.empty() && problems_.empty()) tell_none();
    }
    if (problems_.empty()) {
      for (const MeasuredForce& force : kForces) check_deviations(force);
      note_far_apart();
    }
    if (!problems_.empty()) throw InputError(problems_);
    out_.notes.insert(out_.notes.begin(), table_.notes.begin(), table_.notes.end());
    return std::move(out_);
  }

 private:
  void problem(int line, const std::string& key, const std::string& message) {
    problems_.push_back({path_, line, 0, key, message});
  }

  void tell_none() {
    if (others_ == 0) {
      problem(1, "F_off", "no row has a friction");
    } else {
      problem(1, "finger",
              fmt::format("no row with a friction is of \"{}\" (data_finger); there are {}",
                          finger_, join_names(other_fingers_)));
    }
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
    if (!finger_.empty())
      needed("finger", "write whose finger each row is of, or leave data_finger out");
    const auto any = [&](const auto& says) {
      return std::any_of(table_.rows.begin(), table_.rows.end(), [&](const MeasuredRow& row) {
        return row.measured() && chosen(row) && says(row);
      });
    };
    const bool on = any([](const MeasuredRow& row) { return row.on.has_value(); });
    if (on) {
      needed("F_on_sd", "write F_on_sd_N, one standard deviation of the value");
      needed("voltage", "write voltage_V, the amplitude");
    }
    if (on || any([](const MeasuredRow& row) { return row.voltage.value_or(0) > 0; }))
      needed("frequency", "write frequency_Hz");
  }

  bool chosen(const MeasuredRow& row) const { return finger_.empty() || row.finger == finger_; }

  void take(const MeasuredRow& row) {
    if (!row.measured()) {
      ++empty_;
      return;
    }
    if (!chosen(row)) {
      ++others_;
      const std::string name = fmt::format("\"{}\"", row.finger);
      if (std::find(other_fingers_.begin(), other_fingers_.end(), name) == other_fingers_.end())
        other_fingers_.push_back(name);
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
    if (problems_.size() > before) return;
    const auto [first, is_new] = seen_.try_emplace(
        {row_conditions(d), d.off, d.off_sd, d.on, d.on_sd, row.experiment, row.day, row.repeat},
        row.line);
    if (!is_new) copies_.push_back(fmt::format("line {} of line {}", row.line, first->second));
    out_.rows.push_back(std::move(d));
  }

  // A column of standard deviations in mN among forces in N.
  void check_deviations(const MeasuredForce& force) {
    int stated = 0, large = 0;
    const FrictionDatum* first = nullptr;
    for (const FrictionDatum& d : out_.rows) {
      const double sd = d.*force.sd;
      stated += sd > 0;
      if (!(sd > kLargestDeviation * d.*force.value)) continue;
      ++large;
      if (!first) first = &d;
    }
    if (2 * large <= stated) return;
    problem(first->line, fmt::format("{}_sd", force.name),
            fmt::format("{} N is {} times the value, and {} of {} rows state more than {:g} times "
                        "theirs: is the standard deviation in mN? Then {} N is meant",
                        significant(first->*force.sd, 4),
                        significant(first->*force.sd / first->*force.value, 3), large, stated,
                        kLargestDeviation, significant(first->*force.sd / 1000, 4)));
  }

  // Copies, and rows whose values no stated scatter brings together.
  void note_far_apart() {
    if (!copies_.empty())
      out_.notes.push_back("copies count as measurements of their own: " + join_names(copies_));
    std::map<RowConditions, std::vector<const FrictionDatum*>> same;
    for (const FrictionDatum& d : out_.rows) same[row_conditions(d)].push_back(&d);
    for (const auto& [key, rows] : same) {
      for (const MeasuredForce& force : kForces) note_far_apart(force, rows);
    }
  }

  void note_far_apart(const MeasuredForce& force, const std::vector<const FrictionDatum*>& rows) {
    const FrictionDatum *least = nullptr, *most = nullptr;
    for (const FrictionDatum* d : rows) {
      if (!(d->*force.sd > 0)) continue;
      if (!least || d->*force.value < least->*force.value) least = d;
      if (!most || d->*force.value > most->*force.value) most = d;
    }
    if (!least) return;
    const double apart =
        (most->*force.value - least->*force.value) / std::hypot(most->*force.sd, least->*force.sd);
    if (!(apart > kFarApart)) return;
    const auto [first, second] = std::minmax(least->line, most->line);
    out_.notes.push_back(
        fmt::format("lines {} and {} are of the same conditions, and their {} are {} standard "
                    "deviations of their difference apart",
                    first, second, force.name, significant(apart, 3)));
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
              fmt::format("\"{}\", and \"{}\" in line {}: a fit is of one finger, so say which one "
                          "by data_finger in the calibration",
                          row.finger, first_->finger, first_->line));
  }

  std::string path_, finger_;
  MeasuredTable table_;
  const MeasuredRow* first_ = nullptr;  // with a friction
  int empty_ = 0, others_ = 0;
  std::vector<std::string> other_fingers_;  // quoted
  // Rows with all that they say, and the line of the first of each.
  std::map<std::tuple<RowConditions, double, double, double, double, std::string, std::string, int>,
           int>
      seen_;
  std::vector<std::string> copies_;
  FrictionTable out_;
  std::vector<Problem> problems_;
};

}  // namespace

FrictionTable read_friction(const std::string& path, const std::string& finger) {
  return FrictionReader(path, finger).read();
}

Design as_measured(Design design, const FrictionDatum& row) {
  // The table has voltages, whatever drives the design.
  design.drive.control = DriveControl::Voltage;
  design.drive.current = 0;
  design.drive.source_compliance = 0;
  design.drive.amplitude = row.amplitude;
  // Of a constant voltage, 0, the design has the waveform (check_drives).
  if (row.frequency > 0) design.drive.frequency = row.frequency;
  design.finger.load = row.load;
  if (row.state) design.finger.state = *row.state;
  return design;
}

void check_drives(const std::vector<FrictionDatum>& rows, const std::string& path) {
  std::map<std::string, Design> designs;
  std::vector<Problem> problems;
  for (const FrictionDatum& row : rows) {
    if (!(row.on_sd > 0)) continue;
    auto read = designs.find(row.design);
    if (read == designs.end()) read = designs.emplace(row.design, read_design(row.design)).first;
    const Design d = as_measured(read->second, row);
    const std::string wrong =
        row.amplitude > 0 ? frequency_problem(read->second.drive, row.frequency) : "";
    if (!wrong.empty()) problems.push_back({path, row.line, 0, "frequency", wrong});
    if (!(bridged_margin(d.surface, d.texture, d.drive, row.amplitude) < 1)) continue;
    const double limit = breakdown_voltage(d.surface, d.texture, d.drive);
    problems.push_back(
        {path, row.line, 0, "voltage",
         limit > 0
             ? fmt::format("{} V, but the film breaks down at {} V: leave F_on out, or state in "
                           "{} the strength of a film that withstood it",
                           significant(row.amplitude, 4), significant(limit, 3),
                           fs::path(row.design).filename().string())
             : fmt::format("{} V, but {} has no dielectric that withstands a voltage: leave F_on "
                           "out",
                           significant(row.amplitude, 4),
                           fs::path(row.design).filename().string())});
  }
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace papilla::calibrate
