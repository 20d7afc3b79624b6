#include "CutEstimate.hpp"

#include "OpeningSection.hpp"
#include "ShapeModel.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/PlaceText.hpp>

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace coplane
{
namespace
{
/// What of a polygon, or of a line of two corners, lies in the box.
std::vector<Vec3> clipped(std::vector<Vec3> corners, int dimension, const Vec3& low,
                          const Vec3& high)
{
  for (int axis = 0; axis < dimension; ++axis)
    for (const Real sign : {-1.0, 1.0})
    {
      const auto beyond = [&](const Vec3& x)
      { return sign < 0 ? low[axis] - x[axis] : x[axis] - high[axis]; };
      std::vector<Vec3> inside;
      for (std::size_t k = 0; k < corners.size(); ++k)
      {
        const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()];
        const Real p = beyond(a), q = beyond(b);
        if (p <= 0)
          inside.push_back(a);
        if ((p < 0 && q > 0) || (p > 0 && q < 0))
          inside.push_back(a + (p / (p - q)) * (b - a));
      }
      corners = std::move(inside);
    }
  return corners;
}

/// Cuts nothing.
bool isOnBorder(const std::vector<Vec3>& corners, int dimension, const Vec3& low, const Vec3& high)
{
  for (int axis = 0; axis < dimension; ++axis)
    for (const Real border : {low[axis], high[axis]})
      if (std::all_of(corners.begin(), corners.end(),
                      [&](const Vec3& x)
                      { return std::abs(x[axis] - border) < 1e-6 * (high[axis] - low[axis]); }))
        return true;
  return false;
}

/// Normal times area; in two dimensions times length.
Vec3 areaVector(const std::vector<Vec3>& corners, int dimension)
{
  Vec3 sum{};
  if (corners.size() < 2)
    return sum;
  if (dimension == 2)
  {
    Vec3 longest{};
    for (const Vec3& corner : corners)
      if (norm(corner - corners[0]) > norm(longest))
        longest = corner - corners[0];
    return {-longest.y, longest.x, 0};
  }
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    sum += 0.5 * cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
  return sum;
}
} // namespace

Real estimatedParts(const std::vector<JointSurface>& surfaces, int dimension, const Vec3& low,
                    const Vec3& high)
{
  Real volume = 1, count = 1;
  for (int axis = 0; axis < dimension; ++axis)
    volume *= high[axis] - low[axis];
  const Real edge = std::pow(volume, 1.0 / dimension);
  Vec3 m[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; // 1 + L F
  for (const JointSurface& surface : surfaces)
  {
    const std::vector<Vec3> part = clipped(surface.corners, dimension, low, high);
    const Vec3 vector = areaVector(part, dimension);
    const Real area = norm(vector);
    if (!(area > 0) || isOnBorder(part, dimension, low, high))
      continue;
    ++count;
    for (int axis = 0; axis < 3; ++axis)
      m[axis] += (edge / volume * vector[axis] / area) * vector;
  }
  return std::max(count, dot(cross(m[0], m[1]), m[2]));
}

void demandFewParts(const BlocksRecipe& recipe, const std::string& recipeFile,
                    const std::vector<JointSurface>& surfaces, const Vec3& low, const Vec3& high,
                    Real thickness)
{
  Problems problems;
  const auto demand = [&](const JointsCard& card, const char* what, Real spacing)
  {
    if (spacing > 0 && spacing <= thickness)
      problems.add(nodeAt(recipe.root, {"joints", card.name, what}),
                   fmt::format("joints.{}.{}: spacing = {:.6g} m is not more than "
                               "slivers.thickness = {:.6g} m: each part would be a sliver. All "
                               "lengths are in metres; accepted: a larger spacing, smaller "
                               "elements.size or slivers.thickness.",
                               card.name, what, spacing, thickness));
  };
  for (const JointsCard& card : recipe.joints)
  {
    demand(card, "set", card.set.spacing);
    for (const JointPlaneCard& plane : card.planes)
      demand(card, "planes", plane.spacing);
  }
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  Real parts = estimatedParts(surfaces, recipe.dimension, low, high);
  for (const JointsCard& card : recipe.joints)
    parts += card.voronoi.cells;
  if (parts <= recipe.elements.mostParts)
    return;
  std::vector<std::string> each;
  for (std::size_t j = 0; j < recipe.joints.size(); ++j)
  {
    const JointsCard& card = recipe.joints[j];
    const auto count =
        std::count_if(surfaces.begin(), surfaces.end(),
                      [&](const JointSurface& surface) { return surface.joint == int(j); });
    each.push_back(card.voronoi.cells > 0
                       ? fmt::format("{} cells of joints.{}", card.voronoi.cells, card.name)
                       : fmt::format("{} surfaces of joints.{}", count, card.name));
  }
  fail(ExitCode::Deck,
       "{}: the joints cut the domain into about {:.2g} parts ({}), and up to "
       "elements.most_parts = {:.6g} are cut. All lengths are in metres. Make spacings or "
       "fractures larger or fewer, or raise elements.most_parts: cutting takes long.",
       recipeFile, parts, fmt::join(each, ", "), recipe.elements.mostParts);
}

void demandFewSides(const BlocksRecipe& recipe, const std::string& recipeFile, const Vec3& low,
                    const Vec3& high)
{
  const Real diagonal = norm(high - low);
  Problems problems;
  Real sides = 0;
  std::vector<std::string> each;
  for (const OpeningCard& card : recipe.openings)
  {
    const auto [width, height] = extentOf(card);
    if (std::max(width, height) > 2 * diagonal)
      problems.add(
          nodeAt(recipe.root, {"openings", card.name}),
          fmt::format("openings.{} is {:.6g} m wide and {:.6g} m high, and the domain measures "
                      "{:.4g} m from corner to corner. All lengths are in metres; accepted: a "
                      "section that is not wider or higher than twice that.",
                      card.name, width, height, diagonal));
    const Real size = card.elementSize > 0 ? card.elementSize : recipe.elements.size;
    sides += cornersOf(card, size);
    each.push_back(fmt::format("{:.6g} of openings.{} with elements of {:.6g} m",
                               cornersOf(card, size), card.name, size));
  }
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  if (sides > recipe.elements.mostParts)
    fail(ExitCode::Deck,
         "{}: the sections of openings have about {:.6g} sides ({}), and up to "
         "elements.most_parts = {:.6g} are cut. All lengths are in metres. Make the sizes of "
         "elements at openings larger, or raise elements.most_parts: cutting takes long.",
         recipeFile, sides, fmt::join(each, ", "), recipe.elements.mostParts);
}

std::vector<std::string> notesOfLargeOpenings(const BlocksRecipe& recipe,
                                              const std::vector<Real>& shares)
{
  std::vector<std::string> notes;
  for (std::size_t o = 0; o < shares.size(); ++o)
    if (shares[o] > 0.5)
    {
      const auto [width, height] = extentOf(recipe.openings[o]);
      notes.push_back(fmt::format("openings.{}, {:.6g} m wide and {:.6g} m high, takes {:.3g} % of "
                                  "the domain. All lengths are in metres",
                                  recipe.openings[o].name, width, height, 100 * shares[o]));
    }
  return notes;
}

std::vector<std::string> notesOfSizes(const BlocksRecipe& recipe, const Vec3& low, const Vec3& high)
{
  std::vector<std::string> notes;
  const Real extent = norm(high - low), resolution = 1e-3 * recipe.elements.size;
  for (const JointsCard& card : recipe.joints)
    if (card.set.spacing > extent)
      notes.push_back(fmt::format("joints.{}.set: spacing = {:.6g} m is more than the domain "
                                  "measures, {:.4g} m from corner to corner",
                                  card.name, card.set.spacing, extent));
  int number = 0;
  for (const ElementSizeCard& region : recipe.elements.regions)
  {
    ++number;
    for (std::size_t axis = 0; axis < region.box.min.size(); ++axis)
      if (region.box.min[axis] >= high[int(axis)] || region.box.max[axis] <= low[int(axis)])
      {
        notes.push_back(fmt::format(
            "elements.regions: the box of the region {}, from {} to {} m, lies outside of the "
            "domain, which reaches from {} to {} m: it makes no elements smaller but those near it",
            number, placeText(toVec3(region.box.min), resolution),
            placeText(toVec3(region.box.max), resolution), placeText(low, resolution),
            placeText(high, resolution)));
        break;
      }
  }
  return notes;
}

std::vector<std::string> notesOfOutside(const BlocksRecipe& recipe,
                                        const std::vector<JointSurface>& surfaces,
                                        const std::vector<bool>& outside)
{
  std::map<int, std::vector<std::string>> names; // by the joint
  std::map<int, int> all;
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    if (!surfaces[s].source.empty())
    {
      ++all[surfaces[s].joint];
      if (outside[s])
        names[surfaces[s].joint].push_back(surfaces[s].source);
    }
  std::vector<std::string> notes;
  for (auto& [joint, list] : names)
  {
    const std::size_t count = list.size(), told = std::min<std::size_t>(count, 10);
    list.resize(told);
    notes.push_back(fmt::format("joints.{}: {} of {} lie wholly outside of the domain: {}{}",
                                recipe.joints[std::size_t(joint)].name, count, all[joint],
                                fmt::join(list, ", "),
                                count > told ? fmt::format(", and {} more", count - told) : ""));
  }
  return notes;
}
} // namespace coplane
