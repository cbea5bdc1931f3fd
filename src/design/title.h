// What a design is called after some of its values were set.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"

namespace papilla::design {

inline constexpr std::size_t kLongestTitle = 1000;  // it stands in every file and on every page

// The title of a design that was read with these overrides ("texture.depth=300 nm"), with what they
// made another design of behind it: "Holes; texture.depth 300 nm". Of more than three values their
// sections, "texture changed". An empty title, one that the overrides give, and one that would be
// longer than titles are stays as it is.
std::string title_as_set(const Design& design, const std::vector<std::string>& overrides);

// The same of a design that a search made of the one before: by its kind and its numbers, four
// digits each; "; texture flat" where the relief went. The title of `made` itself says nothing.
std::string title_as_changed(const Design& before, const Design& made);

}  // namespace papilla::design
