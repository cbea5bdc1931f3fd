// GSF and NPY: headers of text, then plain numbers.
#include "geometry/io/raw.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <vector>

#include "base/error.h"
#include "base/file_writer.h"
#include "base/memory.h"
#include "base/units.h"
#include "geometry/io/files.h"

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

}  // namespace

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
      h.grid.nx, h.grid.ny, h.grid.lx, h.grid.ly, info.title);
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

Heightmap read_gsf(const std::string& path) {
  const std::string bytes = read_bytes(path);
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
    if (equals != std::string::npos) {
      const auto trim = [](std::string s) {
        while (!s.empty() && s.back() == ' ') s.pop_back();
        while (!s.empty() && s.front() == ' ') s.erase(0, 1);
        return s;
      };
      header[trim(line.substr(0, equals))] = trim(line.substr(equals + 1));
    }
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
  const double xy = unit("XYUnits"), z = unit("ZUnits");
  Heightmap h;
  h.grid = {static_cast<int>(nx), static_cast<int>(ny), xy * real_value(path, header, "XReal"),
            xy * real_value(path, header, "YReal")};
  const std::size_t data = (end / 4 + 1) * 4;
  if (bytes.size() < data + 4 * h.grid.size()) broken(path, "the data are cut off");
  h.z.resize(h.grid.size());
  for (int iy = 0; iy < h.grid.ny; ++iy) {
    for (int ix = 0; ix < h.grid.nx; ++ix) {
      float value;
      std::memcpy(&value, bytes.data() + data + 4 * h.grid.index(ix, h.grid.ny - 1 - iy), 4);
      h(ix, iy) = z * static_cast<double>(value);
    }
  }
  return h;
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

Heightmap read_npy(const std::string& path, double width) {
  const std::string bytes = read_bytes(path);
  if (bytes.size() < 12 || !bytes.starts_with("\x93NUMPY")) broken(path, "not a .npy file");
  const int major = bytes[6];
  std::size_t length = 0, at = 0;
  if (major == 1) {
    std::uint16_t n;
    std::memcpy(&n, bytes.data() + 8, 2);
    length = n;
    at = 10;
  } else {
    std::uint32_t n;
    std::memcpy(&n, bytes.data() + 8, 4);
    length = n;
    at = 12;
  }
  if (bytes.size() < at + length) broken(path, "the header is cut off");
  const std::string header = bytes.substr(at, length);
  const bool f8 = header.find("'<f8'") != std::string::npos,
             f4 = header.find("'<f4'") != std::string::npos;
  if (!f8 && !f4) broken(path, "needs float64 or float32 numbers (little endian)");
  if (header.find("'fortran_order': False") == std::string::npos)
    broken(path, "needs C order (numpy.ascontiguousarray)");
  const std::size_t open = header.find("'shape': (");
  long rows = 0, columns = 0;
  if (open == std::string::npos ||
      std::sscanf(header.c_str() + open, "'shape': (%ld, %ld)", &rows, &columns) != 2) {
    broken(path, "needs a two-dimensional array");
  }
  check_size(path, static_cast<double>(columns), static_cast<double>(rows));
  if (!(width > 0))
    broken(path,
           "the file holds no lateral size; give it (texture.width of a measured texture, the size "
           "option of a command)");
  Heightmap h;
  h.grid = {static_cast<int>(columns), static_cast<int>(rows), width,
            width * static_cast<double>(rows) / static_cast<double>(columns)};
  const std::size_t item = f8 ? 8 : 4;
  if (bytes.size() < at + length + item * h.grid.size()) broken(path, "the data are cut off");
  h.z.resize(h.grid.size());
  const char* data = bytes.data() + at + length;
  for (std::size_t i = 0; i < h.z.size(); ++i) {
    if (f8) {
      std::memcpy(&h.z[i], data + 8 * i, 8);
    } else {
      float value;
      std::memcpy(&value, data + 4 * i, 4);
      h.z[i] = static_cast<double>(value);
    }
  }
  return h;
}

}  // namespace papilla::geometry
