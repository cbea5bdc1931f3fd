#include "fabricate/wafer_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "base/text.h"
#include "fabricate/export.h"
#include "fabricate/wafer_marks.h"
#include "geometry/io/glyphs.h"

namespace papilla::fabricate {
namespace {

std::int32_t on_nanometres(double metres) {
  return static_cast<std::int32_t>(std::lround(1e9 * metres));
}

// --- what of a design is etched how deep ---

// An etch of a design: an array of features, or contour lines of one cell.
struct Etch {
  double depth = 0;  // [m]
  std::optional<MaskedArray> array;
  std::vector<Polygon> contours;  // of one cell
  // What repeats of all etches of the design together, as drawn [m]; y is 0 where all of it is
  // alike along y.
  double cell_x = 0, cell_y = 0;
};

std::string gradual_refusal(const Texture& texture) {
  const TextureFacts known = facts(texture);
  if (const auto* none = std::get_if<NoOutline>(&known.outline)) return none->reason;
  if (!known.cell) return "it does not repeat, no cell of it can be drawn once";
  return "its relief is gradual, one mask does not make it; wafer.levels = 3 draws its contour "
         "lines, `papilla export` its heights for grey-scale writing";
}

// A texture of one cell of a lattice, sampled for its contour lines.
Heightmap one_cell(const Texture& texture) {
  constexpr int kPixels = 256;
  const UnitCell cell = *facts(texture).cell;
  return generate(
      texture,
      {kPixels, 2 * static_cast<int>(std::ceil(0.5 * kPixels * cell.y / cell.x)), cell.x, cell.y});
}

std::vector<Etch> contour_etches(const Texture& texture, int levels, const Process& process) {
  const TextureFacts known = facts(texture);
  if (levels < 1 || !known.cell || std::holds_alternative<NoOutline>(known.outline))
    throw InputError(gradual_refusal(texture));
  if (!process.none())
    throw InputError(
        "the process is undone for holes, pillars and grooves alone; its relief is "
        "gradual");
  const Heightmap h = one_cell(texture);
  const Planes planes = edge_planes(texture, h);
  std::vector<Etch> out(static_cast<std::size_t>(levels));
  Layout lines = draw_contours(h, levels, planes);
  for (LayoutPolygon& p : lines.cells.back().polygons)
    out[static_cast<std::size_t>(p.layer - 1)].contours.push_back(std::move(p.outline));
  for (Etch& etch : out) {
    etch.depth = (planes.high - planes.low) / levels;
    etch.cell_x = h.grid.lx;
    etch.cell_y = h.grid.ly;
  }
  return out;
}

std::vector<Etch> etches_of(const Texture& texture, const WaferList& list) {
  if (!facts(texture).relief.present) return {};
  const std::vector<Texture> arrays = arrays_of(texture);
  if (arrays.empty()) return contour_etches(texture, list.wafer.levels, list.process);
  const std::vector<MaskedArray> masks = masked(arrays, list.process);
  const UnitCell cell = *facts(texture).cell;
  double longest = 0;
  bool lines = true;
  for (const MaskedArray& array : masks) {
    longest = std::max(longest, array.mask.period);
    lines = lines && array.mask.shape == FeatureArray::Shape::Line;
  }
  std::vector<Etch> out;
  for (const MaskedArray& array : masks)
    out.push_back({array.etch, array, {}, longest, lines ? 0 : longest * cell.y / cell.x});
  return out;
}

// --- cells of a design ---

// The rest of its cell around a disc, in two halves that meet above and below it: polygons without
// holes in them. left: the border of the cell from above the middle of the disc to below it.
std::vector<LayoutPolygon> around_disc(const LayoutPolygon& disc, const Polygon& left_border) {
  const Polygon& p = disc.outline;
  const std::size_t n = p.x.size(), corners = left_border.x.size();
  const std::int32_t middle = left_border.x.front();
  const std::int32_t top = *std::max_element(p.y.begin(), p.y.end()),
                     bottom = *std::min_element(p.y.begin(), p.y.end());
  LayoutPolygon left{disc.layer, {{middle}, {top}}}, right{disc.layer, {{middle}, {bottom}}};
  const auto put = [](LayoutPolygon& to, std::int32_t x, std::int32_t y) {
    to.outline.x.push_back(x);
    to.outline.y.push_back(y);
  };
  for (std::size_t k = 0; k < corners; ++k) {
    put(left, left_border.x[k], left_border.y[k]);
    const std::size_t mirrored = corners - 1 - k;
    put(right, 2 * middle - left_border.x[mirrored], left_border.y[mirrored]);
  }
  put(left, middle, bottom);
  put(right, middle, top);
  // Both go on along the disc clockwise, against its own sense, from its left corner above.
  std::size_t first = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (p.y[i] == top && (p.y[first] != top || p.x[i] < p.x[first])) first = i;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = (first + n - k) % n, j = (first + 2 * n - 1 - k) % n;
    if (p.x[i] > middle) put(right, p.x[i], p.y[i]);
    if (p.x[j] < middle) put(left, p.x[j], p.y[j]);
  }
  return {std::move(left), std::move(right)};
}

// Pillars as what is etched around them: in the square or the hexagon of their lattice. Hexagons
// reach whole nanometres beyond their border: neighbours overlap by 3 nm at most.
void invert_pillars(LayoutCell& cell, const FeatureArray& mask) {
  const LayoutPolygon disc = cell.polygons.at(0);
  const double pitch = 1e9 * mask.period;
  const auto up = [](double nanometres) {
    return static_cast<std::int32_t>(std::ceil(nanometres));
  };
  if (mask.lattice == Lattice::Hexagonal) {
    const std::int32_t x = up(0.5 * pitch), tip = up(pitch / std::sqrt(3.0)) + 1,
                       side = up(0.5 * pitch / std::sqrt(3.0)) + 1;
    cell.polygons = around_disc(disc, {{0, -x, -x, 0}, {tip, side, -side, -tip}});
    return;
  }
  const auto whole = static_cast<std::int32_t>(std::lround(pitch)),
             middle = static_cast<std::int32_t>(std::lround(0.5 * pitch));
  // A pitch of an odd number of nanometres has its middle half a nanometre aside: the right half is
  // as wide as it takes to reach the next cell.
  cell.polygons = around_disc(disc, {{middle, 0, 0, middle}, {whole, whole, 0, 0}});
}

// Whole cells along a side of the pad, the number nearest to it, around its middle: the same for
// all masks of a design, which are in register by it. A cell of 0: all of the side.
struct Side {
  Side(double pad, double cell)
      : cells(cell > 0 ? std::max(1L, std::lround(pad / cell)) : 1),
        length(cell > 0 ? static_cast<double>(cells) * cell : pad),
        begin(-on_nanometres(0.5 * length)) {}

  long cells;
  double length;       // [m]
  std::int32_t begin;  // [nm]
};

void move_by(LayoutCell& cell, std::int32_t x, std::int32_t y) {
  for (LayoutReference& r : cell.references) r.x += x, r.y += y;
}

// Cells of an array over the pad, the last of them the pad around the origin.
std::vector<LayoutCell> array_cells(const std::string& name, const Etch& etch, int layer,
                                    const WaferShape& shape) {
  const MaskedArray& array = *etch.array;
  const Side along_x(shape.pad_width, etch.cell_x), along_y(shape.pad_height, etch.cell_y);
  ArrayDrawing drawing = draw_array(array.mask, along_x.length, along_y.length, shape.facet_error);
  std::vector<LayoutCell>& cells = drawing.layout.cells;
  const bool line = array.mask.shape == FeatureArray::Shape::Line;
  if (!array.mask.deep && line) throw InputError("ridges have no mask of their own; take grooves");
  if (!array.mask.deep) invert_pillars(cells.front(), array.mask);
  for (LayoutCell& cell : cells) {
    const bool top = &cell == &cells.back();
    cell.name = top ? name : name + "_" + cell.name;
    for (LayoutPolygon& p : cell.polygons) p.layer = layer;
    for (LayoutReference& r : cell.references) r.cell = name + "_" + r.cell;
  }
  move_by(cells.back(), along_x.begin, along_y.begin);
  return std::move(cells);
}

std::vector<LayoutCell> contour_cells(const std::string& name, const Etch& etch, int layer,
                                      const WaferShape& shape) {
  LayoutCell cell{name + "_CELL", {}, {}};
  for (const Polygon& p : etch.contours) cell.polygons.push_back({layer, p});
  const std::int32_t step_x = on_nanometres(etch.cell_x), step_y = on_nanometres(etch.cell_y);
  const Side along_x(shape.pad_width, 1e-9 * step_x), along_y(shape.pad_height, 1e-9 * step_y);
  LayoutCell pad{name, {}, {}};
  pad.references.push_back({.cell = cell.name,
                            .x = along_x.begin,
                            .y = along_y.begin,
                            .columns = along_x.cells,
                            .rows = along_y.cells,
                            .step_x = step_x,
                            .step_y = step_y,
                            .array = true});
  return {std::move(cell), std::move(pad)};
}

// --- the wafer ---

class Drawing {
 public:
  explicit Drawing(const WaferPlan& plan) : plan_(plan), shape_(plan.list.wafer) {}

  WaferDrawing draw() {
    gather_etches();
    number_levels();
    draw_designs();
    draw_fields();
    name_layers();
    return std::move(out_);
  }

 private:
  // An etch and where it came from: the how many-th of its depth in its design.
  struct Ordered {
    std::size_t treatment;
    Etch etch;
    int ordinal;
    std::string cell;
  };
  static bool alike(double a, double b) { return std::abs(a - b) <= 1e-10; }  // 0.1 nm

  void gather_etches() {
    Mistakes mistakes;
    for (std::size_t t = 0; t < plan_.treatments.size(); ++t) {
      const Treatment& treatment = plan_.treatments[t];
      try {
        const std::vector<Etch> etches = etches_of(treatment.design.texture, plan_.list);
        for (std::size_t k = 0; k < etches.size(); ++k) {
          int ordinal = 0;
          for (std::size_t j = 0; j < k; ++j) ordinal += alike(etches[j].depth, etches[k].depth);
          const std::string cell =
              etches.size() == 1 ? treatment.name : fmt::format("{}_{}", treatment.name, k + 1);
          etches_.push_back({t, etches[k], ordinal, new_cell_name(cell)});
          note_period(treatment, etches[k]);
        }
      } catch (const InputError& error) {
        mistakes.add(InputError(treatment.name + ": " + error.what()));
      }
    }
    mistakes.tell();
  }
  // Mask programs take letters, digits and _ alone, and merge cells of one name: "H3.5" and "H3-5"
  // are numbered. An array has a second cell, NAME_CELL.
  std::string new_cell_name(std::string name) {
    for (char& c : name) {
      if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    }
    const std::string plain = "DESIGN_" + name;
    std::string out = plain;
    for (int k = 2; cell_names_.count(out) + cell_names_.count(out + "_CELL") > 0; ++k)
      out = fmt::format("{}_{}", plain, k);
    cell_names_.insert(out);
    cell_names_.insert(out + "_CELL");
    return out;
  }
  void note_period(const Treatment& treatment, const Etch& etch) {
    const double wanted = etch.array ? etch.array->wanted.period : etch.cell_x;
    const double made =
        etch.array ? etch.array->mask.period *
                         (plan_.list.process.compensate ? 1 - plan_.list.process.shrinkage : 1)
                   : 1e-9 * std::round(1e9 * etch.cell_x);
    if (std::abs(made - wanted) < 1e-13) return;
    out_.notes.push_back(fmt::format(
        "{}: the period of {:.8g} nm comes out as {:.8g} nm: layouts have a grid of 1 nm",
        treatment.name, 1e9 * wanted, 1e9 * made));
  }
  void number_levels() {
    struct Key {
      double depth;
      int ordinal;
    };
    std::vector<Key> keys;
    for (const Ordered& e : etches_) {
      const auto same = [&](const Key& k) {
        return k.ordinal == e.ordinal && alike(k.depth, e.etch.depth);
      };
      if (std::none_of(keys.begin(), keys.end(), same)) keys.push_back({e.etch.depth, e.ordinal});
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
      return alike(a.depth, b.depth) ? a.ordinal < b.ordinal : a.depth > b.depth;
    });
    constexpr std::size_t kMostLevels = 8;
    if (keys.size() > kMostLevels) {
      std::string depths;
      for (const Key& k : keys)
        depths += (depths.empty() ? "" : ", ") + significant(1e9 * k.depth, 6);
      throw InputError(fmt::format(
          "{} masks, one for each depth ({} nm): at most {}; give designs fewer different depths "
          "(`--set` of a list takes none of them away: leave designs out, or round their depths)",
          keys.size(), depths, kMostLevels));
    }
    if (keys.empty()) keys.push_back({0, 0});  // flat fields alone: a mask of labels
    for (std::size_t k = 0; k < keys.size(); ++k) {
      WaferLevel level{static_cast<int>(k) + 1, keys[k].depth, {}};
      for (const Ordered& e : etches_) {
        if (e.ordinal == keys[k].ordinal && alike(e.etch.depth, keys[k].depth))
          level.designs.push_back(plan_.treatments[e.treatment].name);
      }
      out_.levels.push_back(std::move(level));
    }
  }
  int level_of(const Ordered& e) const {
    for (const WaferLevel& level : out_.levels) {
      // Depths are in falling order, ordinals of one depth in rising order.
      if (!alike(level.etch, e.etch.depth)) continue;
      return level.number + e.ordinal;
    }
    return 1;
  }
  void add(LayoutCell cell) { out_.layout.cells.push_back(std::move(cell)); }

  void draw_designs() {
    Mistakes mistakes;
    for (const Ordered& e : etches_) {
      mistakes.of([&] {
        std::vector<LayoutCell> cells = e.etch.array
                                            ? array_cells(e.cell, e.etch, level_of(e), shape_)
                                            : contour_cells(e.cell, e.etch, level_of(e), shape_);
        check_reach(plan_.treatments[e.treatment].name, cells.back());
        if (e.etch.array) {
          out_.arrays.push_back(
              {plan_.treatments[e.treatment].name, cells.front().name, *e.etch.array});
        }
        for (LayoutCell& cell : cells) add(std::move(cell));
      });
    }
    mistakes.tell();
  }
  // Whole periods that are nearly as wide as the pad, around its middle: long ones reach beyond it.
  void check_reach(const std::string& design, const LayoutCell& pad) const {
    const LayoutReference& corner = pad.references.front();
    const double over = std::max(-1e-9 * corner.x - 0.5 * shape_.pad_width,
                                 -1e-9 * corner.y - 0.5 * shape_.pad_height);
    if (over <= 1e-9 * kCornersBegin) return;
    throw InputError(fmt::format(
        "{}: its whole periods reach {:.4g} um beyond the pad, onto the corners that begin {:.4g} "
        "um beside it; make wafer.pad_width and wafer.pad_height whole numbers of periods",
        design, 1e6 * over, 1e-3 * kCornersBegin));
  }
  std::string label_of(const WaferField& field) const {
    return field.id + " " + plan_.treatments[field.treatment].name;
  }
  void draw_fields() {
    square_ = std::max(1, on_nanometres(shape_.label / kGlyphRows));
    std::set<char> letters;
    for (const WaferField& field : plan_.fields) {
      for (const char c : label_of(field)) letters.insert(c);
    }
    letters.erase(' ');
    for (const char c : letters) add(glyph_cell(c, square_));
    add(pad_corners(on_nanometres(shape_.pad_width), on_nanometres(shape_.pad_height)));
    LayoutCell top{"WAFER", {}, {}};
    for (const WaferField& field : plan_.fields) {
      add(field_cell(field));
      top.references.push_back({.cell = out_.layout.cells.back().name,
                                .x = on_nanometres(field.x),
                                .y = on_nanometres(field.y)});
    }
    place_marks(top);
    add(std::move(top));
  }
  LayoutCell field_cell(const WaferField& field) const {
    LayoutCell out{"FIELD_" + field.id, {}, {}};
    for (const Ordered& e : etches_) {
      if (e.treatment == field.treatment) out.references.push_back({.cell = e.cell});
    }
    out.references.push_back({.cell = "PAD_CORNERS"});
    // Below the pad and its corners, from its left border on.
    const std::int32_t x = -on_nanometres(0.5 * shape_.pad_width);
    const std::int32_t y = -on_nanometres(0.5 * shape_.pad_height + 0.5 * shape_.gap) +
                           on_nanometres(shape_.label / kGlyphRows);
    for (LayoutReference& r : written(label_of(field), x, y, square_))
      out.references.push_back(std::move(r));
    return out;
  }
  // The crossings of the streets between fields that lie on the wafer; of a die all of them.
  std::vector<std::pair<double, double>> crossings() const {
    std::vector<std::pair<double, double>> out;
    for (int j = 0; j <= plan_.rows; ++j) {
      for (int i = 0; i <= plan_.columns; ++i) {
        const double x = (i - 0.5 * plan_.columns) * plan_.pitch_x,
                     y = (j - 0.5 * plan_.rows) * plan_.pitch_y;
        if (shape_.diameter == 0 || std::hypot(x, y) <= 0.5 * shape_.diameter - shape_.edge)
          out.emplace_back(x, y);
      }
    }
    return out;
  }
  void place_marks(LayoutCell& top) {
    for (const WaferLevel& level : out_.levels) add(alignment_mark(level.number));
    for (const char c : {'0', '1', '2', '3', '5'}) {
      LayoutCell digit = glyph_cell(c, kSizeSquare);
      digit.name = "SIZE_" + digit.name;
      add(std::move(digit));
    }
    LayoutCell sizes = size_marks();
    for (LayoutReference& r : sizes.references) r.cell = "SIZE_" + r.cell;
    add(std::move(sizes));
    const auto all = crossings();
    std::pair<double, double> nearest = all.front();
    for (const auto& c : all) {
      if (std::hypot(c.first, c.second) < std::hypot(nearest.first, nearest.second)) nearest = c;
    }
    // The one field of a die has a cross at each of its crossings.
    constexpr std::int32_t kBelow = 400000;
    const bool alone = plan_.rows == 1 && plan_.columns == 1;
    top.references.push_back({.cell = "SIZES",
                              .x = alone ? 0 : on_nanometres(nearest.first),
                              .y = on_nanometres(nearest.second) - (alone ? kBelow : 0)});
    for (const double sx : {-1.0, 1.0}) {
      for (const double sy : {-1.0, 1.0}) place_corner(top, all, sx, sy);
    }
    check_marks(top);
  }
  // Marks that stand on each other align and measure nothing.
  void check_marks(const LayoutCell& top) const {
    struct Mark {
      std::int32_t x, y, reach_x, reach_y;
    };
    std::vector<Mark> marks;
    for (const LayoutReference& r : top.references) {
      if (r.cell == "SIZES") marks.push_back({r.x, r.y, kSizesReach, kSizesHigh});
      if (r.cell.starts_with("ALIGN_")) marks.push_back({r.x, r.y, kMarkReach, kMarkReach});
    }
    for (std::size_t i = 0; i < marks.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Mark &a = marks[i], &b = marks[j];
        if (std::abs(a.x - b.x) >= a.reach_x + b.reach_x ||
            std::abs(a.y - b.y) >= a.reach_y + b.reach_y)
          continue;
        const auto between = static_cast<std::int32_t>(out_.levels.size() - 1) * kMarkPitch;
        throw InputError(fmt::format(
            "{} masks, whose alignment crosses reach {:.4g} mm inwards from each corner: on {} x "
            "{} fields, {:.4g} mm from one to the next, they stand on each other or on the bars of "
            "known width; larger pads or gaps, more rows, or fewer depths",
            out_.levels.size(), 1e-6 * (between + kMarkReach), plan_.columns, plan_.rows,
            1e3 * plan_.pitch_y));
      }
    }
  }
  // Crosses at the outermost crossing of a quarter, one above the other from it inwards.
  void place_corner(LayoutCell& top, const std::vector<std::pair<double, double>>& all, double sx,
                    double sy) const {
    const auto far = [&](const std::pair<double, double>& c) {
      return sx * c.first + sy * c.second;
    };
    const auto& at = *std::max_element(
        all.begin(), all.end(), [&](const auto& a, const auto& b) { return far(a) < far(b); });
    for (const WaferLevel& level : out_.levels) {
      const std::int32_t beside = (level.number - 1) * kMarkPitch;
      top.references.push_back(
          {.cell = fmt::format("ALIGN_{}", level.number),
           .x = on_nanometres(at.first),
           .y = on_nanometres(at.second) - static_cast<std::int32_t>(sy) * beside});
    }
  }
  void name_layers() {
    for (const WaferLevel& level : out_.levels) {
      std::string label = "tone: polygons are deep, what is around them is high";
      if (!level.designs.empty())
        label += fmt::format("; etch {:.6g} nm; designs {}", 1e9 * level.etch,
                             join_names(level.designs, " "));
      if (level.number == 1) label += "; labels and marks";
      constexpr std::size_t kMostLetters = 500;  // of a GDSII text
      if (label.size() > kMostLetters) label = label.substr(0, kMostLetters - 3) + "...";
      out_.layout.layers.push_back(
          {level.number, fmt::format("LEVEL_{}_DEEP", level.number), label});
    }
  }

  static constexpr std::int32_t kSizeSquare = 4000;  // [nm]
  const WaferPlan& plan_;
  const WaferShape& shape_;
  std::vector<Ordered> etches_;
  std::set<std::string> cell_names_;
  std::int32_t square_ = 1;
  WaferDrawing out_;
};

}  // namespace

WaferDrawing draw_wafer(const WaferPlan& plan) { return Drawing(plan).draw(); }

std::vector<Polygon> around_centre(const DrawnArray& array, const LayoutCell& cell) {
  const FeatureArray& mask = array.masked.mask;
  const auto period = static_cast<std::int32_t>(std::lround(1e9 * mask.period));
  const bool line = mask.shape == FeatureArray::Shape::Line;
  const bool centred = !line && mask.lattice == Lattice::Hexagonal;
  std::vector<Polygon> out;
  for (const LayoutPolygon& p : cell.polygons) {
    Polygon one = p.outline;
    if (line) {
      const std::int32_t top = *std::max_element(one.y.begin(), one.y.end());
      for (std::int32_t& y : one.y) y = y == top ? period : 0;
    }
    // Square cells begin at their corner, those of hexagons are around the origin.
    const std::int32_t half = centred ? 0 : static_cast<std::int32_t>(std::lround(0.5 * period));
    for (std::int32_t& x : one.x) x -= half;
    for (std::int32_t& y : one.y) y -= half;
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace papilla::fabricate
