// Structs as one line of words and back: every number exact, and such that a person can read them.
// A struct is coded by its one list of members, `void members(Codec&, S&)`, for both directions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace papilla {

class Encoder {
 public:
  void number(double& value);       // hexadecimal
  void whole(std::int64_t& value);  // decimal
  void bytes(std::string& value);   // "5:as is"
  std::string done() && { return std::move(out_); }

 private:
  void word(const std::string& text);

  std::string out_;
};

class Decoder {
 public:
  explicit Decoder(const std::string& text) : text_(text) {}

  void number(double& value);
  void whole(std::int64_t& value);
  void bytes(std::string& value);
  void refuse() { sound_ = false; }
  // Everything was there, and nothing else.
  bool sound() const { return sound_ && at_ == text_.size(); }
  std::size_t left() const { return text_.size() - at_; }

 private:
  std::string word();

  const std::string& text_;
  std::size_t at_ = 0;
  bool sound_ = true;
};

template <class T>
inline constexpr bool is_vector = false;
template <class T>
inline constexpr bool is_vector<std::vector<T>> = true;
template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

// The number of a list's elements: each takes a letter at least.
inline std::int64_t list_size(Encoder&, std::int64_t count) { return count; }
inline std::int64_t list_size(Decoder& d, std::int64_t count) {
  if (count >= 0 && static_cast<std::uint64_t>(count) <= d.left()) return count;
  d.refuse();
  return 0;
}

template <class Codec, class T>
void code(Codec& c, T& value) {
  if constexpr (std::is_same_v<T, double>) {
    c.number(value);
  } else if constexpr (std::is_same_v<T, std::string>) {
    c.bytes(value);
  } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
    auto whole = static_cast<std::int64_t>(value);
    c.whole(whole);
    value = static_cast<T>(whole);
  } else if constexpr (is_vector<T>) {
    auto count = static_cast<std::int64_t>(value.size());
    c.whole(count);
    value.resize(static_cast<std::size_t>(list_size(c, count)));
    for (auto& element : value) code(c, element);
  } else if constexpr (is_optional<T>) {
    bool there = value.has_value();
    code(c, there);
    if (there && !value) value.emplace();
    if (there) code(c, *value);
  } else {
    members(c, value);
  }
}

template <class Codec, class... T>
void code_all(Codec& c, T&... values) {
  (code(c, values), ...);
}

template <class T>
std::string encoded(T value) {
  Encoder e;
  code(e, value);
  return std::move(e).done();
}

// Nothing where the text is not, in every letter, what encoded() writes of a value.
template <class T>
std::optional<T> decoded(const std::string& text) {
  Decoder d(text);
  T value;
  code(d, value);
  if (!d.sound() || encoded(value) != text) return std::nullopt;
  return value;
}

}  // namespace papilla
