#include "geometry/io/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/io/files.h"
#include "geometry/io/glyphs.h"

namespace papilla::geometry {
namespace {

class Sheet {
 public:
  Sheet(int width, int height)
      : width_(width),
        rgb_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3, 255) {}

  void put(int x, int y, const std::array<std::uint8_t, 3>& c) {
    if (x >= 0 && x < width_)
      std::copy(c.begin(), c.end(),
                rgb_.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * width_ + x));
  }
  // `dots`: pixels of a dot.
  void write(int left, int top, int dots, const std::string& text) {
    for (char c : text) {
      if (const GlyphRows* rows = glyph_rows(c)) {
        for (int y = 0; y < kGlyphRows * dots; ++y) {
          for (int x = 0; x < kGlyphColumns * dots; ++x) {
            if ((*rows)[static_cast<std::size_t>(y / dots)] >> (kGlyphColumns - 1 - x / dots) & 1)
              put(left + x, top + y, {0, 0, 0});
          }
        }
      }
      left += kGlyphAdvance * dots;
    }
  }
  static int text_width(const std::string& text, int dots) {
    return static_cast<int>(text.size()) * kGlyphAdvance * dots;
  }
  std::vector<std::uint8_t> take() { return std::move(rgb_); }

 private:
  int width_;
  std::vector<std::uint8_t> rgb_;
};

std::string in_legend(double value) { return fmt::format("{:.3g}", value + 0.0); }

std::string length_text(double metres) {
  return metres >= 1e-6 ? fmt::format("{:.3g} um", 1e6 * metres)
                        : fmt::format("{:.3g} nm", 1e9 * metres);
}

}  // namespace

FieldPicture picture_with_legend(const Grid& grid, const std::vector<double>& values,
                                 const FieldScale& shown) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const auto share = [&](double v) { return shown.root ? std::sqrt(v) : v; };
  std::vector<double> coloured = values;
  for (double& v : coloured) v = *high > *low ? share((v - *low) / (*high - *low)) : 1;
  FieldPicture out;
  const std::vector<std::uint8_t> field = render_field(grid, coloured, out.width, out.height);
  const int dots = std::max(1, out.width / 256), line = (kGlyphRows + 3) * dots;
  const int top = out.height;
  out.height += 3 * line;
  Sheet sheet(out.width, out.height);
  for (int y = 0; y < top; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const std::size_t at =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
               static_cast<std::size_t>(x));
      sheet.put(x, y, {field[at], field[at + 1], field[at + 2]});
    }
  }
  for (int x = 0; x < out.width; ++x) {
    const auto c = field_colour(share(static_cast<double>(x) / std::max(1, out.width - 1)));
    for (int y = top + dots; y < top + line; ++y) sheet.put(x, y, c);
  }
  const std::string most = fmt::format("{} {}", in_legend(*high * shown.scale), shown.unit);
  sheet.write(dots, top + line + 2 * dots, dots, in_legend(*low * shown.scale));
  sheet.write(out.width - Sheet::text_width(most, dots), top + line + 2 * dots, dots, most);
  sheet.write(dots, top + 2 * line + dots, dots, length_text(scale_bar_length(grid)));
  out.rgb = sheet.take();
  return out;
}

FieldPicture picture_of_heights(const Heightmap& h) {
  return picture_with_legend(h.grid, h.z, {1e9, "nm"});
}

void write_png(const std::string& path, const Heightmap& h) {
  const FieldPicture picture = picture_of_heights(h);
  write_png_rgb(path, picture.width, picture.height, picture.rgb);
}

}  // namespace papilla::geometry
