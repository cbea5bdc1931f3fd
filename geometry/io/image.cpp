// EXR, TIFF and PNG written.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/error.h"
#include "base/file_writer.h"
#include "base/parallel.h"
#include "geometry/io/codec.h"
#include "geometry/io/files.h"
#include "geometry/io/layout.h"

namespace papilla::geometry {
namespace {

namespace fs = std::filesystem;
constexpr const char* kFixedDate = "2000:01:01 00:00:00";  // the same bytes on every run

// Large images are written and checked by strips of rows.
constexpr int kStripRows = 128;
// A compressed image of more pixels is read back by every 16th strip, spread over its height, and
// the last one; others are read back whole.
constexpr double kReadBackWhole = 1 << 24;
constexpr std::size_t kReadBackStep = 16;

// use(begin, strip) for every strip in turn, the next one being filled by fill(begin, strip) at the
// same time: the compressor's threads do not wait for it.
template <typename T, typename Fill, typename Use>
void stream(const std::vector<int>& begins, const Fill& fill, const Use& use) {
  std::array<std::vector<T>, 2> strips;
  if (!begins.empty()) fill(begins[0], strips[0]);
  for (std::size_t i = 0; i < begins.size(); ++i) {
    std::future<void> next;
    if (i + 1 < begins.size()) {
      next = std::async(std::launch::async, [&, i] { fill(begins[i + 1], strips[(i + 1) % 2]); });
    }
    use(begins[i], strips[i % 2]);
    if (next.valid()) next.get();
  }
}

ImageSpec plain_spec(const Grid& grid) {
  ImageSpec spec{.width = grid.nx, .height = grid.ny};
  spec.compressed = false;
  return spec;
}

// Writes an image of T that is never held whole: fill_row(y, out) gives row y, from the top. Read
// back and compared before the old file goes.
template <typename T, typename FillRow>
void write_rows(const std::string& path, ImageSpec spec, const FillRow& fill_row) {
  PartFile part(path);
  spec.sample = kSampleOf<T>;
  spec.attributes.emplace_back("DateTime", kFixedDate);
  spec.attributes.emplace_back("Software", "papilla " PAPILLA_VERSION);
  const auto fail = [&](const std::string& why) {
    std::error_code ignored;
    const bool full = fs::space(fs::path(path).parent_path(), ignored).available < 1 << 16;
    part.fail(why + (full ? " (the disk is full)" : ""));
  };
  const std::size_t width = static_cast<std::size_t>(spec.width) * spec.channels.size();
  // Whole blocks of 16 rows of the compressor, enough for its threads, 64 MB at most.
  const int rows = std::clamp(static_cast<int>((16u << 20) / width) / 16 * 16, 16, kStripRows);
  const auto strip_end = [&](int y) { return std::min(y + rows, spec.height); };
  const auto fill = [&](int begin, std::vector<T>& strip) {
    strip.resize(static_cast<std::size_t>(rows) * width);
    for (int y = begin; y < strip_end(begin); ++y)
      fill_row(y, &strip[static_cast<std::size_t>(y - begin) * width]);
  };
  std::vector<int> strips;
  for (int y = 0; y < spec.height; y += rows) strips.push_back(y);
  std::string error;
  const auto checked = [&](const std::string& why) {
    if (!why.empty()) fail(why);
  };
  const auto out = image_codec().create(part.path(), spec, error);
  if (!out) fail(error);
  stream<T>(strips, fill, [&](int y, const std::vector<T>& strip) {
    checked(out->write(y, strip_end(y), strip.data()));
  });
  checked(out->close());

  auto in = image_codec().open(part.path(), "", error);
  if (!in) fail("does not open again: " + error);
  if (static_cast<double>(spec.width) * spec.height > kReadBackWhole && spec.compressed) {
    std::vector<int> some;
    for (std::size_t i = 0; i < strips.size(); ++i) {
      if (i % kReadBackStep == 0 || i + 1 == strips.size()) some.push_back(strips[i]);
    }
    strips = some;
  }
  std::vector<T> back(static_cast<std::size_t>(rows) * width);
  stream<T>(strips, fill, [&](int y, const std::vector<T>& strip) {
    if (const auto why = in->read_rows(y, strip_end(y), spec.sample, back.data()); !why.empty())
      fail("does not read back: " + why);
    if (std::memcmp(back.data(), strip.data(),
                    static_cast<std::size_t>(strip_end(y) - y) * width * sizeof(T)) != 0) {
      fail("reads back with other values");
    }
  });
  in.reset();
  part.put();
}

void write_bytes_image(const std::string& path, const ImageSpec& spec,
                       const std::vector<std::uint8_t>& bytes) {
  const std::ptrdiff_t width = static_cast<std::ptrdiff_t>(spec.width) * std::ssize(spec.channels);
  write_rows<std::uint8_t>(path, spec, [&](int y, std::uint8_t* out) {
    std::copy_n(bytes.begin() + y * width, width, out);
  });
}

// In one pass of all processors; throws InputError for a height that is no number.
Planes checked_range(const std::string& path, const Heightmap& h) {
  constexpr std::int64_t kChunk = 1 << 14;  // stays in the cache
  const auto size = static_cast<std::int64_t>(h.z.size());
  std::vector<Planes> parts(static_cast<std::size_t>((size + kChunk - 1) / kChunk));
  std::atomic<bool> finite = true;
  parallel_for(static_cast<int>(parts.size()), [&](int p) {
    const double* z = h.z.data() + std::int64_t{p} * kChunk;
    const double* end = h.z.data() + std::min(size, (std::int64_t{p} + 1) * kChunk);
    bool all = true;  // no way out of the loop: it runs in vector registers
    for (const double* i = z; i < end; ++i) all &= std::isfinite(*i);
    if (!all) finite = false;
    parts[static_cast<std::size_t>(p)] = {
        std::reduce(z, end, *z, [](double a, double b) { return b < a ? b : a; }),
        std::reduce(z, end, *z, [](double a, double b) { return b > a ? b : a; })};
  });
  if (!finite) throw InputError("cannot write " + path + ": a height is not a finite number");
  Planes out = parts.front();
  for (const Planes& part : parts)
    out = {std::min(out.low, part.low), std::max(out.high, part.high)};
  return out;
}

// A height above the lowest plane. The lowest plane is exactly zero: rounding of double precision
// would give each of its pixels its own tiny number, and a file three times as large.
float micrometres(double height) { return height < 1e-15 ? 0 : static_cast<float>(1e6 * height); }

// Row y from the top, in micrometres above the lowest plane.
void micrometre_row(const Heightmap& h, double low, int y, float* out) {
  const double* row = &h.z[h.grid.index(0, h.grid.ny - 1 - y)];
  for (int ix = 0; ix < h.grid.nx; ++ix) out[ix] = micrometres(row[ix] - low);
}

void set_resolution(ImageSpec& spec, const Grid& grid) {
  const auto x = static_cast<float>(0.01 / grid.dx()), y = static_cast<float>(0.01 / grid.dy());
  auto& a = spec.attributes;
  a.emplace_back("XResolution", x);
  a.emplace_back("YResolution", y);
  a.emplace_back("ResolutionUnit", "cm");
  a.emplace_back("tiff:write_exif", 0);       // libtiff 4.5 fails on the empty Exif directory
  a.emplace_back("PixelAspectRatio", y / x);  // without it unequal pixels are silently made equal
}

// What other programs find of a TIFF. ImageJ takes lines of names and values: the unit of the
// resolution tags, and the heights of levels by c0 + c1 * level (cf = 0: a straight line); floats
// are in the unit themselves. All that our own reader needs stands on a line of its own.
std::string description(const Heightmap& h, const FileInfo& info, const char* polarity, double low,
                        double high, int levels) {
  nlohmann::ordered_json json{{"papilla", PAPILLA_VERSION},
                              {"title", info.title},
                              {"comment", info.comment},
                              {"size_x_m", h.grid.lx},
                              {"size_y_m", h.grid.ly},
                              {"polarity", polarity},
                              {"black_m", low},
                              {"white_m", high},
                              {"rows", "top first"}};
  const std::string heights = levels > 0 ? fmt::format("cf=0\nc0={:.9g}\nc1={:.9g}\n", 1e6 * low,
                                                       1e6 * (high - low) / levels)
                                         : "";
  return "ImageJ=1.53\nunit=cm\n" + heights + "vunit=um\n" + std::string(kOwnLine) + json.dump() +
         "\n";
}

void write_sixteen_bits(const std::string& path, const ImageSpec& spec, const Heightmap& h,
                        Planes range, Polarity polarity, bool binary) {
  const double low = range.low, span = range.high - low;
  write_rows<std::uint16_t>(path, spec, [&](int y, std::uint16_t* out) {
    for (int ix = 0; ix < h.grid.nx; ++ix) {
      double share = span > 0 ? (h(ix, h.grid.ny - 1 - y) - low) / span : 1;
      if (binary) share = share >= 0.5 ? 1 : 0;
      if (polarity == Polarity::WhiteDeep) share = 1 - share;
      out[ix] = static_cast<std::uint16_t>(std::lround(65535 * share));
    }
  });
}

void write_sixteen(const std::string& path, const Heightmap& h, Polarity polarity, bool binary,
                   const FileInfo& info, const std::optional<Planes>& between = std::nullopt) {
  const Planes pixels = checked_range(path, h), range = between.value_or(pixels);
  ImageSpec spec = plain_spec(h.grid);
  set_resolution(spec, h.grid);
  const auto [low, high] = range;
  const bool white_high = polarity == Polarity::WhiteHigh;
  spec.attributes.emplace_back(
      "ImageDescription", description(h, info, white_high ? "white-is-high" : "white-is-deep",
                                      white_high ? low : high, white_high ? high : low, 65535));
  write_sixteen_bits(path, spec, h, range, polarity, binary);
}

ImageSpec exr_spec(const Heightmap& h, int repeat, const FileInfo& info) {
  ImageSpec spec{.width = repeat * h.grid.nx, .height = repeat * h.grid.ny, .channels = {"Y"}};
  spec.attributes = {{"Gwy::XReal", repeat * h.grid.lx},
                     {"Gwy::YReal", repeat * h.grid.ly},
                     {"Gwy::XYUnit", "m"},
                     {"Gwy::ZUnit", "um"},
                     {"Gwy::Title", info.title}};
  if (!info.comment.empty()) spec.attributes.emplace_back("comments", info.comment);
  return spec;
}

}  // namespace

void write_exr(const std::string& path, const Heightmap& h, const FileInfo& info) {
  write_exr_repeated(path, h, 1, info);
}

void write_exr_repeated(const std::string& path, const Heightmap& h, int repeat,
                        const FileInfo& info, const std::function<void(double)>& progress) {
  const double low = checked_range(path, h).low;
  const auto rows = static_cast<double>(h.grid.ny) * repeat;
  int written = 0;  // a row is asked for again when it is read back
  write_rows<float>(path, exr_spec(h, repeat, info), [&](int y, float* out) {
    if (progress && y >= written && y % h.grid.ny == 0) progress(y / rows);
    written = std::max(written, y);
    micrometre_row(h, low, y % h.grid.ny, out);
    for (int r = 1; r < repeat; ++r)
      std::copy_n(out, h.grid.nx, out + static_cast<std::ptrdiff_t>(r) * h.grid.nx);
  });
}

void write_png16(const std::string& path, const Heightmap& h) {
  const Planes range = checked_range(path, h);
  ImageSpec spec{.width = h.grid.nx, .height = h.grid.ny};
  for (const auto& [name, value] : {std::pair{"Gwy::XReal", h.grid.lx},
                                    {"Gwy::YReal", h.grid.ly},
                                    {"Gwy::ZMin", range.low},
                                    {"Gwy::ZMax", range.high}}) {
    spec.attributes.emplace_back(name, fmt::format("{}", value));
  }
  spec.attributes.emplace_back("Gwy::XYUnit", "m");
  spec.attributes.emplace_back("Gwy::ZUnit", "m");
  write_sixteen_bits(path, spec, h, range, Polarity::WhiteHigh, false);
}

DoseMap write_dose(const std::string& path, const Heightmap& h, const DoseCurve& curve) {
  checked_range(path, h);
  DoseMap out;
  const std::vector<std::uint8_t> grey = dose_levels(h, curve, out);
  ImageSpec spec{.width = h.grid.nx, .height = h.grid.ny};
  set_resolution(spec, h.grid);
  write_bytes_image(path, spec, grey);
  return out;
}

void write_tiff_float(const std::string& path, const Heightmap& h, const FileInfo& info) {
  const double low = checked_range(path, h).low;
  ImageSpec spec = plain_spec(h.grid);
  set_resolution(spec, h.grid);
  spec.attributes.emplace_back("ImageDescription",
                               description(h, info, "white-is-high", 0, 1e-6, 0));
  write_rows<float>(path, spec, [&](int y, float* out) { micrometre_row(h, low, y, out); });
}

void write_tiff16(const std::string& path, const Heightmap& h, Polarity polarity,
                  const FileInfo& info) {
  write_sixteen(path, h, polarity, false, info);
}

void write_mask_tiff(const std::string& path, const Heightmap& h, Polarity polarity,
                     const FileInfo& info, const std::optional<Planes>& between) {
  write_sixteen(path, h, polarity, true, info, between);
}

void write_png_rgb(const std::string& path, int width, int height,
                   const std::vector<std::uint8_t>& rgb) {
  write_bytes_image(path, {.width = width, .height = height, .channels = {"", "", ""}}, rgb);
}

}  // namespace papilla::geometry
