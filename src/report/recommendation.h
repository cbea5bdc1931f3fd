// What should be built, of a finished run, in one paragraph: what it gains and costs, and what
// speaks against it.
#pragma once

#include <optional>
#include <string>

#include "base/rooms.h"
#include "search/advice.h"
#include "search/run.h"

namespace papilla::report {

// Its numbers carry what is behind them (stated_number.h).
std::string recommendation(const ResultFiles& files);

// The design that it is about, as it was searched.
FinalDesign recommended_of(const ResultFiles& files);
// That design on the grid of the fab: values as the sheet has them, in every digit.
Design built_design(const ResultFiles& files);
// What that is worth, as it was judged; as it was searched where it was not judged on the grid.
Score built_score(const ResultFiles& files);
// What a number of built_score is of, in the words of a claim: "what is built", or "what is
// recommended" where it is as searched.
std::string scored_name(const ResultFiles& files);
// Where the design that it is about is among the finalists: a surface without texture may be none
// of them.
std::optional<std::size_t> recommended_place(const ResultFiles& files);
// The same, of a design whose order was checked.
std::optional<std::size_t> checked_place(const ResultFiles& files);
// How many designs of the grid were judged for it.
std::string judged_on_grid(const BuiltDesign& build);

// "wall angle" of texture.wall_angle, "film thickness" of surface.dielectric.0.thickness: a key in
// the words of a sentence.
std::string plain_name(const std::string& path);
// "design 06" of front/06.
std::string design_name(const std::string& folder);
// Of best_flat: "design 06", or the surface of the study file.
std::string flat_name(const FinalDesign& flat);
// "grooves 1.2 um wide at the top, 349 nm deep, 5.41 um from one to the next, walls 88 deg steep"
std::string shape_text(const Design& design);
// "contact angle 90 deg (60 deg in the study file)": what of that which is built is not the
// texture's; "" where nothing was changed.
std::string finish_text(const ResultFiles& files);
// "contact angle of water 63 deg, peak voltage 180 V": what the variables say of a surface besides
// its texture. of: whose numbers these are, for the receipts.
std::string surface_text(const ResultFiles& f, const std::string& of, const Point& unit);

}  // namespace papilla::report
