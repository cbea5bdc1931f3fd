// Zips as other programs write them, by libzip.
#pragma once

#include <zip.h>

#include <cstdint>
#include <string>
#include <vector>

#include "base/digest.h"
#include "base/files.h"
#include "base/rooms.h"

namespace papilla::tests {

struct ZipEntry {
  std::string name, bytes;
};

inline void write_zip(const std::string& path, const std::vector<ZipEntry>& entries,
                      int method = ZIP_CM_DEFLATE) {
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  for (const ZipEntry& entry : entries) {
    zip_source_t* source =
        zip_source_buffer(archive, entry.bytes.data(), entry.bytes.size(), /*freep=*/0);
    const auto index = zip_file_add(archive, entry.name.c_str(), source, ZIP_FL_OVERWRITE);
    zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), method, 0);
  }
  zip_close(archive);
}

inline std::string md5_of(const std::string& bytes) {
  Md5 sum;
  sum.add(bytes.data(), bytes.size());
  return sum.finish();
}

// The parts of an X3P of ours, which is not compressed: its XML and its heights.
struct X3pParts {
  std::string xml, heights;
};
inline X3pParts x3p_parts(const std::string& path, std::size_t pixels) {
  const std::string bytes = read_bytes(path);
  const std::size_t begin = bytes.find("<?xml"), end = bytes.find("</p:ISO5436_2>\n") + 15;
  const std::size_t data = bytes.find("bindata/data.bin", end) + 16;
  return {bytes.substr(begin, end - begin), bytes.substr(data, 8 * pixels)};
}

}  // namespace papilla::tests
