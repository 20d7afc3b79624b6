#pragma once

#include <coplane_contact/Plane.hpp>

#include <gtest/gtest.h>

#include <string>

namespace coplane
{
/// Tests of what both ways of computing forces have in common.
struct WithForces : testing::TestWithParam<ContactOptions::Forces>
{
  const ContactOptions usual = ContactOptions::with(GetParam());
  bool potential() const { return usual.forces == ContactOptions::Forces::Potential; }

  static auto both()
  {
    return testing::Values(ContactOptions::Forces::Potential, ContactOptions::Forces::CommonNormal);
  }
  static std::string name(const testing::TestParamInfo<ParamType>& info)
  {
    return info.param == ContactOptions::Forces::Potential ? "potential" : "commonNormal";
  }
};
} // namespace coplane
