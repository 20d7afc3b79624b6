#include <coplane_setup/Lookups.hpp>
#include <coplane_setup/detail/LinesOfDeck.hpp>

#include <cmath>

namespace coplane
{
namespace
{
/// Points between a and b, the latter included, at distances that are equal and not above `most`.
void divide(const Vec3& a, const Vec3& b, Real most, std::vector<LinePoint>& points)
{
  constexpr Real rounding = 1e-9;
  const int pieces = std::max(1, int(std::ceil(norm(b - a) / most - rounding)));
  for (int i = 1; i <= pieces; ++i)
    points.push_back({i == pieces ? b : a + (Real(i) / pieces) * (b - a), true, 0});
}

std::vector<LinePoint> pointsOf(const LineCard& card)
{
  std::vector<Vec3> path;
  for (const std::vector<Real>& point : card.points)
    path.push_back({point[0], point[1], point.size() > 2 ? point[2] : 0});
  std::vector<LinePoint> points{{path[0], true, 0}};
  constexpr Real rounding = 1e-9;
  Real left = card.freeLength; // of what has no grout
  for (std::size_t i = 1; i < path.size(); ++i)
  {
    Vec3 from = path[i - 1];
    const Real leg = norm(path[i] - from);
    if (left > (1 + rounding) * leg)
    {
      left -= leg; // a bend without grout has no force across: the bar takes the straight way
      continue;
    }
    if (left > 0)
    {
      const bool toTheEnd = left >= (1 - rounding) * leg;
      from = toTheEnd ? path[i] : from + (left / leg) * (path[i] - from);
      points.push_back({from, true, 0});
      left = 0;
      if (toTheEnd)
        continue;
    }
    divide(from, path[i], card.attach == "ends" ? infinity : card.segmentLength, points);
  }
  if (card.attach != "grout")
    return points;
  const std::size_t first = card.freeLength > 0 ? 1 : 0; // with grout
  for (std::size_t i = first; i < points.size(); ++i)
  {
    points[i].tied = card.freeLength == 0 && card.plate && i == 0;
    if (points[i].tied)
      continue;
    if (i > first)
      points[i].bonded += 0.5 * norm(points[i].place - points[i - 1].place);
    if (i + 1 < points.size())
      points[i].bonded += 0.5 * norm(points[i + 1].place - points[i].place);
  }
  return points;
}
} // namespace

std::vector<LineSetup> linesOf(const Deck& deck)
{
  std::vector<LineSetup> lines;
  for (const LineCard& card : deck.lines)
  {
    LineSetup line;
    line.where = card.where;
    line.section = {card.area / card.spacing,
                    card.youngsModulus,
                    card.yieldStress.value_or(infinity),
                    card.hardeningModulus,
                    card.ruptureStrain.value_or(infinity),
                    card.compression,
                    card.diameter.value_or(0),
                    card.rateExponent,
                    card.referenceRate};
    line.bond = {card.groutStiffness / card.spacing,
                 card.groutStrength.value_or(infinity) / card.spacing, card.groutFriction,
                 card.groutPerimeter / card.spacing};
    if (card.dowelStiffness)
      line.dowel = LineDowel{*card.dowelStiffness / card.spacing,
                             card.dowelStrength.value_or(infinity) / card.spacing};
    line.pretension = card.pretension / card.spacing;
    line.pretensionTime = card.pretensionTime;
    line.from = card.from;
    line.until = card.until.value_or(infinity);
    line.stage = card.stage.empty() ? 0 : indexOf(deck.stages, card.stage);
    line.points = pointsOf(card);
    line.bare = card.freeLength > 0 ? 1 : 0;
    const bool both = card.mirrored == "both";
    line.mirrored = {both || card.mirrored == "start", both || card.mirrored == "end"};
    line.points.front().tied |= line.mirrored[0];
    line.points.back().tied |= line.mirrored[1];
    for (int copy = 0; copy < card.copies; ++copy)
    {
      line.name = card.copies == 1 ? card.name : card.name + "_" + std::to_string(copy + 1);
      lines.push_back(line);
      for (LinePoint& point : line.points)
        point.place += card.copyStep;
    }
  }
  return lines;
}
} // namespace coplane
