// Files of heights, masks and pictures against the design, a row at a time.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "base/constants.h"
#include "fabricate/checks.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/layout.h"
#include "geometry/io/legend.h"

namespace papilla::fabricate {
namespace {

// How a format holds heights.
struct HeldAs {
  bool above_lowest = false;   // zero is the lowest plane
  bool binary = false;         // nothing but the lowest and the highest plane
  bool tiff = false;           // sides by tags, and what ImageJ takes of its description
  bool says_polarity = false;  // levels between black and white
  bool says_size = true;
  bool single = false;  // numbers of 32 bits
  int levels = 0;       // of grey between the lowest and the highest; 0: numbers
};
constexpr int kSixteenBits = 65535;

// Sums of a file and its design over all pixels, [m].
struct Compared {
  double n = 0, f = 0, d = 0, ff = 0, dd = 0, fd = 0;
  double f_low = kInfinity, f_high = -kInfinity, d_low = kInfinity, d_high = -kInfinity;
  double off = 0;                           // pixels beyond the rounding
  double most = 0, most_x = 0, most_y = 0;  // the largest of them and its place

  void add(double file, double design) {
    n += 1, f += file, d += design;
    ff += file * file, dd += design * design, fd += file * design;
    f_low = std::min(f_low, file), f_high = std::max(f_high, file);
    d_low = std::min(d_low, design), d_high = std::max(d_high, design);
  }
  double slope() const {
    const double var = dd - d * d / n;
    return var > 0 ? (fd - f * d / n) / var : 1;
  }
  double correlation() const {
    const double var = (ff - f * f / n) * (dd - d * d / n);
    return var > 0 ? (fd - f * d / n) / std::sqrt(var) : 1;
  }
};

class HeightsCheck {
 public:
  HeightsCheck(const ExportSource& source, HeldAs held, int repeat = 1)
      : s_(source),
        held_(held),
        repeat_(repeat),
        planes_(held.binary ? edge_planes(source.texture, source.heightmap)
                            : planes_of(source.heightmap)) {}

  Faults run(const std::string& path) {
    const auto rows = open_height_rows(path, repeat_ > 1);
    judge_header(rows->header());
    const Grid& grid = s_.heightmap.grid;
    if (rows->header().nx != repeat_ * grid.nx || rows->header().ny != repeat_ * grid.ny) {
      faults_.push_back(fmt::format("{} x {} pixels, the design's {} x {}", rows->header().nx,
                                    rows->header().ny, repeat_ * grid.nx, repeat_ * grid.ny));
      return faults_;
    }
    if (const std::string lost = lost_between_pixels(s_.texture, grid); !lost.empty())
      faults_.push_back("edges are lost between its pixels: " + lost);
    if (all_within(*rows)) return faults_;
    compare(*open_height_rows(path, repeat_ > 1));
    judge_heights();
    return faults_;
  }

 private:
  void judge_side(const char* what, const std::optional<double>& is, double design, double exact) {
    if (!is) {
      faults_.push_back(fmt::format("{} is not in the file", what));
    } else if (!(std::abs(*is / design - 1) <= exact)) {
      faults_.push_back(fmt::format("{} {}", what, differs(*is, design, 1e-6, "um")));
    }
  }
  void judge_header(const MapHeader& said) {
    const Grid& grid = s_.heightmap.grid;
    const auto known = [](double side) { return side > 0 ? std::optional(side) : std::nullopt; };
    if (held_.says_size) {
      judge_side("its width", known(said.lx), repeat_ * grid.lx, 1e-9);
      judge_side("its height", known(said.ly), repeat_ * grid.ly, 1e-9);
    }
    if (!held_.tiff) return;
    judge_side("its width by the TIFF tags", said.tag_x, grid.lx, 1e-6);
    judge_side("its height by the TIFF tags", said.tag_y, grid.ly, 1e-6);
    judge_polarity(said);
    judge_imagej(said);
    judge_photometric(said);
  }
  // Other programs invert or colour what is stated to be no grey from black at 0 to white.
  void judge_photometric(const MapHeader& said) {
    constexpr int kBlackIsZero = 1;
    if (said.photometric == kBlackIsZero) return;
    faults_.push_back(fmt::format(
        "its PhotometricInterpretation is {}, and 1 is due: grey, 0 is black",
        said.photometric ? std::to_string(*said.photometric) : std::string("not said")));
  }
  void judge_polarity(const MapHeader& said) {
    if (!held_.says_polarity) return;
    if (said.polarity != s_.options.polarity) {
      const bool high = s_.options.polarity == Polarity::WhiteHigh;
      faults_.push_back(fmt::format("its polarity is {}, the export's is white-{}",
                                    !said.polarity ? "not said"
                                    : high         ? "white-deep"
                                                   : "white-high",
                                    high ? "high" : "deep"));
    }
  }
  // The unit of the resolution tags, and the height of a level, c0 + c1 * level um: as the line of
  // our own reader has it, by which the heights are judged.
  void judge_imagej(const MapHeader& file) {
    const auto value = [&](const char* name) {
      const auto found = file.imagej.find(name);
      return found == file.imagej.end() ? std::string() : found->second;
    };
    const auto fault = [&](const char* name, const std::string& due) {
      const std::string is = value(name);
      faults_.push_back(fmt::format("its description says to ImageJ {}, and {}={} is due",
                                    is.empty() ? fmt::format("no {}", name) : name + ("=" + is),
                                    name, due));
    };
    const auto text = [&](const char* name, const char* due) {
      if (value(name) != due) fault(name, due);
    };
    text("unit", "cm");
    text("vunit", "um");
    if (!held_.says_polarity) return;
    text("cf", "0");  // a straight line
    const double black = 1e6 * file.black, white = 1e6 * file.white;
    const auto number = [&](const char* name, double due, double levels) {
      const std::string is = value(name);
      double read = 0;
      const auto [end, error] = std::from_chars(is.data(), is.data() + is.size(), read);
      const bool whole = error == std::errc{} && end == is.data() + is.size();
      // To the ninth digit of the file.
      const double most = 1e-8 * std::max(std::abs(black), std::abs(white));
      if (!whole || !(levels * std::abs(read - due) <= most))
        fault(name, fmt::format("{:.9g}", due));
    };
    number("c0", black, 1);
    number("c1", (white - black) / kSixteenBits, kSixteenBits);
  }
  double expected(double z) const {
    if (held_.binary) return z >= half_way() ? planes_.high : planes_.low;
    return held_.above_lowest ? z - planes_.low : z;
  }
  double span() const { return planes_.high - planes_.low; }
  double half_way() const { return 0.5 * (planes_.low + planes_.high); }
  // Of the last binary digit, of half a level, and of another processor's sines.
  double rounding() const {
    const double largest =
        held_.above_lowest ? span() : std::max(std::abs(planes_.low), std::abs(planes_.high));
    return (held_.single ? 1e-7 * largest : 0) +
           (held_.levels > 0 ? 0.505 * span() / held_.levels : 0) + 1e-9 * span() + 1e-16;
  }
  // Row r of the file is row iy of the map.
  int map_row(const MapHeader& said, int r) const {
    return (said.top_first ? said.ny - 1 - r : r) % s_.heightmap.grid.ny;
  }
  // Whether every height is right, at the speed of reading: most files are.
  bool all_within(HeightRows& rows) {
    const Grid& grid = s_.heightmap.grid;
    const MapHeader& said = rows.header();
    const double most = rounding();
    std::vector<double> row(static_cast<std::size_t>(said.nx)),
        wanted(static_cast<std::size_t>(grid.nx));
    for (int r = 0; r < said.ny; ++r) {
      rows.next(row.data());
      const int iy = map_row(said, r);
      for (int ix = 0; ix < grid.nx; ++ix)
        wanted[static_cast<std::size_t>(ix)] = expected(s_.heightmap(ix, iy));
      int off = 0;
      for (int tile = 0; tile < repeat_; ++tile) {
        const double* file = &row[static_cast<std::size_t>(tile) * wanted.size()];
        for (std::size_t ix = 0; ix < wanted.size(); ++ix)
          off |= !(std::abs(file[ix] - wanted[ix]) <= most);
      }
      if (off) return false;
      if (s_.progress && r % 1024 == 0) s_.progress(static_cast<double>(r) / said.ny);
    }
    return true;
  }
  void compare(HeightRows& rows) {
    const Grid& grid = s_.heightmap.grid;
    const MapHeader& said = rows.header();
    const double allowed = rounding();
    std::vector<double> row(static_cast<std::size_t>(said.nx));
    for (int r = 0; r < said.ny; ++r) {
      rows.next(row.data());
      const int iy = map_row(said, r);
      for (int ix = 0; ix < said.nx; ++ix) {
        const double file = row[static_cast<std::size_t>(ix)];
        const double z = s_.heightmap(ix % grid.nx, iy), design = expected(z);
        if (!std::isfinite(file)) {
          if (no_numbers_++ == 0) first_x_ = ix, first_y_ = r;
          continue;
        }
        c_.add(file, design);
        deep_ += file < middle(), design_deep_ += design < middle();
        const double miss = std::abs(file - design);
        if (miss <= allowed) continue;
        // On the threshold of a mask either side is right.
        if (held_.binary && std::abs(z - half_way()) <= 1e-9 * span()) continue;
        c_.off += 1;
        if (!(miss <= c_.most)) {
          c_.most = miss;
          c_.most_x = grid.dx() * (ix + 0.5);
          c_.most_y = grid.dy() * ((said.top_first ? said.ny - 1 - r : r) + 0.5);
        }
      }
    }
  }
  double middle() const { return held_.above_lowest ? 0.5 * span() : half_way(); }
  void judge_heights() {
    if (no_numbers_ > 0) {
      faults_.push_back(fmt::format(
          "{} of {} heights are no finite numbers, the first in column {} of row {} of the file",
          no_numbers_, static_cast<std::size_t>(c_.n) + no_numbers_, first_x_, first_y_));
    }
    if (c_.off == 0) return;
    const double depth = c_.f_high - c_.f_low, wanted = planes_.high - planes_.low;
    if (c_.correlation() < -0.5) {
      faults_.push_back("it is upside down: what is deep is high (its polarity)");
    } else if (!(std::abs(depth - wanted) <= 1e-6 * wanted)) {
      faults_.push_back("its depth " + differs(depth, wanted, 1e-9, "nm"));
    }
    // By the area below half the depth; where the depth is another, by the volume, which has none.
    const bool same_depth = std::abs(depth - wanted) <= 1e-6 * wanted;
    const auto volume = [&](double sum, double low, double high) {
      return (high * c_.n - sum) / (c_.n * (high - low));
    };
    const double share = same_depth ? deep_ / c_.n : volume(c_.f, c_.f_low, c_.f_high);
    const double design_share =
        same_depth ? design_deep_ / c_.n : volume(c_.d, c_.d_low, c_.d_high);
    const auto width = width_by_area(s_.texture, share),
               design_width = width_by_area(s_.texture, design_share);
    if (c_.correlation() > -0.5 && std::abs(share - design_share) > 1e-3 * design_share) {
      faults_.push_back(width ? fmt::format("its critical dimension (width of the {}) {}",
                                            array_of(facts(s_.texture))->drawn,
                                            differs(*width, *design_width, 1e-6, "um"))
                              : fmt::format("{:.4g} % of its area is below half the depth, of the "
                                            "design's {:.4g} %",
                                            100 * share, 100 * design_share));
    }
    faults_.push_back(fmt::format(
        "{:.0f} of {:.0f} heights are off by more than the rounding of the format, by {:.4g} nm at "
        "most, at ({:.4g}, {:.4g}) um",
        c_.off, c_.n, 1e9 * c_.most, 1e6 * c_.most_x, 1e6 * c_.most_y));
  }

  const ExportSource& s_;
  HeldAs held_;
  int repeat_;
  Planes planes_;
  Compared c_;
  double deep_ = 0, design_deep_ = 0;  // pixels below half the depth
  std::size_t no_numbers_ = 0;
  int first_x_ = 0, first_y_ = 0;  // of those
  Faults faults_;
};

// Bytes that may differ by `most` levels.
Faults check_picture(const std::string& path, int width, int height, int channels, int most,
                     const std::vector<std::uint8_t>& wanted) {
  const auto rows = open_picture_rows(path);
  if (rows->width != width || rows->height != height || rows->channels != channels) {
    return {fmt::format("{} x {} pixels in {} channels, the design's {} x {} in {}", rows->width,
                        rows->height, rows->channels, width, height, channels)};
  }
  std::vector<std::uint8_t> row(static_cast<std::size_t>(width) *
                                static_cast<std::size_t>(channels));
  std::size_t off = 0, at = 0;
  int largest = 0;
  for (int y = 0; y < height; ++y) {
    rows->next(row.data());
    for (const std::uint8_t value : row) {
      const int miss = std::abs(int{value} - int{wanted[at++]});
      largest = std::max(largest, miss);
      off += miss > most;
    }
  }
  if (off == 0) return {};
  return {fmt::format("{} of {} levels differ from the design's, by {} of 255 at most", off,
                      wanted.size(), largest)};
}

}  // namespace

std::string differs(double is, double design, double unit, const char* name) {
  if (!std::isfinite(is))
    return fmt::format("is no finite number, the design's {:.4g} {}", design / unit, name);
  if (design == 0) return fmt::format("is {:.4g} {}, the design's 0", is / unit, name);
  // As many digits as show the difference.
  const double share = std::abs(is / design - 1);
  const int digits = std::clamp(
      share > 0 && std::isfinite(share) ? 2 - static_cast<int>(std::floor(std::log10(share))) : 4,
      4, 12);
  return fmt::format("is {:.{}g} {}, the design's {:.{}g} {}: {:.3g} % {}", is / unit, digits, name,
                     design / unit, digits, name, 100 * share, is > design ? "more" : "less");
}

Faults check_exr(const ExportSource& s, const std::string& path) {
  return HeightsCheck(s, {.above_lowest = true, .single = true}, s.options.repeat).run(path);
}

Faults check_tiff32(const ExportSource& s, const std::string& path) {
  return HeightsCheck(s, {.above_lowest = true, .tiff = true, .single = true}).run(path);
}

Faults check_tiff(const ExportSource& s, const std::string& path) {
  return HeightsCheck(s, {.tiff = true, .says_polarity = true, .levels = kSixteenBits}).run(path);
}

Faults check_mask(const ExportSource& s, const std::string& path) {
  return HeightsCheck(s, {.binary = true, .tiff = true, .says_polarity = true}).run(path);
}

Faults check_gsf(const ExportSource& s, const std::string& path) {
  return HeightsCheck(s, {.single = true}).run(path);
}

Faults check_doubles(const ExportSource& s, const std::string& path) {
  return HeightsCheck(s, {.says_size = !path.ends_with(".npy")}).run(path);
}

Faults check_png16(const ExportSource& s, const std::string& path) {
  return HeightsCheck(s, {.levels = kSixteenBits}).run(path);
}

Faults check_preview(const ExportSource& s, const std::string& path) {
  const FieldPicture wanted = picture_of_heights(s.heightmap);
  return check_picture(path, wanted.width, wanted.height, 3, 1, wanted.rgb);
}

Faults check_dose(const ExportSource& s, const std::string& path) {
  const Grid& grid = s.heightmap.grid;
  DoseMap facts;
  const std::vector<std::uint8_t> wanted = dose_levels(s.heightmap, *s.options.dose_curve, facts);
  return check_picture(path, grid.nx, grid.ny, 1, 1, wanted);
}

}  // namespace papilla::fabricate
