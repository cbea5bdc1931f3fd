// Heights that a caller drew, as the file that a design names.
#pragma once

#include <memory>
#include <string>

#include "papilla/design.h"

namespace papilla::api {

// The file is there for as long as this is.
class DrawnMap {
 public:
  // Throws InputError for what is no map of square pixels on a square.
  explicit DrawnMap(Heights heights);
  ~DrawnMap();
  DrawnMap(const DrawnMap&) = delete;
  DrawnMap& operator=(const DrawnMap&) = delete;

  const Heights& heights() const { return heights_; }
  const std::string& file() const { return file_; }
  double width() const { return heights_.nx * heights_.dx; }

 private:
  Heights heights_;
  std::string file_;
  int maker_;  // the process that wrote the file, and removes it
};

}  // namespace papilla::api
