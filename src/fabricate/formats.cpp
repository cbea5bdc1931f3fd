#include "fabricate/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "fabricate/checks.h"
#include "fabricate/layers.h"

namespace papilla::fabricate {
namespace {

// An array as cell and array reference, anything else as contours of its heights.
Layout draw(const ExportSource& s, Export& out) {
  const Grid& grid = s.heightmap.grid;
  const TextureFacts known = facts(s.texture);
  if (const FeatureArray* array = array_of(known)) {
    ArrayDrawing drawing = draw_array(*array, grid.lx, grid.ly, s.options.facet_error);
    out.array = drawing.array;
    drawing.layout.layers = layers_of(s);
    return std::move(drawing.layout);
  }
  Layout layout = draw_contours(s.heightmap, s.options.levels, edge_planes(s.texture, s.heightmap));
  layout.layers = layers_of(s);
  out.contours = {layout.cells.back().polygons.size(), s.options.levels};
  return layout;
}

void exr(const ExportSource& s, const std::string& path, Export&) {
  if (s.options.repeat > 1) {
    write_exr_repeated(path, s.heightmap, s.options.repeat, s.info, s.progress);
  } else {
    write_exr(path, s.heightmap, s.info);
  }
}

void tiff(const ExportSource& s, const std::string& path, Export&) {
  write_tiff16(path, s.heightmap, *s.options.polarity, s.info);
}

void tiff32(const ExportSource& s, const std::string& path, Export&) {
  write_tiff_float(path, s.heightmap, s.info);
}

void mask(const ExportSource& s, const std::string& path, Export&) {
  write_mask_tiff(path, s.heightmap, *s.options.polarity, s.info,
                  edge_planes(s.texture, s.heightmap));
}

void gsf(const ExportSource& s, const std::string& path, Export&) {
  write_gsf(path, s.heightmap, s.info);
}

void npy(const ExportSource& s, const std::string& path, Export&) { write_npy(path, s.heightmap); }

void png(const ExportSource& s, const std::string& path, Export&) { write_png(path, s.heightmap); }

void png16(const ExportSource& s, const std::string& path, Export&) {
  write_png16(path, s.heightmap);
}

void x3p(const ExportSource& s, const std::string& path, Export&) { write_x3p(path, s.heightmap); }

void gds(const ExportSource& s, const std::string& path, Export& out) {
  write_gds(path, draw(s, out));
}

void oasis(const ExportSource& s, const std::string& path, Export& out) {
  write_oasis(path, draw(s, out));
}

void stl(const ExportSource& s, const std::string& path, Export&) { write_stl(path, s.heightmap); }

void dose(const ExportSource& s, const std::string& path, Export& out) {
  const DoseMap map = write_dose(path, s.heightmap, *s.options.dose_curve);
  out.dose = map;
  if (map.deep == 0 && map.shallow == 0) return;
  const auto share = [&](std::size_t pixels) {
    return 100 * static_cast<double>(pixels) / static_cast<double>(s.heightmap.grid.size());
  };
  out.warnings.push_back(fmt::format(
      "the dose curve does not reach all depths: {:.3g} % of the pixels are deeper than its end, "
      "{:.3g} % shallower than its start; they get the dose of that end",
      share(map.deep), share(map.shallow)));
}

constexpr double kDeflate = 1032;  // bytes in one of a compressed file, at best

constexpr ExportFormat kFormats[]{
    {.name = "exr",
     .file = "heightmap.exr",
     .holds = "heights in um, 32-bit float, high is bright",
     .repeated = true,
     .pixels_per_byte = kDeflate / 4,
     .judged = 1,
     .write = exr,
     .check = check_exr},
    {.name = "tiff",
     .file = "heightmap.tif",
     .holds = "heights in 16 bits between the lowest and the highest",
     .needs_polarity = true,
     .pixels_per_byte = kDeflate / 2,
     .judged = 4,
     .write = tiff,
     .check = check_tiff},
    {.name = "tiff32",
     .file = "heightmap_float.tif",
     .holds = "heights in um, 32-bit float",
     .asked_only = true,
     .pixels_per_byte = kDeflate / 4,
     .judged = 3,
     .write = tiff32,
     .check = check_tiff32},
    {.name = "mask",
     .file = "mask.tif",
     .holds = "black and white: where the surface is below half its depth",
     .needs_polarity = true,
     .follows_outline = true,
     .pixels_per_byte = kDeflate * 8,
     .write = mask,
     .check = check_mask},
    {.name = "gsf",
     .file = "heightmap.gsf",
     .holds = "heights in m, 32-bit float, for Gwyddion",
     .pixels_per_byte = 1.0 / 4,
     .judged = 2,
     .write = gsf,
     .check = check_gsf},
    {.name = "npy",
     .file = "heightmap.npy",
     .holds = "heights in m, double",
     .pixels_per_byte = 1.0 / 8,
     .write = npy,
     .check = check_doubles},
    {.name = "png",
     .file = "preview.png",
     .holds = "a picture with a colour scale and a scale bar",
     .write = png,
     .check = check_preview},
    {.name = "png16",
     .file = "heightmap.png",
     .holds = "heights in 16 bits of grey, with size and height for Gwyddion",
     .asked_only = true,
     .pixels_per_byte = kDeflate / 2,
     .write = png16,
     .check = check_png16},
    {.name = "x3p",
     .file = "heightmap.x3p",
     .holds = "heights in m, double, as ISO 25178-72 has it",
     .asked_only = true,
     .pixels_per_byte = kDeflate / 8,
     .write = x3p,
     .check = check_doubles},
    {.name = "gds",
     .file = "texture.gds",
     .holds = "polygons: one cell and an array reference of holes, pillars and grooves, contours "
              "of any other relief",
     .needs_outline = true,
     .write = gds,
     .check = check_gds},
    {.name = "oasis",
     .file = "texture.oas",
     .holds = "the polygons of `gds` as OASIS, a smaller file",
     .needs_outline = true,
     .asked_only = true,
     .write = oasis,
     .check = check_oasis},
    {.name = "stl",
     .file = "texture.stl",
     .holds = "triangles in um, the whole map on a closed block",
     .asked_only = true,
     .pixels_per_byte = 1.0 / 100,
     .write = stl,
     .check = check_stl},
    {.name = "dose",
     .file = "dose.png",
     .holds = "dose in 8 bits of grey, by the curve of --dose-curve",
     .needs_dose_curve = true,
     .pixels_per_byte = kDeflate,
     .write = dose,
     .check = check_dose},
};

}  // namespace

std::span<const ExportFormat> export_format_table() { return kFormats; }

std::string without_effect(std::span<const ExportFormat> written, const std::string& setting,
                           const std::string& formats,
                           const std::function<bool(const ExportFormat&)>& depends,
                           const std::string& of_no_file) {
  if (std::any_of(written.begin(), written.end(), depends)) return {};
  std::vector<std::string> names;
  for (const ExportFormat& format : export_format_table()) {
    if (depends(format)) names.emplace_back(format.name);
  }
  if (names.empty()) return fmt::format("{}: {}; leave it out", setting, of_no_file);
  return fmt::format("{} is of {}, and no such file is written: name one in {}, or leave {} out",
                     setting, join_names(names), formats, setting);
}

const std::vector<std::string>& export_formats() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const ExportFormat& format : kFormats) out.push_back(format.name);
    return out;
  }();
  return names;
}

const ExportFormat& find_export_format(const std::string& name) {
  for (const ExportFormat& format : kFormats) {
    if (format.name == name) return format;
  }
  throw InputError(
      fmt::format("unknown format \"{}\"; known: {}", name, join_names(export_formats())));
}

std::string heights_file(const std::vector<ExportedFile>& files) {
  std::vector<ExportFormat> judged;
  for (const ExportFormat& format : kFormats) {
    if (format.judged > 0) judged.push_back(format);
  }
  std::sort(judged.begin(), judged.end(),
            [](const ExportFormat& a, const ExportFormat& b) { return a.judged < b.judged; });
  std::string names;
  for (const ExportFormat& format : judged) {
    for (const ExportedFile& file : files) {
      if (file.format == format.name) return file.path;
    }
    names += (names.empty() ? "" : &format == &judged.back() ? " or " : ", ");
    names += format.name;
  }
  throw InputError("no file of heights to simulate: needs " + names);
}

}  // namespace papilla::fabricate
