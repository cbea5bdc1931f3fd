// A design: a texture, its finish, the finger that feels it, the air and the drive, as a TOML file
// says them. docs/reference names every key.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "papilla/names.h"

namespace papilla::api {

// Heights of one sampled period or patch [m], high touches first; z is row-major, x fastest, ny
// rows of nx; a pixel is dx by dy [m].
struct Heights {
  int nx = 0, ny = 0;
  double dx = 0, dy = 0;
  std::vector<double> z;
};

// A number of a design, SI.
struct Number {
  std::string path;     // "texture.depth"
  std::string unit;     // for people: "nm"; the members below are SI
  std::string meaning;  // of the key
  double value = 0;
  double low = 0, high = 0;  // the range that is accepted
};

// How a texture looks on glass: photopic means; docs/theory/optics.md.
struct Look {
  double haze = 0, transmittance = 1;  // shares; the undeviated light through the plate
  double total_transmittance = 1;      // share: all light through the plate
  double gloss = 0;                    // gloss units at 60 deg (ISO 2813)
  double gloss_20 = 0, gloss_85 = 0;   // at 20 and 85 deg
  double distinctness = 1;             // of the reflected image at 20 deg, share
  double sparkle = 0;                  // of the subpixels of view.panel, share; 0 without one
  double colour_shift = 0;             // distance in CIE 1976 u'v'
  // Which theory answered: "flat", "phase screen", "effective medium", "rigorous", "refused".
  std::string regime;
  std::string warning;  // empty: inside the theory's validity
};

// Immutable, cheap to copy, safe to share between threads.
class Design {
 public:
  // A path of a value and the value as a file would write it: {"texture.depth", "350 nm"}. Behind
  // a path that ends with a colon bare numbers are SI: {"texture.depth:", "350e-9"}.
  using Values = std::vector<std::pair<std::string, std::string>>;

  // A file, or the text of one, with values that replace its own. A study is a design too. A file
  // that is not there is looked for in the designs folders. Both throw InputError with every
  // problem but more droplets than can be settled, which only what simulates minds.
  static Design read(const std::string& file, const Values& values = {});
  static Design parse(const std::string& toml, const Values& values = {});

  // Heights as they are drawn, or measured, as the texture: square, with square pixels, high
  // touches first; all else by `values`. `repeats`: they repeat by themselves and are taken as they
  // are, but for their zero: the highest place is the untouched land; one period is enough, and is
  // pressed as often side by side as textures of that period are. Else they are levelled, mended
  // and made periodic, as scans are: of the middle, 1/1.2 of their width, which is refused below
  // 3 um. They lie in a file that toml() names and that is there for as long as a design of them.
  // Throws InputError.
  static Design from_heights(const Heights& heights, const Values& values = {},
                             bool repeats = true);
  // The toml() of such a design, in another process or at another time.
  static Design parse(const std::string& toml, const Heights& heights);

  // The design with other values. It is read anew, all values together, so that those which go
  // together (a diameter and its period) are given in one call. Of another kind ("texture.type")
  // it has what is given here alone. Its title says what was changed, unless it is given; a design
  // without a title stays without one.
  Design with(const Values& values) const;
  Design with(const std::string& path, const std::string& value) const;

  // Throws InputError where no simulation settles it (too many droplets on its patch): evaluate(),
  // rank() and a study then refuse it, while export_files() and heights() draw it.
  void require_simulated() const;

  double number(const std::string& path) const;  // SI; throws InputError for a path that is none
  std::vector<Number> numbers() const;           // every number that a path names
  std::string title() const;
  const Heights* drawn() const;  // of from_heights; else null
  std::string toml() const;  // every value with the origin of each; reads back to the same design

  // A patch of whole periods, `pixels` along x; of from_heights with as many pixels as were given
  // (an even number of them) those themselves.
  Heights heights(int pixels) const;
  Look look() const;

  struct Inside;  // not for callers
  const Inside& inside() const { return *inside_; }

  explicit Design(std::shared_ptr<const Inside> inside) : inside_(std::move(inside)) {}

 private:
  std::shared_ptr<const Inside> inside_;
};

}  // namespace papilla::api
