// GDSII as its definition has it, read without a line of the writer: polygons in metres, every
// reference and array placed.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/rooms.h"

namespace papilla::tests {

struct GdsPolygon {
  int layer = 0;
  std::vector<double> x, y;  // [m], without the closing point

  double area() const {
    double sum = 0;
    for (std::size_t i = 0, n = x.size(); i < n; ++i)
      sum += x[i] * y[(i + 1) % n] - x[(i + 1) % n] * y[i];
    return 0.5 * std::abs(sum);
  }
  bool holds(double px, double py) const {
    bool in = false;
    for (std::size_t i = 0, j = x.size() - 1; i < x.size(); j = i++) {
      if ((y[i] > py) != (y[j] > py) && px < x[i] + (py - y[i]) / (y[j] - y[i]) * (x[j] - x[i]))
        in = !in;
    }
    return in;
  }
};

class GdsFile {
 public:
  double user_unit = 0, metre = 0;   // of a database unit
  std::vector<GdsPolygon> polygons;  // of the last structure, the top

  explicit GdsFile(const std::string& path) : bytes_(read_bytes(path)) {
    std::map<std::string, std::vector<GdsPolygon>> structures;
    std::string name, target;
    int element = 0, layer = 0, columns = 1, rows = 1;
    for (std::size_t at = 0; at + 4 <= bytes_.size();) {
      const auto length = static_cast<std::size_t>(number(at, 2));
      const auto type = number(at + 2, 2);
      const std::size_t data = at + 4;
      const auto text = [&] { return std::string(bytes_.substr(data, length - 4).c_str()); };
      if (type == 0x0305) user_unit = real(data), metre = real(data + 8);
      if (type == 0x0606) name = text();
      if (type == 0x1206) target = text();
      if (type == 0x0D02) layer = static_cast<int>(number(data, 2));
      if (type == 0x0800 || type == 0x0A00 || type == 0x0B00 || type == 0x0C00)
        element = static_cast<int>(type), columns = rows = 1;
      if (type == 0x1302)
        columns = static_cast<int>(number(data, 2)), rows = static_cast<int>(number(data + 2, 2));
      if (type == 0x1003 && element != 0x0C00) {  // of no text
        std::vector<std::pair<double, double>> points;
        for (std::size_t i = data; i < data + length - 4; i += 8)
          points.emplace_back(coordinate(i), coordinate(i + 4));
        add(structures[name], element == 0x0800 ? nullptr : &structures[target], layer, points,
            columns, rows);
      }
      if (length < 4) break;
      at += length;
    }
    polygons = structures[name];
  }

  double area() const {
    double sum = 0;
    for (const GdsPolygon& p : polygons) sum += p.area();
    return sum;
  }

 private:
  static void add(std::vector<GdsPolygon>& to, const std::vector<GdsPolygon>* placed, int layer,
                  const std::vector<std::pair<double, double>>& points, int columns, int rows) {
    if (!placed) {
      GdsPolygon polygon{layer, {}, {}};
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        polygon.x.push_back(points[i].first);
        polygon.y.push_back(points[i].second);
      }
      to.push_back(polygon);
      return;
    }
    const auto [x, y] = points[0];
    const auto step = [&](std::size_t i, int count) {
      return points.size() < 3
                 ? std::pair(0.0, 0.0)
                 : std::pair((points[i].first - x) / count, (points[i].second - y) / count);
    };
    const auto column = step(1, columns), row = step(2, rows);
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        for (GdsPolygon polygon : *placed) {
          for (double& v : polygon.x) v += x + i * column.first + j * row.first;
          for (double& v : polygon.y) v += y + i * column.second + j * row.second;
          to.push_back(std::move(polygon));
        }
      }
    }
  }
  std::uint64_t number(std::size_t at, std::size_t size) const {
    std::uint64_t out = 0;
    for (std::size_t i = 0; i < size; ++i)
      out = out << 8 | static_cast<unsigned char>(bytes_.at(at + i));
    return out;
  }
  double coordinate(std::size_t at) const {
    return metre * static_cast<std::int32_t>(number(at, 4));
  }
  // Excess-64 exponent of 16 and a mantissa of 56 bits.
  double real(std::size_t at) const {
    const std::uint64_t word = number(at, 8);
    return std::ldexp(static_cast<double>(word & 0x00ffffffffffffff),
                      4 * (static_cast<int>(word >> 56 & 0x7f) - 64) - 56);
  }

  std::string bytes_;
};

}  // namespace papilla::tests
