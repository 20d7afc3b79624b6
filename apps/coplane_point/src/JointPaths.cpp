#include "JointPaths.hpp"

#include <coplane_input/JointCards.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
using RecordJoint = std::function<void(const JointPoint&)>;

/// From the present gap to another, without slip.
void closeTo(JointPoint& point, Real gap, int steps, Real speed, const RecordJoint& record)
{
  const Real from = point.gap();
  const Real dt = std::abs(gap - from) / steps / speed;
  for (int i = 1; i <= steps; ++i)
  {
    point.moveTo(i == steps ? gap : from + (gap - from) * i / steps, point.slip(), dt);
    record(point);
  }
}

void closing(const JointPathCard& card, JointPoint& point, const RecordJoint& record)
{
  for (const Real closure : card.closures)
    closeTo(point, -closure, card.steps, card.speed, record);
}

/// One step of slip under the normal traction, which rises by the surroundings' stiffness times the
/// opening from `start`.
void slipTo(const JointPathCard& card, JointPoint& point, const Vec3& slip, Real start,
            const RecordJoint& record)
{
  const Real dt = norm(slip - point.slip()) / card.speed;
  const Real gap =
      point.balancedGap(slip, dt, card.normalTraction, card.surroundingStiffness, start);
  point.moveTo(gap, slip, dt);
  record(point);
}

void shear(const JointPathCard& card, JointPoint& point, const RecordJoint& record)
{
  const Real start = point.gap();
  for (const Real target : card.slips)
  {
    const Real from = point.slip().x;
    for (int i = 1; i <= card.steps; ++i)
      slipTo(card, point,
             {i == card.steps ? target : from + (target - from) * i / card.steps, 0, 0}, start,
             record);
  }
}

void circle(const JointPathCard& card, JointPoint& point, const RecordJoint& record)
{
  const Real start = point.gap();
  const int steps = std::max(1, int(std::lround(card.turns * card.steps)));
  for (int i = 1; i <= steps; ++i)
  {
    const Real angle = 2 * pi * card.turns * i / steps;
    slipTo(card, point, {card.radius * (std::cos(angle) - 1), card.radius * std::sin(angle), 0},
           start, record);
  }
}

void points(const JointPathCard& card, JointPoint& point, const RecordJoint& record)
{
  for (std::size_t k = 0; k < card.times.size(); ++k)
  {
    const Real from = point.gap(), dt = (card.times[k] - (k ? card.times[k - 1] : 0)) / card.steps;
    const Vec3 before = point.slip(), slip{card.slipsX[k], card.slipsY[k], 0};
    for (int i = 1; i <= card.steps; ++i)
    {
      const Real part = Real(i) / card.steps;
      point.moveTo(from + part * (card.gaps[k] - from), before + part * (slip - before), dt);
      record(point);
    }
  }
}
} // namespace

JointPoint pointOf(const PointDeck& deck, const JointPathCard& card)
{
  const auto joint = std::find_if(deck.joints.begin(), deck.joints.end(),
                                  [&](const JointCard& one) { return one.name == card.joint; });
  const JointLaw law = jointLawOf(*joint);
  const Real h = deck.elements.thickness > 0 ? deck.elements.thickness : 1;
  const Real M = deck.elements.isRigid() ? infinity : deck.elements.modulus;
  return JointPoint(law, law.fittedTo(h, M, h, M), card.declared);
}

void followPath(const JointPathCard& card, JointPoint point, const RecordJoint& record)
{
  record(point);
  if (card.normalTraction > 0)
    closeTo(point, -point.closureUnder(card.normalTraction), std::min(card.steps, 200), card.speed,
            record);
  if (card.type == "closing")
    closing(card, point, record);
  else if (card.type == "shear")
    shear(card, point, record);
  else if (card.type == "circle")
    circle(card, point, record);
  else
    points(card, point, record);
}
} // namespace coplane
