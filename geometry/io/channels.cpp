#include "geometry/io/channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/error.h"

namespace papilla::geometry {
namespace {

std::string listed(const std::vector<MapChannel>& channels) {
  std::string out;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const MapChannel& c = channels[i];
    out += fmt::format("{}{} \"{}\" ({}, {} x {})", i > 0 ? "; " : "", i + 1, c.name,
                       c.unit.empty() ? "no unit" : c.unit, c.nx, c.ny);
  }
  return out;
}

[[noreturn]] void ask(const std::string& path, const std::string& why,
                      const std::vector<MapChannel>& channels) {
  throw InputError(fmt::format(
      "cannot read {0}: {1}; its channels are {2}; name one behind the file, by its name "
      "or number: \"{0}::{3}\"",
      path, why, listed(channels), channels.front().name));
}

}  // namespace

std::size_t choose_channel(const std::string& path, const std::vector<MapChannel>& channels,
                           const std::string& asked) {
  if (channels.empty()) throw InputError("cannot read " + path + ": it holds no map");
  std::vector<std::size_t> fit;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(asked.data(), asked.data() + asked.size(), number);
  const bool is_number = error == std::errc{} && end == asked.data() + asked.size();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (asked.empty() ? channels[i].heights : channels[i].name == asked) fit.push_back(i);
  }
  if (fit.empty() && is_number && number >= 1 && number <= channels.size()) fit = {number - 1};
  if (fit.size() > 1) {
    ask(path,
        asked.empty() ? fmt::format("{} of its channels hold heights", fit.size())
                      : fmt::format("{} of its channels are called \"{}\"", fit.size(), asked),
        channels);
  }
  if (fit.empty()) {
    ask(path, asked.empty() ? "none of its channels holds heights" : "no channel \"" + asked + "\"",
        channels);
  }
  if (!channels[fit[0]].heights) {
    throw InputError(fmt::format(
        "cannot read {}: its channel \"{}\" is in {}, not a length", path, channels[fit[0]].name,
        channels[fit[0]].unit.empty() ? "no unit" : channels[fit[0]].unit));
  }
  return fit[0];
}

}  // namespace papilla::geometry
