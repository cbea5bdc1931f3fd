#include "fabricate/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "base/text.h"
#include "config/writer.h"
#include "design/limits.h"
#include "fabricate/formats.h"
#include "forward/forward.h"
#include "geometry/io/files.h"
#include "geometry/measured_map.h"
#include "metrics/metrics.h"

namespace papilla::fabricate {
namespace {

double mean_of(const Metric& metric, const Response& response) {
  const auto value = summarise(Summary::Mean, metric, response);
  if (!value) throw InputError("the file cannot be judged: " + text(response.troubles()));
  return value->value;
}

// The highest place of a texture over its untouched land [m]: the film below the heights of a file
// lies there, wherever the file has its zero. Eq. geometry.9
double top_of(const Texture& texture, const Grid& grid) {
  if (const auto planes = facts(texture).relief.planes) return planes->high;
  const Heightmap h = generate(texture, grid);
  return *std::max_element(h.z.begin(), h.z.end());
}

// The design beside the files of a run, which names a belief: no file is made by it.
FileVerdict verify_design(const ExportRecord& record, const std::string& path) {
  Design beside = read_study(path, {}, DesignUse::Drawn).design, made_from = record.design;
  beside.finger.belief.clear();
  made_from.finger.belief.clear();  // records of earlier versions have it
  if (beside == made_from) return {path, FileState::Sound, {}};
  const std::vector<std::string> is = split(to_toml(beside), '\n'),
                                 was = split(to_toml(made_from), '\n');
  const auto [a, b] = std::mismatch(is.begin(), is.end(), was.begin(), was.end());
  return {path,
          FileState::Differs,
          {fmt::format("is another design than the files were made from: `{}`, there `{}`",
                       a == is.end() ? "" : *a, b == was.end() ? "" : *b)}};
}

FileVerdict verify_file(const ExportRecord& record, const Export& made, const ExportedFile& file,
                        const FileProgress& progress) {
  if (!std::filesystem::exists(file.path)) return {file.path, FileState::Missing, {"is missing"}};
  try {
    if (file.format == kDesignFormat) return verify_design(record, file.path);
    const FileInfo info = info_of(record.design);
    const std::function<void(double)> share = [&](double done) {
      if (progress) progress(file.path, done);
    };
    share(0);
    std::vector<std::string> faults =
        find_export_format(file.format)
            .check({made.heightmap, made.texture, record.options, info, share}, file.path);
    // What is drawn of the same design, a preview or a layout, may be drawn otherwise by another
    // version.
    if (!faults.empty() && record.version != PAPILLA_VERSION) {
      faults.push_back(fmt::format(
          "it was made by {}, and this is {}, which may write such a file otherwise: make it anew "
          "with `papilla export`",
          record.version.empty() ? "papilla 0.2.2 or an earlier one" : "papilla " + record.version,
          PAPILLA_VERSION));
    }
    const FileState state = faults.empty() ? FileState::Sound : FileState::Differs;
    return {file.path, state, std::move(faults)};
  } catch (const InputError& error) {
    return {file.path, FileState::Unreadable, {error.what()}};
  }
}

// Files of known names that the record does not have.
std::vector<ExportedFile> strangers(const ExportRecord& record, const std::string& folder) {
  std::vector<ExportedFile> out;
  for (const ExportFormat& format : export_format_table()) {
    const std::string path = folder + "/" + format.file;
    const auto same = [&](const ExportedFile& file) { return file.path == path; };
    if (std::filesystem::exists(path) &&
        std::none_of(record.files.begin(), record.files.end(), same))
      out.push_back({format.name, path});
  }
  return out;
}

// How many pixels the maps of a record can hold: a record is a text that anybody can write, and
// memory is taken for as many as it asks for. Of layouts alone nobody knows, nor where the maps
// were taken away from beside them.
double pixels_held(const ExportRecord& record) {
  constexpr double kAlways = 1 << 24;
  double pixels = 0;
  bool maps = false;
  for (const ExportedFile& file : record.files) {
    if (file.format == kDesignFormat) continue;
    std::error_code missing;
    const auto size = std::filesystem::file_size(file.path, missing);
    if (missing) continue;
    const double per_byte = find_export_format(file.format).pixels_per_byte;
    maps = maps || per_byte > 0;
    pixels = std::max(pixels, per_byte * static_cast<double>(size));
  }
  return maps ? std::clamp(pixels, kAlways, kMostPixels) : kMostPixels;
}

FileVerdict verify_stranger(const ExportRecord& record, const Export& made,
                            const ExportedFile& file, const FileProgress& progress) {
  const ExportFormat& format = find_export_format(file.format);
  FileVerdict out{file.path, FileState::Differs, {"is not among the files of this export"}};
  if ((format.needs_polarity && !record.options.polarity) ||
      (format.needs_dose_curve && !record.options.dose_curve))
    return out;
  const FileVerdict judged = verify_file(record, made, file, progress);
  if (judged.state == FileState::Sound) return judged;
  out.state = judged.state;
  out.faults.insert(out.faults.end(), judged.faults.begin(), judged.faults.end());
  return out;
}

}  // namespace

std::vector<FileVerdict> verify_files(const ExportRecord& record, const Export& made,
                                      const FileProgress& progress) {
  std::vector<FileVerdict> out;
  for (const ExportedFile& file : record.files)
    out.push_back(verify_file(record, made, file, progress));
  return out;
}

std::vector<FileVerdict> verify_folder(const std::string& folder, const std::string& file,
                                       const FileProgress& progress) {
  ExportRecord record = read_record(folder);
  const Export made = prepare_export(record.design, record.options, pixels_held(record));
  std::vector<ExportedFile> foreign = strangers(record, folder);
  if (!file.empty()) {
    const auto other = [&](const ExportedFile& f) { return f.path != folder + "/" + file; };
    std::erase_if(record.files, other);
    std::erase_if(foreign, other);
    if (record.files.empty() && foreign.empty())
      throw InputError(fmt::format("{}/{}: no file of the export in this folder", folder, file));
  }
  std::vector<FileVerdict> out = verify_files(record, made, progress);
  for (const ExportedFile& f : foreign) out.push_back(verify_stranger(record, made, f, progress));
  return out;
}

namespace {

// A patch of the design with pixels of the file's size.
Grid like_file(const Texture& texture, const Heightmap& h) {
  constexpr int kFewest = 64;
  const double side = patch_grid(texture, kFewest).lx;
  return patch_grid(texture, std::max(kFewest, static_cast<int>(std::lround(side / h.grid.dx()))));
}

// Whether the map of a texture is as narrow half-way down, to a pixel. Round rims widen shallow
// holes.
bool is_as_narrow(const Constraint& limit, const Texture& texture, const Grid& grid,
                  double narrowest) {
  const PixelMargins own = measure_margins(generate(texture, grid));
  const std::optional<double> there = in_pixels(limit.on, own);
  return there && narrowest >= *there - own.pixel;
}

// Whether a map that is narrower than a limit is the design all the same: it keeps the limit at the
// land, and its own map is as narrow.
bool as_designed(const Constraint& limit, const Texture& texture, const Grid& grid,
                 double narrowest) {
  const auto* shape = std::get_if<ShapeLimit>(&limit.on);
  return shape && keeps(limit, margin_of(shape->margin, facts(texture).margins)) &&
         is_as_narrow(limit, texture, grid, narrowest);
}

// Whether a part with edges is as narrow by itself: then nothing is left between two of them. A
// part of several masks is asked for each of its own.
bool one_mask_is_as_narrow(const Constraint& limit, const Stack& stack, const Grid& grid,
                           double narrowest) {
  return std::any_of(stack.parts.begin(), stack.parts.end(), [&](const Texture& part) {
    if (const auto* inner = std::get_if<Stack>(&part.kind))
      return one_mask_is_as_narrow(limit, *inner, grid, narrowest);
    // Grains of a surface without edges are no holes and walls.
    return std::isfinite(facts(part).margins.smallest()) &&
           is_as_narrow(limit, part, grid, narrowest);
  });
}

// against: what the design of the study is.
Verification held_against(const std::string& against, const Study& study, const std::string& file,
                          double tolerance, double width) {
  const Design& design = study.design;
  // Files are made of designs that cannot be simulated too: of droplets without end.
  if (const auto wrong = design_problems(design); !wrong.empty())
    throw InputError("the file cannot be simulated: " + wrong[0].path + ": " + wrong[0].message);
  const Heightmap h = read_heightmap(file, width);
  Verification out;
  out.against = against;
  out.pixels = measure_margins(h);
  // Grains of a surface without edges are no holes and walls.
  if (!std::isfinite(facts(design.texture).margins.smallest()))
    out.pixels.min_hole = out.pixels.min_wall = kInfinity;
  for (const Constraint& c : study.constraints) {
    const std::optional<double> narrowest = in_pixels(c.on, out.pixels);
    Constraint to_a_pixel = c;
    to_a_pixel.limit -= out.pixels.pixel;
    if (!narrowest || keeps(to_a_pixel, *narrowest)) continue;
    const std::string narrow =
        fmt::format("{} of the file is {:.3g} um, below {:.3g} um (pixel {:.2g} um)",
                    limit_name(c.on), 1e6 * *narrowest, 1e6 * c.limit, 1e6 * out.pixels.pixel);
    const Grid grid = like_file(design.texture, h);
    const auto* stack = std::get_if<Stack>(&design.texture.kind);
    if (!as_designed(c, design.texture, grid, *narrowest)) {
      out.faults.push_back(narrow);
    } else if (stack && !one_mask_is_as_narrow(c, *stack, grid, *narrowest)) {
      out.notes.push_back(
          narrow +
          ", as the design is: each part of the stack alone keeps the limit, made by a "
          "mask of its own; what the features of two masks leave between them "
          "rests on their alignment");
    }
  }
  Fidelity fidelity = fidelity_level("draft");
  fidelity.grid = std::max(fidelity.grid, design.accuracy.grid);
  const Scene scene = scene_of(design);
  const Plan plan = make_plan(scene, design.texture, fidelity);
  out.merit = design.drive.driven() ? "mean(modulation)" : "mean(friction)";
  const Metric metric = design.drive.driven() ? kModulation : kFriction;
  const Response own = evaluate(scene, design.texture, fidelity);
  out.design = mean_of(metric, own);
  // The files may be right all the same.
  if (const auto said = own.said(); !said.empty())
    out.notes.push_back("of the design itself: " + text(said));
  // Where nothing repeats as much of the map as a patch of the design is; whole, where it is hardly
  // larger. What repeats is laid on the patch of the design cell by cell, from its corner: half a
  // period further skins would meet it at other places.
  const double side = std::min(h.grid.lx, h.grid.ly);
  Measured3d map;
  map.file = file;
  map.width = width;
  map.cell = facts(design.texture).cell;
  map.patch = map.cell                    ? std::min(side, plan.grid.lx)
              : side < 1.5 * plan.grid.lx ? side
                                          : plan.grid.lx;
  if (too_coarse(h.grid, map.patch)) {
    out.file = out.loss = std::numeric_limits<double>::quiet_NaN();
    out.faults.push_back(
        fmt::format("a pixel of the file is {:.3g} um wide: the patch of {:.4g} um that is felt "
                    "holds fewer than {:g} of them; export finer pixels",
                    1e6 * std::max(h.grid.dx(), h.grid.dy()), 1e6 * map.patch, kFewestPixels));
    return out;
  }
  // What is exported repeats: nothing is to be levelled or mended, nor blended unless it is cut.
  map.as_is = map.cell || map.patch == side;
  map.top = top_of(design.texture, h.grid);
  out.file = mean_of(metric, evaluate(scene, Texture{map}, fidelity));
  out.loss = std::abs(out.file - out.design) / std::abs(out.design);
  if (!(out.loss <= tolerance)) {
    out.faults.push_back(
        fmt::format("{} of the file is {:.4g}, of {} {:.4g}: {:.2g} % off, more than {:.2g} %",
                    out.merit, out.file, out.against, out.design, 100 * out.loss, 100 * tolerance));
  }
  return out;
}

}  // namespace

Verification verify_export(const Study& study, const std::string& file, double tolerance,
                           double width) {
  return held_against(Verification{}.against, study, file, tolerance, width);
}

Verification verify_export(const ExportRecord& record, double tolerance) {
  Study drawn;
  drawn.design = record.design;
  drawn.design.texture = compensated(record.design.texture, record.options.bias);
  drawn.constraints = record.limits;
  const bool undone = drawn.design.texture != record.design.texture;
  return held_against(undone ? "the design with the process undone" : Verification{}.against, drawn,
                      heights_file(record.files), tolerance, 0);
}

}  // namespace papilla::fabricate
