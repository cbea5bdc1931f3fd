#include "lab/trace_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "config/columns.h"

namespace papilla::lab {
namespace {

constexpr double kMostUnreadable = 0.05;  // share of the lines
constexpr std::size_t kFewest = 100;      // samples: less is no record of sliding

enum TraceColumn { kTime, kTangential, kNormal, kVoltage, kHumidity, kPosition, kTraceColumns };

const std::vector<ColumnKind>& trace_kinds() {
  static const std::vector<ColumnKind> kinds{
      {"time", "s", false, {"t"}},
      {"tangential", "N", false, {"F_t", "Ft", "friction", "lateral"}},
      {"normal", "N", false, {"F_n", "Fn", "load"}},
      {"voltage", "V", false, {"drive"}},
      {"humidity", "%", false, {"relative_humidity"}},
      {"position", "m", false, {"x", "displacement"}}};
  return kinds;
}

class TraceReader {
 public:
  TraceReader(std::string_view text, const std::string& file) : lines_(text), file_(file) {
    out_.time.reserve(std::count(text.begin(), text.end(), '\n'));
  }

  Trace read() {
    lines_.each(
        " \t",
        [this](std::string_view line) {
          if (columns_.empty()) say(line.substr(1));
        },
        [this](const std::vector<std::string_view>& cells) { header(cells); },
        [this](const std::vector<std::string_view>& cells) { sample(cells); });
    check();
    return std::move(out_);
  }

 private:
  std::vector<double>& values(TraceColumn column) {
    const std::array<std::vector<double>*, kTraceColumns> all{
        &out_.time, &out_.tangential, &out_.normal, &out_.voltage, &out_.humidity, &out_.position};
    return *all[column];
  }

  void problem(const std::string& key, const std::string& message) {
    problems_.push_back({file_, lines_.number(), 0, key, message});
  }

  // "field: A3", "Field: A3" or "field = A3"
  void say(std::string_view line) {
    const std::size_t mark = line.find_first_of(":=");
    if (mark == std::string_view::npos) return;
    std::vector<std::string_view> key, value;
    split_cells(line.substr(0, mark), '\n', key);
    split_cells(line.substr(mark + 1), '\n', value);
    std::string name(key.front());
    for (char& c : name) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    out_.said[name] = std::string(value.front());
  }

  void header(const std::vector<std::string_view>& cells) {
    const Header found = read_header(cells, trace_kinds());
    for (const auto& [cell, message] : found.problems) problem(cell, message);
    for (const TableColumn& column : found.columns) {
      const auto index =
          column.kind ? column.kind - trace_kinds().data() : std::ptrdiff_t{kTraceColumns};
      columns_.push_back({static_cast<TraceColumn>(index), column.to_si});
    }
    for (const TraceColumn needed : {kTime, kTangential, kNormal}) {
      const ColumnKind& kind = trace_kinds()[needed];
      if (problems_.empty() && !found.has(kind))
        problem(kind.name, fmt::format("no such column; expected {}_{}", kind.name, kind.unit));
    }
    if (!found.unread.empty()) out_.notes.push_back(unread_note(found));
  }

  void sample(const std::vector<std::string_view>& cells) {
    ++all_;
    std::array<double, kTraceColumns> row{};
    bool good = cells.size() == columns_.size();
    for (std::size_t i = 0; good && i < cells.size(); ++i) {
      if (columns_[i].column == kTraceColumns) continue;
      const auto value = cell_number(cells[i]);
      good = value.has_value();
      if (good) row[columns_[i].column] = *value * columns_[i].to_si;
    }
    if (!good) {
      if (lines_.ended_within() && cells.size() != columns_.size())
        cut_ = true;
      else
        ++unreadable_, last_unreadable_ = lines_.number();
      return;
    }
    for (const Read& r : columns_) {
      if (r.column != kTraceColumns) values(r.column).push_back(row[r.column]);
    }
  }

  void check() {
    if (columns_.empty()) problem("", "no header line");
    const auto share = static_cast<double>(unreadable_) / std::max<double>(1, all_);
    if (share > kMostUnreadable)
      problem("", fmt::format("{} of {} lines hold no sample, the last of them line {}: the file "
                              "is damaged",
                              unreadable_, all_, last_unreadable_));
    else if (unreadable_ > 0)
      out_.notes.push_back(fmt::format("{} without a number left out, the last in line {}",
                                       counted(unreadable_, "sample"), last_unreadable_));
    if (cut_) out_.notes.push_back("the last line is cut off: the record ended there");
    if (problems_.empty() && out_.size() < kFewest)
      problem("", fmt::format("{} only: no record of sliding", counted(out_.size(), "sample")));
    if (problems_.empty()) check_load();
    if (problems_.empty()) check_time();
    if (!problems_.empty()) throw InputError(problems_);
  }

  // By squares: a single spike of the other sign decides nothing, nor does a small zero of the
  // sensor while nothing is touched.
  void check_load() {
    double pressed = 0;
    for (const double force : out_.normal) pressed += force * std::abs(force);
    if (pressed <= 0)
      problem("normal",
              "is below 0 where the finger presses, or 0 everywhere: turn its sign, a force that "
              "presses counts as positive");
  }

  void check_time() {
    std::size_t same = 0;
    for (std::size_t i = 1; i < out_.size(); ++i) {
      same += out_.time[i] == out_.time[i - 1];
      if (out_.time[i] >= out_.time[i - 1]) continue;
      problem("time", fmt::format("falls after {} s: two records in one file, or rows out of order",
                                  significant(out_.time[i - 1], 6)));
      return;
    }
    if (out_.time.back() == out_.time.front()) problem("time", "is the same in all samples");
    if (same == 0 || !problems_.empty()) return;
    spread_equal_times();
    out_.notes.push_back(fmt::format(
        "{} of {} samples share their time with the one before, it is written too coarsely: they "
        "are spaced evenly",
        same, out_.size()));
  }

  void spread_equal_times() {
    std::vector<double>& t = out_.time;
    double step = 0;
    for (std::size_t from = 0; from < t.size();) {
      std::size_t to = from + 1;
      while (to < t.size() && t[to] == t[from]) ++to;
      if (to < t.size()) step = (t[to] - t[from]) / static_cast<double>(to - from);
      for (std::size_t i = from + 1; i < to; ++i)
        t[i] = t[from] + step * static_cast<double>(i - from);
      from = to;
    }
  }

  struct Read {
    TraceColumn column;
    double to_si;
  };
  Lines lines_;
  std::string file_;
  std::vector<Read> columns_;
  int all_ = 0, unreadable_ = 0, last_unreadable_ = 0;
  bool cut_ = false;
  std::vector<Problem> problems_;
  Trace out_;
};

}  // namespace

bool is_trace(std::string_view text) {
  Lines lines(text);
  std::string_view line;
  while (lines.next(line)) {
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string_view> cells;
    split_cells(line, separator_of(line), cells);
    bool time = false, force = false;
    for (const std::string_view cell : cells) {
      time |= cell.starts_with("time") || cell.starts_with("t_") || cell.starts_with("t [");
      force |= cell.starts_with("tangential") || cell.starts_with("F_t") ||
               cell.starts_with("Ft") || cell.starts_with("lateral") ||
               cell.starts_with("friction");
    }
    return time && force;
  }
  return false;
}

Trace read_trace(std::string_view text, const std::string& file) {
  return TraceReader(text, file).read();
}

}  // namespace papilla::lab
