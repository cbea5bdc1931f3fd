#include "report/markup.h"

#include <string_view>
#include <vector>

#include "base/text.h"

namespace papilla::report {
namespace {

// "| a | b |" as a row.
std::string row_html(const std::string& line, bool head) {
  std::vector<std::string> cells = split(line.substr(1), '|');
  if (!cells.empty()) cells.pop_back();
  std::string out = "<tr>";
  for (const std::string& cell : cells)
    out.append(head ? "<th>" : "<td>").append(markup_text(cell)).append(head ? "</th>" : "</td>");
  return out + "</tr>\n";
}

std::string without_emphasis(std::string line) {
  for (const char* mark : {"**", "`"}) {
    for (std::size_t at = 0; (at = line.find(mark, at)) != std::string::npos;)
      line.erase(at, std::string_view(mark).size());
  }
  return line;
}

}  // namespace

std::string markup_text(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

std::string script_text(std::string text) {
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;)
    text.replace(at, 1, "\\u003c");
  return text;
}

std::string markdown_html(const std::string& markdown) {
  std::string out;
  bool in_table = false;
  for (const std::string& marked : split(markdown, '\n')) {
    const std::string line = without_emphasis(marked);
    const bool row = line.starts_with('|');
    if (in_table != row) out += row ? "<div class=\"scroll\"><table>\n" : "</table></div>\n";
    const bool first = row && !in_table;
    in_table = row;
    if (line.empty() || line.starts_with("# ") || line.starts_with("|-")) continue;
    if (line.starts_with("## ")) {
      out += "<h2>" + markup_text(line.substr(3)) + "</h2>\n";
    } else if (row) {
      out += row_html(line, first);
    } else {
      out += "<p>" + markup_text(line) + "</p>\n";
    }
  }
  return out + (in_table ? "</table></div>\n" : "");
}

}  // namespace papilla::report
