#include "detail/JointKeys.hpp"

#include <algorithm>

namespace coplane
{
JointLaw makeLaw(const ClosureCurveParameters& p)
{
  JointLaw law = coulombLaw(p);
  law.initialStiffness = p.initialStiffness;
  law.curve.inverseMaximumClosure = p.maximumClosure > 0 ? 1 / p.maximumClosure : 0;
  law.stiffnessCap = p.stiffnessCap.value_or(0);
  return law;
}

JointLaw makeLaw(const TableParameters& p)
{
  JointLaw law = coulombLaw(p);
  law.curve.points = int(p.closures.size());
  std::copy(p.closures.begin(), p.closures.end(), law.curve.closure);
  std::copy(p.tractions.begin(), p.tractions.end(), law.curve.traction);
  law.stiffnessCap = p.stiffnessCap.value_or(0);
  return law;
}

namespace
{
void checkCurve(const ClosureCurveParameters& p, const CardPlace& card)
{
  checkCap(p.stiffnessCap, "initial_stiffness", p.initialStiffness, card);
  checkCoulomb(p, card);
}

void checkPoints(const TableParameters& p, const CardPlace& card)
{
  checkCoulomb(p, card);
  const auto &c = p.closures, &sigma = p.tractions;
  if (c.empty() || sigma.empty())
    return; // was reported where it was read, unless the list is empty
  if (c.size() != sigma.size())
    return card.problem("tractions",
                        fmt::format("has {} numbers, but closures has {}; accepted: as many.",
                                    sigma.size(), c.size()));
  if (int(c.size()) > ClosureCurve::capacity)
    return card.problem("closures", fmt::format("has {} points; accepted: at most {}.", c.size(),
                                                ClosureCurve::capacity));
  Real slope = 0;
  for (std::size_t i = 0; i < c.size(); ++i)
  {
    const Real from = i ? c[i - 1] : 0, below = i ? sigma[i - 1] : 0;
    if (!(c[i] > from))
      return card.problem("closures",
                          fmt::format("does not rise at item {}: {} m after {} m.", i, c[i], from));
    const Real next = (sigma[i] - below) / (c[i] - from);
    // Points on one straight line may differ by rounding.
    if (!(next > 0) || next < slope * (1 - 1e-12))
      return card.problem(
          "tractions",
          fmt::format("is less steep before item {} than before: {:.6g} Pa/m after {:.6g} Pa/m; "
                      "accepted: slopes that never fall, for the tangent of unloading.",
                      i, next, slope));
    slope = next;
  }
}
} // namespace

JointModel ClosureCurveParameters::model()
{
  using P = ClosureCurveParameters;
  using namespace schema;
  return JointModelOf<P>("closure_curve", "a hyperbola of the closure")
      .has({
          number("initial_stiffness", &P::initialStiffness)
              .needed()
              .in("Pa/m")
              .usually(usual::stiffness)
              .elsewhere({"kn", "jkn", "kni"})
              .above(0)
              .like("2e10")
              .means("slope of the closure curve at zero closure"),
          number("maximum_closure", &P::maximumClosure)
              .needed()
              .in("m")
              .above(0)
              .means("asymptote of the hyperbola")
              .like("5e-4"),
          stiffnessCapKey<P>(),
      })
      .has(coulombKeys<P>())
      .has({cohesionKey<P>()})
      .demands(checkCurve);
}

JointModel TableParameters::model()
{
  using P = TableParameters;
  using namespace schema;
  return JointModelOf<P>("table", "a table of it")
      .has({
          numbers("closures", &P::closures)
              .needed()
              .in("m")
              .above(0)
              .like("[1e-4, 2e-4]")
              .means("points of the closure curve after (0, 0), rising, at most 16; straight "
                     "beyond the "
                     "last"),
          numbers("tractions", &P::tractions)
              .needed()
              .in("Pa")
              .above(0)
              .like("[1e6, 4e6]")
              .means("tractions at `closures`; no segment may be less steep than the one before"),
          stiffnessCapKey<P>(),
      })
      .has(coulombKeys<P>())
      .has({cohesionKey<P>()})
      .demands(checkPoints);
}
} // namespace coplane
