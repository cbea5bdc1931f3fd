#include "search/codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

namespace papilla {

void Encoder::word(const std::string& text) {
  if (!out_.empty()) out_ += ' ';
  out_ += text;
}

void Encoder::number(double& value) { word(fmt::format("{:a}", value)); }
void Encoder::whole(std::int64_t& value) { word(std::to_string(value)); }
void Encoder::bytes(std::string& value) { word(std::to_string(value.size()) + ":" + value); }

std::string Decoder::word() {
  const std::size_t end = std::min(text_.find(' ', at_), text_.size());
  std::string out = text_.substr(at_, end - at_);
  at_ = std::min(end + 1, text_.size());
  sound_ = sound_ && !out.empty();
  return out;
}

void Decoder::number(double& value) {
  const std::string text = word();
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size()) refuse();
}

void Decoder::whole(std::int64_t& value) {
  const std::string text = word();
  value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) refuse();
}

void Decoder::bytes(std::string& value) {
  std::uint64_t size = 0;
  const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), size);
  const auto begin = static_cast<std::size_t>(end - text_.data()) + 1;  // behind the colon
  if (error != std::errc{} || begin > text_.size() || text_[begin - 1] != ':' ||
      size > text_.size() - begin)
    return refuse();
  value = text_.substr(begin, size);
  at_ = std::min(begin + size + 1, text_.size());
}

}  // namespace papilla
