// SDF (ISO 25178-71): a header and numbers, as text ("aISO-1.0", "aBCR-1.0") or binary ("bISO-1.0",
// "bBCR-1.0"). Lengths in metres.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/bytes.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/raw.h"

namespace papilla::geometry {
namespace {

std::string_view trimmed_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

class SdfRows : public HeightRows {
 public:
  explicit SdfRows(const std::string& path) : bytes_(read_bytes(path)), in_(bytes_, path) {
    const std::string magic(in_.take(8));
    if (magic == "aISO-1.0" || magic == "aBCR-1.0") {
      text_ = true;
      read_text_header();
    } else if (magic == "bISO-1.0" || magic == "bBCR-1.0") {
      read_binary_header();
    } else {
      in_.fail("no SDF file of ISO 25178-71");
    }
    check_size(path, nx_, ny_);
    header_.nx = static_cast<int>(nx_);
    header_.ny = static_cast<int>(ny_);
    header_.lx = nx_ * step_x_;
    header_.ly = ny_ * step_y_;
    if (!(step_x_ > 0 && step_y_ > 0 && std::isfinite(step_x_) && std::isfinite(step_y_)))
      in_.fail("its steps are not above 0");
    if (!std::isfinite(scale_) || scale_ == 0) in_.fail("its scale of heights is no number");
    if (!text_ && in_.left() < static_cast<std::size_t>(nx_ * ny_) * item_size())
      in_.fail("the data are cut off");
  }

  void next(double* heights) override {
    for (int ix = 0; ix < header_.nx; ++ix) heights[ix] = text_ ? text_value() : binary_value();
  }

 private:
  void read_text_header() {
    std::map<std::string, std::string, std::less<>> keys;
    in_.until('\n');
    for (std::string_view line = in_.until('\n'); trimmed_blanks(line) != "*";
         line = in_.until('\n')) {
      const std::size_t equals = line.find('=');
      if (equals == std::string_view::npos) {
        if (trimmed_blanks(line).empty()) continue;
        in_.fail("a line of its header says nothing");
      }
      keys[std::string(trimmed_blanks(line.substr(0, equals)))] =
          std::string(trimmed_blanks(line.substr(equals + 1)));
    }
    const auto number = [&](const char* key) {
      const auto found = keys.find(key);
      if (found == keys.end()) in_.fail(fmt::format("no {} in its header", key));
      double out = 0;
      const std::string& text = found->second;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
      if (error != std::errc{} || end != text.data() + text.size())
        in_.fail(fmt::format("{} of its header is no number", key));
      return out;
    };
    nx_ = number("NumPoints");
    ny_ = number("NumProfiles");
    step_x_ = number("Xscale");
    step_y_ = number("Yscale");
    scale_ = number("Zscale");
    refuse_packed(number("Compression"));
  }
  void read_binary_header() {
    in_.take(10 + 12 + 12);  // who and when
    nx_ = in_.number<std::uint16_t>();
    ny_ = in_.number<std::uint16_t>();
    step_x_ = in_.number<double>();
    step_y_ = in_.number<double>();
    scale_ = in_.number<double>();
    in_.number<double>();  // resolution
    refuse_packed(in_.number<std::uint8_t>());
    type_ = in_.number<std::uint8_t>();
    in_.number<std::uint8_t>();  // kind of sum
    item_size();
  }
  void refuse_packed(double kind) const {
    if (kind != 0) in_.fail("its heights are packed, in a way that ISO 25178-71 does not state");
  }
  std::size_t item_size() const {
    switch (type_) {
      case 0:
      case 4:
        return 1;
      case 1:
      case 5:
        return 2;
      case 2:
      case 3:
      case 6:
        return 4;
      case 7:
        return 8;
      default:
        in_.fail(
            fmt::format("its heights are of type {}, which ISO 25178-71 does not state", type_));
    }
  }
  template <class T>
  double value() {
    return scale_ * static_cast<double>(in_.number<T>());
  }
  // Whole numbers have their lowest or highest for what was not measured.
  template <class T>
  double whole(T missing) {
    const T raw = in_.number<T>();
    return raw == missing ? std::nan("") : scale_ * static_cast<double>(raw);
  }
  double binary_value() {
    switch (type_) {
      case 0:
        return whole<std::uint8_t>(UINT8_MAX);
      case 1:
        return whole<std::uint16_t>(UINT16_MAX);
      case 2:
        return whole<std::uint32_t>(UINT32_MAX);
      case 3:
        return value<float>();
      case 4:
        return whole<std::int8_t>(INT8_MIN);
      case 5:
        return whole<std::int16_t>(INT16_MIN);
      case 6:
        return whole<std::int32_t>(INT32_MIN);
      default:
        return value<double>();
    }
  }
  double text_value() {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    std::size_t at = in_.at();
    while (at < bytes_.size() && blank(bytes_[at])) ++at;
    std::size_t end = at;
    while (end < bytes_.size() && !blank(bytes_[end])) ++end;
    in_.go(end);
    const std::string_view word = std::string_view(bytes_).substr(at, end - at);
    if (word == "BAD" || word == "NaN") return std::nan("");
    double out = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), out);
    if (word.empty() || error != std::errc{} || stop != word.data() + word.size())
      in_.fail(word.empty() || word == "*" ? "the data are cut off"
                                           : "a height of it is no number");
    return scale_ * out;
  }

  std::string bytes_;
  ByteReader in_;
  bool text_ = false;
  int type_ = 7;
  double nx_ = 0, ny_ = 0, step_x_ = 0, step_y_ = 0, scale_ = 1;
};

}  // namespace

std::unique_ptr<HeightRows> open_sdf_rows(const std::string& path) {
  return std::make_unique<SdfRows>(path);
}

}  // namespace papilla::geometry
