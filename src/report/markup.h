// Text as SVG and HTML take it.
#pragma once

#include <string>

#include "base/rooms.h"

namespace papilla::report {

// Text as it stands inside an element of SVG or HTML.
std::string markup_text(const std::string& text);
// JSON as it stands inside a script element: no text of a design can end it.
std::string script_text(std::string text);
// The headings, paragraphs and tables of Markdown as this program writes it.
std::string markdown_html(const std::string& markdown);

}  // namespace papilla::report
