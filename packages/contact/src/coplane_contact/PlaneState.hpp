#pragma once

#include <coplane_contact/Plane.hpp>

namespace coplane
{
/// Calls f(name, value&) for all that a plane keeps from cycle to cycle, in the order of the
/// columns of checkpoints. Not among them: the key, `face` (positions in tables of this rank; its
/// candidacy is a column of its own) and `countedHere`.
template <class F>
void forEachMember(Plane& plane, F&& f)
{
  // Flags are bits, to which nothing can refer.
  const auto flag = [&](const char* name, bool now)
  {
    f(name, now);
    return now;
  };
  const auto vector = [&](const char* x, const char* y, const char* z, Vec3& v)
  {
    f(x, v.x);
    f(y, v.y);
    f(z, v.z);
  };
  f("stiffness", plane.stiffness);
  f("joint", plane.joint);
  f("block_0", plane.block[0]);
  f("block_1", plane.block[1]);
  f("state", plane.state);
  f("missed_searches", plane.missedSearches);
  plane.declared = flag("declared", plane.declared);
  plane.born = flag("born", plane.born);
  plane.fresh = flag("fresh", plane.fresh);
  plane.foundLate = flag("found_late", plane.foundLate);
  plane.inherited = flag("inherited", plane.inherited);
  plane.slidesOn = flag("slides_on", plane.slidesOn);
  plane.released = flag("released", plane.released);
  plane.tooDeep = flag("too_deep", plane.tooDeep);
  plane.leads = flag("leads", plane.leads);
  plane.stiff = flag("stiff", plane.stiff);
  f("fit_normal_stiffness", plane.fit.normalStiffness);
  f("fit_stiffness_cap", plane.fit.stiffnessCap);
  f("fit_shear_stiffness", plane.fit.shearStiffness);
  vector("force_x", "force_y", "force_z", plane.force);
  vector("moment_x", "moment_y", "moment_z", plane.moment);
  f("area", plane.area);
  f("overlap", plane.overlap);
  static constexpr const char* weights[2][4] = {
      {"weight_00", "weight_01", "weight_02", "weight_03"},
      {"weight_10", "weight_11", "weight_12", "weight_13"}};
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 4; ++k)
      f(weights[side][k], plane.weights[side][k]);
  vector("normal_x", "normal_y", "normal_z", plane.normal);
  vector("point_x", "point_y", "point_z", plane.pointOfContact);
  f("gap", plane.gap);
  f("offset", plane.offset);
  f("maximum_closure", plane.history.maximumClosure);
  vector("shear_x", "shear_y", "shear_z", plane.history.shearTraction);
  f("slip", plane.history.slip);
  f("opening", plane.history.opening);
  f("shearing", plane.history.shearing);
  f("bonded", plane.history.bonded);
  f("closure", plane.closure);
  f("normal_traction", plane.normalTraction);
  f("depth_limit", plane.depthLimit);
  f("work", plane.work);
  f("friction_work", plane.frictionWork);
  f("hysteresis_work", plane.hysteresisWork);
  f("fracture_work", plane.fractureWork);
  f("damping_work", plane.dampingWork);
}
// A new member changes one of these sizes: it belongs into the list above.
static_assert(sizeof(Plane) == 6 * 64 && sizeof(JointState) == 8 * sizeof(Real) &&
              sizeof(JointFit) == 3 * sizeof(Real));
} // namespace coplane
