#include "OpeningSection.hpp"

#include "ShapeModel.hpp"

#include <algorithm>
#include <cmath>

namespace coplane
{
std::array<Real, 2> measuresOf(const OpeningCard& card)
{
  if (card.circle > 0)
    return {2 * pi * card.circle, pi * card.circle * card.circle};
  if (!card.horseshoe.empty())
  {
    const Real width = card.horseshoe[0], upright = card.horseshoe[1] - width / 2;
    return {width + 2 * upright + pi * width / 2, width * upright + pi * width * width / 8};
  }
  const std::vector<Vec3> corners = toPoints(card.polygon);
  Real perimeter = 0;
  Vec3 twiceArea{};
  for (std::size_t k = 0; k < corners.size(); ++k)
  {
    const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()];
    perimeter += norm(b - a);
    twiceArea += cross(a, b);
  }
  return {perimeter, norm(twiceArea) / 2};
}

std::array<Real, 2> extentOf(const OpeningCard& card)
{
  if (card.circle > 0)
    return {2 * card.circle, 2 * card.circle};
  if (!card.horseshoe.empty())
    return {card.horseshoe[0], card.horseshoe[1]};
  std::array<Real, 2> extent{};
  for (std::size_t axis = 0; axis < 2; ++axis)
  {
    const auto [least, most] =
        std::minmax_element(card.polygon.begin(), card.polygon.end(),
                            [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    extent[axis] = (*most)[axis] - (*least)[axis];
  }
  return extent;
}

Real cornersOf(const OpeningCard& card, Real size)
{
  if (card.circle > 0)
    return std::max(6.0, std::ceil(2 * pi * card.circle / size));
  if (!card.horseshoe.empty())
    return 3 + std::max(18.0, std::ceil(pi * card.horseshoe[0] / 2 / size));
  return Real(card.polygon.size());
}

std::vector<std::array<Real, 2>> sectionOf(const OpeningCard& card, Real size)
{
  std::vector<std::array<Real, 2>> corners;
  const auto add = [&](Real radius, Real height, Real angle) {
    corners.push_back({radius * std::cos(angle), height + radius * std::sin(angle)});
  };
  if (card.circle > 0)
  {
    const int sides = int(cornersOf(card, size));
    const Real turn = 2 * pi / sides;
    for (int k = 0; k < sides; ++k) // the area is that of the circle
      add(card.circle * std::sqrt(turn / std::sin(turn)), 0, turn * k);
  }
  else if (!card.horseshoe.empty())
  {
    const Real half = card.horseshoe[0] / 2;
    corners.push_back({-half, 0});
    corners.push_back({half, 0});
    // The roof lacks up to 0.51 % of the area of its half circle.
    const int sides = int(cornersOf(card, size)) - 3;
    for (int k = 0; k <= sides; ++k)
      add(half, card.horseshoe[1] - half, pi * k / sides);
  }
  else
    for (const std::vector<Real>& corner : card.polygon)
      corners.push_back({corner[0], corner[1]});
  return corners;
}
} // namespace coplane
