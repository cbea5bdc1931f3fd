// Columns of what instruments and people write: a name with its unit, "F_off_mN", "normal [N]",
// "humidity_percent".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/rooms.h"

namespace papilla::lab {

// A quantity that a table may have a column of.
struct ColumnKind {
  std::string name;  // "load"; what people write before the unit
  std::string unit;  // of its dimension: "N"; "": a plain number or a text
  bool is_text = false;
  std::vector<std::string> also{};  // other names of it
};

struct Column {
  const ColumnKind* kind = nullptr;
  double to_si = 1;
};

// What a header cell stands for; null kind: unknown. Throws InputError for a known name whose unit
// is missing or of another dimension.
Column read_column(std::string_view cell, const std::vector<ColumnKind>& kinds);

// Of a line, blanks at the ends of cells and quotes around them removed. Views into the line.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells);
// Comma, semicolon or tab: that of a header line.
char separator_of(std::string_view header);
// Nothing where the whole of it is no finite number.
std::optional<double> cell_number(std::string_view cell);

// The lines of a text, one at a time, without their ends.
class Lines {
 public:
  explicit Lines(std::string_view text);
  bool next(std::string_view& line);
  int number() const { return number_; }               // of the last one, from 1
  bool ended_within() const { return ended_within_; }  // the last one has no line end

 private:
  std::string_view rest_;
  int number_ = 0;
  bool ended_within_ = false;
};

}  // namespace papilla::lab
