// Columns of what instruments and people write: a name with its unit, "F_off_mN", "normal [N]",
// "humidity_percent".
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/rooms.h"

namespace papilla::config {

// A quantity that a table may have a column of. Of two that share a name, one with and one without
// a unit, a cell stands for the one that is written as it is.
struct ColumnKind {
  std::string name;  // "load"; what people write before the unit
  std::string unit;  // of its dimension: "N"; "": a plain number or a text
  bool is_text = false;
  std::vector<std::string> also{};  // other names of it
};

struct TableColumn {
  const ColumnKind* kind = nullptr;
  double to_si = 1;
  std::string unit{};  // of its cells, as its head says it: "mN", "%"; "": a plain number or a text
};

// What a header cell stands for; null kind: unknown. Throws InputError for a known name whose unit
// is missing or of another dimension.
TableColumn read_column(std::string_view cell, const std::vector<ColumnKind>& kinds);

// Of a line, blanks at the ends of cells and quotes around them removed. Views into the line.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells);
// Comma, semicolon or tab: that of a header line.
char separator_of(std::string_view header);
// Nothing where the whole of it is no finite number.
std::optional<double> cell_number(std::string_view cell);

// The columns of a header line, in their order; a null kind: not read. What is wrong with it, each
// told once.
struct Header {
  std::vector<TableColumn> columns;
  std::vector<std::string> unread;
  // A cell and what is wrong with it; the cell empty where the message names it.
  std::vector<std::pair<std::string, std::string>> problems;

  bool has(const ColumnKind& kind) const;
};
Header read_header(const std::vector<std::string_view>& cells,
                   const std::vector<ColumnKind>& kinds);
// "columns that are not read: row, made"; "" where all are.
std::string unread_note(const Header& header);

// The lines of a text, one at a time, without their ends.
class Lines {
 public:
  explicit Lines(std::string_view text);
  bool next(std::string_view& line);
  // Calls comment with lines of '#', header with the cells of the first other line that is not
  // blank, and row with those of each later one. blank: what a line without cells is made of.
  void each(std::string_view blank, const std::function<void(std::string_view line)>& comment,
            const std::function<void(const std::vector<std::string_view>&)>& header,
            const std::function<void(const std::vector<std::string_view>&)>& row);
  int number() const { return number_; }               // of the last one, from 1
  bool ended_within() const { return ended_within_; }  // the last one has no line end

 private:
  std::string_view rest_;
  int number_ = 0;
  bool ended_within_ = false;
};

}  // namespace papilla::config
