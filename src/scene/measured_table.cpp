#include "scene/measured_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "config/columns.h"

namespace papilla::scene {
namespace {

// No skin rubs at ten times its load (coefficients are 0.1 to 3), and what is beyond fifty times it
// is another unit.
constexpr double kLargestCoefficient = 10, kCoefficientOfAnotherUnit = 50;
// From touch to touch, a share of friction: what a row states is often of one touch alone.
constexpr double kScatter = 0.05;
// Deviations beyond which columns are taken for exchanged.
constexpr double kBeyondScatter = 3;
// Humidity in percent below this is meant as a share.
constexpr double kLeastHumidity = 0.01;

enum class Kind {
  Experiment,
  Field,
  Design,
  Finger,
  Day,
  State,
  Repeat,
  Load,
  Humidity,
  HumidityShare,
  Voltage,
  Frequency,
  Off,
  OffSd,
  On,
  OnSd
};

const std::vector<ColumnKind>& table_kinds() {
  static const std::vector<ColumnKind> kinds{{"experiment", "", true, {}},
                                             {"field", "", true, {}},
                                             {"design", "", true, {}},
                                             {"finger", "", true, {}},
                                             {"day", "", true, {"date", "session"}},
                                             {"state", "", true, {}},
                                             {"repeat", "", false, {}},
                                             {"load", "N", false, {"normal"}},
                                             {"humidity", "%", false, {"relative_humidity"}},
                                             {"relative_humidity", "", true, {}},
                                             {"voltage", "V", false, {"amplitude"}},
                                             {"frequency", "Hz", false, {}},
                                             {"F_off", "N", false, {"friction_off"}},
                                             {"F_off_sd", "N", false, {"friction_off_sd"}},
                                             {"F_on", "N", false, {"friction_on"}},
                                             {"F_on_sd", "N", false, {"friction_on_sd"}}};
  return kinds;
}

double scatter(double value, std::optional<double> sd) {
  return std::max(sd.value_or(0), kScatter * value);
}

class TableReader {
 public:
  TableReader(std::string_view text, const std::string& file) : lines_(text), file_(file) {}

  MeasuredTable read() {
    lines_.each(
        " \t,;", [](std::string_view) {},
        [this](const std::vector<std::string_view>& cells) { header(cells); },
        [this](const std::vector<std::string_view>& cells) { row(cells); });
    if (columns_.empty()) problem("", "no header line");
    if (problems_.empty() && out_.rows.empty()) problem("", "no rows below the header");
    if (problems_.empty()) check_order();
    if (!problems_.empty()) throw InputError(problems_);
    if (lines_.ended_within())
      out_.notes.emplace_back("the last line has no line end: is the file whole?");
    return std::move(out_);
  }

 private:
  void problem(const std::string& key, const std::string& message, int cell = 0) {
    problems_.push_back({file_, lines_.number(), cell, key, message});
  }

  void header(const std::vector<std::string_view>& cells) {
    Header found = read_header(cells, table_kinds());
    columns_ = found.columns;
    for (const auto& [cell, message] : found.problems) problem(cell, message);
    for (const TableColumn& column : columns_) {
      if (!column.kind) continue;
      out_.columns.push_back(column.kind->name);
      const Kind kind = kind_of(column);
      out_.has_friction |= kind == Kind::Off || kind == Kind::On;
    }
    if (out_.has("humidity") && out_.has("relative_humidity"))
      problem("relative_humidity", "a second column of the humidity: leave one of the two out");
    // A word that is nearly one of a column is that column, mistyped.
    if (problems_.empty())
      std::erase_if(found.unread, [&](const std::string& c) { return is_mistyped(c); });
    out_.unread = found.unread;
    if (!found.unread.empty()) out_.notes.push_back(unread_note(found));
  }

  bool is_mistyped(const std::string& cell) {
    std::vector<std::string> known;
    for (const ColumnKind& kind : table_kinds()) {
      // A text that is not read is named; short words are near each other.
      if (kind.is_text && kind.name != "relative_humidity" && kind.name != "design") continue;
      known.push_back(kind.name + (kind.unit.empty()  ? ""
                                   : kind.unit == "%" ? "_percent"
                                                      : "_" + kind.unit));
    }
    const std::string near = nearest_name(cell, known);
    if (!near.empty()) problem(cell, fmt::format("no such column, is it `{}`?", near));
    return !near.empty();
  }

  static Kind kind_of(const TableColumn& column) {
    return static_cast<Kind>(column.kind - table_kinds().data());
  }

  void row(const std::vector<std::string_view>& cells) {
    if (cells.size() != columns_.size()) {
      problem("", fmt::format("expected {} cells, got {}{}", columns_.size(), cells.size(),
                              lines_.ended_within() ? ": the file is cut off" : ""));
      return;
    }
    MeasuredRow r;
    r.line = lines_.number();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (columns_[i].kind && !cells[i].empty())
        take(r, columns_[i], cells[i], static_cast<int>(i) + 1);
    }
    for (Problem& p : row_problems(r, file_)) problems_.push_back(std::move(p));
    out_.rows.push_back(std::move(r));
  }

  void take(MeasuredRow& r, const TableColumn& column, std::string_view cell, int place) {
    switch (kind_of(column)) {
      case Kind::Experiment:
        r.experiment = cell;
        return;
      case Kind::Field:
        r.field = cell;
        return;
      case Kind::Design:
        r.design = cell;
        return;
      case Kind::Finger:
        r.finger = cell;
        return;
      case Kind::Day:
        r.day = cell;
        return;
      case Kind::State:
        r.state = state(cell, place);
        return;
      case Kind::Repeat:
        r.repeat = repeat(column, cell, place);
        return;
      case Kind::Load:
        r.load = number(column, cell, place, 1e-6, 100);
        return;
      case Kind::Humidity:
        r.relative_humidity = humidity(column, cell, place);
        return;
      case Kind::HumidityShare:
        r.relative_humidity = share(column, cell, place);
        return;
      case Kind::Voltage:
        r.voltage = number(column, cell, place, 0, 1e5);
        return;
      case Kind::Frequency:
        r.frequency = number(column, cell, place, 0, 1e9);
        return;
      case Kind::Off:
        r.off = number(column, cell, place, 1e-9, 1e3);
        return;
      case Kind::OffSd:
        r.off_sd = number(column, cell, place, 1e-9, 1e3);
        return;
      case Kind::On:
        r.on = number(column, cell, place, 1e-9, 1e3);
        return;
      case Kind::OnSd:
        r.on_sd = number(column, cell, place, 1e-9, 1e3);
        return;
    }
  }

  // low, high: SI. What is said is in the unit of the column, as the cell is.
  std::optional<double> number(const TableColumn& column, std::string_view cell, int place,
                               double low, double high) {
    const auto value = cell_number(cell);
    if (!value) {
      problem(column.kind->name, fmt::format("expected a number, got \"{}\"", cell), place);
      return std::nullopt;
    }
    // Tenths and hundredths are divided by whole numbers: 35 % is the number 0.35 of a plan.
    const double si = column.to_si < 1 ? *value / (1 / column.to_si) : *value * column.to_si;
    if (!(si >= low && si <= high)) {
      problem(column.kind->name,
              fmt::format("{} lies outside {:.12g} to {:.12g} {}", cell, low / column.to_si,
                          high / column.to_si, column.unit),
              place);
      return std::nullopt;
    }
    return si;
  }

  int repeat(const TableColumn& column, std::string_view cell, int place) {
    const double value = number(column, cell, place, 1, 1e6).value_or(0);
    if (value != std::floor(value))
      problem("repeat", fmt::format("expected a whole number, got \"{}\"", cell), place);
    return static_cast<int>(value);
  }

  std::optional<double> humidity(const TableColumn& column, std::string_view cell, int place) {
    const auto value = number(column, cell, place, 0, 1);
    const std::string wrong = value ? humidity_problem(*value) : "";
    if (!wrong.empty()) problem("humidity", wrong, place);
    return value;
  }

  // "15 %" or 0.15, as `papilla calibrate` takes it.
  std::optional<double> share(const TableColumn& column, std::string_view cell, int place) {
    if (const auto q = parse_quantity(cell); q && q->unit == "%") {
      if (q->si >= 0 && q->si <= 1) return q->si;
      problem("relative_humidity", fmt::format("{} lies outside 0 to 100 %", cell), place);
      return std::nullopt;
    }
    const auto value = cell_number(cell);
    if (!value || *value < 2 || *value > 100) return number(column, cell, place, 0, 1);
    problem("relative_humidity",
            fmt::format("{} lies outside 0 to 1: write it as \"{} %\"", cell, cell), place);
    return std::nullopt;
  }

  std::optional<FingerState> state(std::string_view cell, int place) {
    const std::vector<std::string>& names = finger_state_names();
    const auto found = std::find(names.begin(), names.end(), cell);
    if (found != names.end()) return static_cast<FingerState>(found - names.begin());
    problem("state", fmt::format("\"{}\" is no state: {}", cell, join_names(names)), place);
    return std::nullopt;
  }

  // A voltage draws the finger to the surface: columns that surely say the contrary are exchanged
  // where most rows say so, and a few rows have a wrong number.
  void check_order() {
    double less = 0, variance = 0;
    std::vector<const MeasuredRow*> both, lower;
    for (const MeasuredRow& r : out_.rows) {
      if (!r.off || !r.on) continue;
      less += *r.off - *r.on;
      variance += square(scatter(*r.off, r.off_sd)) + square(scatter(*r.on, r.on_sd));
      both.push_back(&r);
      if (*r.off > *r.on) lower.push_back(&r);
    }
    if (!(less > 0)) return;
    constexpr const char* kLess = "under voltage the finger rubs less on average than without it";
    if (!(less > kBeyondScatter * std::sqrt(variance))) {
      out_.notes.push_back(
          fmt::format("{}, by no more than touches scatter; exchanged columns look so too", kLess));
    } else if (2 * lower.size() > both.size() || !name_lower(both, lower)) {
      problem("F_on", fmt::format("{}: are F_off and F_on exchanged?", kLess));
    }
  }

  // The rows that surely say so, each beside the F_off over F_on that the table's middle row has.
  // false: none does by itself.
  bool name_lower(const std::vector<const MeasuredRow*>& both,
                  const std::vector<const MeasuredRow*>& lower) {
    std::vector<double> ratios;
    ratios.reserve(both.size());
    for (const MeasuredRow* r : both) ratios.push_back(*r->off / *r->on);
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>((ratios.size() - 1) / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    const std::size_t before = problems_.size();
    for (const MeasuredRow* r : lower) {
      if (!rubs_less_driven(*r)) continue;
      const double ratio = *r->off / *r->on;
      problems_.push_back(
          {file_, r->line, 0, "F_off",
           fmt::format("{} N is {} times the F_on of the same line, where other rows have {}: one "
                       "of the two is off by a factor of {}",
                       significant(*r->off, 4), significant(ratio, 3), significant(*middle, 3),
                       significant(ratio / *middle, 3))});
    }
    return problems_.size() > before;
  }

  Lines lines_;
  std::string file_;
  std::vector<TableColumn> columns_;
  std::vector<Problem> problems_;
  MeasuredTable out_;
};

}  // namespace

MeasuredTable read_measured_table(std::string_view text, const std::string& file) {
  return TableReader(text, file).read();
}

std::vector<Problem> row_problems(const MeasuredRow& r, const std::string& file) {
  std::vector<Problem> out;
  if (r.on && r.voltage == 0.0)
    out.push_back({file, r.line, 0, "F_on", "a friction under voltage, but the voltage is 0"});
  for (const auto& [name, force] : {std::pair("F_off", r.off), std::pair("F_on", r.on)}) {
    if (!force || !r.load || *force <= kLargestCoefficient * *r.load) continue;
    out.push_back({file, r.line, 0, name,
                   fmt::format("{} N is {} times the load of {} N{}", significant(*force, 4),
                               significant(*force / *r.load, 3), significant(*r.load, 3),
                               *force > kCoefficientOfAnotherUnit * *r.load
                                   ? fmt::format(": are these mN? Then {} N is meant",
                                                 significant(*force / 1000, 4))
                                   : "; no finger rubs so")});
  }
  return out;
}

std::string humidity_problem(double relative_humidity) {
  const std::string percent = significant(100 * relative_humidity, 3);
  if (!(relative_humidity >= 0 && relative_humidity <= 1))
    return percent + " % lies outside 0 to 100 %";
  if (relative_humidity == 0 || relative_humidity >= kLeastHumidity) return "";
  return fmt::format("{} %: is it a share? Then {} % is meant", percent,
                     significant(1e4 * relative_humidity, 3));
}

bool rubs_less_driven(const MeasuredRow& r) {
  return *r.off - *r.on >
         kBeyondScatter * std::hypot(scatter(*r.off, r.off_sd), scatter(*r.on, r.on_sd));
}

std::string frequency_problem(const Drive& drive, double frequency) {
  if (frequency > 0 || drive.waveform == Waveform::Dc || drive.frequency <= 0) return "";
  return fmt::format(
      "0 Hz is a constant voltage, and the design is driven at {}: give the frequency of the "
      "drive, or set drive.waveform = \"dc\" in the design",
      format_quantity(drive.frequency, "Hz"));
}

}  // namespace papilla::scene
