// One list of fields a struct: it drives reading, checking, the generated reference, the
// optimiser's design vector and the units of reports. Every configurable struct S has, beside it,
//     void fields(FieldVisitor& v, S& s);
// which names each member once. Readers, writers and describers are visitors.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/rooms.h"

namespace papilla::config {

// Where a default comes from (shown in resolved.toml and `papilla describe`).
enum class Source { Measured, Paper, Fit, Estimate, Choice };
std::string_view source_name(Source source);  // "measured", "paper", "fit", "estimate", "choice"

enum class Presence { Optional, Required };

// A number with a unit. The limits are in that unit, inclusive; the member is SI.
struct NumberSpec {
  const char* key;
  const char* unit;  // "um", "deg", "%", ... ; "" = plain number (written bare in files)
  double low, high;  // in `unit`
  const char* doc;
  Source source = Source::Choice;
  const char* reference = "";  // paper, table or reason behind the default
  Presence presence = Presence::Optional;
};

// Anything else: text, flags, integers, choices, sections.
struct FieldSpec {
  const char* key;
  const char* doc;
  Source source = Source::Choice;
  const char* reference = "";
  Presence presence = Presence::Optional;
};

class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;

  // True while values come from a file: the moment to set defaults that depend on earlier members.
  virtual bool reading() const { return false; }

  virtual void number(const NumberSpec& spec, double& si) = 0;
  virtual void numbers(const NumberSpec& spec, std::vector<double>& si) = 0;  // a list, same unit
  virtual void integer(const FieldSpec& spec, int low, int high, int& value) = 0;
  virtual void flag(const FieldSpec& spec, bool& value) = 0;
  virtual void text(const FieldSpec& spec, std::string& value) = 0;
  // A path beside the file that names it; the reader makes it absolute.
  virtual void path(const FieldSpec& spec, std::string& value) = 0;
  // One of `names`; value is its index.
  virtual void choice(const FieldSpec& spec, const std::vector<std::string>& names, int& value) = 0;

  template <class E>
  void choice(const FieldSpec& spec, const std::vector<std::string>& names,
              E& value) requires std::is_enum_v<E> {
    int index = static_cast<int>(value);
    choice(spec, names, index);
    value = static_cast<E>(index);
  }

  // A nested struct: [section].
  template <class S>
  void section(const FieldSpec& spec, S& s) {
    if (begin_section(spec)) fields(*this, s);
    end_section();
  }

  // A list of structs: [[list]] or an array of inline tables.
  template <class S>
  void list(const FieldSpec& spec, std::vector<S>& items) {
    bool replace = false;
    const int count = begin_list(spec, static_cast<int>(items.size()), replace);
    if (replace) items.assign(static_cast<std::size_t>(count), S{});
    for (int i = 0; i < count; ++i) {
      if (begin_item(i)) fields(*this, items[static_cast<std::size_t>(i)]);
      end_item();
    }
    end_list();
  }

 protected:
  virtual bool begin_section(const FieldSpec& spec) = 0;  // false: skip the members
  virtual void end_section() = 0;
  // How many items to visit; `replace`: start from that many new ones.
  virtual int begin_list(const FieldSpec& spec, int current, bool& replace) = 0;
  virtual bool begin_item(int index) = 0;
  virtual void end_item() = 0;
  virtual void end_list() = 0;
};

}  // namespace papilla::config
