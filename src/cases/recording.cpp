#include "cases/recording.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "base/text.h"

namespace papilla::cases {
namespace {

[[noreturn]] void refuse(const std::string& name, int line, const std::string& what) {
  throw InputError({Problem{name, line, 1, "", what}});
}

class RecordingReader {
 public:
  RecordingReader(const std::string& csv, const std::string& name, const RecordedColumns& columns)
      : lines_(csv), name_(name), columns_(columns), kinds_(columns.kinds) {
    for (const ColumnKind& kind : columns.kinds)
      kinds_.push_back({kind.name, "", false, kind.also});
  }

  Recording read() {
    std::string_view line;
    std::vector<std::string_view> cells;
    while (lines_.next(line)) {
      if (line.empty()) continue;
      split_cells(line, ',', cells);
      const auto values = numbers_of(cells);
      if (places_.empty() && !values && takes_head(line, cells)) continue;
      if (places_.empty() && values) take_documented_order(cells.size());
      if (!values || places_.empty() || values->size() != places_.size()) unexpected(line);
      add(*values);
    }
    if (out_.rows.size() < 2)
      refuse(name_, 1, fmt::format("expected two lines of {} or more", columns_.expected));
    return std::move(out_);
  }

 private:
  // Where the number of a cell goes in its row.
  struct Place {
    std::size_t index;
    double to_si;
  };

  [[noreturn]] void unexpected(std::string_view line) {
    refuse(name_, lines_.number(),
           fmt::format("expected {}, got \"{}\"{}", columns_.expected, line,
                       line.find(';') != std::string_view::npos
                           ? "; the separator is a comma, decimals a point"
                           : ""));
  }

  // Nothing where one of them is no finite number.
  static std::optional<std::vector<double>> numbers_of(const std::vector<std::string_view>& cells) {
    std::vector<double> out;
    for (const std::string_view cell : cells) {
      const auto value = cell_number(cell);
      if (!value) return std::nullopt;
      out.push_back(*value);
    }
    return out;
  }

  // Whether the line is one: none of its names may be known.
  bool takes_head(std::string_view line, const std::vector<std::string_view>& cells) {
    const Header head = read_header(cells, kinds_);
    if (head.unread.size() == cells.size()) return false;
    if (const std::string wrong = wrong_with(head); !wrong.empty()) {
      refuse(name_, lines_.number(),
             fmt::format("{}; expected {}, got \"{}\"", wrong, columns_.expected, line));
    }
    const std::size_t lacking = columns_.kinds.size() - cells.size();
    for (const TableColumn& column : head.columns)
      places_.push_back({index_of(column) - lacking, column.to_si});
    return true;
  }

  // "" where it has each column once.
  std::string wrong_with(const Header& head) const {
    if (!head.problems.empty()) return head.problems.front().second;
    if (!head.unread.empty()) return "no column here: " + join_names(head.unread);
    std::vector<int> count(columns_.kinds.size());
    for (const TableColumn& column : head.columns) ++count[index_of(column)];
    for (std::size_t k = 0; k < count.size(); ++k) {
      if (count[k] > 1) return "two columns of " + columns_.kinds[k].name;
      if (count[k] == 0 && !(k == 0 && columns_.first_may_lack))
        return "no column of " + columns_.kinds[k].name;
    }
    return "";
  }

  std::size_t index_of(const TableColumn& column) const {
    return static_cast<std::size_t>(column.kind - kinds_.data()) % columns_.kinds.size();
  }

  void take_documented_order(std::size_t count) {
    const std::size_t all = columns_.kinds.size();
    if (count != all && !(columns_.first_may_lack && count + 1 == all)) return;
    for (std::size_t k = 0; k < count; ++k) places_.push_back({k, 1});
  }

  void add(const std::vector<double>& values) {
    std::vector<double>& row = out_.rows.emplace_back(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      row[places_[i].index] = values[i] * places_[i].to_si;
    out_.lines.push_back(lines_.number());
  }

  Lines lines_;
  const std::string& name_;
  const RecordedColumns& columns_;
  std::vector<ColumnKind> kinds_;  // with their units, then without
  std::vector<Place> places_;      // of the cells of a row; none before the head or the first row
  Recording out_;
};

}  // namespace

Recording read_recording(const std::string& csv, const std::string& name,
                         const RecordedColumns& columns) {
  return RecordingReader(csv, name, columns).read();
}

double even_step(const Recording& recording, const std::string& name) {
  const auto& rows = recording.rows;
  const double step = (rows.back()[0] - rows.front()[0]) / static_cast<double>(rows.size() - 1);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double here = rows[i][0] - rows[i - 1][0];
    if (!(step > 0) || std::abs(here - step) > 0.01 * step) {
      refuse(
          name, recording.lines[i],
          fmt::format("expected even steps of time, got {:g} s among steps of {:g} s", here, step));
    }
  }
  return step;
}

Signal recorded_signal(const std::string& csv, const std::string& name, DriveControl control) {
  const bool current = control == DriveControl::Current;
  const ColumnKind held = current ? ColumnKind{"value", "A", false, {"current", "I", "A"}}
                                  : ColumnKind{"value", "V", false, {"voltage", "U", "V"}};
  const Recording recording = read_recording(
      csv, name,
      {{{"time", "s", false, {"t"}}, held}, false, "\"time,value\" in s and " + held.unit});
  const auto& rows = recording.rows;
  const double step = even_step(recording, name);
  const auto count = static_cast<double>(rows.size());
  Signal out{step * count, std::vector<double>(std::bit_ceil(rows.size()))};
  for (std::size_t i = 0; i < out.value.size(); ++i) {
    const double at = count * static_cast<double>(i) / static_cast<double>(out.value.size());
    const auto before = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(before);
    const double next = rows[(before + 1) % rows.size()][1];  // it repeats
    out.value[i] = rows[before][1] + share * (next - rows[before][1]);
  }
  return out;
}

}  // namespace papilla::cases
