// What each kind of texture says about itself, against the surface that it makes.
#include "geometry/facts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "geometry/io/files.h"
#include "geometry/texture.h"
#include "report/reference.h"

namespace papilla::tests::facts_test {
namespace {

std::pair<double, double> extent(const Texture& t) {
  const Heightmap h = generate(t, patch_grid(t, 128));
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  return {*low, *high};
}

// One of every kind that numbers alone make.
std::vector<Texture> all_kinds() {
  std::vector<Texture> out;
  for (std::size_t kind = 0; kind < texture_kinds().size(); ++kind) {
    if (numbers_alone(kind)) out.push_back(default_texture(kind));
  }
  return out;
}

Texture stack(Combine combine, std::vector<Texture> parts) {
  Stack out;
  out.combine = combine;
  out.parts = std::move(parts);
  return {out};
}

// A struct with a stated member cannot be made without it, nor can the facts of a texture.
struct Two {
  Stated<double> first;
  Stated<std::optional<double>> second;
};
template <class T>
concept MadeOfOne = requires {
  T{.first = 1.0};
};
template <class T>
concept MadeOfBoth = requires {
  T{.first = 1.0, .second = std::nullopt};
};
static_assert(MadeOfBoth<Two> && !MadeOfOne<Two>);
static_assert(!std::is_default_constructible_v<Two>);
static_assert(!std::is_default_constructible_v<TextureFacts>);
static_assert(!std::is_default_constructible_v<Roles>);

struct Silent : HoleArray {  // says nothing of its own facts
  static constexpr std::string_view kName = "silent";
  bool operator==(const Silent&) const = default;
};
TextureFacts facts(const Silent&) = delete;
static_assert(TextureKind<HoleArray> && !TextureKind<Silent>);

TEST(Facts, TheReliefOfEveryKindIsThatOfItsHeights) {
  for (const Texture& t : all_kinds()) {
    const Relief relief = facts(t).relief;
    const auto [low, high] = extent(t);
    EXPECT_EQ(relief.present, high > low) << texture_name(t);
    if (!relief.planes) continue;
    // A particle may be 1.7 times the mean radius (place_particles).
    EXPECT_GE(low, relief.planes->low - 1e-12) << texture_name(t);
    EXPECT_LE(high, 1.7 * relief.planes->high + 1e-12) << texture_name(t);
    EXPECT_GE(high - low, 0.9 * *relief.height()) << texture_name(t);
  }
}

TEST(Facts, AZeroOfWhatDecidesTheReliefIsFlat) {
  int asked = 0;
  for (Texture t : all_kinds()) {
    double* relief = roles(t).relief;
    if (!relief) continue;
    *relief = 0;
    EXPECT_FALSE(facts(t).relief.present) << texture_name(t);
    const auto [low, high] = extent(t);
    EXPECT_EQ(low, high) << texture_name(t);
    ++asked;
  }
  EXPECT_GE(asked, 5);
}

TEST(Facts, AnArrayHasTheMembersThatItsOutlineIsDrawnFrom) {
  int arrays = 0;
  for (Texture t : all_kinds()) {
    const TextureFacts known = facts(t);
    const auto* array = std::get_if<FeatureArray>(&known.outline);
    if (!array) continue;
    const Roles role = roles(t);
    ASSERT_TRUE(role.period && role.width && role.depth && role.edge_radius) << texture_name(t);
    EXPECT_EQ(*role.period, array->period);
    EXPECT_EQ(*role.width, array->width);
    EXPECT_EQ(known.period(), array->period);
    ++arrays;
  }
  EXPECT_GE(arrays, 3);
}

TEST(Facts, TheOpenShareIsTheShareOfHeightsBelowTheMiddle) {
  for (const Texture& t : all_kinds()) {
    const TextureFacts known = facts(t);
    if (!known.open_share || !known.relief.present) continue;
    const Heightmap h = generate(t, patch_grid(t, 512));
    const double middle = 0.5 * (known.relief.planes->low + known.relief.planes->high);
    const auto below = std::count_if(h.z.begin(), h.z.end(), [&](double z) { return z < middle; });
    EXPECT_NEAR(static_cast<double>(below) / static_cast<double>(h.z.size()), *known.open_share,
                0.01)
        << texture_name(t);
  }
}

TEST(Facts, RoughAndMeasuredSurfacesAndStacksOfThemHaveRelief) {
  const Texture rough{RandomRough{}}, smooth{RandomRough{.rms = 0}}, flat{Flat{}};
  Measured3d map;
  map.patch = 20e-6;
  EXPECT_TRUE(facts(rough).relief.present);
  EXPECT_FALSE(facts(smooth).relief.present);
  EXPECT_TRUE(facts(map).relief.present);
  EXPECT_TRUE(facts(stack(Combine::Sum, {flat, rough})).relief.present);
  EXPECT_TRUE(facts(stack(Combine::Sum, {flat, Texture{map}})).relief.present);
  EXPECT_FALSE(facts(stack(Combine::Sum, {flat, smooth})).relief.present);
  EXPECT_EQ(facts(stack(Combine::Sum, {rough, Texture{map}})).free_patch.side(12e-6), 20e-6);
}

TEST(Facts, TheHigherOfALandAndItsHolesIsFlat) {
  const Texture flat{Flat{}}, holes{HoleArray{}}, pillars{PillarArray{}};
  for (const Texture& t : {holes, pillars}) {
    for (const Combine combine : {Combine::Sum, Combine::Maximum}) {
      const Texture both = stack(combine, {flat, t});
      const auto [low, high] = extent(both);
      EXPECT_EQ(facts(both).relief.present, high > low);
      EXPECT_NEAR(*facts(both).relief.height(), high - low, 1e-12);
    }
  }
}

TEST(Facts, OutlinesAreThoseThatALayoutCanDraw) {
  const Texture rough{RandomRough{}}, holes{HoleArray{}};
  const auto none = [](const Texture& t) {
    return std::holds_alternative<NoOutline>(facts(t).outline);
  };
  EXPECT_TRUE(none(Texture{}) && none(rough) && none(Texture{ParticleFilm{}}));
  EXPECT_TRUE(none(stack(Combine::Sum, {Texture{}, rough})));
  EXPECT_FALSE(none(holes) || none(Texture{Measured3d{}}));
  EXPECT_FALSE(none(stack(Combine::Sum, {rough, holes})));
}

// Key, default, range and source of every number, as they are written down.
TEST(Keys, OfTexturesAreThoseOfTheReference) {
  for (const char* section : {"texture"}) {
    const std::string page = std::string(PAPILLA_SOURCE_DIR) + "/docs/reference/" + section + ".md";
    EXPECT_EQ(reference_section(section, ReferenceFormat::Markdown), read_bytes(page)) << section;
  }
}

}  // namespace
}  // namespace papilla::tests::facts_test
