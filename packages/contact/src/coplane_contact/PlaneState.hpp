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
  f("node_stiffness", plane.nodeStiffness);
  f("joint", plane.joint);
  f("block_0", plane.block[0]);
  f("block_1", plane.block[1]);
  f("state", plane.state);
  f("sighting", plane.sighting);
  f("refusal", plane.refusal);
  f("lineage", plane.lineage);
  plane.declared = flag("declared", plane.declared);
  plane.tooDeep = flag("too_deep", plane.tooDeep);
  plane.stiff = flag("stiff", plane.stiff);
  f("exits", plane.exits);
  f("turns", plane.turns);
  f("covered", plane.covered);
  f("fit_normal_stiffness", plane.fit.normalStiffness);
  f("fit_stiffness_cap", plane.fit.stiffnessCap);
  f("fit_shear_stiffness", plane.fit.shearStiffness);
  f("area", plane.area);
  f("overlap", plane.overlap);
  static constexpr const char* forces[2][4][3] = {{{"force_00_x", "force_00_y", "force_00_z"},
                                                   {"force_01_x", "force_01_y", "force_01_z"},
                                                   {"force_02_x", "force_02_y", "force_02_z"},
                                                   {"force_03_x", "force_03_y", "force_03_z"}},
                                                  {{"force_10_x", "force_10_y", "force_10_z"},
                                                   {"force_11_x", "force_11_y", "force_11_z"},
                                                   {"force_12_x", "force_12_y", "force_12_z"},
                                                   {"force_13_x", "force_13_y", "force_13_z"}}};
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 4; ++k)
      vector(forces[side][k][0], forces[side][k][1], forces[side][k][2], plane.nodal[side][k]);
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
  f("birth_area_0", plane.birthArea[0]);
  f("birth_area_1", plane.birthArea[1]);
  f("stored", plane.stored);
  f("maximum_before", plane.maximumBefore);
  f("half_hysteresis", plane.halfHysteresis);
  f("work", plane.work);
  f("friction_work", plane.frictionWork);
  f("hysteresis_work", plane.hysteresisWork);
  f("fracture_work", plane.fractureWork);
  f("damping_work", plane.dampingWork);
}
// A new member belongs into the list above, or is found anew at searches. It changes one of these
// sizes, unless it fits into what is filled up today.
static_assert(sizeof(Plane) == 8 * 64 && sizeof(JointState) == 8 * sizeof(Real) &&
              sizeof(JointFit) == 3 * sizeof(Real));
} // namespace coplane
