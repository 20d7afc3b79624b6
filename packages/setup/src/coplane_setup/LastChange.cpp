#include <coplane_core/Error.hpp>
#include <coplane_schema/TimeFunctionEvaluator.hpp>
#include <coplane_setup/Lookups.hpp>
#include <coplane_setup/detail/LastChange.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
constexpr Real leastChange = 1e-9; // over the largest value
constexpr int samples = 10000;     // of an expression

/// Where a function of the place is asked: 3 points along each axis of the box around a set.
std::vector<Vec3> pointsAround(const std::vector<int>& nodes, const RankMesh& part,
                               const Comm& comm)
{
  std::vector<Real> extremes(6, -infinity); // of -x and x
  for (const int n : nodes)
    for (int c = 0; c < 3; ++c)
    {
      const Real x = part.coordinates[std::size_t(n)][c];
      extremes[std::size_t(c)] = std::max(extremes[std::size_t(c)], -x);
      extremes[std::size_t(3 + c)] = std::max(extremes[std::size_t(3 + c)], x);
    }
  comm.max(extremes);
  std::vector<Vec3> points;
  for (int i = 0; i < 27 && std::isfinite(extremes[0]); ++i)
  {
    const int steps[] = {i % 3, i / 3 % 3, i / 9};
    Vec3 point;
    for (int c = 0; c < 3; ++c)
    {
      const Real low = -extremes[std::size_t(c)], high = extremes[std::size_t(3 + c)];
      point[c] = low + 0.5 * steps[c] * (high - low);
    }
    points.push_back(point);
  }
  return points;
}

Real lastChangeOfTable(const TimeFunction& table, const Window& when)
{
  for (std::size_t i = table.values.size(); i-- > 1;)
    if (table.values[i] != table.values[i - 1] && table.times[i - 1] < when.until)
      return std::min(table.times[i], when.until);
  return 0;
}

/// Times lie the closer the earlier they are: the end is often given with plenty to spare.
Real lastChangeOfExpression(const TimeFunction& function, const std::vector<Vec3>& points,
                            const Window& when)
{
  TimeFunctionEvaluator evaluate(function);
  const auto valueAt = [&](Real t, const Vec3& point)
  {
    try
    {
      return evaluate(t, point);
    }
    catch (const Error&) // not finite there, where the run perhaps never comes
    {
      return Real(NAN);
    }
  };
  const auto timeOf = [&](int k)
  { return when.from + (when.until - when.from) * std::pow(Real(k) / samples, 3); };
  Real last = 0;
  for (const Vec3& point : function.ofPlace ? points : std::vector<Vec3>(1))
  {
    std::vector<Real> values(samples + 1);
    Real largest = 0, final = NAN;
    for (int k = 0; k <= samples; ++k)
      if (const Real value = values[std::size_t(k)] = valueAt(timeOf(k), point); value == value)
      {
        largest = std::max(largest, std::abs(value));
        final = value;
      }
    int k = samples;
    while (k >= 0 && !(std::abs(values[std::size_t(k)] - final) > leastChange * largest))
      --k;
    if (k >= 0)
      last = std::max(last, timeOf(std::min(k + 1, samples)));
  }
  return last;
}

class LastChange
{
public:
  LastChange(Real end, RelaxationOptions& into) : end_(end), into_(&into) {}

  void add(Real time, const std::string& what)
  {
    time = std::min(time, end_);
    if (time > into_->lastChange)
    {
      into_->lastChange = time;
      into_->changing = what;
    }
  }
  /// @param points where a function of the place is asked
  void add(const TimeFunction& function, const Window& when, const std::vector<Vec3>& points,
           const std::string& what)
  {
    const Window seen{when.from, std::min(when.until, end_)};
    if (seen.from >= seen.until)
      return;
    if (!function.times.empty())
      add(lastChangeOfTable(function, seen), what);
    else if (!function.expression.empty())
      add(lastChangeOfExpression(function, points, seen), what);
  }
  Real end() const { return end_; }

private:
  Real end_;
  RelaxationOptions* into_;
};

/// What varies with the time in a condition.
std::vector<TimeFunction> functionsOf(const ConditionCard& card)
{
  std::vector<TimeFunction> functions{card.pressure};
  for (const auto* vector :
       {&card.velocity, &card.displacement, &card.acceleration, &card.traction, &card.incident})
    functions.insert(functions.end(), vector->begin(), vector->end());
  for (const auto* vector : {&card.translation, &card.spin})
    if (*vector)
      functions.insert(functions.end(), (*vector)->begin(), (*vector)->end());
  return functions;
}

std::vector<int> nodesOf(const ConditionCard& card, const Mesh& mesh, const RankMesh& part)
{
  if (card.type == "rigid_motion")
    return {};
  if (!card.onSides())
    return part.nodeSets[std::size_t(indexOf(mesh.nodeSets, card.set))];
  std::vector<int> nodes;
  for (const RankMesh::Side& side : part.sideSets[std::size_t(indexOf(mesh.sideSets, card.set))])
  {
    const RankMesh::Block& block = part.blocks[std::size_t(side.block)];
    const ElementTopology& shape = topology(block.type);
    for (int k = 0; k < shape.nodesPerSide; ++k)
      nodes.push_back(block.connectivity[std::size_t(
          side.element * shape.nodes + shape.sideNodes[std::size_t(side.side)][std::size_t(k)])]);
  }
  return nodes;
}
} // namespace

void findLastChange(const Deck& deck, const Mesh& mesh, const RankMesh& part, const Comm& comm,
                    Conditions& conditions)
{
  LastChange last(deck.time.end, conditions.relaxation);
  for (const TimeFunction& function : deck.gravity)
    last.add(function, {}, {}, "gravity");
  for (std::size_t i = 0; i < deck.conditions.size(); ++i)
  {
    const ConditionCard& card = deck.conditions[i];
    const std::string what = fmt::format("conditions.{} ({})", i, card.where);
    const Window when{card.from, card.until.value_or(infinity)};
    if (when.from < last.end())
      last.add(when.until < last.end() ? when.until : when.from, what);
    const std::vector<Vec3> points = pointsAround(nodesOf(card, mesh, part), part, comm);
    for (const TimeFunction& function : functionsOf(card))
      last.add(function, when, points, what);
  }
  Real blast = 0;
  for (const AirBlast& load : conditions.airBlasts)
    for (const BlastSide& face : load.sides)
      blast = std::max(blast, std::min(load.when.until,
                                       face.wave.arrival + std::max(face.wave.incident.duration,
                                                                    face.wave.reflected.duration)));
  last.add(comm.max(blast), "an air blast");
}
} // namespace coplane
