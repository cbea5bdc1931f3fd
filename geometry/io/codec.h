// Image files behind an interface (internal to geometry/io). OpenImageIO and the 240 libraries that
// it brings take 0.3 s to load, more than most commands run: they are in a module of their own
// (geometry/modules), which is loaded when the first image file is touched.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/rooms.h"

namespace papilla::geometry {

enum class Sample { U8, U16, F32, Other };

template <typename T>
inline constexpr Sample kSampleOf = sizeof(T) == 1   ? Sample::U8
                                    : sizeof(T) == 2 ? Sample::U16
                                                     : Sample::F32;

struct ImageSpec {
  int width = 0, height = 0, depth = 1;
  std::vector<std::string> channels{""};  // names, where they matter
  Sample sample = Sample::F32;            // in the file
  bool whole = false;                     // read: the file holds whole numbers of whatever width
  bool compressed = true;                 // to write: zip, or what the format has
  // By the library's names. Doubles stay doubles: Gwyddion ignores floats.
  std::vector<std::pair<std::string, std::variant<int, float, double, std::string>>> attributes{};
};

// Begins the line of an ImageDescription that our own reader takes: JSON.
inline constexpr std::string_view kOwnLine = "papilla=";

// Errors are texts, "" where all is well: no exception crosses the module.
class ImageOut {
 public:
  virtual ~ImageOut() = default;
  // Rows begin to end - 1 from the top, of the spec's sample.
  virtual std::string write(int begin, int end, const void* rows) = 0;
  virtual std::string close() = 0;
};

class ImageIn {
 public:
  virtual ~ImageIn() = default;
  virtual const ImageSpec& spec() const = 0;  // without the attributes
  virtual std::optional<double> number(const std::string& attribute) const = 0;  // doubles alone
  virtual std::optional<float> single(const std::string& attribute) const = 0;   // floats alone
  virtual std::optional<int> whole(const std::string& attribute) const = 0;      // ints alone
  virtual std::string text(const std::string& attribute) const = 0;
  virtual std::string read_rows(int begin, int end, Sample sample, void* rows) = 0;
};

class ImageCodec {
 public:
  virtual ~ImageCodec() = default;
  // The format is that of the ending. Null: `error` says why.
  virtual std::unique_ptr<ImageOut> create(const std::string& path, const ImageSpec& spec,
                                           std::string& error) const = 0;
  // reader: "openexr", "tiff"; "": that of the ending.
  virtual std::unique_ptr<ImageIn> open(const std::string& path, const std::string& reader,
                                        std::string& error) const = 0;
};

// Version of the classes above: the module of another build is refused.
constexpr int kCodecInterface = 4;

// Loads the module on the first call. Throws std::runtime_error where it does not load.
const ImageCodec& image_codec();

}  // namespace papilla::geometry
