// GSF and NPY: headers of text, then plain numbers.
#include "geometry/io/raw.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <vector>

#include "base/error.h"
#include "base/file_writer.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/units.h"
#include "geometry/io/files.h"
#include "geometry/io/height_rows.h"

namespace papilla::geometry {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little endian");

[[noreturn]] void broken(const std::string& path, const std::string& why) {
  throw InputError("cannot read " + path + ": " + why);
}

double real_value(const std::string& path, const std::map<std::string, std::string>& header,
                  const std::string& key) {
  const auto it = header.find(key);
  if (it == header.end()) broken(path, "no " + key + " in the header");
  double value = 0;
  const auto [end, error] =
      std::from_chars(it->second.data(), it->second.data() + it->second.size(), value);
  if (error != std::errc{} || !std::isfinite(value) || value <= 0)
    broken(path, key + " is not a positive number");
  return value;
}

// The line of a GSF that an export of a design has, and no instrument.
constexpr const char* kDesignKey = "PapillaDesign";

class PlainRows : public HeightRows {
 public:
  void next(double* heights) override {
    get_heights(heights, static_cast<std::size_t>(header_.nx));
  }

 protected:
  explicit PlainRows(const RegularFile& file)
      : path_(file.path()), size_(file.bytes()), file_(file.stream()) {}
  // The first bytes of the file, as many as there are.
  std::string head(std::size_t most) {
    std::string out(std::min<std::uint64_t>(most, size_), '\0');
    get(out.data(), out.size());
    return out;
  }
  // All heights in the order of the file.
  std::vector<double> all() {
    std::vector<double> out(static_cast<std::size_t>(header_.nx) *
                            static_cast<std::size_t>(header_.ny));
    get_heights(out.data(), out.size());
    return out;
  }
  // The heights begin there, and nothing follows them.
  void begin(std::uint64_t at) {
    const std::uint64_t item = single_ ? sizeof(float) : sizeof(double);
    const auto pixels = static_cast<std::uint64_t>(header_.nx) * static_cast<unsigned>(header_.ny);
    const std::uint64_t due = at + item * pixels;
    if (size_ < due) broken(path_, "the data are cut off");
    if (size_ > due) {
      broken(path_, fmt::format("{} bytes more than {} x {} pixels have: its heights are not what "
                                "its header says",
                                size_ - due, header_.nx, header_.ny));
    }
    file_.seekg(static_cast<std::streamoff>(at));
  }

  std::string path_;
  std::uint64_t size_ = 0;
  bool single_ = false;  // 32-bit numbers
  double scale_ = 1;     // to metres

 private:
  void get_heights(double* to, std::size_t count) {
    if (single_) {
      singles_.resize(count);
      get(singles_.data(), count * sizeof(float));
      for (std::size_t i = 0; i < count; ++i) to[i] = scale_ * static_cast<double>(singles_[i]);
    } else {
      get(to, count * sizeof(double));
      for (std::size_t i = 0; i < count; ++i) to[i] *= scale_;
    }
  }
  void get(void* to, std::size_t bytes) {
    if (!file_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes)))
      broken(path_, "the data are cut off");
  }

  std::ifstream file_;
  std::vector<float> singles_;
};

// As a header of lines can hold it: a line end within would begin another key, and a zero ends the
// header.
std::string as_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  return text;
}

std::string trimmed(std::string s) {
  while (!s.empty() && s.back() == ' ') s.pop_back();
  while (!s.empty() && s.front() == ' ') s.erase(0, 1);
  return s;
}

class GsfRows : public PlainRows {
 public:
  explicit GsfRows(const std::string& path) : PlainRows(RegularFile(path)) {
    const std::string bytes = head(std::size_t{1} << 20);
    if (!bytes.starts_with("Gwyddion Simple Field 1.0\n"))
      broken(path, "not a Gwyddion Simple Field");
    const std::size_t end = bytes.find('\0');
    if (end == std::string::npos) broken(path, "the header does not end");
    std::map<std::string, std::string> header;
    std::size_t at = bytes.find('\n') + 1;
    while (at < end) {
      const std::size_t stop = std::min(bytes.find('\n', at), end);
      const std::string line = bytes.substr(at, stop - at);
      const std::size_t equals = line.find('=');
      if (equals != std::string::npos)
        header[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
      at = stop + 1;
    }
    const double nx = real_value(path, header, "XRes"), ny = real_value(path, header, "YRes");
    check_size(path, nx, ny);
    const auto unit = [&](const char* key) {
      const auto it = header.find(key);
      const auto u = it == header.end() ? find_unit("m") : find_unit(it->second);
      if (!u || !u->same_dimension(*find_unit("m")))
        broken(path, std::string(key) + " is not a length unit");
      return u->to_si;
    };
    const double xy = unit("XYUnits");
    scale_ = unit("ZUnits");
    single_ = true;
    header_.nx = static_cast<int>(nx);
    header_.ny = static_cast<int>(ny);
    // The format leaves it to its writers whether the sides are said.
    const auto side = [&](const char* key) {
      return header.count(key) > 0 ? xy * real_value(path, header, key) : 0;
    };
    header_.lx = side("XReal");
    header_.ly = side("YReal");
    header_.made = header.count(kDesignKey) > 0;
    begin((end / 4 + 1) * 4);
  }
};

// What stands behind a key of the header, a Python dictionary: from there to its end.
std::string_view npy_value(const std::string& path, const std::string& header, const char* key) {
  const std::string quoted = fmt::format("'{}': ", key);
  const std::size_t at = header.find(quoted);
  if (at == std::string::npos) broken(path, fmt::format("no {} in the header", key));
  return std::string_view(header).substr(at + quoted.size());
}

class NpyRows : public PlainRows {
 public:
  explicit NpyRows(const std::string& path) : PlainRows(RegularFile(path)) {
    const std::string bytes = head(std::size_t{1} << 17);
    if (bytes.size() < 12 || !bytes.starts_with("\x93NUMPY")) broken(path, "not a .npy file");
    const bool first = bytes[6] == 1;
    std::size_t length = 0;
    const std::size_t at = first ? 10 : 12;
    std::memcpy(&length, bytes.data() + 8, first ? 2 : 4);
    if (bytes.size() < at + length) broken(path, "the header is cut off");
    const std::string header = bytes.substr(at, length);
    const std::string_view type = npy_value(path, header, "descr");
    single_ = type.starts_with("'<f4'");
    if (!single_ && !type.starts_with("'<f8'")) {
      broken(path, fmt::format("its numbers are {}; needs float64 or float32, little endian: "
                               "array.astype('<f8')",
                               type.substr(0, type.find(", 'fortran_order'"))));
    }
    by_columns_ = npy_value(path, header, "fortran_order").starts_with("True");
    const std::string shape(npy_value(path, header, "shape"));
    const std::string written = shape.substr(0, shape.find(')') + 1);
    long rows = 0, columns = 0;
    int end = 0;
    if (std::sscanf(written.c_str(), "(%ld, %ld)%n", &rows, &columns, &end) != 2 || end == 0)
      broken(path, "needs a two-dimensional array, got the shape " + written);
    check_size(path, static_cast<double>(columns), static_cast<double>(rows));
    header_.nx = static_cast<int>(columns);
    header_.ny = static_cast<int>(rows);
    header_.top_first = false;
    header_.made = true;
    begin(at + length);
  }

  void next(double* heights) override {
    if (!by_columns_) return PlainRows::next(heights);
    // Fortran order: a column after the other. All of them are read before the first row.
    if (columns_.empty()) columns_ = all();
    const auto ny = static_cast<std::size_t>(header_.ny);
    for (std::size_t ix = 0; ix < static_cast<std::size_t>(header_.nx); ++ix)
      heights[ix] = columns_[ix * ny + row_];
    ++row_;
  }

 private:
  bool by_columns_ = false;
  std::vector<double> columns_;
  std::size_t row_ = 0;
};

}  // namespace

std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xff);
  return out;
}

void check_size(const std::string& path, double nx, double ny) {
  constexpr double kMostPixels = 268435456;  // 2^28: 2 GiB of doubles
  if (!(nx >= 1 && ny >= 1 && nx * ny <= kMostPixels)) {
    broken(path, fmt::format("{:.0f} x {:.0f} pixels; at most 2^28 can be read", nx, ny));
  }
  if (nx != std::floor(nx) || ny != std::floor(ny)) broken(path, "not a whole number of pixels");
  require_memory(16 * nx * ny, fmt::format("{} ({:.0f} x {:.0f} pixels)", path, nx, ny));
}

void write_gsf(const std::string& path, const Heightmap& h, const FileInfo& info) {
  std::string header = "Gwyddion Simple Field 1.0\n";
  header += fmt::format(
      "XRes = {}\nYRes = {}\nXReal = {}\nYReal = {}\nXYUnits = m\nZUnits = m\nTitle = {}\n",
      h.grid.nx, h.grid.ny, h.grid.lx, h.grid.ly, as_one_line(info.title));
  if (!info.comment.empty())
    header += fmt::format("{} = {}\n", kDesignKey, as_one_line(info.comment));
  header.append(4 - header.size() % 4, '\0');
  FileWriter out(path);
  out.append(header);
  std::vector<float> row(static_cast<std::size_t>(h.grid.nx));
  for (int iy = h.grid.ny - 1; iy >= 0; --iy) {  // top row first: y grows upward here
    for (int ix = 0; ix < h.grid.nx; ++ix)
      row[static_cast<std::size_t>(ix)] = static_cast<float>(h(ix, iy));
    out.append(row.data(), row.size() * sizeof(float));
  }
  out.commit();
}

void write_npy(const std::string& path, const Heightmap& h) {
  std::string header = fmt::format(
      "{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", h.grid.ny, h.grid.nx);
  const std::size_t total = (10 + header.size() + 1 + 63) / 64 * 64;
  header.append(total - 10 - header.size() - 1, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  FileWriter out(path);
  out.append("\x93NUMPY\x01\x00", 8);
  out.append(&length, sizeof length);
  out.append(header);
  out.append(h.z.data(), h.z.size() * sizeof(double));
  out.commit();
}

std::unique_ptr<HeightRows> open_gsf_rows(const std::string& path) {
  return std::make_unique<GsfRows>(path);
}

std::unique_ptr<HeightRows> open_npy_rows(const std::string& path) {
  return std::make_unique<NpyRows>(path);
}

}  // namespace papilla::geometry
