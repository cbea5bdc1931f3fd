// A design as a form: each key with its value, unit, range, source, and the line of the file that
// it comes from; and what a page may write into it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/reader.h"
#include "design/study.h"

namespace papilla::studio {

enum class KeyType { Number, Numbers, Integer, Flag, Choice, Text, Path };

struct FormKey {
  std::string path;  // "texture.depth"
  KeyType type = KeyType::Number;
  std::string value;  // as people write it: "350 nm"
  std::string unit, doc, source, reference;
  double shown = 0, low = 0, high = 0;  // Number, Integer: in the unit
  std::vector<std::string> choices;
};

// Every key of a design, in the order of its sections.
std::vector<FormKey> form_keys(const Design& design);

// A key set to a text, as `--set` takes it: "texture.depth=262 nm".
struct Change {
  std::string path, text;

  std::string setting() const { return path + "=" + text; }
  bool operator==(const Change&) const = default;
};

// What a page wrote, as a setting that can only be a value of that key. Throws InputError for a key
// that the form has not and for what is no value of its type. Files are not set so.
Change checked_change(const std::vector<FormKey>& keys, const std::string& path,
                      const std::string& text);

// "0", "12": as the items of a list are counted.
bool is_number(const std::string& text);
// surface.dielectric.0.thickness -> surface.dielectric; empty: no item of a list.
std::string list_of(const std::string& path);
// A list of sections set as a whole; of what an item has a law for, and the law is none, nothing.
Change whole_list(const Design& design, const std::string& list);

// The settings that make one design of another; a new kind of texture comes first. A list with
// other items, in number or kind, is one change: what is not there has no key. Without the title,
// which follows from the changes.
std::vector<Change> changes_between(const Design& from, const Design& to);

// The rows of the form. opened: the design that sliders take their ranges from.
nlohmann::ordered_json form_json(const Study& study, const Design& opened,
                                 const std::vector<Change>& changes);
// Of the rows whose value, or where it comes from, is another than the page was told: just that,
// with their path. None: the rows or their words are others, the page needs all of them.
std::optional<nlohmann::ordered_json> moved_since(const nlohmann::ordered_json& told,
                                                  const nlohmann::ordered_json& rows);

}  // namespace papilla::studio
